//! Effects lowered to per unit, ready to run.

use super::{Any, Brush, Budget, EffectSet, MAX_EFFECTS, Needs, Shaft, Stiff, Winding};
use crate::scalar::{Real, Scalar};
use crate::units::PerUnit;

/// Effects lowered to per unit, in the order in which the command meets them.
#[derive(Clone, Copy, Debug)]
pub struct Lowered<S: Scalar> {
    effects: [Option<Any<S>>; MAX_EFFECTS],
    /// What they need of the model, together.
    pub needs: Needs,
    /// Drop of the brushes.
    pub brush: Brush<S>,
}

impl<S: Scalar> Lowered<S> {
    /// Lowers the effects of a set that do something.
    pub fn new<R: Real>(set: &EffectSet<R>, units: &PerUnit<R>) -> Self {
        let mut sorted = [None; MAX_EFFECTS];
        for (slot, present) in sorted.iter_mut().zip(set.present()) {
            *slot = Some(present);
        }
        sorted.sort_unstable_by_key(|slot| slot.map_or(u16::MAX, |(kind, _)| kind.rank()));
        let mut lowered = Lowered {
            effects: [None; MAX_EFFECTS],
            needs: Needs::NOTHING,
            brush: Brush::default(),
        };
        for (slot, (kind, values)) in lowered.effects.iter_mut().zip(sorted.into_iter().flatten()) {
            let effect = kind.lower::<S, R>(values, units);
            lowered.needs = lowered.needs.or(kind.needs());
            lowered.brush = lowered.brush.and(effect.brush());
            *slot = Some(effect);
        }
        lowered
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.effects[0].is_none()
    }

    #[inline(always)]
    fn each(&self) -> impl Iterator<Item = &Any<S>> {
        self.effects.iter().map_while(Option::as_ref)
    }

    /// Volts from the drive for a command.
    #[inline]
    pub fn drive(&self, command: S) -> S {
        self.each()
            .fold(command, |volts, effect| effect.drive(volts))
    }

    /// Changes of the winding with `volts` from the drive.
    #[inline]
    pub fn winding(&self, volts: S, shaft: &Shaft<S>, memory: &[S; MAX_EFFECTS]) -> Winding<S> {
        self.each()
            .zip(memory)
            .fold(Winding::default(), |sum, (effect, memory)| {
                sum.and(effect.winding(volts, shaft, *memory))
            })
    }

    /// Sum of the torques against positive rotation.
    #[inline]
    pub fn torque(&self, shaft: &Shaft<S>, memory: &[S; MAX_EFFECTS]) -> S {
        self.each()
            .zip(memory)
            .fold(S::zero(), |sum, (effect, memory)| {
                sum + effect.torque(shaft, *memory)
            })
    }

    /// Sum of the stiff torques.
    pub fn stiff(&self, shaft: &Shaft<S>, memory: &[S; MAX_EFFECTS]) -> Stiff<S> {
        self.each()
            .zip(memory)
            .fold(Stiff::default(), |sum, (effect, memory)| {
                sum.and(effect.stiff(shaft, *memory))
            })
    }

    /// Torque that the current should give and does not.
    #[inline]
    pub fn lost_torque(&self, shaft: &Shaft<S>, memory: &[S; MAX_EFFECTS]) -> S {
        self.each()
            .zip(memory)
            .fold(S::zero(), |sum, (effect, memory)| {
                sum + effect.lost_torque(shaft, *memory)
            })
    }

    /// Sum of the friction budgets.
    #[inline]
    pub fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        self.each().fold(Budget::default(), |sum, effect| {
            sum.and(effect.friction(shaft))
        })
    }

    /// Brings the memories up to the end of a part.
    #[inline]
    pub fn remember(&self, memory: &mut [S; MAX_EFFECTS], shaft: &Shaft<S>) {
        for (effect, memory) in self.each().zip(memory) {
            *memory = effect.remember(*memory, shaft);
        }
    }

    /// Error of the angle that the encoder sees, in turns.
    #[inline]
    pub fn sensed(&self, turns: S, memory: &[S; MAX_EFFECTS]) -> S {
        self.each()
            .zip(memory)
            .fold(S::zero(), |sum, (effect, memory)| {
                sum + effect.sensed(turns, *memory)
            })
    }
}
