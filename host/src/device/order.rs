//! A user's order in SI and in the device's units.

use super::{Course, DeviceError};
use servoid_io::output::CommandSequence;
use servoid_results::device_run::DutyScale;
use shared::fit::{Grade, Settings};
use shared::trace::OPEN;
use shared::wire::{About, Job, Kind, Limits, Segment};

/// A run in SI. Limits that are `None` are not watched.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// Kind of run.
    pub kind: Kind,
    /// Largest drive of the excitation, as a part of the supply.
    pub amplitude: f64,
    /// Length of the long excitation, s.
    pub excite_s: f64,
    /// True if the bridge opens in its pauses.
    pub coast: bool,
    /// Length of the recording that the device fits, s; what the device can hold if `None`.
    pub record_s: Option<f64>,
    /// Length of the verification, s.
    pub verify_s: f64,
    /// Error that is the encoder's, counts RMS; the usual one if none.
    pub verify_within: Option<f64>,
    /// The least that what the device finds must be good for, or the run fails.
    pub accept: Grade,
    /// Seed of the excitations.
    pub seed: u64,
    /// Settings of the device's fit.
    pub fit: Settings,
    /// V.
    pub supply_v: f64,
    /// Counts a revolution.
    pub counts_per_rev: f64,
    /// Largest voltage of any drive, V.
    pub max_voltage: Option<f64>,
    /// Largest current, A.
    pub max_current: Option<f64>,
    /// Either way from the start, revolutions.
    pub max_travel: Option<f64>,
    /// rad/s.
    pub max_speed: Option<f64>,
    /// Current that the winding bears forever, A, and its thermal time constant, s.
    pub continuous: Option<(f64, f64)>,
    /// Armature resistance, Ω: lets a board without a current sensor guess the current.
    pub resistance_ohm: Option<f64>,
    /// Where a servo is to go.
    pub course: Option<Course>,
}

/// Allowance for probing, braking and waiting, s.
const ASIDE_S: f64 = 30.0;

impl Order {
    /// Error that is the encoder's unless the user says otherwise, counts RMS.
    fn usual_limit(&self) -> f64 {
        (self.counts_per_rev / 4096.0).max(1.0)
    }

    /// Largest voltage of an excitation, V.
    pub fn largest_voltage(&self) -> f64 {
        let asked = self.amplitude * self.supply_v;
        self.max_voltage.map_or(asked, |most| most.min(asked))
    }

    /// Volts per duty of the device.
    pub fn scale(&self, about: &About) -> DutyScale {
        DutyScale {
            supply_v: self.supply_v,
            full: about.full,
        }
    }

