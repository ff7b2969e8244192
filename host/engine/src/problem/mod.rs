//! A recording and a model with unknowns, as a cost over the unit cube.
//!
//! | file | holds |
//! |---|---|
//! | `unknown` | one number that is searched for |
//! | `structure` | all of them, and the model that their values make |
//! | `residuals` | model minus reading over a horizon |
//! | `fit_problem` | the cost of a point of the cube, and the residuals behind it |
//! | `changes` | by how much the residuals of models near one differ from its own |
//! | `tangent` | residuals and changes as a triangle, which is all that a least-squares step needs |
//! | `moments` | mean and squares of many numbers, some at a time |

mod changes;
mod fit_problem;
mod moments;
pub(crate) mod residuals;
mod structure;
pub(crate) mod tangent;
mod unknown;

pub use crate::data::Data;
pub use crate::simulation::{Candidate, Horizon, StartAngle};
pub use changes::Centring;
pub use fit_problem::FitProblem;
pub use moments::Moments;
pub use residuals::{errors, rms_counts};
pub use structure::{
    Base, ELECTRICAL_TIME_CONSTANT, START_OFFSET, START_SPEED, Structure, VISCOUS_PART,
};
pub use unknown::{Scale, Unknown};
