//! What can be told of effects, as text.

use super::fold::folded;
use super::style::{HEADING, painted};
use crate::schema::effects::{EffectFacts, Effects};

/// A line for each effect, or all of the only one.
pub fn text(effects: &Effects) -> String {
    if let [only] = &effects.effects[..] {
        return one(only);
    }
    let names = effects.effects.iter().map(|effect| effect.name.len());
    let width = names.max().unwrap_or(0);
    let mut out = String::new();
    for effect in &effects.effects {
        out += &format!("  {:width$}  {}\n", effect.name, effect.title);
    }
    out + "\nservoid effects NAME tells all of one.\n"
}

fn one(effect: &EffectFacts) -> String {
    let mut out = format!("{}: {}\n", painted(HEADING, &effect.name), effect.title);
    let parameters: Vec<String> = (effect.parameters.iter())
        .map(|p| format!("{} ({})", p.name, p.unit))
        .collect();
    let told: Vec<String> = (effect.told_from.iter())
        .flat_map(|told| {
            let measure = told.measure.iter().map(|m| format!("; or {m}"));
            [format!("{}: {}", told.other, told.record)]
                .into_iter()
                .chain(measure)
        })
        .collect();
    for (name, text) in [
        ("acts on", effect.acts_on.clone()),
        ("equation", effect.equation.clone()),
        ("parameters", parameters.join(", ")),
        ("symptom", effect.symptom.clone()),
        ("experiment", effect.experiment.clone()),
        ("remedy", effect.remedy.clone()),
        ("look-alikes", effect.look_alikes.join(", ")),
        ("told from", told.join(" ")),
        ("source", effect.source.clone()),
    ] {
        if !text.is_empty() {
            out += &format!(
                "{}\n",
                folded(&format!("  {name:11}  {text}"), "               ")
            );
        }
    }
    out
}
