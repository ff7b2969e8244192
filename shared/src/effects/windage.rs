//! Windage: the drag of the air that a fan or a fast rotor stirs.

use super::{AtSpeed, Description, Effect, Evidence, Facts, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Turbulent drag, `c·ω·|ω|`.
#[derive(Clone, Copy, Debug)]
pub struct Windage<S: Scalar> {
    drag: S::Coefficient,
}

lanes!(Windage { drag });

impl<S: Scalar> Effect<S> for Windage<S> {
    const DESCRIPTION: Description = Description {
        name: "windage",
        place: Place::Torque,
        title: "windage (drag on the square of the speed)",
        parameters: &[Parameter::amplitude(
            "drag",
            Quantity::Drag,
            (0.0, 0.5),
            0.05,
        )],
        equation: "T = c*w*|w|",
        signature: "curvature of the voltage over the speed, at high speed",
        exposed_by: "a staircase up to full speed, and coasting down from it",
        look_alikes: &["asym_viscous", "heating", "supply_sag", "torque_sat"],
        source: "Vrancik, NASA TN D-4849, 1968",
        facts: Facts {
            evidence: Evidence::Grows,
            at_speed: AtSpeed::OtherForm("drag on the square of the speed has no place here"),
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        torque: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        Windage {
            drag: units.multiplier::<S>(values[0], Quantity::Drag),
        }
    }

    #[inline(always)]
    fn torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        let square = shaft.mean_over_speed(
            #[inline(always)]
            |speed| speed * speed.abs(),
        );
        square.times(self.drag)
    }
}
