//! A [`MotorFile`] to the text of a `motor.toml`.

use toml::Value;

use super::log_part::{LogPart, Selection};
use super::motor_drive::DriveKind;
use super::motor_file::{Columns, Fact, Known, MotorFile};
use super::motor_units::{AngleUnit, CommandUnit, TimeUnit, Units};
use super::preset::Preset;
use crate::channel::{Channel, Measured};
use crate::recording::{Drive, Recording};

/// A key and the text of its value, `None` where the default says it already.
type Line = (&'static str, Option<String>);

impl MotorFile {
    /// The motor file with which a recording is read that [`write_csv`](crate::output::write_csv) has written: what is known of the
    /// motor, and the contract's columns and units.
    pub fn for_written(&self, recording: &Recording) -> Self {
        let angle = if recording.quantised {
            AngleUnit::Counts
        } else {
            AngleUnit::Revolutions
        };
        let command = match recording.drive {
            Drive::Voltage => CommandUnit::Volts,
            Drive::Current => CommandUnit::Amperes,
            Drive::Torque => CommandUnit::NewtonMetres,
        };
        MotorFile {
            counts_per_rev: self.encoder_counts(),
            columns: Columns::default(),
            units: Units {
                voltage: command,
                angle,
                ..Units::default()
            },
            log: LogPart::default(),
            ..self.clone()
        }
    }

    /// The text that [`parse`](Self::parse) reads back as this value (but for [`source`](Self::source)).
    /// Defaults are left out.
    pub fn to_toml(&self) -> String {
        let (units, reversed) = (&self.units, self.units.reversed);
        let usual = self.log.preset.map(Preset::units).unwrap_or_default();
        let top = section(
            "",
            &[
                ("name", self.name.as_deref().map(quoted)),
                ("counts_per_rev", self.counts_per_rev.map(number)),
                ("supply_v", self.supply_v.map(number)),
                ("metres_per_rev", self.metres_per_rev.map(number)),
            ],
        );
        let kind = self.drive_kind();
        let named = |channel| (kind.key(channel), self.columns.get(channel).map(quoted));
        let columns = section("columns", &Channel::ALL.map(named));
        let mut units_of = vec![
            ("time", word(TimeUnit::ALL, units.time, usual.time)),
            (
                "voltage",
                signed(
                    &[CommandUnit::ALL],
                    reversed.voltage,
                    units.voltage,
                    usual.voltage,
                ),
            ),
            (
                "target",
                (units.target).and_then(|unit| name(AngleUnit::ALL, unit)),
            ),
            (
                "angle",
                signed(
                    &[AngleUnit::ALL, AngleUnit::SPEEDS],
                    reversed.angle,
                    units.angle,
                    usual.angle,
                ),
            ),
        ];
        units_of.extend(Measured::ALL.map(|channel| {
            let (own, turned) = (units.measured[channel], reversed.measured[channel]);
            let sign = if turned { "-" } else { "" };
            let said = own != usual.measured[channel] || turned;
            let text = said.then(|| quoted(&format!("{sign}{}", units.of(channel).name)));
            (channel.facts().key, text)
        }));
        let units = section("units", &units_of);
        let usual = (self.log.preset).map_or(DriveKind::Voltage, |preset| preset.drive);
        let kind = Some(self.drive_kind()).filter(|kind| self.drive_said || *kind != usual);
        let control = self.position.unwrap_or_default();
        let drive = section(
            "drive",
            &[
                ("kind", kind.map(|kind| quoted(kind.name()))),
                ("gain_v_per_rad", control.gain_v_per_rad.map(number)),
                (
                    "damping_v_s_per_rad",
                    control.damping_v_s_per_rad.map(number),
                ),
                ("limit_v", control.limit_v.map(number)),
                ("dead_band_rad", control.dead_band_rad.map(number)),
                ("rate_hz", control.rate_hz.map(number)),
            ],
        );
        let selections: Vec<String> = (self.log.select.iter()).map(Selection::to_string).collect();
        let log = section(
            "log",
            &[
                ("preset", self.log.preset.map(|preset| quoted(preset.name))),
                ("table", self.log.table.as_deref().map(quoted)),
                (
                    "select",
                    (!selections.is_empty()).then(|| quoted(&selections.join(","))),
                ),
                ("rate_hz", self.log.rate_hz.map(number)),
                ("from_s", self.log.from_s.map(number)),
                ("to_s", self.log.to_s.map(number)),
            ],
        );
        [top, columns, units, drive, known(&self.known), log].concat()
    }
}

impl Known {
    /// Every fact of the six physical parameters with its key in `[known]`, in the order of the file.
    pub fn facts(&self) -> [(&'static str, Option<Fact>); 6] {
        [
            ("resistance_ohm", self.resistance_ohm),
            ("inductance_h", self.inductance_h),
            ("kt_n_m_a", self.kt_n_m_a),
            ("kb_v_s_rad", self.kb_v_s_rad),
            ("inertia_kg_m2", self.inertia_kg_m2),
            ("viscous_n_m_s", self.viscous_n_m_s),
        ]
    }
}

fn known(known: &Known) -> String {
    let mut lines: Vec<Line> = known
        .facts()
        .map(|(key, fact)| (key, fact.map(fact_text)))
        .into();
    lines.extend([
        ("unbalance_n_m", known.unbalance_n_m.map(fact_text)),
        ("carrier_hz", known.carrier_hz.map(fact_text)),
        ("dead_time_s", known.dead_time_s.map(fact_text)),
    ]);
    lines.push(("kt_equals_kb", known.kt_equals_kb.then(|| "true".into())));
    section("known", &lines)
}

fn section(name: &str, lines: &[Line]) -> String {
    let written = |(key, value): &Line| value.as_ref().map(|value| format!("{key} = {value}\n"));
    let body: String = lines.iter().filter_map(written).collect();
    if name.is_empty() || body.is_empty() {
        body
    } else {
        format!("[{name}]\n{body}")
    }
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn number(value: f64) -> String {
    Value::from(value).to_string()
}

fn word<T: PartialEq>(all: &[(&str, T)], value: T, default: T) -> Option<String> {
    if value == default {
        return None;
    }
    name(all, value)
}

/// A unit with its sign, `None` for the usual one.
fn signed<T: PartialEq + Copy>(
    lists: &[&[(&str, T)]],
    reversed: bool,
    unit: T,
    usual: T,
) -> Option<String> {
    if unit == usual && !reversed {
        return None;
    }
    let mut all = lists.iter().flat_map(|list| list.iter());
    let (name, _) = all.find(|(_, other)| *other == unit)?;
    Some(quoted(&format!(
        "{}{name}",
        if reversed { "-" } else { "" }
    )))
}

fn name<T: PartialEq>(all: &[(&str, T)], value: T) -> Option<String> {
    let named = all.iter().find(|(_, unit)| *unit == value);
    named.map(|(name, _)| quoted(name))
}

fn fact_text(fact: Fact) -> String {
    match fact.tolerance {
        None => number(fact.value),
        Some(tolerance) => {
            format!(
                "{{ value = {}, tolerance = {} }}",
                number(fact.value),
                number(tolerance)
            )
        }
    }
}
