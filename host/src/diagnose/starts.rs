//! Where the search for a new effect's parameters starts.

use super::orders;
use super::refit::Refit;
use super::workshop::Workshop;
use shared::effects::Kind;
use shared::units::Quantity;

/// Lines of the angle's spectrum that are tried.
const LINES: usize = 3;
/// Part of the typical amplitude to start from.
const AMPLITUDE: f64 = 0.5;

/// Starts for the parameters of `kind`, SI, beside the model `parent`.
pub fn starts(workshop: &Workshop<'_>, parent: &Refit, kind: Kind) -> Vec<Vec<f64>> {
    let data = workshop.data;
    let parameters = kind.description().parameters;
    let mut typical: Vec<f64> = parameters
        .iter()
        .map(|p| {
            let share = if p.amplitude { AMPLITUDE } else { 1.0 };
            p.scaled(p.typical * share, data.supply, data.units.speed)
        })
        .collect();
    if kind == Kind::Lugre {
        return friction(workshop, parent, &mut typical);
    }
    if let Some(shares) = several(kind) {
        let at = |&(index, share): &(usize, f64)| {
            let mut values = typical.clone();
            values[index] *= share;
            values
        };
        return shares.iter().map(at).collect();
    }
    match parameters
        .iter()
        .position(|p| p.quantity == Quantity::PerRev)
    {
        None => vec![typical],
        Some(order) => orders::lines(data, &parent.candidate)
            .iter()
            .filter(|line| line.order > 1)
            .take(LINES)
            .map(|line| {
                let mut values = typical.clone();
                values[order] = line.order as f64;
                values
            })
            .collect(),
    }
}

/// Effects whose cost has several valleys: a parameter, and the shares of its typical value to start from.
fn several(kind: Kind) -> Option<&'static [(usize, f64)]> {
    match kind {
        Kind::VoltageSat => Some(&[(0, 1.0), (0, 0.7), (0, 0.5)]),
        Kind::Backlash => Some(&[(2, 1.0), (2, 0.3), (1, 0.4)]),
        Kind::BrushDrop => Some(&[(1, 1.0), (1, 0.2)]),
        Kind::Stribeck => Some(&[(2, 1.0), (2, 4.0)]),
        _ => None,
    }
}

/// Bristles slide as dry friction does: their torque starts at what dry friction alone would have. None
/// where that explains little, since bristles cannot be led and cost much.
fn friction(workshop: &Workshop<'_>, parent: &Refit, typical: &mut [f64]) -> Vec<Vec<f64>> {
    if parent.effects.contains(&Kind::Coulomb) {
        return Vec::new();
    }
    let Some(dry) = workshop.sketch(parent, Kind::Coulomb) else {
        return Vec::new();
    };
    if dry.foreseen() > EXPLAINS * parent.rms_counts {
        return Vec::new();
    }
    let values = dry.structure.values(&dry.x);
    let torque = dry.structure.effect_values(&values).last().copied();
    typical[0] = torque.unwrap_or(typical[0]);
    vec![typical.to_vec()]
}

/// Part of the error that dry friction must at most leave for bristles to be tried.
const EXPLAINS: f64 = 0.5;
