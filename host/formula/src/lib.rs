//! Laws that a user states as text, compiled to effects.
//!
//! ```
//! let kind = servoid_formula::define(
//!     "gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau^2/v0*z); \
//!      h = 0.01 in [1e-3, 1] rad; ma, md in [0, 1]; v0 = 12 V",
//! )?;
//! assert_eq!(kind.name(), "gear");
//! assert_eq!(kind.parameters().len(), 3);
//! # Ok::<(), servoid_formula::Fault>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `syntax` | the grammar: statements and expressions |
//! | `definition` | statements to a [`Definition`]: what its names mean, and which a place sees |
//! | `dimension` | units, and what is wrong with those of a law |
//! | `value` | an expression's value, and the range in which it lies |
//! | `compile` | an expression as a stack program |
//! | `amplitude` | with which parameters a law vanishes |
//! | `registry` | the laws that have been stated in this process |
//! | `uses` | what a law depends on, and where it acts |
//! | `code` | a law in other programs' languages |

#![forbid(unsafe_code)]

mod amplitude;
mod code;
mod compile;
mod definition;
mod dimension;
mod fault;
mod registry;
mod syntax;
mod uses;
mod value;

pub use code::Language;
pub use definition::{Definition, Parameter, State};
pub use dimension::Dimension;
pub use fault::Fault;
pub use registry::{Law, by_name, define, law_of, text_of};
pub use syntax::{Binary, Expression, Function, Term};
pub use uses::Used;
pub use value::Point;
