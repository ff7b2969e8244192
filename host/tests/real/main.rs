//! Recordings measured by others: how they are read, how well they are fitted, and what is named. Each error has a limit on both
//! sides, since one that is suspiciously small would be as wrong as one that is too large.
//!
//! Those whose licence allows it are in `tests/recordings`, and their tests never skip. The others are outside the project: where they
//! are missing, their tests say so and pass.
#![forbid(unsafe_code)]

mod criterion;
mod diagnoses;
mod fits;
mod likelihood;
mod limits;
mod position;
mod program;
mod proposals;
mod recordings;
mod source;
mod steady;
mod vendored;
