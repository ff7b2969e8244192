//! Gauge repeatability and reproducibility, where motors were recorded more than once: how much of what recordings differ by is the
//! measurement's (AIAG, Measurement Systems Analysis, 4th edition). A nested analysis of variance: recordings of one motor at one
//! station, stations (with operators) of one motor, motors; groups of unlike size by Searle's coefficients.

use crate::quantity::Table;
use crate::unit::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Standard deviations of a quantity by where they come from, in the quantity's scale: parts of the value where that is `log`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Gauge {
    /// The quantity.
    pub quantity: String,
    /// Motors that were recorded more than once.
    pub motors: usize,
    /// Their recordings.
    pub recordings: usize,
    /// Between recordings of one motor at one station by one operator.
    pub repeatability: f64,
    /// Between stations and operators; null where no motor was recorded at two.
    pub reproducibility: Option<f64>,
    /// Between motors.
    pub motor_to_motor: f64,
    /// Repeatability and reproducibility as a part of all, per cent: below 10 good, above 30 not acceptable (AIAG).
    pub percent: f64,
}

/// The gauge of each quantity; empty where no motor was recorded twice.
pub(crate) fn gauges(units: &[Unit], table: &Table, odd: &[bool]) -> Vec<Gauge> {
    (0..table.quantities.len())
        .filter_map(|k| {
            // Motor, then station and operator.
            let mut motors: BTreeMap<&str, BTreeMap<(&str, &str), Vec<f64>>> = BTreeMap::new();
            for (unit, reading) in table.column(k).filter(|(unit, _)| !odd[*unit]) {
                let labels = &units[unit].labels;
                if labels.serial.is_some() {
                    let place = (
                        labels.station.as_deref().unwrap_or(""),
                        labels.operator.as_deref().unwrap_or(""),
                    );
                    let motor = motors.entry(units[unit].motor()).or_default();
                    motor.entry(place).or_default().push(reading.y);
                }
            }
            let motors: Vec<Vec<Vec<f64>>> = motors
                .into_values()
                .map(|places| places.into_values().collect::<Vec<_>>())
                .filter(|places: &Vec<Vec<f64>>| places.iter().map(Vec::len).sum::<usize>() > 1)
                .collect();
            gauge(&table.quantities[k].name, &motors)
        })
        .collect()
}

fn gauge(quantity: &str, motors: &[Vec<Vec<f64>>]) -> Option<Gauge> {
    if motors.len() < 2 {
        return None;
    }
    let places = || motors.iter().flatten();
    let readings: usize = places().map(Vec::len).sum();
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let squares = |of: &[f64]| of.iter().map(|y| (y - mean(of)).powi(2)).sum::<f64>();
    let flat: Vec<Vec<f64>> = motors.iter().map(|places| places.concat()).collect();
    let of_places = places().count() - motors.len();
    let within = readings - places().count();
    let mean_square = |sum: f64, freedom: usize| (freedom > 0).then(|| sum / freedom as f64);
    let error = mean_square(places().map(|own| squares(own)).sum(), within);
    let between_places: f64 = motors
        .iter()
        .zip(&flat)
        .flat_map(|(places, all)| {
            let middle = mean(all);
            places
                .iter()
                .map(move |own| own.len() as f64 * (mean(own) - middle).powi(2))
        })
        .sum();
    let place = mean_square(between_places, of_places);
    // Without a repeat at one place, what places differ by holds the error as well.
    let repeatability = error.or(place)?;
    // Readings a place, as Searle (1971) counts groups of unlike size.
    let of_motor: f64 = (motors.iter().zip(&flat))
        .map(|(places, all)| {
            let own: f64 = places.iter().map(|own| (own.len() as f64).powi(2)).sum();
            own / all.len() as f64
        })
        .sum();
    let a_place = (readings as f64 - of_motor) / of_places.max(1) as f64;
    let reproducibility = place
        .zip(error)
        .map(|(place, error)| ((place - error) / a_place).max(0.0));
    let all = mean(&flat.concat());
    let motor_squares: f64 = flat
        .iter()
        .map(|own| own.len() as f64 * (mean(own) - all).powi(2))
        .sum();
    let motor = motor_squares / (motors.len() - 1) as f64;
    let sizes: f64 = flat.iter().map(|own| (own.len() as f64).powi(2)).sum();
    let a_motor = (readings as f64 - sizes / readings as f64) / (motors.len() - 1) as f64;
    let below = place.unwrap_or(repeatability).max(repeatability);
    let motor_to_motor = ((motor - below) / a_motor).max(0.0);
    let gauge = repeatability + reproducibility.unwrap_or(0.0);
    let total = gauge + motor_to_motor;
    (total > 0.0).then(|| Gauge {
        quantity: quantity.to_owned(),
        motors: motors.len(),
        recordings: readings,
        repeatability: repeatability.sqrt(),
        reproducibility: reproducibility.map(f64::sqrt),
        motor_to_motor: motor_to_motor.sqrt(),
        percent: 100.0 * (gauge / total).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng::{normal, seeded};

    #[test]
    fn what_was_put_in_is_found_again() {
        let mut rng = seeded(5);
        let mut draw = |spread: f64| spread * normal::<f64>(&mut rng);
        let motors: Vec<Vec<Vec<f64>>> = (0..400)
            .map(|motor| {
                let own = draw(1.0);
                (0..2 + motor % 2)
                    .map(|_| {
                        let place = draw(0.3);
                        (0..3).map(|_| own + place + draw(0.1)).collect()
                    })
                    .collect()
            })
            .collect();
        let found = gauge("x", &motors).unwrap();
        for (found, truth) in [
            (found.repeatability, 0.1),
            (found.reproducibility.unwrap(), 0.3),
            (found.motor_to_motor, 1.0),
        ] {
            assert!(
                (found / truth - 1.0).abs() < 0.12,
                "seed 5: {found} for {truth}"
            );
        }
    }
}
