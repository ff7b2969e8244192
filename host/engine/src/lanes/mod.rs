//! Several candidates in the lanes of vector registers: a number that holds one value for each of them, with which
//! `shared`'s equations are computed as with any other number.
//!
//! Which instructions the processor has is found out when the program runs. Where it has no vectors, lanes are computed
//! number by number, with the same bits.
//!
//! | file | holds |
//! |---|---|
//! | `transpose` | eight rows of eight numbers into their columns, and the number of lanes |
//! | `token` | the proof that the processor has the instructions |
//! | `number` | the number in lanes |
//! | `dispatch` | work given to the widest instructions |
//! | `triangles` | least squares whose rows come one by one |

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
