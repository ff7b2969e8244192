//! What a diagnosis ends with, as plain data.

mod diagnosis;
mod step;
mod verdict;

pub use diagnosis::Diagnosis;
pub use step::Step;
pub use verdict::Verdict;
