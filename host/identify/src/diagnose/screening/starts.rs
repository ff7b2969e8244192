//! Where the search for a new effect's parameters starts.

use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, ScreenedModel};
use crate::diagnose::spectrum::orders;
use shared::effects::Kind;
use shared::units::Quantity;

/// Lines of the angle's spectrum that are tried.
const LINES: usize = 3;
/// Part of the typical amplitude to start from.
const AMPLITUDE: f64 = 0.5;

/// Starts for the parameters of `kind`, SI, beside the model `parent`.
pub fn starts(
    context: &Context<'_>,
    parent: &FittedModel,
    kind: Kind,
    dry: &[ScreenedModel],
) -> Vec<Vec<f64>> {
    let data = context.data;
    let parameters = kind.description().parameters;
    let typical: Vec<f64> = parameters
        .iter()
        .map(|p| {
            let share = if p.amplitude { AMPLITUDE } else { 1.0 };
            p.scaled(p.typical * share, data.supply, data.units.speed)
        })
        .collect();
    if kind == Kind::Lugre {
        return bristles(parent, &typical, dry);
    }
    if let Some(axes) = several(kind) {
        return axes.iter().fold(vec![typical], |starts, &(index, shares)| {
            let along = |start: &Vec<f64>| -> Vec<Vec<f64>> {
                let at = |&share: &f64| {
                    let mut values = start.clone();
                    values[index] *= share;
                    values
                };
                shares.iter().map(at).collect()
            };
            starts.iter().flat_map(along).collect()
        });
    }
    match parameters
        .iter()
        .position(|p| p.quantity == Quantity::PerRev)
    {
        None => vec![typical],
        Some(_) => orders::lines(data, &parent.candidate)
            .iter()
            .filter(|line| line.order > 1)
            .take(LINES)
            .map(|line| vec![line.cosine, line.sine, line.order as f64])
            .collect(),
    }
}

/// Effects whose cost has several valleys: parameters, each with the shares of its typical value to start from.
fn several(kind: Kind) -> Option<&'static [(usize, &'static [f64])]> {
    match kind {
        Kind::VoltageSat => Some(&[(0, &[1.0, 0.7, 0.5])]),
        Kind::Backlash => Some(&[(0, &[1.0, 0.4]), (1, &[1.0, 0.4, 1.75]), (2, &[1.0, 0.3])]),
        Kind::Compliance => Some(&[(0, &[1.0, 2.0, 0.5, 0.25]), (1, &[1.0, 0.4, 1.75])]),
        Kind::BrushDrop => Some(&[(1, &[1.0, 0.2])]),
        Kind::Stribeck => Some(&[(2, &[1.0, 4.0])]),
        _ => None,
    }
}

/// Bristles slide as dry friction does: their torque, and what they hold more at rest, start at what dry
/// friction alone would have.
fn bristles(parent: &FittedModel, typical: &[f64], dry: &[ScreenedModel]) -> Vec<Vec<f64>> {
    let of_parent =
        |screened: &&ScreenedModel| screened.structure.effects.starts_with(&parent.effects);
    let best = |kind: Kind| {
        dry.iter()
            .filter(of_parent)
            .find(|screened| screened.newest() == Some(kind))
    };
    let own = |screened: &ScreenedModel, count: usize| {
        let values = screened.structure.values(&screened.x);
        let values = screened.structure.effect_values(&values);
        values[values.len().saturating_sub(count)..].to_vec()
    };
    let mut starts = Vec::new();
    if let Some(screened) = best(Kind::Coulomb) {
        let mut values = typical.to_vec();
        values[..1].copy_from_slice(&own(screened, 1));
        starts.push(values);
    }
    starts
}
