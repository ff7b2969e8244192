//! MATLAB's files of level 5, and what its files of version 7.3 have in common with them.
//!
//! | file | holds |
//! |---|---|
//! | `value` | variables as a tree |
//! | `tables` | the tables of variables |
//! | `simulink` | what Simulink writes |
//! | `stream` | elements of a file of level 5 |
//! | `matrix` | a variable, taken apart |
//! | `parts` | names, axes and texts in it |
//! | `gather` | the numbers of arrays |
//! | `level5` | the log of a file of level 5 |

mod gather;
mod level5;
mod matrix;
mod parts;
mod simulink;
mod stream;
mod tables;
mod value;

pub(crate) use level5::{is_level5, open as open_level5};
pub(crate) use tables::Tables;
pub(crate) use value::{Fields, Numbers, Records, Value};
