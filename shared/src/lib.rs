//! The motor, its encoder and the lean optimisers: everything that the microcontroller and the PC
//! must compute alike. No std, no allocation, no I/O, no clock, no thread, no unsafe code.
//!
//! Read it in the order of the flow:
//!
//! 1. [`scalar`]: the number a model is computed in (f64, f32, fixed point; later SIMD lanes);
//! 2. [`units`]: SI to per unit and back, the only file that knows SI;
//! 3. [`recording`]: what was commanded and what the encoder read; [`excite`] makes the commands;
//! 4. [`motor`]: the linear armature-controlled machine, [`discretise`]d exactly or by Euler's step;
//! 5. [`effects`]: one physical effect a file, and the list of them;
//! 6. [`encoder`]: floor, wrap, differences;
//! 7. [`model`]: motor + effects + encoder, the few lines to read first;
//! 8. [`cost`]: how far the model is from the recording;
//! 9. [`optim`]: particle swarm, firefly and random search, ask and tell; [`rng`] feeds them.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod cost;
pub mod discretise;
pub mod effects;
pub mod encoder;
pub mod error;
pub mod excite;
pub mod fit;
pub mod model;
pub mod motor;
pub mod optim;
pub mod recording;
pub mod rng;
pub mod scalar;
pub mod trace;
pub mod units;
pub mod wire;
