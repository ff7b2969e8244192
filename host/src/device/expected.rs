//! What a run can bring, by its job: how long it takes, how many rows, which numbers. A device that says otherwise is broken or is none of
//! ours; it gets neither all memory nor all time, and no result comes of it.

use super::DeviceError;
use servoid_results::device_run::Recorded;
use shared::fit::SEARCHES;
use shared::wire::{About, Job, Kind, Report, Rows, Segment, Stage, Tuned};
use std::time::Duration;

/// Longest probe, s: each of its steps, its brake, its last step, and braking before all of them.
const PROBE_S: f64 = 10.0;
/// An emulated device may be so many times slower than its own clock.
const SLOWER: f64 = 20.0;
/// Longest time that a model may take, s: a thousand samples on an emulated core without a floating-point unit.
const MODEL_S: f64 = 10.0;
/// Longest time without anything new, s.
const STILL: Duration = Duration::from_secs(60);
/// Shortest and longest control periods that make sense, µs.
const PERIODS_US: std::ops::RangeInclusive<u32> = 10..=1_000_000;

/// Most models of the polish after each search.
const MOST_OF_POLISH: u32 = 10_000;
/// Longest step that tries a servo, periods.
const LONGEST_STEP: u32 = 11_000;

/// The bounds of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    job: Job,
    played: u32,
    probed: u32,
    longest: Duration,
}

impl Expected {
    /// Of a job, with the plan that it plays, on a device.
    pub fn of(job: &Job, plan: &[Segment], about: &About) -> Self {
        let period_s = f64::from(about.period_us) * 1e-6;
        let played = plan.iter().map(|segment| u32::from(segment.periods)).sum();
        let driven_s = f64::from(job.limits.time) * period_s + PROBE_S;
        let models = match job.kind {
            Kind::Commission | Kind::Tune => {
                f64::from(SEARCHES) * (f64::from(job.fit.evaluations) + 300.0)
            }
            Kind::Record | Kind::Play | Kind::Follow => 0.0,
        };
        let longest_s = driven_s * SLOWER + models * MODEL_S;
        Expected {
            job: *job,
            played,
            probed: (PROBE_S / period_s) as u32,
            longest: Duration::try_from_secs_f64(longest_s).unwrap_or(Duration::MAX),
        }
    }

    /// Most rows of a stage.
    fn rows(&self, stage: Stage) -> u32 {
        match stage {
            Stage::Probe => self.probed,
            Stage::Excite if self.job.kind == Kind::Play => self.played,
            Stage::Excite => self.job.excite,
            Stage::Record => self.job.record.into(),
            Stage::Verify => self.job.verify,
            Stage::Tune if self.job.kind == Kind::Tune => LONGEST_STEP,
            Stage::Follow if self.job.kind == Kind::Follow => self.job.limits.time,
            Stage::Follow => 0,
            Stage::Idle
            | Stage::Fit
            | Stage::Simulate
            | Stage::Tune
            | Stage::Keep
            | Stage::Report => 0,
        }
    }

    /// Checks the time that has passed, in all and since something new came.
    ///
    /// # Errors
    /// Too long.
    pub fn check_time(&self, all: Duration, still: Duration) -> Result<(), DeviceError> {
        let limit = match (all > self.longest, still > STILL) {
            (true, _) => self.longest,
            (false, true) => STILL,
            (false, false) => return Ok(()),
        };
        Err(DeviceError::Endless {
            seconds: limit.as_secs_f64(),
            still: still > STILL,
        })
    }

    /// Checks that no more models were run than a fit can take.
    ///
    /// # Errors
    /// More.
    pub fn check_models(&self, done: u32) -> Result<(), DeviceError> {
        let most = SEARCHES * (u32::from(self.job.fit.evaluations) + MOST_OF_POLISH);
        if done > most {
            return Err(nonsense(format!(
                "{done} models of a fit of at most {most}"
            )));
        }
        Ok(())
    }

    /// Checks that rows are some that were ordered.
    ///
    /// # Errors
    /// Rows beyond their stage.
    pub fn check_rows(&self, rows: &Rows) -> Result<(), DeviceError> {
        let most = self.rows(rows.stage);
        let end = u64::from(rows.first) + rows.rows.len() as u64;
        if end > u64::from(most) {
            return Err(nonsense(format!(
                "period {end} of the stage {:?}, which has {most}",
                rows.stage
            )));
        }
        Ok(())
    }

    /// Checks the numbers of a report.
    ///
    /// # Errors
    /// A number that no fit has.
    pub fn check_report(&self, report: &Report) -> Result<(), DeviceError> {
        let mut numbers = Vec::new();
        if let Some(outcome) = &report.outcome {
            let values = outcome.estimates.iter().map(|estimate| estimate.value);
            numbers.extend(values.map(|value| ("a parameter", value, f32::MIN)));
            // A parameter that the recording does not determine has an infinite one.
            let errors = outcome.estimates.iter().map(|estimate| estimate.std);
            numbers.extend(
                errors
                    .filter(|std| *std != f32::INFINITY)
                    .map(|std| ("a standard deviation", std, 0.0)),
            );
            numbers.push(("the error of the fit", outcome.mean_square, 0.0));
        }
        if let Some(verified) = &report.verified {
            numbers.push(("the error of the verification", verified.mean_square, 0.0));
        }
        if let Some(Tuned {
            gains,
            predicted,
            measured,
            ..
        }) = &report.tuned
        {
            let of_gains = [gains.position, gains.speed, gains.back_emf, gains.friction];
            numbers.extend(of_gains.map(|gain| ("a gain", gain, 0.0)));
            for answer in [Some(*predicted), *measured].into_iter().flatten() {
                let of_step = [answer.overshoot, answer.left];
                numbers.extend(of_step.map(|number| ("a step's answer", number, f32::MIN)));
            }
        }
        match numbers
            .iter()
            .find(|(_, value, least)| !(value.is_finite() && value >= least))
        {
            Some((what, value, _)) => Err(nonsense(format!("{value} for {what}"))),
            None => Ok(()),
        }
    }

    /// Marks the periods that a report counts and that never came, at the ends of their stages. In a run that came to its end each stage
    /// has the length that was ordered; of another's, the last stage is the one that broke off.
    pub fn complete(&self, recorded: &mut [Recorded], report: &Report, whole: bool) {
        if whole {
            for part in recorded
                .iter_mut()
                .filter(|part| !matches!(part.stage, Stage::Probe | Stage::Tune | Stage::Follow))
            {
                part.rows.resize(self.rows(part.stage) as usize, None);
            }
        }
        let have: usize = recorded.iter().map(|part| part.rows.len()).sum();
        let lost = (report.periods as usize).saturating_sub(have);
        if let Some(last) = recorded.last_mut() {
            let most = self.rows(last.stage) as usize;
            let length = (last.rows.len() + lost).min(most.max(last.rows.len()));
            last.rows.resize(length, None);
        }
    }
}

/// Checks what a device says of itself.
///
/// # Errors
/// A number that no device has.
pub fn check_about(about: &About) -> Result<(), DeviceError> {
    let wrong = if !(1..=32_768).contains(&about.full) {
        format!("{} for the duty of the whole supply", about.full)
    } else if !PERIODS_US.contains(&about.period_us) {
        format!("a control period of {} us", about.period_us)
    } else if about.capacity == 0 {
        "a capacity of 0 periods".to_owned()
    } else {
        return Ok(());
    };
    Err(nonsense(wrong))
}

fn nonsense(what: String) -> DeviceError {
    DeviceError::Nonsense { what }
}
