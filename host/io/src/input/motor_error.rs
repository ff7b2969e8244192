//! What can be wrong with a `motor.toml`, each with its remedy.

use std::io;

use super::place::Place;

/// A `motor.toml` that cannot be used: where, and why.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {fault}")]
pub struct MotorFileError {
    /// File, line and character.
    pub place: Box<Place>,
    /// What was seen there and what to do.
    pub fault: MotorFault,
}

impl MotorFileError {
    /// A fault at a place.
    pub(super) fn new(place: Place, fault: MotorFault) -> Self {
        MotorFileError {
            place: Box::new(place),
            fault,
        }
    }
}

/// What was seen in a `motor.toml`, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum MotorFault {
    /// The system refused to read it.
    #[error("cannot be read: {0}; check the path and its permissions")]
    Io(io::Error),
    /// The path is a folder.
    #[error("is a folder; name the motor file inside it")]
    Folder,
    /// Larger than any description of a motor.
    #[error("is larger than {limit} bytes, which no motor file is; is this the recording?")]
    TooBig {
        /// The limit in bytes.
        limit: u64,
    },
    /// Not UTF-8.
    #[error("is not UTF-8 text; save it as UTF-8")]
    NotText,
    /// Not TOML.
    #[error("this is not TOML: {0}; see https://toml.io")]
    Syntax(String),
    /// A key nobody reads.
    #[error("unknown key `{key}` {section}; {hint}")]
    UnknownKey {
        /// The key as written.
        key: String,
        /// Where it stands: at the top, or in which section.
        section: String,
        /// The nearest key, or the section it belongs to.
        hint: String,
    },
    /// A key that must be there is not.
    #[error("`{key}` is missing here; {remedy}")]
    MissingKey {
        /// The key.
        key: String,
        /// What to write.
        remedy: &'static str,
    },
    /// A value of the wrong type.
    #[error("`{key}` is {} {seen} here; write {wanted}", article(.seen))]
    WrongType {
        /// The key.
        key: String,
        /// TOML's name of the type seen.
        seen: &'static str,
        /// What is needed.
        wanted: &'static str,
    },
    /// Zero or negative where only a positive number has a meaning.
    #[error(
        "`{key}` is {value}; it must be greater than zero, so correct the number or leave the key out"
    )]
    NotPositive {
        /// The key.
        key: String,
        /// The value seen.
        value: f64,
    },
    /// NaN or infinity.
    #[error("`{key}` is {text}, not a finite number; correct the number or leave the key out")]
    NotFinite {
        /// The key.
        key: String,
        /// The value as written.
        text: String,
    },
    /// A word that is none of those allowed.
    #[error("`{key}` is \"{text}\"; {hint}")]
    UnknownWord {
        /// The key.
        key: String,
        /// The word seen.
        text: String,
        /// The nearest word, or all of them.
        hint: String,
    },
    /// An empty string where a name is needed.
    #[error("`{key}` is empty; write the column's name in the recording, or leave the key out")]
    EmptyName {
        /// The key.
        key: String,
    },
    /// A tolerance that says nothing.
    #[error(
        "tolerance is {value}, but it is relative to the value: write 0.05 for 5 % (less than 1)"
    )]
    Tolerance {
        /// The value seen.
        value: f64,
    },
    /// The command's unit cannot drive this kind of amplifier.
    #[error("the command is in {unit:?}, but the drive's kind is {kind:?}; {remedy}")]
    DriveUnit {
        /// Unit of the command.
        unit: &'static str,
        /// Kind of the drive.
        kind: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A key that this kind of drive has no use for.
    #[error("`{key}` does not go with a drive of kind {kind:?}; {remedy}")]
    NotOfDrive {
        /// The key.
        key: &'static str,
        /// Kind of the drive.
        kind: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A position loop needs angles.
    #[error(
        "the angle is a speed here, but a position loop acts on the angle itself; log the angle, or the voltage that the \
             drive gave"
    )]
    SpeedBehindLoop,
    /// A selection of rows that is none.
    #[error("`select` is \"{text}\"; write COLUMN=VALUE, as in \"joint=2\"")]
    Selection {
        /// As written.
        text: String,
    },
    /// A span that holds nothing.
    #[error("the span from {from} s to {to} s holds nothing; `to_s` must be greater than `from_s`")]
    Span {
        /// Its start, s.
        from: f64,
        /// Its end, s.
        to: f64,
    },
    /// `kt_equals_kb` contradicts the two values given.
    #[error(
        "kt_equals_kb says that kt and kb are one number, but kt_n_m_a is {kt} and kb_v_s_rad is {kb}; in SI units \
         they are equal: correct one, leave one out, or remove kt_equals_kb"
    )]
    UnequalConstants {
        /// Torque constant, N·m/A.
        kt: f64,
        /// Back-EMF constant, V·s/rad.
        kb: f64,
    },
}

fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    }
}
