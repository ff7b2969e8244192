//! Arithmetic of f32 in whole numbers, for cores without a unit for it: to the bit what IEEE 754 asks, rounded to nearest, ties
//! to even. The compiler's own routines are quicker by a little, and three times as long.

use core::cmp::Ordering;

/// Sign of a number's bits.
const SIGN: u32 = 1 << 31;
const INFINITY: u32 = 0x7f80_0000;
const NAN: u32 = 0x7fc0_0000;
/// Exponent of what is no finite number.
const SPECIAL: i32 = 255;

/// Magnitude as `significand · 2^(exponent − 127 − 23)`, with 24 significant bits unless it is zero.
#[inline(never)]
fn parts(x: u32) -> (i32, u32) {
    let (exponent, fraction) = ((x >> 23 & 0xff) as i32, x & 0x7f_ffff);
    if exponent > 0 {
        return (exponent, fraction | 1 << 23);
    }
    let short = fraction.leading_zeros() - 8;
    (1 - short as i32, fraction << (short & 31))
}

/// `x · 2^(−by)`; bits that are lost leave a one at the end.
fn shifted(x: u32, by: i32) -> u32 {
    if by > 30 {
        return u32::from(x != 0);
    }
    let kept = x >> by;
    kept | u32::from(kept << by != x)
}

/// The number next to `x · 2^(exponent − 127 − 30)`, for `x` below 2³¹.
#[inline(never)]
fn rounded(sign: u32, exponent: i32, x: u32) -> u32 {
    if x == 0 {
        return sign;
    }
    let short = x.leading_zeros() - 1;
    let (mut exponent, mut x) = (exponent - short as i32, x << short);
    if exponent >= SPECIAL {
        return sign | INFINITY;
    }
    if exponent < 1 {
        x = shifted(x, 1 - exponent);
        exponent = 1;
    }
    // The leading one adds to the exponent, and so does a carry.
    let bits = ((exponent as u32 - 1) << 23) + (x >> 7);
    let up = (x & 0x7f) + (bits & 1) > 64;
    sign | (bits + u32::from(up))
}

/// Sum of two numbers, as bits.
pub fn sum(a: u32, b: u32) -> u32 {
    let (a, b) = if a & !SIGN < b & !SIGN {
        (b, a)
    } else {
        (a, b)
    };
    let ((ea, ma), (eb, mb)) = (parts(a), parts(b));
    let (sign, opposed) = (a & SIGN, (a ^ b) & SIGN != 0);
    if ea == SPECIAL {
        // The larger: infinite, or no number at all.
        let undefined = a & !SIGN > INFINITY || (opposed && eb == SPECIAL);
        return if undefined { NAN } else { a };
    }
    let (ma, mb) = (ma << 6, shifted(mb << 6, ea - eb));
    if !opposed {
        rounded(sign, ea + 1, ma + mb)
    } else if ma == mb {
        0
    } else {
        rounded(sign, ea + 1, ma - mb)
    }
}

/// Product of two numbers, as bits.
pub fn product(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let ((ea, ma), (eb, mb)) = (parts(a), parts(b));
    if ea == SPECIAL || eb == SPECIAL {
        return infinite(sign, a, b, ma == 0 || mb == 0);
    }
    let product = u64::from(ma) * u64::from(mb);
    let lost = product as u32 & 0x1_ffff != 0;
    rounded(
        sign,
        ea + eb - 126,
        (product >> 17) as u32 | u32::from(lost),
    )
}

/// Quotient of two numbers, as bits.
pub fn quotient(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let ((ea, ma), (eb, mb)) = (parts(a), parts(b));
    if ea == SPECIAL || mb == 0 {
        return infinite(sign, a, b, eb == SPECIAL || ma == 0);
    }
    if eb == SPECIAL {
        return if b & !SIGN > INFINITY { NAN } else { sign };
    }
    let (mut rest, mut bits) = (ma, 0);
    for _ in 0..26 {
        bits <<= 1;
        if rest >= mb {
            rest -= mb;
            bits |= 1;
        }
        rest <<= 1;
    }
    rounded(sign, ea - eb + 131, bits << 1 | u32::from(rest != 0))
}

/// How two numbers compare, as bits; none if one is no number.
#[inline(never)]
pub fn order(a: u32, b: u32) -> Option<Ordering> {
    if a & !SIGN > INFINITY || b & !SIGN > INFINITY {
        return None;
    }
    let key = |x: u32| {
        let magnitude = (x & !SIGN).cast_signed();
        if x & SIGN == 0 { magnitude } else { -magnitude }
    };
    Some(key(a).cmp(&key(b)))
}

