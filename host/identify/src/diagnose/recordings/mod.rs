//! The recordings before anything is fitted: what is wrong with them, and which part is held out.

pub mod holdout;
mod remark;
pub mod usable;

pub use holdout::HeldOut;
pub use remark::Remark;
