//! Candidates side by side: one number for each of them in the lanes of the processor's vector registers, with
//! which `shared`'s equations are computed as with any other number.
//!
//! Which instructions there are is found out when the program runs. Where there are none, candidates are
//! computed one by one.

mod dispatch;
mod number;
mod token;
mod transpose;
mod triangles;

pub use dispatch::{Work, with_vectors, work};
pub use number::{LaneMask, Lanes};
pub use token::Token;
pub use transpose::{LANES, Tile, Transpose};
pub use triangles::Triangles;