/// The smaller of two numbers, as bits: of zeros the negative one, and what is a number rather than what is none.
pub fn least(a: u32, b: u32) -> u32 {
    let first = match order(a, b) {
        None => a & !SIGN <= INFINITY,
        Some(Ordering::Equal) => a & SIGN != 0,
        Some(order) => order.is_lt(),
    };
    if first { a } else { b }
}

/// The larger of two.
pub fn greatest(a: u32, b: u32) -> u32 {
    least(a ^ SIGN, b ^ SIGN) ^ SIGN
}

/// The number next to a whole one, as bits.
#[inline(never)]
pub fn from_whole(x: u64) -> u32 {
    // To 31 bits, and what is lost to one.
    let short = x.leading_zeros().min(63);
    let high = ((x << short) >> 33) as u32;
    let lost = (x << short) & 0x1_ffff_ffff != 0;
    rounded(0, 127 + 63 - short as i32, high | u32::from(lost))
}

/// The same of a signed one.
pub fn from_signed(x: i64) -> u32 {
    from_whole(x.unsigned_abs()) | (u32::from(x < 0) << 31)
}

/// Infinity, unless it is no number at all.
#[inline(never)]
fn infinite(sign: u32, a: u32, b: u32, undefined: bool) -> u32 {
    if undefined || a & !SIGN > INFINITY || b & !SIGN > INFINITY {
        NAN
    } else {
        sign | INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{self, Rng};

    /// What is near a border: of nothing, of the subnormal, of one, of the infinite.
    const BORDERS: [u32; 16] = [
        0,
        1,
        2,
        0x007f_ffff,
        0x0080_0000,
        0x0080_0001,
        0x00ff_ffff,
        0x3f7f_ffff,
        0x3f80_0000,
        0x3f80_0001,
        0x4000_0000,
        0x7f7f_ffff,
        INFINITY,
        INFINITY + 1,
        NAN,
        0x4b80_0001,
    ];

    fn compare(a: u32, b: u32) {
        let (x, y) = (f32::from_bits(a), f32::from_bits(b));
        for (what, ours, theirs) in [
            ("+", sum(a, b), x + y),
            ("-", sum(a, b ^ SIGN), x - y),
            ("*", product(a, b), x * y),
            ("/", quotient(a, b), x / y),
        ] {
            let same = if theirs.is_nan() {
                f32::from_bits(ours).is_nan()
            } else {
                ours == theirs.to_bits()
            };
            assert!(
                same && order(a, b) == x.partial_cmp(&y),
                "{x:e} {what} {y:e} ({a:08x}, {b:08x}): {ours:08x}, not {:08x}",
                theirs.to_bits()
            );
        }
    }

    #[test]
    fn of_two_it_takes_the_one_that_a_processor_does() {
        for a in BORDERS.into_iter().flat_map(|a| [a, a | SIGN]) {
            for b in BORDERS.into_iter().flat_map(|b| [b, b | SIGN]) {
                let (x, y) = (f32::from_bits(a), f32::from_bits(b));
                let (ours, theirs) = (f32::from_bits(least(a, b)), x.min(y));
                assert!(
                    ours == theirs || (ours.is_nan() && theirs.is_nan()),
                    "{x} {y}"
                );
                let (ours, theirs) = (f32::from_bits(greatest(a, b)), x.max(y));
                assert!(
                    ours == theirs || (ours.is_nan() && theirs.is_nan()),
                    "{x} {y}"
                );
            }
        }
        assert_eq!((least(0, SIGN), least(SIGN, 0)), (SIGN, SIGN));
    }

    #[test]
    fn it_computes_the_bits_that_a_processor_does() {
        for a in BORDERS {
            for b in BORDERS {
                for signs in 0..4 {
                    compare(a | (signs & 1) << 31, b | (signs >> 1) << 31);
                }
            }
        }
        let mut rng = rng::seeded(23);
        for k in 0..64 {
            for _ in 0..10_000 {
                let x = rng.next_u64() >> k;
                let (ours, theirs) = (from_whole(x), (x as f32).to_bits());
                assert_eq!(ours, theirs, "{x:#x}");
                let x = x.cast_signed();
                assert_eq!(from_signed(x), (x as f32).to_bits(), "{x:#x}");
            }
        }
        assert_eq!((from_whole(0), from_signed(0)), (0, 0));
        for _ in 0..3_000_000 {
            let (a, b) = (rng.next_u32(), rng.next_u32());
            compare(a, b);
            // Neighbours in size, where digits cancel and products of few bits end in a tie.
            compare(a, (a & 0xff00_0000) ^ (b >> 8));
            compare(a & 0xffff_f000, b & 0xffff_e000);
            compare(a, BORDERS[(b % 16) as usize]);
            // About as small as there are, before and after.
            compare(a & 0x81ff_ffff, b);
            compare(a & 0x9fff_ffff, b & 0x9fff_ffff);
        }
    }
}
