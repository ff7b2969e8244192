//! The motor, its encoder and the lean optimisers: everything that the microcontroller and the PC
//! must compute alike. No std, no allocation, no I/O, no clock, no thread, no unsafe code.
//!
//! Read it in the order of the flow:
//!
//! 1. [`scalar`]: the number that a model is computed in (f64, f32, fixed point, or the host's SIMD lanes);
//!    [`rng`]: random numbers from a printed seed;
//! 2. [`units`]: SI to per unit and back, the only file that knows SI;
//! 3. [`excite`] makes the commands; [`recording`] is what was commanded and read, [`trace`] the same as a device
//!    keeps it, in four bytes a period;
//! 4. [`motor`]: the linear armature-controlled machine; [`discretise`]: its exact step, and Euler's;
//!    [`bridge`]: the voltage that a duty puts across the winding;
//! 5. [`effects`]: one physical effect a file, and the list of them;
//! 6. [`encoder`]: floor, wrap, differences;
//! 7. [`model`]: motor + effects + encoder, one step; [`error`]: why a model cannot be built. Its folder `fast` holds
//!    shorter forms of the same step and may be skipped;
//! 8. [`cost`]: how far the model is from the recording;
//! 9. [`optim`]: particle swarm, firefly and random search, by ask and tell;
//! 10. [`fit`]: the device's fit, a slice at a time: search, then Levenberg and Marquardt's method;
//! 11. [`servo`]: gains by a fitted motor, and the loop that they are for;
//! 12. [`wire`]: the messages between device and host.
//!
//! `examples/` shows the flow in programs of a page: `simulate_effect`, `fixed_point`, `fit_on_device`.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

// Numbers.
pub mod rng;
pub mod scalar;

// Measures.
pub mod units;

// Data.
pub mod excite;
pub mod recording;
pub mod trace;

// The linear machine.
pub mod discretise;
pub mod motor;

// What drives it.
pub mod bridge;

// What else happens in a motor.
pub mod effects;

// The sensor.
pub mod encoder;

// All of it, a step at a time.
pub mod error;
pub mod model;

// The search.
pub mod cost;
pub mod optim;

// On the device.
pub mod fit;
pub mod servo;
pub mod wire;
