//! A little unpredictability from what a microcontroller has: noise of an ADC, its identity, the moment of a question.
//! It tells one power-up from another; it keeps no secret.

/// The pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Entropy(u32);

impl Entropy {
    /// Stirs `value` in. The finaliser of MurmurHash3: a bit of `value` turns half of the bits of what follows.
    pub fn stir(&mut self, value: u32) {
        let mut h = self.0.wrapping_add(0x9e37_79b9) ^ value;
        h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        self.0 = h ^ (h >> 16);
    }

    /// A number that depends on everything that was stirred in, `moment` included.
    pub fn draw(&mut self, moment: u32) -> u32 {
        self.stir(moment);
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bit_of_noise_changes_about_half_of_every_later_draw() {
        for bit in 0..32 {
            let (mut a, mut b) = (Entropy::default(), Entropy::default());
            a.stir(0);
            b.stir(1 << bit);
            for moment in 0..100 {
                let different = (a.draw(moment) ^ b.draw(moment)).count_ones();
                assert!(
                    (4..=28).contains(&different),
                    "{different} bits differ for bit {bit}"
                );
            }
        }
    }
}
