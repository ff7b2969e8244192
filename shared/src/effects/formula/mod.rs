//! A law that a user states: a small stack program in the place of an effect's code.
//!
//! The host compiles the text of a formula to a [`Program`], which holds nothing but data, so that a device can run what it
//! has never seen. The program is lowered with the values of its parameters: each of its intermediate results gets a scale of its
//! own from the range in which it can lie, so that every number that is computed with is near one in every number format.
//!
//! | file | holds |
//! |---|---|
//! | `program` | the operations, and what a program says of itself |
//! | `interval` | the range in which a result lies |
//! | `lower` | scales and constants for the values of the parameters |
//! | `number` | what is computed with: a number, or a number with its derivatives |
//! | `power` | powers, which number formats have not |
//! | `interpret` | its operations on a stack |
//! | `run` | the program along the shaft |
//! | `states` | its states over a part of a sample |

mod interpret;
mod interval;
mod lower;
mod number;
mod power;
mod program;
mod run;
mod states;

pub use interval::Interval;
pub use lower::MAX_NUMBERS;
pub use program::{MAX_CONSTANTS, MAX_DEPTH, MAX_STATES, Op, Output, Program, State, Variable};

use super::Description;
use crate::error::ModelError;
use crate::scalar::{Real, Scalar};
use crate::units::PerUnit;
use core::hash::{Hash, Hasher};
pub(super) use run::Stated;

/// A law that a user stated, with all that an effect of the catalogue says about itself.
#[derive(Debug)]
pub struct Formula {
    /// What it is. The equation is the text from which it was compiled.
    pub description: Description,
    /// What it computes.
    pub program: Program,
}

impl Formula {
    /// Whether a number format can hold it, with these values in SI.
    ///
    /// # Errors
    /// A state or a scale that is beyond the format.
    pub fn check<S: Scalar, R: Real>(
        &self,
        values: &[R],
        units: &PerUnit<R>,
    ) -> Result<(), ModelError> {
        lower::check::<S, R>(self, values, units)
    }

    /// The law's value in its unit at a speed in rad/s, an angle in rad and a current (or command) in V, as it runs in f64.
    pub fn value(&'static self, values: &[f64], units: &PerUnit<f64>, at: [f64; 3]) -> f64 {
        Stated::<f64>::lower(self, values, units).value(units, at)
    }
}

// The text tells two formulas apart.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.description.equation == other.description.equation
            && self.description.name == other.description.name
    }
}

impl Eq for Formula {}

impl Hash for Formula {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.description.equation.hash(state);
    }
}

impl PartialOrd for Formula {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Formula {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        let key = |formula: &Self| (formula.description.name, formula.description.equation);
        key(self).cmp(&key(other))
    }
}
