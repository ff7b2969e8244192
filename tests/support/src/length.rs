//! How much of a long law is tried.
//!
//! Laws over many seeds, machines or effects are tried over the first few, or over a part that takes each of them in turn, and that is
//! said. Where `SERVOID_LONG` is set, which `scripts/test --long` does, they are tried over all.

use crate::left_out::note;

/// How many of `all` cases are tried: all of them, or the first `few`.
#[must_use]
pub fn cases<N: std::fmt::Display>(all: N, few: N) -> N {
    if is_long() {
        return all;
    }
    note("SHORT", &format!("{few} of {all} cases"));
    few
}

/// Whether the case with this number is tried: each, or one of so many. Where the number is a sum of two places, as that of a machine and
/// that of an effect, each of either has its turn.
#[must_use]
pub fn has_its_turn(number: usize, of: usize) -> bool {
    if !is_long() && number == 0 {
        note("SHORT", &format!("one of {of} cases"));
    }
    is_long() || number.is_multiple_of(of)
}

/// How many inputs a law tries that may be tried with any number of them: `SERVOID_CASES`, or as many as is `usual`.
#[must_use]
pub fn fuzzed<N: std::str::FromStr>(usual: N) -> N {
    setting("SERVOID_CASES").unwrap_or(usual)
}

/// A number that the environment sets.
#[must_use]
pub fn setting<N: std::str::FromStr>(name: &str) -> Option<N> {
    std::env::var(name).ok()?.parse().ok()
}

/// Whether long laws are tried at full length.
#[must_use]
pub fn is_long() -> bool {
    setting::<u8>("SERVOID_LONG").is_some_and(|long| long > 0)
}
