//! From flags and files to recordings: `motor.toml` beside the recording or named, then the flags.

use super::motor_beside::write_motor;
use super::progress::FileBar;
use crate::cli::{MotorArgs, RecordingsArgs};
use crate::error::Error;
use crate::session::Session;
use servoid_io::channel::Channel;
use servoid_io::input::{
    Columns, DriveKind, MotorFile, Part, Preset, Reading, read_one, read_recordings_with,
};
use servoid_io::position_loop::LoopSettings;
use servoid_io::recording::Recording;
use servoid_results::schema;
use std::path::{Path, PathBuf};

/// Checks that the `outputs` of a verb, and its JSON, replace nothing that it reads.
pub(super) fn check_outputs(
    session: &Session,
    outputs: &[(&'static str, &Path)],
    args: &MotorArgs,
    recording: &Path,
    validate: Option<&Path>,
) -> Result<(), Error> {
    let validate: Vec<&Path> = validate.into_iter().collect();
    check_outputs_of(session, outputs, args, &[recording], &validate)
}

/// As [`check_outputs`], for several recordings.
fn check_outputs_of(
    session: &Session,
    outputs: &[(&'static str, &Path)],
    args: &MotorArgs,
    fitted: &[&Path],
    validate: &[&Path],
) -> Result<(), Error> {
    let motors: Vec<PathBuf> = fitted.iter().map(|path| motor_path(args, path)).collect();
    let files = |paths: &[&Path]| -> Vec<PathBuf> {
        paths.iter().map(|path| Part::of(path).path).collect()
    };
    let (fitted, validate) = (files(fitted), files(validate));
    let mut inputs: Vec<(&str, &Path)> = Vec::new();
    inputs.extend(fitted.iter().map(|path| ("the recording", path.as_path())));
    let held_out = validate.iter();
    inputs.extend(held_out.map(|path| ("the --validate recording", path.as_path())));
    inputs.extend(motors.iter().map(|path| ("the motor file", path.as_path())));
    session.check_outputs(outputs, &inputs)
}

/// The recordings of a fit or a diagnosis.
pub(super) struct Read {
    /// Fitted.
    pub(super) fitted: Vec<Recording>,
    /// Never fitted.
    pub(super) held_out: Vec<Recording>,
    /// What is known of the motor that made the first.
    pub(super) motor: MotorFile,
    /// How the logs were read.
    pub(super) how: schema::read::Read,
}

/// Reads the recordings of a fit or a diagnosis, once its `outputs` replace none of them.
pub(super) fn read(
    session: &Session,
    outputs: &[(&'static str, &Path)],
    args: &MotorArgs,
    recordings: &RecordingsArgs,
) -> Result<Read, Error> {
    let (fitted, held_out) = (paths(recordings.fitted()), paths(recordings.held_out()));
    let Some(first) = recordings.first() else {
        return Err(Error::Usage(
            "no recording is given to fit: name it before --validate".to_owned(),
        ));
    };
    check_outputs_of(session, outputs, args, &fitted, &held_out)?;
    // Each with whether its path means a part of a file.
    let (mut known, mut notes) = (None, Vec::new());
    let mut all = |paths: &[&Path]| -> Result<Vec<(bool, Recording)>, Error> {
        let mut all = Vec::new();
        for path in paths {
            let is_part = Part::of(path).name.is_some();
            let reading = all_of(session, args, path)?;
            known.get_or_insert(reading.motor);
            notes.extend(reading.notes);
            all.extend(
                reading
                    .recordings
                    .into_iter()
                    .map(|recording| (is_part, recording)),
            );
        }
        Ok(all)
    };
    let (fitted, held_out) = (all(&fitted)?, all(&held_out)?);
    // Parts of a file that are named to be held out are not among those of the whole file.
    let is_kept = |own: &Recording| {
        let mut named = held_out.iter().filter(|(is_part, _)| *is_part);
        named.all(|(_, other)| other.source != own.source)
    };
    let fitted: Vec<Recording> = (fitted.into_iter())
        .map(|(_, recording)| recording)
        .filter(is_kept)
        .collect();
    let held_out = held_out
        .into_iter()
        .map(|(_, recording)| recording)
        .collect();
    let motor = match known {
        Some(motor) => motor,
        None => motor_file(args, first)?,
    };
    if args.write_motor {
        let beside = first.with_file_name("motor.toml");
        session.remark(&write_motor(session, &beside, &motor)?);
    }
    let how = schema::read::Read::of(&motor, notes);
    Ok(Read {
        fitted,
        held_out,
        motor,
        how,
    })
}

fn paths(list: &[PathBuf]) -> Vec<&Path> {
    list.iter().map(PathBuf::as_path).collect()
}

/// What is known of the motor that made `recording`.
pub(super) fn motor_file(args: &MotorArgs, recording: &Path) -> Result<MotorFile, Error> {
    let mut motor = match &args.motor {
        Some(path) => MotorFile::read(path)?,
        None => MotorFile::find_beside(recording)?.unwrap_or_default(),
    };
    let preset = args.preset.as_deref().and_then(Preset::by_name);
    let usual = preset.map_or(motor.drive_kind(), |preset| preset.drive);
    let flags = from_flags(args, usual)?;
    if preset.is_some() {
        // The log is as the preset says, whatever other logs of this motor are.
        motor.columns = Columns::default();
        motor.units = flags.units;
        motor.drive = flags.drive;
        motor.drive_said |= args.drive.is_some();
        motor.position = flags.position;
    }
    if flags.drive_kind() != motor.drive_kind() {
        // The file's command is another one.
        motor.columns.set(Channel::Command, None);
        motor.units.voltage = flags.units.voltage;
        motor.units.target = None;
    }
    motor.counts_per_rev = flags.counts_per_rev.or(motor.counts_per_rev);
    motor.supply_v = flags.supply_v.or(motor.supply_v);
    motor.metres_per_rev = flags.metres_per_rev.or(motor.metres_per_rev);
    for (channel, name) in flags.columns.iter() {
        motor.columns.set(channel, Some(name.to_owned()));
    }
    let (units, new) = (&mut motor.units, flags.units);
    for unit in &args.unit {
        match unit.split('=').next() {
            Some("time") => units.time = new.time,
            Some("voltage") => {
                units.voltage = new.voltage;
                units.reversed.voltage = new.reversed.voltage;
            }
            Some("target") => units.target = new.target,
            Some("angle") => {
                units.angle = new.angle;
                units.reversed.angle = new.reversed.angle;
            }
            other => {
                let channel = other.and_then(Channel::by_key);
                if let Some(Channel::Measured(channel)) = channel {
                    units.measured[channel] = new.measured[channel];
                    units.reversed.measured[channel] = new.reversed.measured[channel];
                }
            }
        }
    }
    let (log, new) = (&mut motor.log, flags.log);
    log.preset = new.preset.or(log.preset);
    log.table = new.table.or(log.table.take());
    if !new.select.is_empty() {
        log.select = new.select;
    }
    log.rate_hz = new.rate_hz.or(log.rate_hz);
    log.from_s = new.from_s.or(log.from_s);
    log.to_s = new.to_s.or(log.to_s);
    motor.drive = flags.drive;
    motor.position =
        (flags.position).map(|settings| motor.position.unwrap_or_default().under(&settings));
    let (known, new) = (&mut motor.known, flags.known);
    known.resistance_ohm = new.resistance_ohm.or(known.resistance_ohm);
    known.inductance_h = new.inductance_h.or(known.inductance_h);
    known.kt_n_m_a = new.kt_n_m_a.or(known.kt_n_m_a);
    known.kb_v_s_rad = new.kb_v_s_rad.or(known.kb_v_s_rad);
    known.inertia_kg_m2 = new.inertia_kg_m2.or(known.inertia_kg_m2);
    known.viscous_n_m_s = new.viscous_n_m_s.or(known.viscous_n_m_s);
    known.unbalance_n_m = new.unbalance_n_m.or(known.unbalance_n_m);
    known.carrier_hz = new.carrier_hz.or(known.carrier_hz);
    known.dead_time_s = new.dead_time_s.or(known.dead_time_s);
    known.kt_equals_kb |= args.kt_equals_kb;
    Ok(motor)
}

/// The motor file of a recording, whether or not there is one.
fn motor_path(args: &MotorArgs, recording: &Path) -> PathBuf {
    args.motor
        .clone()
        .unwrap_or_else(|| recording.with_file_name("motor.toml"))
}

/// Reads the only recording of a file and checks that there is something to fit in it.
pub(super) fn recording(
    session: &Session,
    args: &MotorArgs,
    path: &Path,
) -> Result<(Recording, MotorFile), Error> {
    let motor = motor_file(args, path)?;
    let mut reading = read_one(path, &motor)?;
    for note in &reading.notes {
        session.remark(note);
    }
    let recording = reading
        .recordings
        .pop()
        .ok_or_else(|| Error::Failed(format!("{}: holds no recording", path.display())))?;
    recording.check_excited()?;
    Ok((recording, reading.motor))
}

/// Reads all recordings of a file, checks that there is something to fit in each, and says what their reader has to say.
pub(super) fn all_of(session: &Session, args: &MotorArgs, path: &Path) -> Result<Reading, Error> {
    let motor = motor_file(args, path)?;
    let bar = FileBar::new(session, "read");
    let reading = read_recordings_with(path, &motor, &|reached| bar.reached(reached))?;
    drop(bar);
    for note in &reading.notes {
        session.remark(note);
    }
    for recording in &reading.recordings {
        recording.check_excited()?;
    }
    Ok(reading)
}

/// What the flags say, read as lines of a motor file: its reader has all the checks and suggestions. Each
/// flag is read alone first, so that a refusal names it. `drive` is the motor file's, for the units.
fn from_flags(args: &MotorArgs, drive: DriveKind) -> Result<MotorFile, Error> {
    let drive = args.drive.as_deref().unwrap_or(drive.name());
    let drive_line = format!("drive.kind = {}\n", toml::Value::from(drive));
    parse(&format!("--drive {drive}"), &drive_line)?;
    let mut text = drive_line.clone();
    let mut keys: Vec<String> = Vec::new();
    for Line { flag, key, value } in lines(args)? {
        let line = format!("{key} = {value}\n");
        parse(&flag, &format!("{drive_line}{line}"))?;
        if keys.contains(&key) {
            return Err(Error::Usage(format!("{flag}: was given before")));
        }
        keys.push(key);
        text += &line;
    }
    parse("the flags together", &text)
}

fn parse(flag: &str, text: &str) -> Result<MotorFile, Error> {
    MotorFile::parse(text, "").map_err(|error| Error::Usage(format!("{flag}: {}", error.fault)))
}

/// A flag as it was given, and what it would be in a motor file.
struct Line {
    flag: String,
    key: String,
    value: toml::Value,
}

fn lines(args: &MotorArgs) -> Result<Vec<Line>, Error> {
    let mut lines = Vec::new();
    for (flag, key, value) in [
        ("--counts-per-rev", "counts_per_rev", args.counts_per_rev),
        ("--supply-v", "supply_v", args.supply),
        ("--metres-per-rev", "metres_per_rev", args.metres_per_rev),
        ("--rate", "log.rate_hz", args.rate),
        ("--from", "log.from_s", args.from),
        ("--to", "log.to_s", args.to),
    ] {
        lines.extend(value.map(|value| Line {
            flag: format!("{flag} {value}"),
            key: key.to_owned(),
            value: value.into(),
        }));
    }
    for (flag, key, text) in [
        ("--preset", "log.preset", args.preset.clone()),
        ("--table", "log.table", args.table.clone()),
        ("--select", "log.select", joined(&args.select)),
    ] {
        lines.extend(text.map(|text| Line {
            flag: format!("{flag} {text}"),
            key: key.to_owned(),
            value: text.into(),
        }));
    }
    for (section, flag, pairs) in [
        ("columns", "--column", &args.column),
        ("units", "--unit", &args.unit),
    ] {
        for pair in pairs {
            let (what, name) = split(flag, pair, "angle=name")?;
            lines.push(Line {
                flag: format!("{flag} {pair}"),
                key: format!("{section}.{what}"),
                value: name.into(),
            });
        }
    }
    for pair in &args.position_loop {
        lines.push(loop_line(pair)?);
    }
    for pair in &args.known {
        let (fact, value) = split("--known", pair, "resistance_ohm=1.2~0.05")?;
        let flag = format!("--known {pair}");
        lines.push(Line {
            value: fact_value(&flag, value)?,
            key: format!("known.{fact}"),
            flag,
        });
    }
    Ok(lines)
}

/// Several values of one flag as one text, `None` of none.
fn joined(values: &[String]) -> Option<String> {
    (!values.is_empty()).then(|| values.join(","))
}

/// One `--loop`.
fn loop_line(pair: &str) -> Result<Line, Error> {
    let (what, value) = split("--loop", pair, "gain_v_per_rad=8.4")?;
    let flag = format!("--loop {pair}");
    let number: f64 = value.trim().parse().map_err(|_| {
        Error::Usage(format!(
            "{flag}: `{value}` is not a number; write it like --loop gain_v_per_rad=8.4"
        ))
    })?;
    Ok(Line {
        flag,
        key: format!("drive.{what}"),
        value: number.into(),
    })
}

/// What flags say of a position loop.
pub(super) fn loop_settings(pairs: &[String]) -> Result<LoopSettings, Error> {
    let mut settings = LoopSettings::default();
    for pair in pairs {
        let Line { flag, key, value } = loop_line(pair)?;
        let file = parse(
            &flag,
            &format!("drive.kind = \"position\"\n{key} = {value}\n"),
        )?;
        settings = settings.under(&file.position.unwrap_or_default());
    }
    Ok(settings)
}

/// `1.2`, `1.2~0.05` or `true`.
fn fact_value(flag: &str, text: &str) -> Result<toml::Value, Error> {
    if let Ok(truth) = text.parse::<bool>() {
        return Ok(truth.into());
    }
    let number = |text: &str| {
        text.trim().parse::<f64>().map_err(|_| {
            Error::Usage(format!(
                "{flag}: `{text}` is not a number; write it like --known resistance_ohm=1.2~0.05"
            ))
        })
    };
    let Some((value, tolerance)) = text.split_once('~') else {
        return Ok(number(text)?.into());
    };
    let mut table = toml::Table::new();
    table.insert("value".to_owned(), number(value)?.into());
    table.insert("tolerance".to_owned(), number(tolerance)?.into());
    Ok(table.into())
}

fn split<'a>(flag: &str, pair: &'a str, example: &str) -> Result<(&'a str, &'a str), Error> {
    pair.split_once('=')
        .filter(|(key, _)| {
            !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        })
        .ok_or_else(|| Error::Usage(format!("{flag} {pair}: write it like {flag} {example}")))
}
