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

/// Whether laws that take minutes are tried at full length.
#[must_use]
pub fn long_minutes() -> bool {
    level() >= 2
}

fn level() -> u8 {
    let said = std::env::var("SERVOID_LONG").unwrap_or_default();
    said.parse().unwrap_or(0)
}

fn tried<N: std::fmt::Display>(whole: bool, all: N, few: N) -> N {
    if whole {
        return all;
    }
    note("SHORT", &format!("{few} of {all} cases"));
    few
}
