//! What a name says beside the words of its channel: whether it is of a speed, of a target, of a commanded current, and the unit that it
//! has in brackets.

use super::motor_drive::DriveKind;
use super::names::{Match, Spelling, parts};
use super::units_told::unit_of;
use crate::channel::Channel;

/// What speeds are called, the likeliest first.
const SPEEDS: &[&str] = &[
    "speed",
    "velocity",
    "omega",
    "velo",
    "vel",
    "rpm",
    "dtheta",
    "dq",
    "qd",
    "w",
    "geschwindigkeit",
    "drehzahl",
    "vitesse",
    "velocidad",
    "\u{901f}\u{5ea6}",
    "\u{8f6c}\u{901f}",
];
/// How names end that tell a speed's unit, the longest first.
const SPEED_ENDS: &[(&str, &str)] = &[
    ("counts_per_sample", "counts/sample"),
    ("counts_per_second", "counts/s"),
    ("counts_per_s", "counts/s"),
    ("counts_s", "counts/s"),
    ("ticks_per_s", "counts/s"),
    ("ticks_s", "counts/s"),
    ("rad_per_s", "rad/s"),
    ("rad_s", "rad/s"),
    ("rads", "rad/s"),
    ("deg_per_s", "deg/s"),
    ("deg_s", "deg/s"),
    ("dps", "deg/s"),
    ("rev_per_s", "rev/s"),
    ("rev_s", "rev/s"),
    ("rps", "rev/s"),
    ("rpm", "rpm"),
    ("u_min", "rpm"),
    ("tr_min", "rpm"),
    ("1_min", "rpm"),
];
/// Units of a speed that mean nothing else, wherever they stand in a name.
const SPEED_UNITS: &[(&str, &str)] = &[("rpm", "rpm"), ("rps", "rev/s"), ("dps", "deg/s")];
/// What is wanted of a position loop, the likeliest first.
const TARGETS: &[&str] = &[
    "target",
    "goal",
    "setpoint",
    "reference",
    "desired",
    "ref",
    "command",
    "commanded",
    "cmd",
    "action",
    "soll",
    "sollwert",
    "ziel",
    "consigne",
    "cible",
    "consigna",
    "objetivo",
    "\u{76ee}\u{6807}",
];
const NO_TARGETS: &[&str] = &[
    "speed",
    "velocity",
    "vel",
    "torque",
    "current",
    "error",
    "voltage",
    "volts",
    "pwm",
    "duty",
    "geschwindigkeit",
    "drehzahl",
    "moment",
    "strom",
];
/// What a drive that closes a current loop is commanded by, the likeliest first.
const CURRENTS: &[&str] = &[
    "current_command",
    "iq_setpoint",
    "iq_ref",
    "iq_cmd",
    "command",
    "cmd",
    "setpoint",
    "current_a",
    "current",
    "torque",
    "iq",
    "i",
    "sollstrom",
    "drehmoment",
    "strom",
    "voltage",
    "u",
];
const NO_CURRENTS: &[&str] = &[
    "limit", "max", "bus", "supply", "battery", "measured", "meas", "actual", "mos",
];

/// How surely a name means the target of a position loop.
pub(super) fn target(name: &str) -> Option<(Match, usize)> {
    Spelling::of(name)
        .called(TARGETS, NO_TARGETS)
        .filter(|_| speed_unit(name).is_none())
}

/// How surely a name means what a current loop is told.
pub(super) fn commanded_current(name: &str) -> Option<(Match, usize)> {
    Spelling::of(name).called(CURRENTS, NO_CURRENTS)
}

/// Which of these names means a channel of such a drive most surely, by its spelling alone.
pub(super) fn most_like<'n>(
    names: &[&'n str],
    channel: Channel,
    kind: DriveKind,
) -> Option<&'n str> {
    let called = |name: &str| match (channel, kind) {
        (Channel::Command, DriveKind::Position) => target(name),
        (Channel::Command, DriveKind::Current) => commanded_current(name),
        _ => channel.facts().called(name),
    };
    let own = names.iter().filter_map(|name| Some((called(name)?, *name)));
    let best = own.min_by_key(|((how, place), _)| (std::cmp::Reverse(*how), *place));
    best.map(|(_, name)| name)
}

