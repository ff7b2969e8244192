//! NumPy's arrays: `.npy`, one array, and `.npz`, a zip archive of them.
//!
//! | file | holds |
//! |---|---|
//! | `literal` | literals of Python |
//! | `dtype` | what an element of an array is made of |
//! | `header` | the header of an array |
//! | `strip` | columns of an array as bytes |
//! | `pass` | reading columns, some rows at a time |
//! | `single` | arrays without axes |
//! | `arrays` | the log of one array or several |
//! | `npy` | one array |
//! | `npz` | a zip archive of arrays |

mod arrays;
mod dtype;
mod header;
mod literal;
mod npy;
mod npz;
mod pass;
mod single;
mod strip;

pub(crate) use header::MAGIC;
pub(crate) use npy::open as open_npy;
pub(crate) use npz::{is_archive, open as open_npz};
