//! servoid in Python: recordings from numpy arrays or files, a fit, a diagnosis, and the models that come of them.
//!
//! This crate calls the front door of `servoid-identify` and hands its results over as the JSON of the command line; what is
//! pleasant to use is written in Python, in `python/servoid`.
//!
//! | file | holds |
//! |---|---|
//! | `recording` | a recording, from arrays or a file |
//! | `fit` | a model fitted to recordings |
//! | `diagnosis` | which effects recordings show |
//! | `batch` | many recordings, one row each |
//! | `fleet` | what a batch says of all motors together |
//! | `model` | a model that runs again: simulation, export |
//! | `watch` | the work in a thread of its own, stopped by Ctrl-C |
//! | `error` | errors as Python's exceptions, with their cause |

mod batch;
mod diagnosis;
mod error;
mod fit;
mod fleet;
mod model;
mod recording;
mod watch;

use pyo3::prelude::*;

/// The part of `servoid` that is compiled.
#[pymodule]
mod _servoid {
    #[pymodule_export]
    use super::batch::{batch, batch_table};
    #[pymodule_export]
    use super::diagnosis::{Diagnosis, diagnose};
    #[pymodule_export]
    use super::error::{Error, UsageError};
    #[pymodule_export]
    use super::fit::{Fit, fit};
    #[pymodule_export]
    use super::fleet::{draw_motors, fleet, population};
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::recording::{Recording, read};

    use pyo3::prelude::*;
    use shared::effects::Kind;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        let names: Vec<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
        module.add("EFFECTS", names)?;
        module.add("USUAL_STEPS", servoid_identify::diagnose::USUAL_STEPS)?;
        // Of exceptions that Python's part raises; those from here say their own.
        module.py().get_type::<Error>().setattr("cause", "failed")?;
        module
            .py()
            .get_type::<UsageError>()
            .setattr("cause", "usage")
    }
}
