//! A search on fewer readings. An observer corrects a motor about once a time constant; what a log holds many times in between costs time and
//! tells nothing where the motor's own noise is far above the encoder's. What was found is then judged on all readings.
//! Proposals for a long bench are searched along its first readings, every one of them.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `recordings` | the recordings with fewer readings |
//! | `on_all` | what was found, judged on all readings |
//! | `along` | a model along other recordings |

mod along;
mod on_all;
mod recordings;
mod settings;

pub use along::along;
pub use on_all::on_all_readings;
pub use recordings::Thinned;
pub use settings::MOST_ON_ALL;
