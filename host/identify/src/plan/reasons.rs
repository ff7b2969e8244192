//! Explains why the best excitation separates, or names the remedy where none does.

use super::excitation::Excitation;
use super::hypothesis::Hypothesis;
use shared::effects::{Kind, Place};
use shared::excite::{Experiment, Shape};

/// Words of `Description::exposed_by` that tell of a shape.
fn words(shape: Shape) -> &'static [&'static str] {
    match shape {
        Shape::Rest => &["rest", "hold"],
        Shape::Step => &["step"],
        Shape::Steps { open: false } => &["steps", "zero command", "braking"],
        Shape::Steps { open: true } => &["coasting", "bridge open", "with it open"],
        Shape::Staircase { .. } => &["staircase", "speeds", "levels"],
        Shape::Triangle { .. } => &["triangle", "creeping", "slow"],
        Shape::Reversals { .. } => &["reversals", "square waves", "braking"],
        Shape::Chirp { .. } => &["chirp"],
        Shape::Telegraph { .. } => &["levels", "commands of at least four sizes"],
        Shape::Multisine { .. } => &["multisine"],
    }
}

/// One sentence on why the excitation separates the hypotheses.
pub fn why(excitation: &Excitation, hypotheses: &[Hypothesis]) -> String {
    let driven = |part: &&Experiment| part.amplitude > 0.0 || part.shape == Shape::Rest;
    let parts: Vec<&Experiment> = excitation.parts.iter().filter(driven).collect();
    let mut reveals: Vec<&str> = Vec::new();
    for part in &parts {
        let text = part.shape.reveals();
        if !reveals.contains(&text) {
            reveals.push(text);
        }
    }
    let fits = |kind: &Kind| {
        let exposed = kind.description().exposed_by;
        parts
            .iter()
            .any(|part| words(part.shape).iter().any(|word| exposed.contains(word)))
    };
    let mut exposed: Vec<String> = Vec::new();
    for kind in hypotheses
        .iter()
        .flat_map(|h| &h.effects)
        .filter(|k| fits(k))
    {
        let text = format!(
            "{} is exposed by {}",
            kind.name(),
            kind.description().exposed_by
        );
        if !exposed.contains(&text) {
            exposed.push(text);
        }
    }
    let mut sentence = format!("it shows {}", reveals.join(", and "));
    if !exposed.is_empty() {
        sentence += &format!(": {}", exposed.join(", "));
    }
    sentence
}

/// The measurement that separates two hypotheses which voltage and angle cannot, within the limits or at all.
pub fn remedy(a: &Hypothesis, b: &Hypothesis) -> String {
    let only = |of: &Hypothesis, other: &Hypothesis| -> Vec<Kind> {
        let absent = |kind: &&Kind| !other.effects.contains(kind);
        of.effects.iter().filter(absent).copied().collect()
    };
    let mut apart: Vec<Kind> = only(a, b).into_iter().chain(only(b, a)).collect();
    apart.sort_unstable();
    let measures = apart.iter().flat_map(|kind| kind.facts().told_from);
    let measures = measures.filter(|told| apart.iter().any(|&kind| told.other.is(kind)));
    let known = measures.filter_map(|told| told.measure).next();
    let placed =
        |places: &[Place]| (apart.iter()).any(|kind| places.contains(&kind.description().place));
    let text = if let Some(known) = known {
        known
    } else if placed(&[Place::Sensed]) {
        "an index pulse, or runs at several speeds: an error of the encoder stays at its angle, a torque does not"
    } else if placed(&[Place::Drive, Place::Winding])
        && placed(&[Place::Friction, Place::Torque, Place::Load])
    {
        "a current sensor: a voltage that is lost shows against the current, a torque does not"
    } else if placed(&[Place::Drive, Place::Winding]) {
        "a current sensor, or the same at two supply voltages"
    } else {
        "a known added inertia, which scales every torque but not the friction of the shaft"
    };
    text.to_owned()
}
