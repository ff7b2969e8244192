//! Changes of the winding, and the drop of its brushes, as volts added to the drive.
//!
//! With resistance `1 + r`, inductance `1/(1 + l)`, back-EMF `1 + e` times their own, volts `a` beside the drive's and a drop `D`
//! of the brushes, all held over the substep,
//!
//! ```text
//! τe·dc/dt = (1 + l)·(v + a − (1 + r)·c − (1 + e)·kb·ω − D(c))  =  v + E − c − kb·ω
//! ```
//!
//! defines the volts `E` that the plain winding must see instead. Its mean is solved for, with the
//! gain `g` of the mean current: the current follows within the substep when the winding is fast, and
//! an explicit formula would overshoot. `D = Vb·clamp(c/knee, ±1)` has one bend each way and is
//! solved exactly; a rounded knee by Newton's method from there. Where a ripple spares currents, their distance from those stands for
//! `|c|`.

use super::substep_map::SubstepTiming;
use crate::effects::{Brush, Shaft, WHOLE_DROP, Winding};
use crate::scalar::{Mask, Scalar};

/// Volts `E` of a substep whose mean shaft, with the plain winding at `volts`, is `free`.
#[inline(always)]
pub fn extra_volts<S: Scalar>(
    changed: &Winding<S>,
    brush: &Brush<S>,
    volts: S,
    free: &Shaft<S>,
    timing: &SubstepTiming<S>,
) -> S {
    let one = S::from_f64(1.0);
    let Winding {
        resistance,
        rate,
        back_emf,
        volts: added,
        ..
    } = *changed;
    let gain = timing.gain;
    let emf = free.speed.times(timing.kb);
    let inductive = volts - free.current - emf;
    let lost = resistance * free.current + back_emf * emf - added;
    let given = bounded(rate, inductive) - lost - bounded(rate, lost);
    let stiffness = one + gain * (rate + resistance + rate * resistance);
    let scale = one.part_of(stiffness);
    if !S::zero().less(brush.drop).any() {
        return given * scale;
    }
    // The current without brushes, times the stiffness.
    let current = free.current * stiffness + gain * given;
    let spared = brush.spared(volts);
    let off = current - spared.centre * stiffness;
    let beyond = (off.abs() - spared.half * stiffness).max(S::zero());
    let most = brush.most(volts, off);
    let most = most + rate * most;
    let knee = brush.knee * stiffness;
    let mut part = beyond.part_of(knee + gain * most);
    if brush.is_rounded().any() {
        let rounded = rounded_part(brush, beyond, part, knee, gain * most);
        part = S::select(brush.is_rounded(), rounded, part);
    }
    let drop = most * part * off.signum();
    (given - drop) * scale
}

/// Newton's steps for a rounded knee. It is a concave curve but for the corner that a blend has.
const NEWTON_STEPS: usize = 8;

/// The part of the drop that a rounded knee loses: `knee·u + most·φ(u) = current` for the current `u` in knees, from where the
/// `sharp` one has it.
#[inline(always)]
fn rounded_part<S: Scalar>(brush: &Brush<S>, current: S, sharp: S, knee: S, most: S) -> S {
    let zero = S::zero();
    let farthest = S::from_f64(WHOLE_DROP);
    let whole = knee * farthest;
    let beyond = (current - most).max(zero).part_of(whole) * farthest;
    let mut knees = sharp.max(beyond);
    for _ in 0..NEWTON_STEPS {
        let (part, slope) = brush.lost(knees);
        let missing = current - knee * knees - most * part;
        // A blend beyond the sharp knee falls a little, and must not turn the step round.
        let steep = (knee + most * slope).max(knee.times(S::coefficient(0.25)));
        let step = missing.abs().part_of(steep * farthest) * farthest;
        let (up, down) = (step.min(farthest - knees), step.min(knees));
        knees = S::select(missing.less(zero), knees - down, knees + up);
    }
    brush.lost(knees).0
}

/// Whether the current passes a bend of the brushes' law within the substep, with the drive at `volts`.
#[inline(always)]
pub fn bends<S: Scalar>(brush: &Brush<S>, volts: S, start: &Shaft<S>, mean: &Shaft<S>) -> S::Mask {
    let zero = S::zero();
    let end = start.current + mean.current_change;
    let moved = brush.side(volts, start.current) - brush.side(volts, end);
    let bent = zero.less(moved).or(moved.less(zero));
    bent.and(zero.less(brush.drop))
}

/// The product, kept within half the range of a format that has one.
#[inline(always)]
fn bounded<S: Scalar>(a: S, b: S) -> S {
    if S::LIMIT.is_infinite() {
        return a * b;
    }
    let sixteenth = S::from_f64(0.0625);
    let limit = S::from_f64(S::LIMIT / 32.0);
    let product = (a * sixteenth) * b;
    product.min(limit).max(-limit).times(S::coefficient(16.0))
}
