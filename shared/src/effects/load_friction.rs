//! Friction that grows with the torque passed through a gear.

use super::supply_sag::WITH_THE_SUPPLY_LOGGED;
use super::{
    AtSpeed, Budget, Description, Effect, Facts, Needs, Other, Parameter, Place, Shaft, ToldFrom,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Dry friction `μ·|T|` of the torque `T` that the motor and its load pass to each other.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction<S: Scalar> {
    share: S::Coefficient,
}

lanes!(LoadFriction { share });

impl<S: Scalar> Effect<S> for LoadFriction<S> {
    const DESCRIPTION: Description = Description {
        name: "load_friction",
        place: Place::Friction,
        title: "friction that grows with the transmitted torque",
        parameters: &[Parameter::amplitude(
            "share",
            Quantity::Ratio,
            (0.0, 0.6),
            0.08,
        )],
        equation: "|T| <= mu*|Tm + Tl|, motor torque Tm, load torque Tl against rotation",
        signature: "residual torque against motion that grows with the current",
        exposed_by: "accelerating and braking at several levels; lifting and lowering a weight",
        look_alikes: &["supply_sag", "coulomb", "torque_sat"],
        source: "Duclusaud, Passault, Extended friction models for servo actuators, ICRA 2025",
        facts: Facts {
            at_speed: AtSpeed::OtherForm("friction that grows with the load has no place here"),
            told_from: &[ToldFrom {
                other: Other::Effect("supply_sag"),
                record: WITH_THE_SUPPLY_LOGGED,
                measure: Some("a measured supply voltage, or a known weight lifted and lowered"),
            }],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        current: true,
        friction: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        LoadFriction {
            share: units.multiplier::<S>(values[0], Quantity::Ratio),
        }
    }

    #[inline(always)]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        Budget::even(shaft.transmitted.abs().times(self.share))
    }
}
