//! Bounds that a user sets on an unknown.

use crate::error::Error;
use servoid_engine::problem::{Scale, Structure};
use servoid_io::input::suggest::did_you_mean;

/// The range of one unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Name of the unknown, as in the result.
    pub name: String,
    /// Lower and upper bound, in the unit of the result.
    pub range: (f64, f64),
}

impl Bound {
    /// Sets the range of its unknown.
    ///
    /// # Errors
    /// [`Error::Usage`] where the model has no such unknown, or it cannot take the lower bound.
    pub(crate) fn apply(&self, structure: &mut Structure) -> Result<(), Error> {
        let Bound { name, range } = self;
        let names: Vec<String> = structure.unknowns.iter().map(|u| u.name.clone()).collect();
        let Some(unknown) = structure.unknowns.iter_mut().find(|u| u.name == *name) else {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            return Err(Error::Usage(format!(
                "--bounds {name}: not an unknown of this model; {}",
                did_you_mean(name, &names)
            )));
        };
        if range.0 < 0.0 && unknown.range.0 >= 0.0 {
            return Err(Error::Usage(format!(
                "--bounds {name}: the lower bound {} is negative, and {name} cannot be",
                range.0
            )));
        }
        if range.0 == 0.0 && unknown.scale == Scale::Log {
            return Err(Error::Usage(format!(
                "--bounds {name}: the lower bound must be above zero"
            )));
        }
        unknown.confine(*range);
        Ok(())
    }
}
