//! An effect that a caller brings along.

use super::effects::Effect;
use std::fmt;
use std::sync::Arc;

/// An effect that is none of the catalogue: its equation is the caller's.
#[derive(Clone)]
pub struct Stated(pub Arc<dyn Effect>);

impl fmt::Debug for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("stated effect")
    }
}
