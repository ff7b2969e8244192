//! Limits of an excitation. A candidate that exceeds them under any hypothesis is
//! scaled down, or dropped where that does not help.

use super::excitation::Excitation;
use super::hypothesis::{Hypothesis, Setup};
use super::playback::play;
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::error::ModelError;
use shared::excite::Command;
use std::ops::ControlFlow;

/// Largest values allowed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Voltage, V; beyond the supply it limits nothing.
    pub voltage_v: Option<f64>,
    /// Current, as the voltage across the resistance `R·i`, V.
    pub current_v: Option<f64>,
    /// Travel of the shaft from end to end, revolutions.
    pub travel_rev: Option<f64>,
    /// Most commands in a row, each held until the next: what a device that plays them can hold.
    pub commands: Option<usize>,
}

/// Peak values of an excitation, the largest over all hypotheses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Usage {
    /// Largest voltage, V.
    pub voltage_v: f64,
    /// Largest current, as the voltage across the resistance `R·i`, V.
    pub current_v: f64,
    /// Travel from end to end, revolutions.
    pub travel_rev: f64,
    /// Largest speed, rad/s.
    pub speed_rad_s: f64,
}

/// Part of a limit that a plan may use by the model. The model's step and the plant agree to a
/// fraction of a percent; the rest is for a current that peaks between samples where an effect adds to
/// the command, and for start angles that were not tried.
const USABLE: f64 = 0.9;
/// Ratio of successive amplitudes that are tried; those that exceed a limit end early.
const STEP_DOWN: f64 = 0.85;
/// Smallest part of a candidate's amplitude that is tried.
const SMALLEST: f64 = 0.01;
/// Start angles tried, parts of a revolution, where an effect depends on the angle.
const QUARTERS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

impl Limits {
    /// The largest command, as a part of the supply.
    pub fn largest_command(&self, supply_v: f64) -> f64 {
        self.voltage_v
            .map_or(1.0, |volts| (volts / supply_v).min(1.0))
    }

    fn allow(&self, usage: &Usage) -> bool {
        let within = |used: f64, limit: Option<f64>| limit.is_none_or(|l| used <= USABLE * l);
        within(usage.current_v, self.current_v) && within(usage.travel_rev, self.travel_rev)
    }

    /// `candidate` scaled down until it stays within the limits under every hypothesis, with its
    /// peak values; `None` where no amplitude does.
    ///
    /// # Errors
    /// A hypothesis that is no possible model.
    pub fn admit(
        &self,
        candidate: &Excitation,
        hypotheses: &[Hypothesis],
        setup: &Setup,
        seed: u64,
    ) -> Result<Option<(Excitation, Usage)>, ModelError> {
        let commands = || {
            let drive = candidate.drive(setup.sample_s, seed);
            1 + drive.windows(2).filter(|pair| pair[0] != pair[1]).count()
        };
        if self.commands.is_some_and(|most| commands() > most) {
            return Ok(None);
        }
        let mut factor = 1.0;
        while factor >= SMALLEST {
            let excitation = candidate.scaled(factor);
            let drive = excitation.drive(setup.sample_s, seed);
            if let Some(usage) = self.usage(&drive, hypotheses, setup)? {
                return Ok(Some((excitation, usage)));
            }
            factor *= STEP_DOWN;
        }
        Ok(None)
    }

    /// Peak values of a drive over all hypotheses; `None` beyond a limit.
    fn usage(
        &self,
        drive: &[Command<f64>],
        hypotheses: &[Hypothesis],
        setup: &Setup,
    ) -> Result<Option<Usage>, ModelError> {
        let voltage = |command: &Command<f64>| (command.drive * setup.supply_v).abs();
        let mut all = Usage {
            voltage_v: drive.iter().map(voltage).fold(0.0, f64::max),
            ..Usage::default()
        };
        for hypothesis in hypotheses {
            let turns = |kind: &shared::effects::Kind| kind.needs().angle || kind.needs().sensed;
            let starts = if hypothesis.effects.iter().any(turns) {
                &QUARTERS[..]
            } else {
                &QUARTERS[..1]
            };
            for quarter in starts {
                let start = (quarter * setup.counts_per_rev).floor() + FLOOR_OFFSET_COUNTS;
                let Some(usage) = self.usage_of(hypothesis, drive, setup, start)? else {
                    return Ok(None);
                };
                all.current_v = all.current_v.max(usage.current_v);
                all.travel_rev = all.travel_rev.max(usage.travel_rev);
                all.speed_rad_s = all.speed_rad_s.max(usage.speed_rad_s);
            }
        }
        Ok(Some(all))
    }

    /// Of one hypothesis from one angle; ends at the first sample beyond a limit.
    fn usage_of(
        &self,
        hypothesis: &Hypothesis,
        drive: &[Command<f64>],
        setup: &Setup,
        start: f64,
    ) -> Result<Option<Usage>, ModelError> {
        let mut usage = Usage::default();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut allowed = true;
        play(hypothesis, setup, drive, start, |moment| {
            low = low.min(moment.angle_counts);
            high = high.max(moment.angle_counts);
            usage.travel_rev = (high - low) / setup.counts_per_rev;
            usage.current_v = usage.current_v.max(moment.current_v);
            usage.speed_rad_s = usage.speed_rad_s.max(moment.speed_rad_s.abs());
            allowed = self.allow(&usage) && usage.travel_rev.is_finite();
            if allowed {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })?;
        Ok(allowed.then_some(usage))
    }
}
