//! What the benches of different boards share.

pub mod plant;
pub mod switch;
