//! A model run along a recording: one candidate, or several at a time in the lanes of vector registers.
//!
//! | file | holds |
//! |---|---|
//! | `candidate` | a model with all its numbers, and how it is stepped |
//! | `horizon` | how far it runs on its own, and what is known of its start |
//! | `segment` | the parts of the recording that a horizon makes |
//! | `propagator` | the loop over the samples, for one number or for lanes |
//! | `single` | one candidate |
//! | `batch` | several candidates |
//! | `replay` | one candidate that a position loop drives towards the recorded targets |
//! | `response` | one candidate along commands that nobody measured the motion of |

mod batch;
mod candidate;
mod horizon;
mod propagator;
mod replay;
mod response;
mod segment;
mod single;

pub use batch::Batch;
pub use candidate::{Candidate, Method};
pub use horizon::{Correction, Horizon, StartAngle, Window};
pub use propagator::{Mode, Number, Propagator};
pub use replay::replayed;
pub use response::{Commands, ResponseError, response};
pub use segment::{Segment, segments, whole};
pub use single::{Simulation, step};
