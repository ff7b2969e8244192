//! Where the search for a new effect's parameters starts.

use super::settings::{AMPLITUDE, LINES};
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, ScreenedModel};
use crate::diagnose::spectrum::orders;
use shared::effects::{Kind, Starts};

/// Starts for the parameters of `kind`, SI, beside the model `parent`. `first` is that with the simpler effect from which some
/// effects start.
pub fn starts(
    context: &Context<'_>,
    parent: &FittedModel,
    kind: Kind,
    first: Option<&ScreenedModel>,
) -> Vec<Vec<f64>> {
    let data = context.data;
    let parameters = kind.parameters();
    let typical: Vec<f64> = parameters
        .iter()
        .map(|p| {
            let share = if p.amplitude { AMPLITUDE } else { 1.0 };
            p.scaled(p.typical * share, data.supply, data.units.speed)
        })
        .collect();
    match kind.facts().starts {
        Starts::Typical => vec![typical],
        Starts::Shares(axes) => axes.iter().fold(vec![typical], |starts, &(index, shares)| {
            let along = |start: &Vec<f64>| -> Vec<Vec<f64>> {
                let at = |&share: &f64| {
                    let mut values = start.clone();
                    values[index] *= share;
                    values
                };
                shares.iter().map(at).collect()
            };
            starts.iter().flat_map(along).collect()
        }),
        Starts::AngleOrders => orders::lines(data, &parent.candidate)
            .iter()
            .filter(|line| line.order > 1)
            .take(LINES)
            .map(|line| vec![line.cosine, line.sine, line.order as f64])
            .collect(),
        Starts::Fit(_) => fitted_first(kind, typical, first).into_iter().collect(),
    }
}

/// Typical values, but what the effect has in common with a simpler one as the model with that has it.
fn fitted_first(kind: Kind, typical: Vec<f64>, first: Option<&ScreenedModel>) -> Option<Vec<f64>> {
    let simpler = kind.facts().starts.after()?;
    let contained = kind.containing(simpler)?;
    let screened = first?;
    let found = screened.structure.values(&screened.x);
    let found = screened.structure.effect_values(&found);
    let own = &found[found.len().saturating_sub(contained.values.len())..];
    let mut values = typical;
    for (value, found) in contained.values.iter().zip(own) {
        for place in value.places() {
            values[place] = *found;
        }
    }
    Some(values)
}
