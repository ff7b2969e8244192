//! The text of a `motor.toml` to a [`MotorFile`].

use super::log_part::log_part;
use super::motor_drive::{DRIVE_KEYS, DriveKind, drive};
use super::motor_error::{MotorFault, MotorFileError};
use super::motor_file::{Columns, Fact, Known, MotorFile};
use super::motor_units::{AngleUnit, CommandUnit, Reversed, TimeUnit, Units};
use super::preset::Preset;
use super::section::{Found, NumberOrTable, Section, Text};
use crate::channel::{Channel, Measured, PerMeasured};

const FACTS: [&str; 10] = [
    "resistance_ohm",
    "inductance_h",
    "kt_n_m_a",
    "kb_v_s_rad",
    "inertia_kg_m2",
    "viscous_n_m_s",
    "unbalance_n_m",
    "carrier_hz",
    "dead_time_s",
    "kt_equals_kb",
];
const TOP: [&str; 4] = ["name", "counts_per_rev", "supply_v", "metres_per_rev"];

/// Keys that stand in one section only, to tell where a lost one belongs.
const HOMES: [(&str, &[&str]); 5] = [
    ("", &TOP),
    ("columns", &["enabled", "direction"]),
    ("log", &["preset", "table", "select", "from_s", "to_s"]),
    ("drive", &DRIVE_KEYS),
    ("known", &FACTS),
];

impl MotorFile {
    /// Reads the text of a motor file; `source` names it in errors.
    ///
    /// # Errors
    /// `source:line:column` of a syntax error, of a key nobody reads (with the nearest that is), or of a value
    /// of the wrong type, not finite or not positive.
    pub fn parse(text: &str, source: &str) -> Result<Self, MotorFileError> {
        // Editors on Windows put a byte order mark first, which TOML does not allow.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut top = Section::top(Text { source, text })?;
        let mut file = MotorFile {
            source: Some(source.into()),
            name: top.string("name")?.map(|found| found.value),
            counts_per_rev: value(top.positive("counts_per_rev")?),
            supply_v: value(top.positive("supply_v")?),
            metres_per_rev: value(top.positive("metres_per_rev")?),
            ..MotorFile::default()
        };
        let column_section = top.section("columns")?;
        let unit_section = top.section("units")?;
        let drive_section = top.section("drive")?;
        file.log = log_part(top.section("log")?)?;
        let preset = file.log.preset;
        let kind;
        (kind, file.drive_said, file.position) = drive(
            drive_section,
            preset.map_or(DriveKind::Voltage, |preset| preset.drive),
        )?;
        file.drive = kind.of_motor();
        file.columns = columns(column_section, kind)?;
        file.units = units(unit_section, kind, preset.map(Preset::units))?;
        file.known = known(top.section("known")?)?;
        top.finish(|key| home_of(key, ""))?;
        Ok(file)
    }
}

fn value<T>(found: Option<Found<T>>) -> Option<T> {
    found.map(|found| found.value)
}

fn columns(mut section: Section<'_>, kind: DriveKind) -> Result<Columns, MotorFileError> {
    kind.refuses_other_key(&section)?;
    let mut columns = Columns::default();
    for channel in Channel::ALL {
        columns.set(channel, section.column(kind.key(channel))?);
    }
    section.finish(|key| home_of(key, "columns"))?;
    Ok(columns)
}

/// The units; `usual` ones are a preset's.
fn units(
    mut section: Section<'_>,
    kind: DriveKind,
    usual: Option<Units>,
) -> Result<Units, MotorFileError> {
    let usual = usual.unwrap_or_default();
    kind.refuses_other_key(&section)?;
    let (voltage, target) = match kind {
        DriveKind::Position => (None, section.word("target", AngleUnit::ALL)?),
        _ => (section.signed_word("voltage", &[CommandUnit::ALL])?, None),
    };
    if let Some(found) = &voltage {
        fits_drive(found.value.1, kind).map_err(|fault| section.error(&found.span, fault))?;
    }
    let time = section.word("time", TimeUnit::ALL)?;
    let angle = section.signed_word("angle", &[AngleUnit::ALL, AngleUnit::SPEEDS])?;
    let mut measured = usual.measured;
    let mut turned = PerMeasured::default();
    for channel in Measured::ALL {
        let facts = channel.facts();
        let named = facts.units.iter().enumerate();
        let all: Vec<(&str, usize)> = named.map(|(place, unit)| (unit.name, place)).collect();
        if let Some(found) = section.signed_word(facts.key, &[&all])? {
            (turned[channel], measured[channel]) = found.value;
        }
    }
    if let (Some(found), DriveKind::Position) = (&angle, kind)
        && matches!(found.value.1, AngleUnit::Speed(_))
    {
        return Err(section.error(&found.span, MotorFault::SpeedBehindLoop));
    }
    let (voltage, angle) = (value(voltage), value(angle));
    let units = Units {
        time: value(time).unwrap_or(usual.time),
        voltage: voltage.map_or(usual.voltage, |(_, unit)| unit),
        target: value(target),
        angle: angle.map_or(usual.angle, |(_, unit)| unit),
        measured,
        reversed: Reversed {
            voltage: voltage.is_some_and(|(reversed, _)| reversed),
            angle: angle.is_some_and(|(reversed, _)| reversed),
            measured: turned,
        },
    };
    section.finish(|key| home_of(key, "units"))?;
    Ok(units)
}

