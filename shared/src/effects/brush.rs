//! A voltage that is lost against the current: by brushes, or by the dead time of a bridge.

use super::tangent::tanh;
use crate::scalar::{Mask, Scalar, lanes};

/// A voltage lost against the current: none within the current's ripple, proportional from there over a knee, constant beyond; or rounded.
#[derive(Clone, Copy, Debug, Default)]
pub struct Brush<S> {
    /// Voltage beyond the knee.
    pub drop: S,
    /// Current of the knee, as the voltage across the resistance.
    pub knee: S,
    /// 0 for the sharp knee, 1 for a hyperbolic tangent; between and beyond, a blend of the two.
    pub form: S,
    /// Reach `q` of the ripple, as the voltage across the resistance, by `|d|·(1 − |d|)` of the duty `d`; 0 where nothing switches.
    pub ripple: S,
}

lanes!(Brush {
    drop,
    knee,
    form,
    ripple
});

/// The currents that the ripple turns within each carrier wave, which lose nothing, as voltages across the resistance.
///
/// With `q = T/(4τ)` the ripple at the duty `d` reaches, in parts of the supply, to `r = q·d·(1 − d)` on either side of the mean; to the
/// second order of `T/τ` to `r·(1 − q·(1 − 2d)/3)` below it for `d > 0`, where the current of the sign of `d` is lost, and to
/// `r·(1 + q·(1 − 2d)/3)` above it, where that of the other sign is. A current that would change its sign within the dead time
/// `t_d = D·T/2` dies, and what is lost rises from none to all of `D` over `w = q·D`: for a current of the sign of `d` from a mean on that is
/// `2q·D·(1 − d + r)` smaller than the ripple's reach, for the other of `2q·D·(d + r)`, by how fast the current rises and falls. Where the
/// pulse `d` or the pause `1 − d` is shorter than `D`, it takes its place. `d` stands for its size.
#[derive(Clone, Copy, Debug)]
pub struct Spared<S> {
    /// In the middle of them.
    pub centre: S,
    /// From there to either end.
    pub half: S,
}

/// Currents from here on, in knees, lose the whole drop: the tangent lacks 2e-6 of it.
pub const WHOLE_DROP: f64 = 7.0;

/// A duty that is nearer to 1 than this has no edges: its pause is shorter than a step of any timer.
const NO_EDGES: f64 = 1.0 / 24_000.0;

impl<S: Scalar> Brush<S> {
    /// Both, which bend at the later of their knees.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Brush {
            drop: self.drop + other.drop,
            knee: self.knee.max(other.knee),
            form: self.form + other.form,
            ripple: self.ripple.max(other.ripple),
        }
    }

    /// Whether the knee is not sharp.
    #[inline(always)]
    pub fn is_rounded(&self) -> S::Mask {
        self.form.less(S::zero()).or(S::zero().less(self.form))
    }

    /// The part of the drop that is lost at a current of so many knees, from 0 to [`WHOLE_DROP`], and its slope there.
    #[inline(always)]
    pub fn lost(&self, knees: S) -> (S, S) {
        let one = S::from_f64(1.0);
        let sharp = one - self.form;
        let tanh = tanh(knees);
        let slope = S::select(knees.less(one), sharp, S::zero());
        (
            sharp * knees.min(one) + self.form * tanh,
            slope + self.form * (one - tanh * tanh),
        )
    }

    /// Where the ripple spares the current at `volts` of the drive.
    #[inline(always)]
    pub fn spared(&self, volts: S) -> Spared<S> {
        let (zero, one, half) = (S::zero(), S::from_f64(1.0), S::from_f64(0.5));
        let size = volts.abs().min(one);
        let rest = one - size;
        let reach = size * rest * self.ripple;
        // The mean lies a little off the middle of the ripple.
        let skew = reach * (rest - size) * self.ripple.times(S::coefficient(1.0 / 3.0));
        let dies = |pulse: S, pause: S| {
            let part = self.drop.min(pulse) * (pause + reach) * self.ripple;
            part + part
        };
        let with = reach - skew - dies(size, rest);
        let against = (reach + skew - dies(rest, size)).max(-with);
        Spared {
            centre: (with - against) * half * volts.signum(),
            half: ((with + against) * half).max(zero),
        }
    }

    /// What is lost beyond the knee at `volts` of the drive by a current of the sign of `current`: against the voltage a bridge cannot
    /// give more than its supply, and a leg that is always high has no edge.
    #[inline(always)]
    pub fn most(&self, volts: S, current: S) -> S {
        let zero = S::zero();
        let rest = (S::from_f64(1.0) - volts.abs()).max(zero);
        let against = (volts.signum() * current.signum()).less(zero);
        let limited = S::select(against, self.drop.min(rest), self.drop);
        let switched = S::select(rest.less(S::from_f64(NO_EDGES)), zero, limited);
        S::select(zero.less(self.ripple), switched, self.drop)
    }

    /// Where on the law a current is at `volts` of the drive: −1 or 1 beyond the knee, 0 within.
    #[inline(always)]
    pub fn side(&self, volts: S, current: S) -> S {
        let spared = self.spared(volts);
        let off = current - spared.centre;
        let within = off.abs().less(spared.half + self.knee);
        S::select(within, S::zero(), off.signum())
    }
}
