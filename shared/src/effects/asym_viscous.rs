//! Viscous friction that differs between the directions.

use super::{AtSpeed, Description, Effect, Evidence, Facts, Needs, Pair, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Extra viscous friction, `bf·ω` forward and `bb·ω` backward, as of a lip seal or a screw pump: the
/// mean of both on the speed, half their difference on its magnitude.
#[derive(Clone, Copy, Debug)]
pub struct AsymViscous<S: Scalar> {
    mean: S::Coefficient,
    difference: S::Coefficient,
}

lanes!(AsymViscous { mean, difference });

impl<S: Scalar> Effect<S> for AsymViscous<S> {
    const DESCRIPTION: Description = Description {
        name: "asym_viscous",
        place: Place::Torque,
        title: "viscous friction that differs between the directions",
        parameters: &[
            Parameter::amplitude("forward", Quantity::Damping, (0.0, 0.5), 0.06),
            Parameter::amplitude("backward", Quantity::Damping, (0.0, 0.5), 0.02),
        ],
        equation: "T = bf*w for w > 0, bb*w for w < 0",
        signature: "slope of the residual torque against speed that differs between the directions",
        exposed_by: "two speeds in each direction",
        look_alikes: &["asym_coulomb", "windage"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994",
        facts: Facts {
            evidence: Evidence::Grows,
            pair: Some(Pair::Difference),
            at_speed: AtSpeed::Viscous {
                mean_of: &[0, 1],
                without: Some("the mean of both directions stands for each"),
            },
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        torque: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let half = R::from_f64(0.5);
        let (forward, backward) = (values[0], values[1]);
        AsymViscous {
            mean: units.multiplier::<S>((forward + backward) * half, Quantity::Damping),
            difference: units.multiplier::<S>((forward - backward) * half, Quantity::Damping),
        }
    }

    #[inline(always)]
    fn torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        let magnitude = shaft.mean_over_speed(S::abs);
        shaft.speed.times(self.mean) + magnitude.times(self.difference)
    }
}
