//! The command line `servoid`.
#![forbid(unsafe_code)]
fn main() {}
