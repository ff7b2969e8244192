//! An excitation: its experiments, its name and its commands.

use super::hypothesis::Setup;
use servoid_io::output::CommandSequence;
use shared::excite::{Command, Experiment, Shape, commands};
use std::fmt;

/// Steps with the bridge open in their pauses.
pub(super) const COAST: Shape = Shape::Steps { open: true };

/// An excitation: experiments one after the other. Amplitudes are parts of the supply.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// The experiments.
    pub parts: Vec<Experiment>,
}

impl Excitation {
    /// The same with every amplitude `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Self {
        let part = |e: &Experiment| Experiment {
            amplitude: e.amplitude * factor,
            ..*e
        };
        Excitation {
            parts: self.parts.iter().map(part).collect(),
        }
    }

    /// One command a sample. The seed matters to telegraphs only.
    pub fn drive(&self, sample_s: f64, seed: u64) -> Vec<Command<f64>> {
        commands(&self.parts, sample_s, seed).collect()
    }

    /// The commands in volts, sample by sample.
    pub fn commands(&self, setup: &Setup, seed: u64) -> CommandSequence {
        let drive = self.drive(setup.sample_s, seed);
        let coasts = drive.iter().any(|command| !command.enabled);
        CommandSequence {
            time_s: (0..drive.len())
                .map(|k| k as f64 * setup.sample_s)
                .collect(),
            voltage_v: drive.iter().map(|c| c.drive * setup.supply_v).collect(),
            enabled: coasts.then(|| drive.iter().map(|command| command.enabled).collect()),
        }
    }

    /// True if the bridge opens at any time.
    pub fn coasts(&self) -> bool {
        self.parts.iter().any(|part| part.shape == COAST)
    }
}

/// As in `triangle at 25 % for 8 s, coast at 100 % for 12 s`.
impl fmt::Display for Excitation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, same) in self.parts.chunk_by(|a, b| a == b).enumerate() {
            let (part, times) = (&same[0], same.len());
            if k > 0 {
                write!(f, ", ")?;
            }
            if times > 1 {
                write!(f, "{times} times ")?;
            }
            match part.shape {
                Shape::Rest => write!(f, "rest")?,
                shape => write!(f, "{} at {} %", name(shape), short(100.0 * part.amplitude))?,
            }
            write!(f, " for {} s", short(part.seconds))?;
        }
        Ok(())
    }
}

/// Three decimals at most, and none that are zero.
fn short(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

fn name(shape: Shape) -> String {
    match shape {
        Shape::Rest => "rest".to_owned(),
        Shape::Step => "step".to_owned(),
        Shape::Steps { open: false } => "steps".to_owned(),
        Shape::Steps { open: true } => "coast".to_owned(),
        Shape::Staircase { .. } => "staircase".to_owned(),
        Shape::Triangle { waves: 1 } => "triangle".to_owned(),
        Shape::Triangle { waves } => format!("{waves} triangles"),
        Shape::Reversals { count } => format!("{count} reversals"),
        Shape::Chirp { .. } => "chirp".to_owned(),
        Shape::Telegraph { .. } => "telegraph".to_owned(),
        Shape::Multisine { .. } => "multisine".to_owned(),
    }
}
