//! From flags and files to recordings: `motor.toml` beside the recording or named, then the flags.

use crate::cli::MotorArgs;
use crate::error::Error;
use crate::input::{MotorFile, read_recording};
use crate::recording::Recording;
use std::path::{Path, PathBuf};

/// What is known of the motor that made `recording`.
pub(super) fn motor_file(args: &MotorArgs, recording: &Path) -> Result<MotorFile, Error> {
    let mut motor = match &args.motor {
        Some(path) => MotorFile::read(path)?,
        None => MotorFile::find_beside(recording)?.unwrap_or_default(),
    };
    let flags = MotorFile::parse(&flags_as_toml(args)?, "the command line")
        .map_err(|error| Error::Usage(error.to_string()))?;
    motor.counts_per_rev = flags.counts_per_rev.or(motor.counts_per_rev);
    motor.supply_v = flags.supply_v.or(motor.supply_v);
    motor.metres_per_rev = flags.metres_per_rev.or(motor.metres_per_rev);
    for (flag, column) in [
        (flags.columns.time, &mut motor.columns.time),
        (flags.columns.voltage, &mut motor.columns.voltage),
        (flags.columns.angle, &mut motor.columns.angle),
        (flags.columns.current, &mut motor.columns.current),
        (flags.columns.enabled, &mut motor.columns.enabled),
    ] {
        if flag.is_some() {
            *column = flag;
        }
    }
    for unit in &args.unit {
        match unit.split('=').next() {
            Some("time") => motor.units.time = flags.units.time,
            Some("voltage") => motor.units.voltage = flags.units.voltage,
            Some("angle") => motor.units.angle = flags.units.angle,
            _ => motor.units.current = flags.units.current,
        }
    }
    if args.drive.is_some() {
        motor.drive = flags.drive;
    }
    let (known, new) = (&mut motor.known, flags.known);
    known.resistance_ohm = new.resistance_ohm.or(known.resistance_ohm);
    known.inductance_h = new.inductance_h.or(known.inductance_h);
    known.kt_n_m_a = new.kt_n_m_a.or(known.kt_n_m_a);
    known.kb_v_s_rad = new.kb_v_s_rad.or(known.kb_v_s_rad);
    known.inertia_kg_m2 = new.inertia_kg_m2.or(known.inertia_kg_m2);
    known.viscous_n_m_s = new.viscous_n_m_s.or(known.viscous_n_m_s);
    known.kt_equals_kb |= args.kt_equals_kb;
    Ok(motor)
}

/// The motor file of a recording, whether or not there is one.
pub(super) fn motor_path(args: &MotorArgs, recording: &Path) -> PathBuf {
    args.motor
        .clone()
        .unwrap_or_else(|| recording.with_file_name("motor.toml"))
}

/// Reads a recording and checks that there is something to fit in it.
pub(super) fn recording(args: &MotorArgs, path: &Path) -> Result<(Recording, MotorFile), Error> {
    let motor = motor_file(args, path)?;
    let recording = read_recording(path, &motor)?;
    recording.check_excited()?;
    Ok((recording, motor))
}

/// The flags as the text of a motor file: its reader has all the checks and suggestions.
fn flags_as_toml(args: &MotorArgs) -> Result<String, Error> {
    let mut text = String::new();
    for (key, value) in [
        ("counts_per_rev", args.counts_per_rev),
        ("supply_v", args.supply),
        ("metres_per_rev", args.metres_per_rev),
    ] {
        if let Some(value) = value {
            text += &format!("{key} = {value:?}\n");
        }
    }
    if let Some(drive) = &args.drive {
        text += &format!("drive.kind = {}\n", toml::Value::from(drive.as_str()));
    }
    for (section, flag, pairs) in [
        ("columns", "--column", &args.column),
        ("units", "--unit", &args.unit),
    ] {
        for pair in pairs {
            let (what, name) = split(flag, pair, "angle=name")?;
            text += &format!("{section}.{what} = {}\n", toml::Value::from(name));
        }
    }
    for pair in &args.known {
        let (fact, value) = split("--known", pair, "resistance_ohm=1.2~0.05")?;
        text += &match value.split_once('~') {
            Some((value, tolerance)) => {
                format!("known.{fact} = {{ value = {value}, tolerance = {tolerance} }}\n")
            }
            None => format!("known.{fact} = {value}\n"),
        };
    }
    Ok(text)
}

fn split<'a>(flag: &str, pair: &'a str, example: &str) -> Result<(&'a str, &'a str), Error> {
    pair.split_once('=')
        .filter(|(key, _)| {
            !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        })
        .ok_or_else(|| Error::Usage(format!("{flag} {pair}: write it like {flag} {example}")))
}
