//! An unknown gain, where the loop's output reaches its limit.
//!
//! As long as the output stays within its limit, volts are the gain times the error, and twice the gain in a motor of twice
//! the inertia and friction moves alike. The limit is a voltage that is known: where the output stands at it, the motion tells
//! how many volts that is of the rest.

use super::motion::Motion;
use super::output::Follower;
use super::settings::{GainOrigin, LoopSettings};
use std::fmt;

/// Lengths of the blocks, in samples; the clearest answer counts.
const BLOCKS: [usize; 4] = [8, 16, 32, 64];
/// Part of the square error that may remain where the output is limited. On recordings of a servo whose output never reached
/// its limit, wrong gains took away at most 5 %; on two in which it did, 18 and 42 %.
const CLEAR: f64 = 0.85;
/// Least step in the likelihood's logarithm: chance reaches it once in ten thousand recordings. On the two it was 13 and 35, on
/// the others at most 3.
const SURE: f64 = 8.0;
/// Least error stated, relative: what the equation leaves out, above all the winding's lag, moves the gain by 1.3 to 3.9 % in the
/// motors of the virtual bench, most in the one whose winding is slowest.
const LEFT_OUT: f64 = 0.04;
/// Largest gain tried, in those at which the output just reaches its limit.
const MOST: f64 = 30.0;
/// Step of the gain's logarithm.
const STEP: f64 = 0.05;
/// A gain is located so well, relative.
const LOCATED: f64 = 1e-3;
/// Samples that a gain is estimated from, 100 s at 1 kHz: more would take longer than the fit.
const MOST_SAMPLES: usize = 100_000;

/// How an estimated gain was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainEstimate {
    /// Standard error, relative: of one length of the blocks, or between several.
    pub relative_std: f64,
    /// Time for which the output stands at its limit, s.
    pub limited_s: f64,
}

/// Why a gain cannot be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GainUnknown {
    /// Too little motion, or the target never leaves the reading.
    NoMotion,
    /// A loop that never reaches its limit explains the motion as well.
    NeverLimited,
    /// The motion is explained best by a relay: a larger gain changes nothing.
    AlwaysLimited,
}

impl fmt::Display for GainUnknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            GainUnknown::NoMotion => "there is too little motion towards a target",
            GainUnknown::NeverLimited => {
                "a loop that never reaches its limit explains the motion as well as any other"
            }
            GainUnknown::AlwaysLimited => {
                "the loop stands at its limit nearly all the time, whatever its gain"
            }
        })
    }
}

/// The gain that explains the motion best, V/rad, with its error.
///
/// # Errors
/// Why the recording does not tell it.
pub(super) fn estimate(
    follower: &Follower<'_>,
    settings: &LoopSettings,
    limit_v: f64,
) -> Result<(f64, GainEstimate), GainUnknown> {
    let follower = &follower.first(MOST_SAMPLES);
    let largest = follower.largest_error();
    if largest <= 0.0 {
        return Err(GainUnknown::NoMotion);
    }
    let search = Search {
        follower,
        settings,
        limit_v,
        free: limit_v / largest,
    };
    let motions = BLOCKS
        .iter()
        .filter_map(|&block| Motion::new(follower, block));
    let minima: Vec<Minimum> = motions
        .map(|mut motion| search.minimum(&mut motion))
        .collect();
    let clearest = minima
        .iter()
        .max_by(|a, b| a.step().total_cmp(&b.step()))
        .ok_or(GainUnknown::NoMotion)?;
    if !clearest.is_sure() {
        return Err(GainUnknown::NeverLimited);
    }
    if clearest.at_end {
        return Err(GainUnknown::AlwaysLimited);
    }
    let sure = minima.iter().filter(|m| m.is_sure() && !m.at_end);
    let spread = sure.map(|other| (other.log_gain - clearest.log_gain).abs());
    let gain = search.gain(clearest.log_gain);
    let estimate = GainEstimate {
        relative_std: spread.fold(clearest.std.max(LEFT_OUT), f64::max),
        limited_s: follower.limited_s(gain, limit_v),
    };
    Ok((gain, estimate))
}

/// The least error over the gain, of one length of blocks.
struct Minimum {
    /// Logarithm of the gain over that at which the output just reaches its limit.
    log_gain: f64,
    /// Square error there, as a part of that without a limit.
    left: f64,
    /// Standard error of the logarithm.
    std: f64,
    independent: f64,
    at_end: bool,
}

