//! The supply falls with the current drawn from it.

use super::{Description, Effect, Facts, Needs, Other, Parameter, Place, Shaft, ToldFrom, Winding};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// The bridge draws the part `d = u/Vs` of the current from the supply and passes on the part `d` of
/// its voltage, so a source resistance `Rs` adds `Rs·d²` to the winding's. (That is why this effect
/// of the drive changes the winding.)
#[derive(Clone, Copy, Debug)]
pub struct SupplySag<S: Scalar> {
    sag: S::Coefficient,
}

lanes!(SupplySag { sag });

/// What the supply gives way shows in its voltage.
pub(super) const WITH_THE_SUPPLY_LOGGED: &str =
    "hard steps and a stall while the supply voltage is logged";

impl<S: Scalar> Effect<S> for SupplySag<S> {
    const DESCRIPTION: Description = Description {
        name: "supply_sag",
        place: Place::Drive,
        title: "sag of the supply under load",
        parameters: &[Parameter::amplitude(
            "sag",
            Quantity::PerSquareVolt,
            (0.0, 0.6),
            0.06,
        )],
        equation: "v = u - k*u^2*(R*i), k = (Rs/R)/Vs^2",
        signature: "missing voltage in proportion to the current, only at large commands",
        exposed_by: "hard steps and reversals at several levels",
        look_alikes: &["load_friction", "torque_sat", "voltage_sat", "heating"],
        source: "Mohan, Undeland, Robbins, Power Electronics, 2003, ch. 7 (averaged chopper)",
        facts: Facts {
            told_from: &[ToldFrom {
                other: Other::Effect("voltage_sat"),
                record: WITH_THE_SUPPLY_LOGGED,
                measure: None,
            }],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs::VOLTS_BY_CURRENT;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        SupplySag {
            sag: units.multiplier::<S>(values[0], Quantity::PerSquareVolt),
        }
    }

    #[inline(always)]
    fn winding(&self, shaft: &Shaft<S>, _memory: S) -> Winding<S> {
        Winding {
            resistance: (shaft.volts * shaft.volts).times(self.sag),
            ..Winding::default()
        }
    }
}
