//! How much of a long law is tried.
//!
//! Laws over many seeds are tried over all of them with `SERVOID_LONG=1`, which `scripts/test --require-all` sets; otherwise over
//! the first few, and that is said.

use crate::left_out::note;

/// Whether laws are tried at full length.
#[must_use]
pub fn long() -> bool {
    std::env::var_os("SERVOID_LONG").is_some_and(|value| value == "1")
}

/// How many of `all` cases are tried: all of them, or the first `few`.
#[must_use]
pub fn cases<N: std::fmt::Display>(all: N, few: N) -> N {
    if long() {
        return all;
    }
    note("SHORT", &format!("{few} of {all} cases"));
    few
}
