//! Effects lowered to per unit, ready to run.

use super::{Any, Brush, Budget, EffectSet, MAX_EFFECTS, Memory, Needs, Shaft, Stiff, Winding};
use crate::scalar::{Real, Scalar, lanes};
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

lanes!(Lowered {
    effects,
    needs,
    brush
});

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
    #[inline(always)]
    pub fn drive(&self, command: S) -> S {
        let mut volts = command;
        for effect in self.each() {
            volts = effect.drive(volts);
        }
        volts
    }

    /// Changes of the winding.
    #[inline(always)]
    pub fn winding(&self, shaft: &Shaft<S>, memory: &[Memory<S>; MAX_EFFECTS]) -> Winding<S> {
        let mut sum = Winding::default();
        for (effect, memory) in self.each().zip(memory) {
            sum = sum.and(effect.winding(shaft, memory));
        }
        sum
    }

    /// Sum of the torques against positive rotation.
    #[inline(always)]
    pub fn torque(&self, shaft: &Shaft<S>, memory: &[Memory<S>; MAX_EFFECTS]) -> S {
        let mut sum = S::zero();
        for (effect, memory) in self.each().zip(memory) {
            sum = sum + effect.torque(shaft, memory);
        }
        sum
    }

    /// Sum of the stiff torques.
    #[inline]
    pub fn stiff(&self, shaft: &Shaft<S>, memory: &[Memory<S>; MAX_EFFECTS]) -> Stiff<S> {
        S::routine(
            #[inline(always)]
            || {
                let mut sum = Stiff::default();
                for (effect, memory) in self.each().zip(memory) {
                    sum = sum.and(effect.stiff(shaft, memory));
                }
                sum
            },
        )
    }

    /// Torque that the current should give and does not.
    #[inline(always)]
    pub fn lost_torque(&self, shaft: &Shaft<S>, memory: &[Memory<S>; MAX_EFFECTS]) -> S {
        let mut sum = S::zero();
        for (effect, memory) in self.each().zip(memory) {
            sum = sum + effect.lost_torque(shaft, memory);
        }
        sum
    }

    /// Sum of the friction budgets.
    #[inline(always)]
    pub fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let mut sum = Budget::default();
        for effect in self.each() {
            sum = sum.and(effect.friction(shaft));
        }
        sum
    }

    /// Brings the memories up to the end of a part.
    #[inline]
    pub fn remember(&self, memory: &mut [Memory<S>; MAX_EFFECTS], shaft: &Shaft<S>) {
        S::routine(
            #[inline(always)]
            || {
                for (effect, memory) in self.each().zip(&mut *memory) {
                    *memory = effect.remember(memory, shaft);
                }
            },
        )
    }

    /// Error of the angle that the encoder sees, in turns.
    #[inline(always)]
    pub fn sensed(&self, turns: S, memory: &[Memory<S>; MAX_EFFECTS]) -> S {
        let mut sum = S::zero();
        for (effect, memory) in self.each().zip(memory) {
            sum = sum + effect.sensed(turns, memory);
        }
        sum
    }
}
