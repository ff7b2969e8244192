//! The square root in single precision, bit by bit: a sixth of the flash that `libm::sqrtf` takes, and the same bits, since
//! there is but one correctly rounded root. It is slower, and nothing in a hot loop has a root.

/// Nearest number to the square root of `x`.
pub fn square_root(x: f32) -> f32 {
    let bits = x.to_bits();
    if bits << 1 == 0 || bits == f32::INFINITY.to_bits() {
        return x;
    }
    if bits >> 23 >= 0xff {
        return f32::NAN;
    }
    // `x = significand · 2^(exponent − 150)`, the significand with its highest bit at place 23.
    let (mut exponent, mut significand) = ((bits >> 23) as i32, bits & 0x7f_ffff);
    if exponent == 0 {
        let up = significand.leading_zeros() as i32 - 8;
        significand <<= up;
        exponent = 1 - up;
    } else {
        significand |= 0x80_0000;
    }
    exponent -= 127;
    // An even exponent halves.
    let mut rest = significand << (1 + (exponent & 1));
    let (mut root, mut twice, mut bit) = (0, 0, 1 << 24);
    while bit != 0 {
        let next = twice + bit;
        if next <= rest {
            rest -= next;
            twice = next + bit;
            root += bit;
        }
        rest <<= 1;
        bit >>= 1;
    }
    // One bit more than fits: half of a last place. A tie there is none, as no root has that many bits.
    root += root & 1;
    f32::from_bits((root >> 1) + ((exponent >> 1) + 126).cast_unsigned() * 0x80_0000)
}

#[cfg(test)]
mod tests {
    use super::square_root;
    use crate::rng::{self, Rng};

    #[test]
    fn it_is_the_processor_s_root() {
        let mut rng = rng::seeded(3);
        let special = [
            0.0,
            -0.0,
            1.0,
            4.0,
            -1.0,
            f32::INFINITY,
            f32::NAN,
            1e-45,
            f32::MAX,
        ];
        let drawn = (0..1_000_000).map(|_| f32::from_bits(rng.next_u32()));
        for x in special.into_iter().chain(drawn) {
            let (own, theirs) = (square_root(x), x.sqrt());
            let same = own.to_bits() == theirs.to_bits() || (own.is_nan() && theirs.is_nan());
            assert!(same, "{x}: {own}, not {theirs}");
        }
    }
}
