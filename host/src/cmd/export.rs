//! `servoid export`: what was found, in another program's words.

use crate::cli::{ExportArgs, SideName};
use crate::error::Error;
use crate::session::Session;
use serde::Serialize;
use servoid_io::output::write_whole;
use servoid_results::export::gains::Asked;
use servoid_results::export::{
    Format, Lack, Mapped, Options, Side, Subject, SubjectError, Written,
};
use servoid_results::schema::{Identified, ResultError, ResultFault};

/// Ratios of gears, generously.
const RATIOS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Formats that take a period.
const SAMPLED: &[&str] = &["c", "rust", "python", "gains", "ros2-control", "odrive"];
/// Formats with a current loop.
const CURRENT: &[&str] = &["gains", "odrive", "vesc", "moteus"];
/// Formats with a speed loop.
const SPEED: &[&str] = &["gains", "ros2-control", "odrive"];
/// Formats of drives of brushless motors.
const DRIVES: &[&str] = &["odrive", "vesc", "moteus"];

/// `servoid.export/1`.
#[derive(Serialize)]
struct ExportJson<'a> {
    schema: &'static str,
    format: &'static str,
    source: &'a str,
    out: Option<String>,
    side: Side,
    text: &'a str,
    mapping: &'a [Mapped],
    cannot_carry: &'a [Lack],
    remarks: &'a [String],
    version: &'static str,
}

pub(super) fn run(session: &Session, args: &ExportArgs) -> Result<(), Error> {
    let out = args.out.as_deref().map(|path| ("--out", path));
    let report = args.result.join("device.json");
    let inputs = [
        ("the result", args.result.as_path()),
        ("the result", &report),
    ];
    session.check_outputs(out.as_slice(), &inputs)?;
    let side = side(args)?;
    let options = options(args)?;
    let unknown = || Error::Usage(format!("--to {}: no such format", args.to));
    let format = Format::by_name(&args.to).ok_or_else(unknown)?;
    let identified = Identified::read(&args.result)?;
    let source = args.result.display().to_string();
    let subject = Subject::new(&identified, &source, side).map_err(|error| match error {
        SubjectError::Export(error) => Error::from(error),
        SubjectError::Model(fault) => Error::from(ResultError {
            path: args.result.clone(),
            fault: ResultFault::Model(fault),
        }),
    })?;
    let computes_gains = CURRENT.contains(&format.name) || SPEED.contains(&format.name);
    if computes_gains && !args.force {
        subject.needs_grade(format.name)?;
    }
    let written = (format.write)(&subject, &options)?;
    for line in written.lines() {
        session.remark(&line);
    }
    if let Some(path) = &args.out {
        write_whole(path, |out| out.write_all(written.text.as_bytes()))?;
    }
    let text = match &args.out {
        Some(path) => summary(format, &written, path),
        None => written.text.clone(),
    };
    session.deliver(
        &text,
        &ExportJson {
            schema: "servoid.export/1",
            format: format.name,
            source: &source,
            out: args.out.as_ref().map(|path| path.display().to_string()),
            side,
            text: &written.text,
            mapping: &written.mapping,
            cannot_carry: &written.cannot_carry,
            remarks: &written.remarks,
            version: env!("CARGO_PKG_VERSION"),
        },
    )
}

/// Where each number went, a line each.
fn summary(format: &Format, written: &Written, path: &std::path::Path) -> String {
    let mut text = format!("{}: {}\n", path.display(), format.name);
    for mapped in &written.mapping {
        text += &format!(
            "  {} -> {} ({}, {} side)\n",
            mapped.from, mapped.to, mapped.unit, mapped.side
        );
    }
    text
}

fn side(args: &ExportArgs) -> Result<Side, Error> {
    let ratio = positive("--ratio", args.ratio)?;
    if let Some(ratio) = ratio.filter(|ratio| !RATIOS.contains(ratio)) {
        return Err(Error::Usage(format!(
            "--ratio {ratio}: must be between {:e} and {:e}",
            RATIOS.start(),
            RATIOS.end()
        )));
    }
    match (args.side, ratio) {
        (SideName::Motor, None) => Ok(Side::Motor),
        (SideName::Output, Some(ratio)) => Ok(Side::Output { ratio }),
        (SideName::Motor, Some(ratio)) => Err(Error::Usage(format!(
            "--ratio {ratio}: changes nothing on the motor's side; add --side output"
        ))),
        (SideName::Output, None) => Err(Error::Usage(
            "--side output: needs --ratio N, the turns of the motor a turn of the output".into(),
        )),
    }
}

fn options(args: &ExportArgs) -> Result<Options, Error> {
    let gains = &args.gains;
    let drive = &args.drive;
    for (flag, given, formats) in [
        (
            "--current-bandwidth",
            gains.current_bandwidth.is_some(),
            CURRENT,
        ),
        ("--speed-bandwidth", gains.speed_bandwidth.is_some(), SPEED),
        ("--method", gains.method.is_some(), SPEED),
        ("--loops", gains.loops.is_some(), &["gains"]),
        ("--sample", args.sample.is_some(), SAMPLED),
        ("--winding", drive.winding.is_some(), DRIVES),
        ("--pole-pairs", drive.pole_pairs.is_some(), DRIVES),
    ] {
        if given && !formats.contains(&args.to.as_str()) {
            return Err(Error::Usage(format!(
                "{flag}: is for --to {}, not for --to {}",
                formats.join(", "),
                args.to
            )));
        }
    }
    Ok(Options {
        sample_s: positive("--sample", args.sample)?,
        gains: Asked {
            current_hz: positive("--current-bandwidth", gains.current_bandwidth)?,
            speed_hz: positive("--speed-bandwidth", gains.speed_bandwidth)?,
            method: gains.method,
            loops: gains.loops,
        },
        winding: drive.winding.unwrap_or_default(),
        pole_pairs: drive.pole_pairs,
    })
}

fn positive(flag: &str, value: Option<f64>) -> Result<Option<f64>, Error> {
    match value {
        Some(value) if !(value > 0.0 && value.is_finite()) => Err(Error::Usage(format!(
            "{flag} {value}: must be a positive number"
        ))),
        value => Ok(value),
    }
}
