//! Targets of a drive that closes a position loop, against the readings and the supply.

use super::{Finding, Severity};
use servoid_io::position_loop::GainOrigin;
use servoid_io::recording::{PositionDrive, Recording};
use std::f64::consts::TAU;

/// A loop's limit may exceed the stated supply by this part.
const ABOVE_SUPPLY: f64 = 0.02;
/// Targets that span so many times what the readings do, or the reverse, are in another unit.
const OTHER_UNIT: f64 = 20.0;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let Some(drive) = &recording.position else {
        return Vec::new();
    };
    [
        elsewhere(recording, drive),
        above_supply(recording, drive),
        estimated(drive),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Targets and readings that do not belong together.
fn elsewhere(recording: &Recording, drive: &PositionDrive) -> Option<Finding> {
    let rad = TAU / recording.counts_per_rev;
    let targets = Span::of(&drive.target_counts)?;
    let readings = Span::of(&recording.counts)?;
    let ratio = targets.width() / readings.width().max(1.0);
    if ratio > OTHER_UNIT || (ratio < 1.0 / OTHER_UNIT && targets.width() > 0.0) {
        return Some(Finding::new(
            "target_unit",
            Severity::Warning,
            format!(
                "the target spans {:.4} rad and the angle {:.4} rad",
                targets.width() * rad,
                readings.width() * rad
            ),
            "that looks like two units; say that of the target with --unit target=deg (or counts, rad, rev), or under [units] in \
             motor.toml",
        ));
    }
    (targets.low > readings.high || targets.high < readings.low).then(|| {
        let apart = (targets.low - readings.high).max(readings.low - targets.high);
        Finding::new(
            "target_elsewhere",
            Severity::Warning,
            format!("the angle never comes nearer than {:.4} rad to any target", apart * rad),
            "either they have another zero, which must be taken off one of the columns, or the drive was not obeying",
        )
    })
}

fn above_supply(recording: &Recording, drive: &PositionDrive) -> Option<Finding> {
    let (limit, supply) = (drive.control.limit_v, recording.supply_v?);
    (limit > supply * (1.0 + ABOVE_SUPPLY)).then(|| {
        Finding::new(
            "limit_above_supply",
            Severity::Warning,
            format!("limit_v is {limit:.2} V and supply_v is {supply:.2} V"),
            "no bridge gives more than its supply; correct one of them",
        )
    })
}

/// The gain, where the recording told it.
fn estimated(drive: &PositionDrive) -> Option<Finding> {
    let gain = drive.control.gain_v_per_rad;
    let GainOrigin::Estimated(estimate) = drive.control.origin else {
        return None;
    };
    Some(Finding::new(
        "loop_gain_estimated",
        Severity::Remark,
        format!(
            "the position loop's gain is estimated as {gain:.4} V/rad, to {:.1} %, since its output stands at {:.2} V for {:.2} s",
            100.0 * estimate.relative_std,
            drive.control.limit_v,
            estimate.limited_s
        ),
        format!(
            "all that is in volts shares this error; for recordings in which the drive stays below its limit, give \
             --loop gain_v_per_rad={gain:.4}"
        ),
    ))
}

struct Span {
    low: f64,
    high: f64,
}

impl Span {
    fn of(values: &[f64]) -> Option<Span> {
        let low = values.iter().copied().reduce(f64::min)?;
        let high = values.iter().copied().reduce(f64::max)?;
        Some(Span { low, high })
    }

    fn width(&self) -> f64 {
        self.high - self.low
    }
}
