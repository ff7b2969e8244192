//! Identification: a model fitted to recordings, a diagnosis of what it lacks, and a plan of what to record next.
//!
//! The front door is [`identify()`] and [`diagnose()`]: recordings in, a fit or a diagnosis out. For several recordings it is [`FitSets`]
//! and [`Datasets`].
//!
//! | module | holds |
//! |---|---|
//! | `check` | what a recording can be trusted for, before anything is fitted to it |
//! | `late_driver` | drivers that wake after the log has begun |
//! | `shaft_angle` | recordings that begin at different angles of the shaft |
//! | `fit` | start by regression, search, uncertainty, physical parameters, scores |
//! | `likelihood` | a second fit with process noise, for real motion: inertia, delay, standard errors, BIC |
//! | `diagnose` | which physical effects a recording shows that the model lacks |
//! | `discovery` | a law for what the catalogue of effects leaves |
//! | `residual_analysis` | where a model fails: volts against speed, voltage, angle, time |
//! | `findings` | where the models of a diagnosis fail |
//! | `steady` | which effects a curve of steady speeds shows |
//! | `plan` | the excitation that separates models which explain a recording alike |
//! | `repeats` | recordings of one command: what a motor does not repeat, and what a model lacks |
//! | `paper` | the paper's table and contest |
//! | `truth` | what the virtual bench hides, in the model's terms |
#![forbid(unsafe_code)]

pub mod certificate;
pub mod check;
mod datasets;
pub mod diagnose;
mod diagnosed;
pub mod discovery;
pub mod error;
mod findings;
pub mod fit;
mod fit_sets;
mod golden_section;
mod identify;
mod late_driver;
pub mod likelihood;
#[cfg(test)]
mod noisy_motor;
pub mod paper;
pub mod plan;
mod prepared;
mod progress;
pub mod repeats;
pub mod residual_analysis;
mod shaft_angle;
pub mod steady;
pub mod truth;

pub use datasets::Datasets;
pub use diagnosed::{Diagnosed, diagnose, diagnose_data, diagnose_datasets};
pub use error::Error;
pub use findings::Findings;
pub use fit_sets::FitSets;
pub use identify::{LEAST_SQUARES, bounded_problem, identify, identify_data};
pub use late_driver::LateDriver;
pub use progress::{Progress, Silent};
pub use shaft_angle::turns;
