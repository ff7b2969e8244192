//! What a diagnosis says to its reader: the evidence for each effect, where models fail, and what to do next.

pub mod advice;
pub mod evidence;
mod findings;
pub mod pair;

pub use findings::{Findings, findings};