/// How surely a name means a measured speed.
pub(super) fn speed(name: &str) -> Option<(Match, usize)> {
    let wanted = crate::channel::WANTED;
    let spelling = Spelling::of(name);
    spelling.called(SPEEDS, wanted).or_else(|| {
        let told = speed_unit(name).filter(|_| !spelling.has_part(wanted));
        told.map(|_| (Match::Part, SPEEDS.len()))
    })
}

/// Whether a name means a speed that is wanted of a speed loop.
pub(super) fn is_speed_setpoint(name: &str) -> bool {
    let spelling = Spelling::of(name);
    let is_wanted = spelling.has_part(crate::channel::WANTED);
    is_wanted && (spelling.called(SPEEDS, &[]).is_some() || speed_unit(name).is_some())
}

/// The unit of a speed that a name ends with, or has in brackets.
pub(super) fn speed_unit(name: &str) -> Option<&'static str> {
    let spelling = Spelling::of(name);
    let mut ends = SPEED_ENDS.iter();
    let by_end = ends.find(|(end, _)| {
        let rest = spelling.joined().strip_suffix(end);
        rest.is_some_and(|rest| rest.is_empty() || rest.ends_with('_'))
    });
    let anywhere = || {
        let mut units = SPEED_UNITS.iter();
        units.find(|(word, _)| spelling.has_part(&[word]))
    };
    by_end.or_else(anywhere).map(|(_, unit)| *unit).or_else(|| {
        let unit = unit_of(Channel::Angle, bracketed(name)?)?;
        unit.contains('/')
            .then_some(unit)
            .or_else(|| (unit == "rpm").then_some(unit))
    })
}

/// What a name has in brackets at its end: `Winkel [Grad]`.
pub(super) fn bracketed(name: &str) -> Option<&str> {
    let name = name.trim();
    let (open, close) = [('[', ']'), ('(', ')'), ('{', '}')]
        .into_iter()
        .find(|(_, close)| name.ends_with(*close))?;
    let (_, inside) = name.strip_suffix(close)?.rsplit_once(open)?;
    Some(inside.trim()).filter(|inside| !inside.is_empty())
}

/// The unit of a channel that a name has in brackets, or after it as in `mV [0x2201]`.
pub(super) fn unit_in(channel: Channel, name: &str) -> Option<&'static str> {
    let by_bracket = bracketed(name).and_then(|inside| unit_of(channel, inside));
    by_bracket.or_else(|| {
        let (before, _) = name.rsplit_once(['[', '('])?;
        unit_of(channel, before.split_whitespace().last()?)
    })
}

/// The unit that a name tells, where that is not the usual one.
pub(super) fn told_unit(channel: Channel, name: &str) -> Option<&'static str> {
    let usual = match channel {
        Channel::Time => "s",
        Channel::Command => "V",
        Channel::Angle => "counts",
        Channel::Measured(channel) => channel.facts().units[0].name,
        Channel::Enabled | Channel::Direction => return None,
    };
    unit_in(channel, name)
        .or_else(|| by_last_part(channel, name))
        .filter(|unit| *unit != usual)
}

fn by_last_part(channel: Channel, name: &str) -> Option<&'static str> {
    let parts = parts(name);
    let last = parts.last()?;
    let own = unit_of(channel, last).filter(|_| parts.len() > 1 || last.len() > 1);
    match channel {
        // `pwm` and `duty` are names of commands and tell their unit as well.
        Channel::Command if own.is_none() => {
            let is = |word: &str| parts.iter().any(|part| part == word);
            (is("duty") || is("pwm")).then_some("duty")
        }
        _ => own,
    }
}

/// Whether what a name has in brackets is a unit of another channel, so that it cannot be this one.
pub(super) fn has_foreign_unit(channel: Channel, name: &str) -> bool {
    let Some(inside) = bracketed(name).filter(|inside| !inside.contains("0x")) else {
        return false;
    };
    if unit_of(channel, inside).is_some() {
        return false;
    }
    let newton_metres = ["nm", "n*m", "n.m"].contains(&super::names::folded(inside).as_str());
    let known = Channel::ALL
        .into_iter()
        .any(|other| unit_of(other, inside).is_some());
    known || newton_metres
}
