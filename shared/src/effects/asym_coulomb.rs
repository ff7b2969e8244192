//! Coulomb friction that differs between the directions.

use super::{
    AtSpeed, Budget, Contained, Description, Effect, Evidence, Facts, Needs, Parameter, Place,
    Shaft, Value,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Friction `Tf` against forward and `Tb` against backward motion: to the equations, Coulomb
/// friction of their mean and a load of half their difference that it always outweighs.
#[derive(Clone, Copy, Debug)]
pub struct AsymCoulomb<S> {
    mean: S,
    bias: S,
}

lanes!(AsymCoulomb { mean, bias });

impl<S: Scalar> Effect<S> for AsymCoulomb<S> {
    const DESCRIPTION: Description = Description {
        name: "asym_coulomb",
        place: Place::Friction,
        title: "Coulomb friction that differs between the directions",
        parameters: &[
            Parameter::amplitude("forward_torque", Quantity::Torque, (0.0, 0.5), 0.036),
            Parameter::amplitude("backward_torque", Quantity::Torque, (0.0, 0.5), 0.024),
        ],
        equation: "T = Tf for w > 0, -Tb for w < 0; -Tb <= T <= Tf at rest",
        signature: "residual torque changes sign with speed, by a different size in each direction",
        exposed_by: "steps of both signs; a hold at rest tells it from a constant load",
        look_alikes: &["coulomb", "load_torque", "offset_voltage"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994",
        facts: Facts {
            contains: &[Contained {
                name: "coulomb",
                values: &[Value::Mean(0, 1)],
                at_rest: &[],
                whole: true,
            }],
            evidence: Evidence::ChangesSign,
            at_speed: AtSpeed::Sliding {
                mean_of: &[0, 1],
                without: Some("the mean of both directions stands for each"),
            },
            caution: Some(
                "unequal friction, and equal friction beside a constant load or an offset, do the same while the shaft \
                 turns: hold it at rest at several angles, where a load acts and friction only holds, and let it run down \
                 with the bridge open, where an offset vanishes",
            ),
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        friction: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let half = R::from_f64(0.5);
        let (forward, backward) = (values[0], values[1]);
        AsymCoulomb {
            mean: units.number((forward + backward) * half, Quantity::Torque),
            bias: units.number((forward - backward) * half, Quantity::Torque),
        }
    }

    #[inline(always)]
    fn friction(&self, _shaft: &Shaft<S>) -> Budget<S> {
        Budget {
            bias: self.bias,
            ..Budget::even(self.mean)
        }
    }
}
