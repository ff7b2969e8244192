//! Why a result cannot be exported, with the remedy.

use shared::error::ModelError;

/// Why a format cannot take a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// The format needs something that the result does not say.
    #[error("{format} needs {needs}, which this result does not determine; {remedy}")]
    Undetermined {
        /// The format.
        format: &'static str,
        /// What is missing.
        needs: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The amplifier closed a current loop, so that nothing is known in volts.
    #[error(
        "{format} needs a motor driven by a voltage, and this one was recorded behind a current loop; record it with a \
         voltage, or export to toml, json, csv, c, rust, modelica, gains or ros2-control"
    )]
    CurrentDriven {
        /// The format.
        format: &'static str,
    },
    /// Gains are asked of numbers that the device calls good for nothing.
    #[error(
        "{format} computes gains, and the device did not verify these numbers: {reason}. Commission again, or add --force"
    )]
    Unverified {
        /// The format.
        format: &'static str,
        /// Why they are no better.
        reason: String,
    },
    /// A loop that cannot be closed as asked.
    #[error("{0}")]
    Loop(String),
    /// A format for the motor's own winding, and another shaft.
    #[error(
        "{format} speaks of the motor's own winding and shaft; export it without --side output, and give the drive the gear"
    )]
    MotorSide {
        /// The format.
        format: &'static str,
    },
    /// A text that cannot be made.
    #[error("the text cannot be written: {0}; this is a defect of servoid, export to csv instead")]
    Text(String),
    /// A unit that nobody knows.
    #[error(
        "`{name}` is in `{unit}`, a unit that servoid does not know; run the verb that wrote the result again"
    )]
    Unit {
        /// The parameter.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// No step can be computed.
    #[error("the step of the linear machine cannot be computed: {0}; give another --sample")]
    Step(#[from] ModelError),
}

/// Remedy where a torque in N·m is needed.
pub(super) const NAME_RESISTANCE: &str = "fit again with --known resistance_ohm=… (an ohmmeter) and --kt-equals-kb or --known kt_n_m_a=… (a \
     datasheet), or with a current column";

/// Remedy where nothing is determined.
pub(super) const FIT_AGAIN: &str = "fit again: a longer recording with more changes of speed, or a search that converges (--algorithm lm)";