/// A current amplifier takes volts at its input, amperes or a torque; a bridge takes volts or a share of the supply.
fn fits_drive(unit: CommandUnit, kind: DriveKind) -> Result<(), MotorFault> {
    let of_current = unit.is_of_current();
    let wrong = |kind, remedy| {
        Err(MotorFault::DriveUnit {
            unit: unit.name(),
            kind,
            remedy,
        })
    };
    match kind {
        DriveKind::Voltage if of_current => wrong(
            "voltage",
            "for an amplifier that closes a current loop write kind = \"current\" under [drive]",
        ),
        DriveKind::Current if unit.full_scale().is_some() => wrong(
            "current",
            "a duty is a voltage: write kind = \"voltage\" under [drive], or give the command in V or A",
        ),
        _ => Ok(()),
    }
}

fn known(mut section: Section<'_>) -> Result<Known, MotorFileError> {
    let facts = Known {
        resistance_ohm: fact(&mut section, "resistance_ohm")?,
        inductance_h: fact(&mut section, "inductance_h")?,
        kt_n_m_a: fact(&mut section, "kt_n_m_a")?,
        kb_v_s_rad: fact(&mut section, "kb_v_s_rad")?,
        inertia_kg_m2: fact(&mut section, "inertia_kg_m2")?,
        viscous_n_m_s: fact(&mut section, "viscous_n_m_s")?,
        unbalance_n_m: fact(&mut section, "unbalance_n_m")?,
        carrier_hz: fact(&mut section, "carrier_hz")?,
        dead_time_s: fact(&mut section, "dead_time_s")?,
        kt_equals_kb: false,
    };
    let equal = section.boolean("kt_equals_kb")?;
    if let (Some(Found { value: true, span }), Some(kt), Some(kb)) =
        (&equal, facts.kt_n_m_a, facts.kb_v_s_rad)
        && contradict(kt, kb)
    {
        let fault = MotorFault::UnequalConstants {
            kt: kt.value,
            kb: kb.value,
        };
        return Err(section.error(span, fault));
    }
    section.finish(|key| home_of(key, "known"))?;
    Ok(Known {
        kt_equals_kb: value(equal).unwrap_or(false),
        ..facts
    })
}

/// Whether no common value lies within both tolerances; constants are taken to be rounded at the sixth digit.
fn contradict(a: Fact, b: Fact) -> bool {
    let reach = |fact: Fact| fact.value * fact.tolerance.unwrap_or(0.0).max(1e-6);
    (a.value - b.value).abs() > reach(a) + reach(b)
}

/// `key = 1.2` or `key = { value = 1.2, tolerance = 0.05 }`.
fn fact(section: &mut Section<'_>, key: &'static str) -> Result<Option<Fact>, MotorFileError> {
    let Some(Found { value, span }) = section.positive_or_table(key)? else {
        return Ok(None);
    };
    let mut inner = match value {
        NumberOrTable::Number(value) => {
            return Ok(Some(Fact {
                value,
                tolerance: None,
            }));
        }
        NumberOrTable::Table(table) => table,
    };
    let value = inner.positive("value")?;
    let tolerance = inner.positive("tolerance")?;
    if let Some(found) = tolerance.as_ref().filter(|found| found.value >= 1.0) {
        return Err(inner.error(&found.span, MotorFault::Tolerance { value: found.value }));
    }
    let Some(value) = value else {
        let remedy = "write { value = 1.2, tolerance = 0.05 }, or the number alone";
        return Err(inner.error(
            &span,
            MotorFault::MissingKey {
                key: format!("{key}.value"),
                remedy,
            },
        ));
    };
    inner.finish(|_| None)?;
    Ok(Some(Fact {
        value: value.value,
        tolerance: tolerance.map(|found| found.value),
    }))
}

/// Where a key belongs that stands in the wrong section `here`. A key written below a `[section]` falls
/// into it, the commonest slip in TOML.
pub(super) fn home_of(key: &str, here: &str) -> Option<String> {
    let (home, _) = HOMES
        .iter()
        .find(|(home, keys)| *home != here && keys.contains(&key))?;
    Some(match *home {
        "" => "it belongs above the first [section]".into(),
        home => format!("it belongs under [{home}]"),
    })
}
