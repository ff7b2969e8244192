//! Excitations by their names, and what an amplifier is told to do by one.

use servoid_plant::DriveSample;
use shared::excite::{COMMISSIONING, COMMISSIONING_COAST, Experiment, Shape, commands};

/// Sequences of several shapes.
const SEQUENCES: [(&str, &[Experiment]); 2] = [
    ("commissioning", &COMMISSIONING),
    ("commissioning-coast", &COMMISSIONING_COAST),
];
/// Usual length of a single shape, s.
const USUAL_SECONDS: f64 = 10.0;

/// All names.
pub fn names() -> impl Iterator<Item = &'static str> {
    let sequences = SEQUENCES.iter().map(|(name, _)| *name);
    sequences.chain(Shape::ALL.iter().map(|(name, _)| *name))
}

/// The experiments of one, at their usual length; `None` of an unknown name.
pub fn named(name: &str) -> Option<Vec<Experiment>> {
    if let Some((_, sequence)) = SEQUENCES.iter().find(|(known, _)| *known == name) {
        return Some(sequence.to_vec());
    }
    let (_, shape) = Shape::ALL.iter().find(|(known, _)| *known == name)?;
    Some(vec![Experiment {
        shape: *shape,
        seconds: USUAL_SECONDS,
        amplitude: 1.0,
    }])
}

/// Length of some experiments, s.
pub fn length(plan: &[Experiment]) -> f64 {
    plan.iter().map(|part| part.seconds).sum()
}

/// The same stretched to `seconds`, with drives of this part of theirs.
pub fn stretched(plan: &[Experiment], seconds: f64, amplitude: f64) -> Vec<Experiment> {
    let usual = length(plan);
    let stretch = |part: &Experiment| Experiment {
        seconds: part.seconds * seconds / usual,
        amplitude: part.amplitude * amplitude,
        ..*part
    };
    plan.iter().map(stretch).collect()
}

/// What an amplifier is told sample by sample, its full drive being `full` (V, A, or rad of a target).
pub fn drive(plan: &[Experiment], sample_s: f64, seed: u64, full: f64) -> Vec<DriveSample> {
    let told = commands::<f64>(plan, sample_s, seed).map(|command| DriveSample {
        volts: command.drive * full,
        enabled: command.enabled,
    });
    told.collect()
}
