//! Errors as Python's exceptions. Each has a `cause`, the word by which programs tell errors apart.

use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    servoid,
    Error,
    PyException,
    "Something that servoid could not do, with the remedy; `cause` tells programs what it was."
);
create_exception!(
    servoid,
    UsageError,
    Error,
    "An argument that cannot be used: the caller's mistake."
);

/// An exception of this cause.
pub(crate) fn raised(cause: &'static str, said: impl std::fmt::Display) -> PyErr {
    let said = said.to_string();
    let error = match cause {
        "usage" => UsageError::new_err(said),
        _ => Error::new_err(said),
    };
    // An attribute can be set on every exception; if not, its text still tells what is wrong.
    Python::attach(|py| {
        let _ = error.value(py).setattr("cause", cause);
    });
    error
}

/// An identification's error.
pub(crate) fn identify(error: servoid_identify::Error) -> PyErr {
    raised(error.cause(), &error)
}
