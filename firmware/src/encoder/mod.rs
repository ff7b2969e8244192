//! Encoders that are read over a bus, for a board of [`generic`](crate::board::generic)'s parts. Quadrature is the chips' own business: a
//! timer counts it, or a state machine.
//!
//! | file | encoder | reading |
//! |---|---|---|
//! | `as5047` | AS5047P, AS5047D: SPI, 14 bits | parity and error flag |
//! | `mt6701` | MT6701: SSI, 14 bits | CRC and field |
//! | `as5600` | AS5600: I²C, 12 bits | field; late |
//! | `hall` | three lines, six states an electrical revolution | states that cannot be |
//!
//! An encoder that is late is asked as much later ([`SampledLate`]). An absolute angle becomes a cumulative count while the shaft turns less than half a revolution in a control period.

mod absolute;
pub mod as5047;
pub mod as5600;
pub mod hall;
pub mod mt6701;
mod readings;
mod sampled_late;

pub use absolute::{Absolute, Angle};
pub use readings::Readings;
pub use sampled_late::SampledLate;
