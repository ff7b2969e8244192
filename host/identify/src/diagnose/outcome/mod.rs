//! What a diagnosis ends with, as plain data.

mod diagnosis;
mod floor;
mod step;
mod verdict;

pub use diagnosis::Diagnosis;
pub use floor::{Floor, FloorKind, Repeated};
pub use step::Step;
pub use verdict::Verdict;
