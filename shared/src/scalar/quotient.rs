//! Division of 64-bit numbers. Where a core divides nothing at all, the compiler's routine for it takes half a kilobyte, and
//! is faster than the few divisions of a device's program need it.

/// `dividend / divisor`; zero if there is no divisor.
#[cfg(not(short_multiplier))]
#[inline(always)]
pub fn quotient(dividend: u64, divisor: u64) -> u64 {
    dividend.checked_div(divisor).unwrap_or(0)
}

#[cfg(short_multiplier)]
pub use bit_by_bit as quotient;

/// The same, bit by bit.
#[cfg(any(short_multiplier, test))]
#[inline(never)]
pub fn bit_by_bit(dividend: u64, divisor: u64) -> u64 {
    let up = divisor
        .leading_zeros()
        .checked_sub(dividend.leading_zeros());
    let (Some(mut left), true) = (up, divisor != 0) else {
        return 0;
    };
    let (mut rest, mut part, mut quotient) = (dividend, divisor << left, 0);
    loop {
        quotient <<= 1;
        if rest >= part {
            rest -= part;
            quotient |= 1;
        }
        if left == 0 {
            return quotient;
        }
        left -= 1;
        part >>= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::{bit_by_bit, quotient};
    use crate::rng::{self, Rng};

    #[test]
    fn bit_by_bit_it_is_the_same() {
        let mut rng = rng::seeded(9);
        for _ in 0..200_000 {
            let mut drawn = || rng.next_u64() >> rng::below(&mut rng, 64);
            let (dividend, divisor) = (drawn(), drawn());
            assert_eq!(bit_by_bit(dividend, divisor), quotient(dividend, divisor));
        }
        assert_eq!((bit_by_bit(7, 0), quotient(7, 0)), (0, 0));
        assert_eq!(bit_by_bit(u64::MAX, 1), u64::MAX);
    }
}
