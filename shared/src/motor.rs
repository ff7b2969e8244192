//! The linear armature-controlled DC machine.
//!
//! Winding and shaft (any text on electrical machines; Ljung, *System Identification*, 1999, §4):
//!
//! ```text
//! v = R·i + L·di/dt + Kb·ω          J·dω/dt = Kt·i − f·ω − T
//! ```
//!
//! Voltage and angle alone cannot tell the six parameters apart. Multiply the second line by `R/Kt`
//! and write `c = R·i`, the voltage that the current uses up in the resistance:
//!
//! ```text
//! v = c + τe·dc/dt + Kb·ω           m·dω/dt = c − b·ω − T·R/Kt
//! τe = L/R    m = J·R/Kt    b = f·R/Kt
//! ```
//!
//! [`Machine`] holds these four numbers and is all that the model computes with. From voltage and
//! angle only three combinations follow, [`Response`]: with the bridge closed and no other torque,
//! `Kb` and `b` act alike.

use crate::error::ModelError;
use crate::scalar::Real;
use crate::units::{PerUnit, Quantity};

/// The six physical parameters, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physical<R> {
    /// Armature resistance `R`, Ω.
    pub resistance: R,
    /// Armature inductance `L`, H.
    pub inductance: R,
    /// Torque constant `Kt`, N·m/A.
    pub kt: R,
    /// Back-EMF constant `Kb`, V·s/rad.
    pub kb: R,
    /// Moment of inertia `J`, kg·m².
    pub inertia: R,
    /// Viscous friction `f`, N·m·s/rad.
    pub viscous: R,
}

impl<R: Real> Physical<R> {
    /// What voltage and angle can see of it. For the paper's motor see
    /// "Metaheuristic algorithms for parameter estimation of DC servo motors with quantized sensor
    /// measurements", IJAPE 14(1), 2025.
    pub fn machine(&self) -> Machine<R> {
        let volts_per_torque = self.resistance / self.kt;
        Machine {
            kb: self.kb,
            damping: self.viscous * volts_per_torque,
            inertia: self.inertia * volts_per_torque,
            electrical: self.inductance / self.resistance,
        }
    }
}

/// The linear machine as its terminals show it: torques and inertia referred to the winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine<R> {
    /// Back-EMF constant `Kb`, V·s/rad; zero behind an amplifier with a current loop.
    pub kb: R,
    /// Viscous friction `f·R/Kt`, V·s/rad.
    pub damping: R,
    /// Inertia `J·R/Kt`, V·s²/rad.
    pub inertia: R,
    /// Electrical time constant `L/R`, s.
    pub electrical: R,
}

impl<R: Real> Machine<R> {
    /// The combinations that voltage and angle determine. Infinite where `kb + damping` is zero.
    pub fn response(&self) -> Response<R> {
        let total = self.kb + self.damping;
        Response {
            gain: R::from_f64(1.0) / total,
            a1: (self.inertia + self.electrical * self.damping) / total,
            a2: self.electrical * self.inertia / total,
        }
    }

    /// The same machine per unit.
    pub fn lower(&self, units: &PerUnit<R>) -> Machine<R> {
        Machine {
            kb: units.lower(self.kb, Quantity::Damping),
            damping: units.lower(self.damping, Quantity::Damping),
            inertia: units.lower(self.inertia, Quantity::Inertia),
            electrical: units.lower(self.electrical, Quantity::Time),
        }
    }

    /// Finite, inertia positive, nothing negative.
    pub fn check(&self) -> Result<(), ModelError> {
        for (name, value, positive) in [
            ("back-EMF constant", self.kb, false),
            ("viscous friction", self.damping, false),
            ("inertia", self.inertia, true),
            ("electrical time constant", self.electrical, false),
        ] {
            let below = value < R::zero() || (positive && value <= R::zero());
            if below || !value.is_finite() {
                return Err(ModelError::Parameter {
                    name,
                    value: value.to_f64(),
                });
            }
        }
        Ok(())
    }
}

/// What voltage and angle determine of a linear machine: `θ/V = gain / (s·(a2·s² + a1·s + 1))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response<R> {
    /// Steady speed per volt, rad/(s·V): `Kt/(Kt·Kb + R·f)`.
    pub gain: R,
    /// First-order coefficient, s: `(R·J + L·f)/(Kt·Kb + R·f)`; close to the mechanical time constant.
    pub a1: R,
    /// Second-order coefficient, s²: `L·J/(Kt·Kb + R·f)`.
    pub a2: R,
}

impl<R: Real> Response<R> {
    /// The machine without viscous friction that has this response; every other one with the same
    /// response moves the encoder alike while the bridge is closed.
    pub fn machine(&self) -> Machine<R> {
        self.machine_with_damping(R::zero())
    }

    /// The machine with viscous friction `damping` (V·s/rad, below `1/gain`) that has this response.
    ///
    /// With `D = 1/gain`: `m + τe·b = a1·D` and `τe·m = a2·D`, hence the inertia solves
    /// `m² − a1·D·m + b·a2·D = 0`; the larger root is the one that tends to `a1·D` as `b` vanishes.
    pub fn machine_with_damping(&self, damping: R) -> Machine<R> {
        let total = R::from_f64(1.0) / self.gain;
        let sum = self.a1 * total;
        let product = damping * self.a2 * total;
        let discriminant = sum * sum - R::from_f64(4.0) * product;
        let root = if discriminant > R::zero() {
            discriminant.sqrt()
        } else {
            R::zero()
        };
        let inertia = (sum + root) * R::from_f64(0.5);
        Machine {
            kb: total - damping,
            damping,
            inertia,
            electrical: self.a2 * total / inertia,
        }
    }
}
