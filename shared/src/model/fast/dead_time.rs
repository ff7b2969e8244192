//! What the dead time of a bridge of two legs takes, as the mean of a carrier wave.
//!
//! While both transistors of a leg are off, the current chooses the side, always the one that opposes it: over a carrier wave `T` with the
//! dead time `t_d` the two legs lose `D = 2·t_d/T` of the supply against the current's sign (Holmes and Lipo, *Pulse Width Modulation for
//! Power Converters*, 2003, section 12.2). With both legs on one carrier, the ripple of a winding `L/R = τ` at the duty `d` reaches to
//! `r = |d|·(1 − |d|)·T/(4·τ)` of the current at rest on either side of the mean, and every edge lies at an end of it: as long as the
//! current changes its sign within a wave, no edge loses anything. Beyond, all of `D` is lost, as soon as the current no longer dies within
//! the dead time, over `w = D·T/(4·τ)`.
//!
//! Over an interval in which the current's mean would be `q` without the loss and falls by `c/2` with each volt lost, what is lost is
//! `D·min(1, (|q| − r)/(w + D·c/2))`: the implicit equation, solved.

use crate::scalar::{Real, Scalar};

/// What a bridge loses, in the number format `S`.
#[derive(Clone, Copy, Debug)]
pub struct DeadTime<S: Scalar> {
    /// Volts.
    pub lost: S,
    /// Reach of the ripple by `|d|·(1 − |d|)`.
    ripple: S::Coefficient,
    /// Its largest reach, with what the loss rises over.
    pub sure: S,
    /// What the loss rises over, with the shaft turning and held.
    rise: [S; 2],
}

impl<S: Scalar> DeadTime<S> {
    /// A bridge that loses nothing.
    pub const fn none(zero: S, none: S::Coefficient) -> Self {
        DeadTime {
            lost: zero,
            ripple: none,
            sure: zero,
            rise: [zero; 2],
        }
    }
}

impl<S: Scalar<Mask = bool>> DeadTime<S> {
    /// Of `lost` volts per unit, at so many carrier waves in an `electrical` time constant, in an interval that turns a volt into so much
    /// current while the shaft turns, and while it is held.
    pub fn set<R: Real>(&mut self, lost: R, waves: R, by_volts: [S::Coefficient; 2]) {
        let quarter = R::from_f64(0.25) / waves;
        let number = |x: R| S::from_f64(x.to_f64());
        self.lost = number(lost);
        self.ripple = S::coefficient_of(quarter);
        let width = number(quarter * lost);
        self.sure = number(quarter * R::from_f64(0.25)) + width;
        let half = self.lost * S::from_f64(0.5);
        self.rise = by_volts.map(|by| width + half.times(by));
    }

    /// Whether anything is lost.
    #[inline(always)]
    pub fn is_any(&self) -> bool {
        S::zero().less(self.lost)
    }

    /// What is lost of a duty, where the mean of the current would be `mean`.
    #[inline(always)]
    pub fn of(&self, duty: S, mean: S, held: bool) -> S {
        let size = duty.abs();
        let beyond = mean.abs() - (size - size * size).times(self.ripple);
        if !S::zero().less(beyond) {
            return S::zero();
        }
        let rise = self.rise[usize::from(held)];
        let part = if beyond.less(rise) {
            beyond.part_of(rise)
        } else {
            S::from_f64(1.0)
        };
        part * self.lost * mean.signum()
    }
}