impl Minimum {
    fn is_sure(&self) -> bool {
        self.left < CLEAR && self.step() > SURE
    }

    /// Step of the likelihood's logarithm from a loop without a limit.
    fn step(&self) -> f64 {
        -0.5 * self.independent * libm::log(self.left)
    }
}

struct Search<'a> {
    follower: &'a Follower<'a>,
    settings: &'a LoopSettings,
    limit_v: f64,
    /// The gain at which the output just reaches its limit.
    free: f64,
}

impl Search<'_> {
    fn gain(&self, log_gain: f64) -> f64 {
        self.free * libm::exp(log_gain)
    }

    fn unexplained(&self, motion: &mut Motion, log_gain: f64) -> f64 {
        let gain = self.gain(log_gain);
        let control = (self.settings).with(gain, self.limit_v, GainOrigin::Given);
        motion.unexplained(self.follower.time_s, &self.follower.volts(&control))
    }

    fn minimum(&self, motion: &mut Motion) -> Minimum {
        let steps = (libm::log(MOST) / STEP) as usize;
        let unlimited = self.unexplained(motion, -STEP);
        let (mut best, mut least) = (0, f64::INFINITY);
        for step in 0..=steps {
            let error = self.unexplained(motion, step as f64 * STEP);
            if error < least {
                (best, least) = (step, error);
            }
        }
        let middle = best as f64 * STEP;
        let (log_gain, least) = self.narrowed(motion, middle - STEP, middle + STEP);
        // A parabola through the logarithm of the likelihood.
        let around = [-STEP, STEP].map(|d| libm::log(self.unexplained(motion, log_gain + d)));
        let bend = (around[0] + around[1] - 2.0 * libm::log(least)) / (STEP * STEP);
        let information = 0.5 * motion.independent() * bend;
        Minimum {
            log_gain,
            left: least / unlimited,
            std: information.max(f64::MIN_POSITIVE).sqrt().recip(),
            independent: motion.independent(),
            at_end: best == steps,
        }
    }

    /// Golden section.
    fn narrowed(&self, motion: &mut Motion, mut low: f64, mut high: f64) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut inner = high - GOLDEN * (high - low);
        let mut outer = low + GOLDEN * (high - low);
        let mut at_inner = self.unexplained(motion, inner);
        let mut at_outer = self.unexplained(motion, outer);
        while high - low > LOCATED {
            if at_inner < at_outer {
                (high, outer, at_outer) = (outer, inner, at_inner);
                inner = high - GOLDEN * (high - low);
                at_inner = self.unexplained(motion, inner);
            } else {
                (low, inner, at_inner) = (inner, outer, at_outer);
                outer = low + GOLDEN * (high - low);
                at_outer = self.unexplained(motion, outer);
            }
        }
        if at_inner < at_outer {
            (inner, at_inner)
        } else {
            (outer, at_outer)
        }
    }
}

impl<'a> Follower<'a> {
    /// The first `samples` samples.
    fn first(&self, samples: usize) -> Follower<'a> {
        let end = samples.min(self.time_s.len());
        Follower {
            time_s: &self.time_s[..end],
            target_counts: &self.target_counts[..end],
            counts: &self.counts[..end],
            enabled: self.enabled.map(|enabled| &enabled[..end]),
            ..*self
        }
    }

    /// Error at sample `k`, rad.
    fn error(&self, k: usize) -> f64 {
        (self.target_counts[k] - self.counts[k]) * self.rad_per_count()
    }

    /// Largest error while the bridge is closed, rad.
    fn largest_error(&self) -> f64 {
        let closed = (0..self.time_s.len()).filter(|&k| self.is_closed(k));
        closed.map(|k| self.error(k).abs()).fold(0.0, f64::max)
    }

    /// Time for which a proportional loop stands at its limit, s.
    fn limited_s(&self, gain_v_per_rad: f64, limit_v: f64) -> f64 {
        (1..self.time_s.len())
            .filter(|&k| {
                self.is_closed(k - 1) && gain_v_per_rad * self.error(k - 1).abs() > limit_v
            })
            .map(|k| self.time_s[k] - self.time_s[k - 1])
            .sum()
    }
}
