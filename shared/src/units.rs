//! SI to per unit and back. The only file that knows SI.
//!
//! Per unit, every number that the hot loop touches is near one: volts are divided by a base
//! voltage (the supply), speeds by a base speed (at least the no-load speed), times by the sample
//! interval. Torques are voltages too: a torque `T` is stated as the voltage `T·R/Kt` that the
//! winding must spend on it, because voltage and angle alone determine nothing else (see
//! [`motor`](crate::motor)).

use crate::error::ModelError;
use crate::scalar::{Real, Scalar};

/// What a parameter measures, and with that its unit and its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// V; a torque referred to the winding, `T·R/Kt`, is one as well.
    Voltage,
    /// A torque, in V referred to the winding (`T·R/Kt`).
    Torque,
    /// rad/s.
    Speed,
    /// s.
    Time,
    /// V·s/rad: back-EMF, or viscous friction referred to the winding.
    Damping,
    /// V·s²/rad²: drag on the square of the speed, referred to the winding.
    Drag,
    /// V·s²/rad: inertia referred to the winding, `J·R/Kt`.
    Inertia,
    /// V/rad: a spring rate referred to the winding.
    Stiffness,
    /// rad.
    Angle,
    /// 1/V: something that acts in proportion to a (current or torque) voltage.
    PerVolt,
    /// 1/V²: something that acts in proportion to the square of a voltage.
    PerSquareVolt,
    /// 1/(V²·s): something that grows with power over time.
    PerEnergy,
    /// A plain ratio.
    Ratio,
    /// °C.
    Temperature,
    /// Cycles per revolution.
    PerRev,
    /// In a unit of its own, which a [formula](crate::effects::formula) states; its ranges are in that unit.
    Stated(&'static str),
}

impl Quantity {
    /// Unit symbol.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Voltage | Quantity::Torque => "V",
            Quantity::Speed => "rad/s",
            Quantity::Time => "s",
            Quantity::Damping => "V*s/rad",
            Quantity::Drag => "V*s^2/rad^2",
            Quantity::Inertia => "V*s^2/rad",
            Quantity::Stiffness => "V/rad",
            Quantity::Angle => "rad",
            Quantity::PerVolt => "1/V",
            Quantity::PerSquareVolt => "1/V^2",
            Quantity::PerEnergy => "1/(V^2*s)",
            Quantity::Ratio => "1",
            Quantity::Temperature => "degC",
            Quantity::PerRev => "1/rev",
            Quantity::Stated(unit) => unit,
        }
    }
}

/// Base of temperatures, °C: windings are near it.
const HOT: f64 = 100.0;

/// The bases of the per-unit system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerUnit<R> {
    /// Base voltage, V.
    pub volts: R,
    /// Base speed, rad/s.
    pub speed: R,
    /// Sample interval, s.
    pub interval: R,
    /// Encoder counts per revolution; fractional behind some gears.
    pub counts_per_rev: R,
}

impl<R: Real> PerUnit<R> {
    /// Checks that the bases are positive and finite.
    pub fn new(volts: R, speed: R, interval: R, counts_per_rev: R) -> Result<Self, ModelError> {
        for (name, value) in [
            ("base voltage", volts),
            ("base speed", speed),
            ("sample interval", interval),
            ("counts per revolution", counts_per_rev),
        ] {
            if !(value.is_finite() && value > R::zero()) {
                return Err(ModelError::Parameter {
                    name,
                    value: value.to_f64(),
                });
            }
        }
        Ok(PerUnit {
            volts,
            speed,
            interval,
            counts_per_rev,
        })
    }

    /// The same bases for a part of the interval.
    pub fn with_interval(self, interval: R) -> Self {
        PerUnit { interval, ..self }
    }

    /// Size of one per-unit step of `quantity`, in its SI unit.
    pub fn base(&self, quantity: Quantity) -> R {
        let one = R::from_f64(1.0);
        match quantity {
            Quantity::Voltage | Quantity::Torque => self.volts,
            Quantity::Speed => self.speed,
            Quantity::Time => self.interval,
            Quantity::Damping => self.volts / self.speed,
            Quantity::Drag => self.volts / (self.speed * self.speed),
            Quantity::Inertia => self.volts * self.interval / self.speed,
            Quantity::Stiffness => self.volts / self.base(Quantity::Angle),
            Quantity::Angle => R::from_f64(core::f64::consts::TAU),
            Quantity::PerVolt => one / self.volts,
            Quantity::PerSquareVolt => one / (self.volts * self.volts),
            Quantity::PerEnergy => one / (self.volts * self.volts * self.interval),
            Quantity::Temperature => R::from_f64(HOT),
            Quantity::Ratio | Quantity::PerRev | Quantity::Stated(_) => one,
        }
    }

    /// From SI to per unit.
    pub fn lower(&self, value: R, quantity: Quantity) -> R {
        value / self.base(quantity)
    }

    /// From SI to per unit, as a number of the format `S`.
    pub fn number<S: Scalar>(&self, value: R, quantity: Quantity) -> S {
        S::of(self.lower(value, quantity))
    }

    /// From SI to per unit, as a multiplier of the format `S`.
    pub fn multiplier<S: Scalar>(&self, value: R, quantity: Quantity) -> S::Coefficient {
        S::coefficient_of(self.lower(value, quantity))
    }

    /// From per unit to SI.
    pub fn raise(&self, value: R, quantity: Quantity) -> R {
        value * self.base(quantity)
    }

    /// Encoder counts that the shaft turns at base speed in one interval.
    pub fn counts_per_unit(&self) -> R {
        self.speed * self.interval * self.counts_per_rev / R::from_f64(core::f64::consts::TAU)
    }
}
