//! Where the search for a new effect's parameters starts.

use super::orders;
use crate::problem::{Candidate, Data};
use shared::effects::Kind;
use shared::units::Quantity;

/// Lines of the angle's spectrum that are tried.
const LINES: usize = 3;
/// Part of the typical amplitude to start from.
const AMPLITUDE: f64 = 0.5;

/// Starts for the parameters of `kind`, SI, beside the model `current`.
pub fn starts(data: &Data, current: &Candidate, kind: Kind) -> Vec<Vec<f64>> {
    let description = kind.description();
    let typical: Vec<f64> = description
        .parameters
        .iter()
        .map(|p| {
            let share = if p.amplitude { AMPLITUDE } else { 1.0 };
            p.scaled(p.typical * share, data.supply, data.units.speed)
        })
        .collect();
    let order = description
        .parameters
        .iter()
        .position(|p| p.quantity == Quantity::PerRev);
    match order {
        None => vec![typical],
        Some(order) => orders::lines(data, current)
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
