//! Identification: a model fitted to recordings, a diagnosis of what it lacks, and a plan of what to record next.
//!
//! | module | holds |
//! |---|---|
//! | `fit` | start by regression, search, uncertainty, physical parameters, scores |
//! | `diagnose` | which physical effects a recording shows that the model lacks |
//! | `plan` | the excitation that separates models which explain a recording alike |
//! | `paper` | the paper's table and contest |
//! | `truth` | what the virtual bench hides, in the model's terms |
#![forbid(unsafe_code)]

pub mod diagnose;
pub mod error;
pub mod fit;
pub mod paper;
pub mod plan;
pub mod truth;

pub use error::Error;
