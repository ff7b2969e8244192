//! What a fitted motor is good for.

use super::Predicted;
use crate::scalar::Real;
use serde::{Deserialize, Serialize};

/// What a fitted motor is good for, best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Grade {
    /// For nothing that its numbers are needed for.
    No,
    /// For gains: its numbers are known well enough, though what it leaves is more than the encoder's.
    Control,
    /// For all: what it leaves is the encoder's.
    Floor,
}

/// Why a grade is no better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reason {
    /// There is no better.
    None,
    /// What is left is more than the encoder's.
    Left,
    /// The recording does not determine gain or time constant well enough.
    Undetermined,
    /// The verification has another gain or time constant.
    Disagrees,
    /// It predicts hardly better than one who takes it that the speed stays.
    Predicts,
}

/// A verdict with what it rests on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verdict {
    /// What the motor is good for.
    pub grade: Grade,
    /// Why it is for no more.
    pub reason: Reason,
    /// Part by which the gain may be off, with a probability of 95 %.
    pub gain: f32,
    /// The same of the time constant.
    pub time_constant: f32,
    /// The same of gain over time constant, the acceleration from standstill, from which gains are computed.
    pub acceleration: f32,
}

/// Parts by which gain, time constant and their ratio may be off at most, with a probability of 95 %, where gains are to be computed from them.
const MOST_OFF: [f32; 3] = [0.05, 0.1, 0.1];
/// Standard deviations that 95 % lie within: Student's, with as many degrees of freedom as blocks of a recording beyond six unknowns.
const WITHIN: f32 = 2.23;
/// What no fit tells: magnets and a winding that warm by 5 K are off by one percent and two, and a carrier takes a duty over within 50 µs.
const OTHERWISE: [f32; 3] = [0.01, 0.02, 0.02];
impl Verdict {
    /// Of the standard deviations of gain, time constant and their ratio, as parts of them; of the mean square that the fit left; and of how
    /// well it predicted, with the largest error that is an encoder's, counts RMS.
    pub(super) fn of(stds: [f32; 3], least: f32, predicted: &Predicted, within: f32) -> Self {
        let Predicted {
            gain,
            time_constant,
            ..
        } = *predicted;
        let moves = [gain, time_constant, gain - time_constant];
        let mut off = [f32::INFINITY; 3];
        for (k, off) in off.iter_mut().enumerate() {
            let (std, moved) = (WITHIN * stds[k], WITHIN * moves[k]);
            let all = Real::sqrt(std * std + moved * moved + OTHERWISE[k] * OTHERWISE[k]);
            if all.is_finite() {
                *off = all;
            }
        }
        let beyond = |values: [f32; 3], factor: f32| {
            let mut pairs = values.iter().zip(MOST_OFF);
            pairs.any(|(value, most)| value.is_nan() || factor * value > most)
        };
        let encoder = within * within;
        let reason = if beyond(off, 1.0) {
            match beyond(stds, WITHIN) {
                true => Reason::Undetermined,
                false => Reason::Disagrees,
            }
        } else if least <= encoder && predicted.mean_square <= encoder {
            Reason::None
        } else if predicted.beats_persistence() {
            Reason::Left
        } else {
            Reason::Predicts
        };
        Verdict {
            grade: match reason {
                Reason::None => Grade::Floor,
                Reason::Left => Grade::Control,
                _ => Grade::No,
            },
            reason,
            gain: off[0],
            time_constant: off[1],
            acceleration: off[2],
        }
    }
}
