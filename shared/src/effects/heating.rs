//! The winding heats up.

use super::{Description, Effect, Evidence, Facts, Needs, Parameter, Place, Shaft, Winding};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// One thermal node. The memory is the rise `y` of the resistance, as a share of the cold one:
/// `dy/dt = k·(1 + y)·c² − y/τ`, since the loss is `(1 + y)·c²/R`. The magnets weaken with it: torque
/// and back-EMF fall by the share `q·y`.
#[derive(Clone, Copy, Debug)]
pub struct Heating<S: Scalar> {
    heating: S::Coefficient,
    cooling: S::Coefficient,
    magnets: S::Coefficient,
}

lanes!(Heating {
    heating,
    cooling,
    magnets
});

impl<S: Scalar> Effect<S> for Heating<S> {
    const DESCRIPTION: Description = Description {
        name: "heating",
        place: Place::Winding,
        title: "heating of the winding",
        parameters: &[
            Parameter::amplitude("rate", Quantity::PerEnergy, (0.0, 0.5), 0.04),
            Parameter::shape("time_constant", Quantity::Time, (1.0, 300.0), 20.0),
            Parameter::shape("magnets", Quantity::Ratio, (0.0, 0.6), 0.25),
        ],
        equation: "dy/dt = k*(1+y)*(R*i)^2 - y/tau; R*(1+y), Kt*(1-q*y), Kb*(1-q*y)",
        signature: "slow drift of gain and time constant with the power spent since the start",
        exposed_by: "the same short experiment cold and, after minutes of load, hot",
        look_alikes: &["supply_sag", "windage", "torque_sat"],
        source: "IEC 60034-1 for copper; Hughes, Electric Motors and Drives, 2013 (one thermal node)",
        facts: Facts {
            evidence: Evidence::Drifts,
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        current: true,
        winding: true,
        lost_torque: true,
        memory: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let cooling = units.base(Quantity::Time) / values[1].max(units.interval);
        Heating {
            heating: units.multiplier::<S>(values[0], Quantity::PerEnergy),
            cooling: S::coefficient(cooling.to_f64()),
            magnets: units.multiplier::<S>(values[2], Quantity::Ratio),
        }
    }

    #[inline(always)]
    fn winding(&self, shaft: &Shaft<S>, memory: S) -> Winding<S> {
        let rise = self.rise(memory, shaft);
        Winding {
            resistance: rise,
            back_emf: -rise.times(self.magnets),
            ..Winding::default()
        }
    }

    #[inline(always)]
    fn lost_torque(&self, shaft: &Shaft<S>, memory: S) -> S {
        shaft.current * self.rise(memory, shaft).times(self.magnets)
    }

    #[inline(always)]
    fn remember(&self, memory: S, shaft: &Shaft<S>) -> S {
        memory + self.change(self.rise(memory, shaft), shaft)
    }
}

impl<S: Scalar> Heating<S> {
    /// Mean rise over the part.
    #[inline(always)]
    fn rise(&self, memory: S, shaft: &Shaft<S>) -> S {
        memory + self.change(memory, shaft) * S::from_f64(0.5)
    }

    /// Change over the part of a rise that stays near `rise`.
    #[inline(always)]
    fn change(&self, rise: S, shaft: &Shaft<S>) -> S {
        let square = shaft.mean_over_current(
            #[inline(always)]
            |current| current * current,
        );
        let heat = (square + square * rise).times(self.heating);
        (heat - rise.times(self.cooling)).times(shaft.length)
    }
}
