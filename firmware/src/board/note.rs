//! A word that a program leaves for itself before it resets its chip, and finds when it has started again: why it did that.
//! It lies in memory that keeps whatever it holds over a reset, and holds anything after power-up.

use shared::wire::Reset;

/// Marks a word that was left on purpose.
const MARK: u32 = 0x5e41_0000;

/// The word that says why.
pub fn word(reset: Reset) -> u32 {
    let code = Reset::ALL.iter().position(|&known| known == reset);
    MARK | code.unwrap_or(0) as u32
}

/// What a word says; nothing if nobody has left it there.
pub fn said(word: u32) -> Option<Reset> {
    let code = word ^ MARK;
    Reset::ALL.get(usize::try_from(code).ok()?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_left_is_found_and_chance_leaves_nothing() {
        for reset in Reset::ALL {
            assert_eq!(said(word(reset)), Some(reset));
        }
        for chance in [0, u32::MAX, 1, MARK ^ 0x100, MARK | 0xff, MARK << 1] {
            assert_eq!(said(chance), None, "{chance:x}");
        }
    }
}
