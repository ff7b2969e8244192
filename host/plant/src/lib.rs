//! The virtual bench: a DC servo motor with hidden physical effects, simulated finely enough to count
//! as the truth, that makes test recordings.
//!
//! It shares no code with the model that is fitted to its recordings, on purpose: it is written in
//! plain SI units, integrates the differential equations with a Runge-Kutta method at 20 kHz or more,
//! and locates every stop and every release of the shaft. When a fitted model reproduces a recording
//! of the bench, two independent derivations agree.
//!
//! ```text
//! drive samples → timeline → plant (machine + effects + second inertia) → encoder → run
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `machine` | the true parameters of the motor, and presets |
//! | `effects` | the hooks of an effect, the catalogue, and one file per effect |
//! | `hidden` | one hidden effect: its parameters and its strength, typical or from text |
//! | `outside` | laws that the catalogue does not hold, to be found by other means |
//! | `timeline` | the time at which each command reaches the bridge |
//! | `plant` | the state and its differential equations |
//! | `integrate` | the state moved forward, with stops, releases and contacts located |
//! | `bridge` | two half bridges that switch, with their dead time |
//! | `coupling` | the spring and the gap between motor and load |
//! | `encoder` | from the shaft's angle to a counter reading |
//! | `position` | a drive that closes a position loop |
//! | `run` | the bench itself: the order in which the above happen |
//!
//! # Conventions
//!
//! All inertia and friction are referred to the motor shaft, and the encoder sits there too. With an
//! open bridge the current is zero at once: the few hundred microseconds during which the winding
//! discharges through the diodes are left out. The shaft is released at rest, without current, at t = 0.
//!
//! # How to add an effect
//!
//! 1. Write `effects/<name>.rs`: a struct with its physical parameters, its equation and source in the
//!    doc comment; a `KIND` with the name that the contract spells and a typical value for each
//!    parameter; `impl Effect` with the one hook where it enters the equations.
//!    Curves of the same effect from other sources go into its `other_laws`.
//! 2. Add `mod <name>;` and `&<name>::KIND` to `effects/mod.rs`, at its place between command and counter.
//!
//! The laws in `laws/` then hold it to: no strength, no change (bit for bit); less strength, less
//! change; same seed, same bits; and half the substep, the same recording.

#![forbid(unsafe_code)]

mod bridge;
mod chance;
mod coupling;
pub mod effects;
mod encoder;
mod error;
mod hidden;
mod integrate;
#[cfg(test)]
mod laws;
mod machine;
pub mod outside;
mod plant;
mod position;
mod run;
mod stated;
mod timeline;

pub use chance::Chance;
pub use coupling::Coupling;
pub use error::BenchError;
pub use hidden::Hidden;
pub use machine::{Machine, PRESETS};
pub use outside::{Given, Outside, OutsideLaw, Variable};
pub use plant::STATED_MEMORIES;
pub use position::PositionControl;
pub use run::{Amplifier, Bench, Reading, Run};
pub use stated::Stated;
pub use timeline::DriveSample;
