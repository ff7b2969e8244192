//! Errors in an order to the bench, each with its remedy.

use super::effects::{CATALOGUE, Kind};
use super::machine::PRESETS;

/// Why the bench refused to run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// No effect of that name is in the catalogue.
    #[error("unknown effect `{name}`{hint}; the bench knows: {known}")]
    UnknownEffect {
        /// The unknown name.
        name: String,
        /// "; did you mean …?", or empty.
        hint: String,
        /// All names, separated by commas.
        known: String,
    },
    /// No machine of that name is among the presets.
    #[error("unknown machine `{name}`{hint}; the bench has: {known}")]
    UnknownMachine {
        /// The unknown name.
        name: String,
        /// "; did you mean …?", or empty.
        hint: String,
        /// All names, separated by commas.
        known: String,
    },
    /// The effect has no parameter of that name.
    #[error("effect `{effect}` has no parameter `{key}`{hint}; it has: {known}")]
    UnknownParameter {
        /// The effect.
        effect: &'static str,
        /// The unknown name.
        key: String,
        /// "; did you mean …?", or empty.
        hint: String,
        /// All names, separated by commas.
        known: String,
    },
    /// The effect has no other curve of that name.
    #[error("effect `{effect}` has no law `{name}`{hint}; it has: {known}")]
    UnknownLaw {
        /// The effect.
        effect: &'static str,
        /// The unknown name.
        name: String,
        /// "; did you mean …?", or empty.
        hint: String,
        /// All names, separated by commas, or that there is none.
        known: String,
    },
    /// Part of an effect's description is not `key=value`.
    #[error("`{part}` in `{spec}`: expected key=value, as in `coulomb:torque=0.01,strength=2`")]
    NotAnAssignment {
        /// The whole description.
        spec: String,
        /// The part that cannot be read.
        part: String,
    },
    /// A value is not a number.
    #[error(
        "`{effect}:{key}={text}`: `{text}` is not a number; give one in {unit}, as in 0.01 or 1e-2"
    )]
    NotANumber {
        /// The effect.
        effect: &'static str,
        /// The parameter.
        key: String,
        /// The value given.
        text: String,
        /// The parameter's unit.
        unit: &'static str,
    },
    /// A parameter of an effect lies outside what physics allows.
    #[error("`{effect}:{key}={value}`: needs {low} to {high} {unit}")]
    OutOfRange {
        /// The effect.
        effect: &'static str,
        /// The parameter.
        key: &'static str,
        /// The value given.
        value: f64,
        /// Least value.
        low: f64,
        /// Largest value.
        high: f64,
        /// The parameter's unit.
        unit: &'static str,
    },
    /// The same effect was hidden twice.
    #[error(
        "effect `{0}` is listed twice; name it once and give its strength, as in `{0}:strength=2`"
    )]
    Twice(&'static str),
    /// An effect of the armature circuit was hidden behind an amplifier that closes a current loop.
    #[error(
        "effect `{0}` acts on the armature voltage, which a current-controlled amplifier hides; \
         leave it out or drive with a voltage"
    )]
    HiddenByCurrentLoop(&'static str),
    /// A setting of the bench or the machine is impossible.
    #[error("{setting} = {value}: needs {need}")]
    BadSetting {
        /// The setting.
        setting: &'static str,
        /// The value given.
        value: f64,
        /// The values allowed.
        need: &'static str,
    },
    /// A command is not a number.
    #[error("drive sample {row}: the command is {value}; every command must be a finite number")]
    BadCommand {
        /// Index of the sample, from 0.
        row: usize,
        /// The value given.
        value: f64,
    },
    /// Some part of the motor moves far faster than the substep.
    #[error(
        "the motor needs substeps of {step_s:.1e} s, too short to simulate; raise the inductance, or soften \
         the effect that is so fast (a larger compliance, presliding or knee)"
    )]
    TooStiff {
        /// The substep that it needs, s.
        step_s: f64,
    },
    /// The simulation diverged.
    #[error(
        "the simulation diverged before t = {time_s} s; lower the command or the effects' parameters"
    )]
    Diverged {
        /// Time of the first sample that is not a number, s.
        time_s: f64,
    },
}

impl BenchError {
    pub(super) fn require(
        holds: bool,
        setting: &'static str,
        value: f64,
        need: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(BenchError::BadSetting {
                setting,
                value,
                need,
            })
        }
    }

    pub(super) fn unknown_effect(name: &str) -> Self {
        let (hint, known) = nearest(name, CATALOGUE.iter().map(|kind| kind.name));
        BenchError::UnknownEffect {
            name: name.into(),
            hint,
            known,
        }
    }

    pub(super) fn unknown_machine(name: &str) -> Self {
        let (hint, known) = nearest(name, PRESETS.iter().copied());
        BenchError::UnknownMachine {
            name: name.into(),
            hint,
            known,
        }
    }

    pub(super) fn unknown_law(kind: &Kind, name: &str) -> Self {
        let (hint, mut known) = nearest(name, kind.other_laws.iter().map(|law| law.name));
        if known.is_empty() {
            known = "only the catalogue's own".to_owned();
        }
        BenchError::UnknownLaw {
            effect: kind.name,
            name: name.into(),
            hint,
            known,
        }
    }

    pub(super) fn unknown_parameter(kind: &Kind, key: &str) -> Self {
        let keys = kind
            .params
            .iter()
            .map(|param| param.name)
            .chain(["strength"]);
        let (hint, known) = nearest(key, keys);
        BenchError::UnknownParameter {
            effect: kind.name,
            key: key.into(),
            hint,
            known,
        }
    }
}

/// The hint at the most similar name, if any is similar, and the list of all names.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> (String, String) {
    let known: Vec<&str> = known.collect();
    let hint = known
        .iter()
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| format!("; did you mean `{candidate}`?"))
        .unwrap_or_default();
    (hint, known.join(", "))
}
