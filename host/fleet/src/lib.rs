//! What a batch says of all motors together, and the population that they are a sample of.
//!
//! ```text
//! results of a batch + labels → units → quantities → odd units, lots, stations, drift, gauge → summary, page
//!                                                  └ without the odd ones → population → draws
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `unit`, `labels` | the recordings with their results; of which motor, lot, station and time they are |
//! | `quantity` | the parameters that motors are compared by, and the scale in which they differ evenly |
//! | `robust`, `multiple` | location and scatter that odd values do not move; many tests at a time |
//! | `odd` | units that are not like the others, each with the reason |
//! | `group`, `drift`, `gauge` | lots and stations; changes with time; repeatability and reproducibility |
//! | `components` | variance and covariance between units, with each unit's own error taken off |
//! | `population`, `draw` | the motors that a fleet is a sample of, and motors drawn from them |
//! | `summary` | all of it as one document |
//! | `page`, `text` | for people |
#![forbid(unsafe_code)]

mod components;
mod draw;
mod drift;
mod error;
mod gauge;
mod group;
mod labels;
mod multiple;
mod odd;
mod page;
mod population;
mod quantity;
mod robust;
mod summary;
mod text;
mod unit;
mod words;

pub use draw::{Draws, draw};
pub use drift::Drift;
pub use error::Error;
pub use gauge::Gauge;
pub use group::{Difference, Group};
pub use labels::LabelFile;
pub use odd::{Odd, Reason};
pub use page::{page, unit_page};
pub use population::{Bounded, Member, Population};
pub use quantity::{Quantity, Scale};
pub use summary::{Fleet, Spread, Summary};
pub use text::{population_text, summary_text};
pub use unit::{Refused, Unit};
