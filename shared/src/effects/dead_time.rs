//! Dead time of a switched bridge.

use super::{
    Brush, Description, Effect, Evidence, Facts, Needs, Other, Parameter, Place, Starts, ToldFrom,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// The mean voltage that a bridge of two legs loses against the current while both transistors of a leg are off: with the dead time
/// `t_d` and the carrier's period `T`, `Vd = (2·t_d/T)·Vs`. It loses nothing as long as the ripple turns the current within each
/// carrier wave ([`Spared`](super::Spared)); the ripple is largest at half of the supply, `V1 = Vs·T·R/(16·L)`. Beyond, the loss rises
/// over `w = 4·V1·Vd/Vs`. A leg that is always high has no edge and loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct DeadTime<S> {
    loss: Brush<S>,
}

lanes!(DeadTime { loss });

/// Narrowest rise of the loss, as a part of the supply: what every number format resolves.
const NARROWEST: f64 = 1.0 / 65_536.0;

impl<S: Scalar> Effect<S> for DeadTime<S> {
    const DESCRIPTION: Description = Description {
        name: "dead_time",
        place: Place::Drive,
        title: "dead time of a switched bridge",
        parameters: &[
            Parameter::amplitude("voltage", Quantity::Voltage, (0.0, 0.2), 0.04),
            Parameter::shape("ripple", Quantity::Voltage, (0.0, 0.1), 0.01),
        ],
        equation: "v = u - Vd*sgn(x)*max(0, min((|x| - h)/w, 1)), x = R*i - c, w = 4*V1*Vd/Vs; the ripple V1 spares c - h < R*i < c + h",
        signature: "residual voltage changes sign with the current and is the same beyond the ripple; none within it",
        exposed_by: "braking and driving at the same speed, at small and large commands; two supply voltages",
        look_alikes: &["brush_drop", "dead_zone", "coulomb"],
        source: "Holmes, Lipo, Pulse Width Modulation for Power Converters, 2003, section 12.2",
        facts: Facts {
            starts: Starts::Shares(&[(1, &[1.0, 0.2])]),
            evidence: Evidence::ChangesSign,
            told_from: &[ToldFrom {
                other: Other::Effect("brush_drop"),
                record: "the same commands on two supply voltages: a dead time scales with the supply, brushes do not",
                measure: Some(
                    "the same at two supply voltages, or at two carrier frequencies: what a dead time takes grows with both",
                ),
            }],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs::VOLTS_BY_CURRENT;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let drop = units.lower(values[0], Quantity::Voltage);
        let reach = units.lower(values[1], Quantity::Voltage) * R::from_f64(4.0);
        DeadTime {
            loss: Brush {
                drop: S::of(drop),
                knee: S::of((reach * drop).max(R::from_f64(NARROWEST))),
                ripple: S::of(reach),
                ..Brush::default()
            },
        }
    }

    #[inline(always)]
    fn brush(&self) -> Brush<S> {
        self.loss
    }
}
