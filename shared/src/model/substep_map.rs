//! A substep as the effects see it: its map, its length and its mean current.

use super::step_map::{RealMaps, StepMap};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};
use core::ops::Deref;

/// Constants of a substep, from which the mean current follows.
///
/// The mean of `τe·dc/dt = v − c − kb·ω` over a substep of length `h` is exactly
/// `c̄ = v − kb·ω̄ − (τe/h)·Δc`.
#[derive(Clone, Copy, Debug)]
pub struct SubstepTiming<S: Scalar> {
    /// Length in intervals.
    pub length: S::Coefficient,
    /// One over the length.
    pub per_length: S::Coefficient,
    /// `τe/h`.
    pub lag: S::Coefficient,
    /// Back-EMF constant.
    pub kb: S::Coefficient,
    /// Mean current per held volt.
    pub gain: S,
    /// Angle by which a held torque shortens the travel, per torque, in base speed × interval.
    pub compliance: S,
    /// Moment of inertia by the length.
    pub inertia: S::Coefficient,
}

lanes!(SubstepTiming {
    length,
    per_length,
    lag,
    kb,
    gain,
    compliance,
    inertia
});

impl<S: Scalar> SubstepTiming<S> {
    /// Of a substep of `length` intervals in which a held volt raises the current by `current`, and a
    /// held volt and a held torque turn the shaft by `angle`.
    pub fn new<R: Real>(machine: &Machine<R>, length: R, current: R, angle: [R; 2]) -> Self {
        let per_length = R::from_f64(1.0) / length;
        let lag = machine.electrical * per_length;
        let gain = R::from_f64(1.0) - machine.kb * angle[0] * per_length - lag * current;
        SubstepTiming {
            length: S::coefficient(length.to_f64()),
            per_length: S::coefficient(per_length.to_f64()),
            lag: S::coefficient(lag.to_f64()),
            kb: S::coefficient(machine.kb.to_f64()),
            gain: S::from_f64(gain.to_f64()),
            compliance: S::from_f64(-angle[1].to_f64()),
            inertia: S::coefficient((machine.inertia * per_length).to_f64()),
        }
    }
}

/// The map of a substep with its timing. Two types, because a small device has neither the room nor the time for the
/// timing, which only effects need.
#[derive(Clone, Copy, Debug)]
pub struct SubstepMap<S: Scalar> {
    map: StepMap<S>,
    timing: SubstepTiming<S>,
}

lanes!(SubstepMap { map, timing });

impl<S: Scalar> SubstepMap<S> {
    /// The map of zeros: nothing moves.
    pub fn zero() -> Self {
        let none = S::Coefficient::default();
        SubstepMap {
            map: StepMap::of(none),
            timing: SubstepTiming {
                length: none,
                per_length: none,
                lag: none,
                kb: none,
                gain: S::zero(),
                compliance: S::zero(),
                inertia: none,
            },
        }
    }

    /// Lowers the maps of a substep of `length` intervals.
    ///
    /// # Errors
    /// A multiplier beyond the range of `S`.
    pub fn new<R: Real>(
        maps: &RealMaps<R>,
        machine: &Machine<R>,
        length: R,
    ) -> Result<Self, ModelError> {
        let mut map = StepMap::of(S::Coefficient::default());
        maps.lower(&mut map)?;
        let (current, angle) = maps.by_inputs();
        let timing = SubstepTiming::new(machine, length, current, angle);
        Ok(SubstepMap { map, timing })
    }

    /// Length of the substep, and constants of its mean current.
    #[inline(always)]
    pub fn timing(&self) -> &SubstepTiming<S> {
        &self.timing
    }
}

impl<S: Scalar> Deref for SubstepMap<S> {
    type Target = StepMap<S>;

    #[inline(always)]
    fn deref(&self) -> &StepMap<S> {
        &self.map
    }
}
