//! How much of a long law is tried.
//!
//! Laws over many seeds are tried over all of them where `SERVOID_LONG` is 1, which `scripts/test --require-all` sets, and those that
//! then take minutes where it is 2, which `--long` sets. Otherwise they are tried over the first few, and that is said.

use crate::left_out::note;

/// How many of `all` cases are tried: all of them, or the first `few`.
#[must_use]
pub fn cases<N: std::fmt::Display>(all: N, few: N) -> N {
    tried(level() >= 1, all, few)
}

/// The same of laws that take minutes.
#[must_use]
pub fn many_minutes<N: std::fmt::Display>(all: N, few: N) -> N {
    tried(long_minutes(), all, few)
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

/// Whether laws that take minutes are tried at full length.
#[must_use]
pub fn long_minutes() -> bool {
    level() >= 2
}

fn level() -> u8 {
    setting("SERVOID_LONG").unwrap_or(0)
}

fn tried<N: std::fmt::Display>(whole: bool, all: N, few: N) -> N {
    if whole {
        return all;
    }
    note("SHORT", &format!("{few} of {all} cases"));
    few
}
