//! A motor by the values of its unknowns.

use super::Arithmetic;
use crate::model::{Rigid, RigidPlan};
use crate::motor::Response;
use crate::units::PerUnit;
use serde::{Deserialize, Serialize};

/// A motor behind a bridge, in the device's own measure: counts, periods, and parts of the supply. See [`Unknown`](super::Unknown) for what
/// each value is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motor {
    pub(super) gain: f32,
    pub(super) first_order: f32,
    pub(super) electrical: f32,
    pub(super) coulomb: f32,
    pub(super) load: f32,
    pub(super) dead_time: f32,
    pub(super) viscous: f32,
    pub(super) supply: f32,
    /// Waves of the bridge's carrier in a period.
    pub(super) carriers: f32,
    /// Duty that is the whole supply, a part of the unit.
    pub(super) full: f32,
}

/// A winding slower than this many mechanical time constants is no motor's.
const SLOWEST_WINDING: f32 = 4.0;

impl Motor {
    /// None: all zeros.
    pub(super) const NONE: Self = Motor {
        gain: 0.0,
        first_order: 0.0,
        electrical: 0.0,
        coulomb: 0.0,
        load: 0.0,
        dead_time: 0.0,
        viscous: 0.0,
        supply: 0.0,
        carriers: 0.0,
        full: 0.0,
    };

    /// Makes `model` this motor; says whether there is one: none with a coefficient beyond the range of `S`, or an electrical time constant
    /// far above the mechanical one.
    // Out of line, as `build`, and for the sake of short instructions, which reach the first kilobyte of a stack.
    #[inline(never)]
    pub(super) fn set<S: Arithmetic>(&self, model: &mut Rigid<S>) -> bool {
        // Beyond the second there is no machine with this response.
        if self.electrical > SLOWEST_WINDING * self.first_order
            || 4.0 * self.viscous * self.electrical > self.first_order
        {
            return false;
        }
        // A count is the unit of angle, a period that of time, the supply that of voltage: SI in all but name.
        let response = Response {
            gain: self.gain,
            a1: self.first_order,
            a2: self.first_order * self.electrical,
        };
        let plan = RigidPlan {
            machine: response.machine_with_damping(self.viscous / self.gain),
            coulomb: self.coulomb,
            load: self.load,
            dead_time: self.dead_time,
            carriers: self.carriers,
            full: self.full,
            supply: self.supply,
            units: PerUnit {
                volts: 1.0,
                speed: power_of_two_above(self.gain),
                interval: 1.0,
                counts_per_rev: core::f32::consts::TAU,
            },
        };
        S::set(model, &plan)
    }
}

/// The power of two next above a positive number: dividing by it loses no bits.
fn power_of_two_above(x: f32) -> f32 {
    f32::from_bits((x.to_bits() & 0x7f80_0000) + 0x0080_0000)
}
