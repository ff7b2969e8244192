//! What was found, in the words of other programs.
//!
//! | file | holds |
//! |---|---|
//! | `subject` | what is exported: the model with its numbers, on one side of a gear |
//! | `side` | from the motor's side of a gear to the output's |
//! | `format` | the list of formats: everything else follows from it |
//! | `options` | what a user chooses beside the format |
//! | `written` | what a format wrote, where each number went, and what it has no place for |
//! | `friction` | friction in the two numbers that most programs have for it |
//! | `one_constant` | the motor of simulators, with one motor constant and torques in N·m |
//! | `brushless` | the motor of drives with three phases |
//! | `discrete` | the exact step of the linear machine, in SI |
//! | `table` | every number with unit, error, side, and whether it is determined |
//! | one file a format | its text |
//! | `gains/` | controllers for the motor |
//!
//! A number that the data do not determine is never written as one that they do, and what a format has no place for is
//! named, in the file where it takes comments and beside it in any case.

mod bam;
mod brushless;
mod c;
mod comment;
mod constants;
mod csv;
mod digits;
mod discrete;
mod error;
mod format;
mod friction;
pub mod gains;
mod json;
mod law_code;
mod mjlab;
mod modelica;
mod moteus;
mod mujoco;
mod odrive;
mod one_constant;
mod options;
mod python;
mod ros2_control;
mod rust;
mod side;
mod simscape;
mod subject;
mod table;
mod toml;
mod urdf;
mod vesc;
mod wpilib;
mod written;

pub use brushless::Winding;
pub use error::ExportError;
pub use format::{FORMATS, Format};
pub(crate) use json::Motor;
pub use options::Options;
pub use side::Side;
pub use subject::{Subject, SubjectError, Term, Value};
pub use written::{Lack, Mapped, Written};

#[cfg(test)]
mod laws;
#[cfg(test)]
mod samples;
