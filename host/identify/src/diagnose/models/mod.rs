//! Models and their errors: plain data, which the procedures of the stages make and compare.

mod errors;
mod fitted_model;
mod losses;
mod observer_errors;
mod screened_model;

pub use errors::{Errors, NOISE_COUNTS, ROOM};
pub use fitted_model::{FittedModel, distinct, same};
pub use losses::{Loss, Losses};
pub use observer_errors::{MEMORIES_S, ObserverErrors};
pub use screened_model::ScreenedModel;
