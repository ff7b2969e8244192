//! What a log may have a column of: one table, from which the readers, the guesses, the flags and the page's dialog follow.
//!
//! | file | holds |
//! |---|---|
//! | `kind` | the channels |
//! | `facts` | what is known of each: its key, its words in five languages, its units, its range |
//! | `table` | the facts of every channel |
//! | `unit` | units that a factor and a zero convert |
//! | `series` | the columns of a recording beside time, command and angle |

mod facts;
mod kind;
mod series;
mod table;
mod unit;

pub use facts::Facts;
pub use kind::{Channel, Measured};
pub use series::Series;
pub(crate) use table::WANTED;
pub use unit::{LinearUnit, PerMeasured};
