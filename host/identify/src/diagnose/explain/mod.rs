//! What a diagnosis says to its reader: the evidence for each effect, whether its recordings belong together, and what to do next.

pub mod advice;
pub mod evidence;
pub mod pair;
mod settings;
