//! The counter misses counts.

use super::{Description, Effect, Facts, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// A decoder that cannot follow loses the share `s` of the travel that is beyond the speed `w0`, and
/// never finds it again. The memory is what it has lost, in turns.
///
/// Counts are lost one by one and by chance; this is their mean, all that a model can foretell. At
/// `w0 = 0` it is a change of scale, which no recording shows. The single losses are local steps of
/// whole counts in the residual: to be looked for there, and not simulated.
#[derive(Clone, Copy, Debug)]
pub struct MissedCounts<S: Scalar> {
    share: S::Coefficient,
    speed: S,
}

lanes!(MissedCounts { share, speed });

impl<S: Scalar> Effect<S> for MissedCounts<S> {
    const DESCRIPTION: Description = Description {
        name: "missed_counts",
        place: Place::Sensed,
        title: "counts missed at high speed",
        parameters: &[
            Parameter::amplitude("share", Quantity::Ratio, (0.0, 0.1), 0.002),
            Parameter::shape("speed", Quantity::Speed, (0.0, 1.0), 0.5),
        ],
        equation: "d(lost)/dt = s*max(|w| - w0, 0)*sgn(w); reading = theta - lost",
        signature: "small steps of whole counts against the motion, the more the faster it is, that stay",
        exposed_by: "fast runs there and back; an index pulse",
        look_alikes: &["enc_ecc"],
        source: "none; the loss is taken to grow above a speed",
        facts: Facts {
            by_chance: true,
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        sensed: true,
        memory: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        MissedCounts {
            share: units.multiplier::<S>(values[0], Quantity::Ratio),
            speed: units.number::<S>(values[1], Quantity::Speed).max(S::zero()),
        }
    }

    #[inline(always)]
    fn remember(&self, memory: S, shaft: &Shaft<S>) -> S {
        let followed = self.speed.part_of(shaft.speed.abs());
        let beyond = shaft.travel - shaft.travel * followed;
        memory + beyond.times(self.share)
    }

    #[inline(always)]
    fn sensed(&self, _turns: S, memory: S) -> S {
        -memory
    }
}