    /// The order in the device's units.
    ///
    /// # Errors
    /// A number that makes no sense, or is beyond the device; it names the flag.
    pub fn job(&self, about: &About, plan: &[Segment]) -> Result<Job, DeviceError> {
        let wrong = |text: String| DeviceError::Order(text);
        let period_s = f64::from(about.period_us) * 1e-6;
        let periods = |flag: &str, seconds: f64, most: f64| {
            let periods = (seconds / period_s).round();
            if (0.0..=most).contains(&periods) {
                Ok(periods as u32)
            } else {
                Err(wrong(format!(
                    "{flag} {seconds}: must be 0 to {} s",
                    most * period_s
                )))
            }
        };
        let positive = |flag: &str, value: Option<f64>, scale: f64, most: f64| match value {
            None => Ok(0),
            Some(value) => {
                let scaled = (value * scale).round();
                if scaled >= 1.0 && scaled <= most {
                    Ok(scaled as u32)
                } else {
                    Err(wrong(format!(
                        "{flag} {value}: must be {} to {}",
                        1.0 / scale,
                        most / scale
                    )))
                }
            }
        };
        const HOUR: f64 = 3.6e6;
        let scale = self.scale(about);
        let largest = f64::from(scale.largest());
        let duty = match self.max_voltage {
            None => largest,
            Some(volts) => {
                let duty = scale.duty(volts);
                if duty.is_nan() || duty < 1.0 {
                    return Err(wrong(format!(
                        "--max-voltage {volts}: must be at least {} V, one step of the device",
                        scale.volts(1)
                    )));
                }
                duty
            }
        };
        if !(self.amplitude > 0.0 && self.amplitude <= 1.0) {
            return Err(wrong(format!(
                "--amplitude {}: must be above 0 and at most 1",
                self.amplitude
            )));
        }
        let capacity = f64::from(about.capacity);
        let record = periods(
            "--record",
            self.record_s.unwrap_or(capacity * period_s),
            capacity,
        )?;
        let excite = periods("--excite", self.excite_s, HOUR)?;
        let verify = periods("--verify", self.verify_s, HOUR)?;
        let played: u32 = plan.iter().map(|segment| u32::from(segment.periods)).sum();
        let followed = periods(
            "the course of",
            self.course.as_ref().map_or(0.0, Course::seconds),
            HOUR,
        )?;
        let aside = (ASIDE_S / period_s) as u32;
        let per_count = self.counts_per_rev / std::f64::consts::TAU * period_s;
        let (continuous_a, thermal_s) = self.continuous.unzip();
        Ok(Job {
            kind: self.kind,
            amplitude: (self.amplitude * largest) as i16,
            excite,
            coast: self.coast,
            record: record as u16,
            verify,
            verify_within: positive(
                "--verify-within",
                Some(self.verify_within.unwrap_or(self.usual_limit())),
                100.0,
                1e9,
            )?,
            accept: self.accept,
            seed: self.seed,
            fit: self.fit,
            limits: Limits {
                duty: duty.min(largest) as i16,
                travel: positive("--max-travel", self.max_travel, self.counts_per_rev, 2e9)?,
                speed: positive("--max-speed", self.max_speed, per_count, 32_000.0)? as u16,
                current_ma: positive("--max-current", self.max_current, 1e3, 1e9)?,
                continuous_ma: positive("--continuous-current", continuous_a, 1e3, 1e6)?,
                thermal: positive("--thermal-time", thermal_s, 1.0 / period_s, 1e9)?,
                stall_ma: positive(
                    "the stall current",
                    self.resistance_ohm.map(|r| self.supply_v / r),
                    1e3,
                    1e9,
                )?,
                time: excite + record + verify + played + followed + aside,
            },
            supply_mv: (self.supply_v * 1e3).round().clamp(1.0, 4e9) as u32,
            counts_per_rev: self.counts_per_rev.round().clamp(0.0, 4e9) as u32,
        })
    }
}

/// A command sequence as segments of a plan.
///
/// # Errors
/// Commands beyond the supply, or steps of time that are no whole number of periods.
pub fn segments(
    commands: &CommandSequence,
    scale: DutyScale,
    period_us: u32,
) -> Result<Vec<Segment>, DeviceError> {
    let period_s = f64::from(period_us) * 1e-6;
    let mut segments: Vec<Segment> = Vec::new();
    let rows = commands.time_s.len();
    let interval = |k: usize| {
        let k = k.min(rows.saturating_sub(2));
        commands.time_s[k + 1] - commands.time_s[k]
    };
    if rows < 2 {
        return Err(DeviceError::Order(
            "the plan has fewer than two rows".to_owned(),
        ));
    }
    let mut owed = 0.0;
    for (k, volts) in commands.voltage_v.iter().enumerate() {
        let duty = scale.duty(*volts);
        if duty.is_nan() || duty.abs() > f64::from(scale.full) {
            return Err(DeviceError::Order(format!(
                "row {}: {volts} V is more than the supply's {} V; make the plan with --max-voltage",
                k + 1,
                scale.supply_v
            )));
        }
        let closed = commands.enabled.as_ref().is_none_or(|enabled| enabled[k]);
        let duty = if closed {
            let largest = f64::from(scale.largest());
            duty.clamp(-largest, largest) as i16
        } else {
            OPEN
        };
        // Rounding is carried over, so that a long plan keeps its length.
        owed += interval(k) / period_s;
        let periods = owed.round().clamp(0.0, 65_535.0);
        owed -= periods;
        let periods = periods as u16;
        match segments.last_mut() {
            Some(last) if last.duty == duty && last.periods.checked_add(periods).is_some() => {
                last.periods += periods;
            }
            _ if periods > 0 => segments.push(Segment { duty, periods }),
            _ => {}
        }
    }
    Ok(segments)
}
