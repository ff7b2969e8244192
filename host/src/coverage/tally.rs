//! How the errors lie.

use super::condition::{Condition, Standardised};
use crate::prove::Count;
use servoid_identify::fit::cost_name;
use servoid_results::schema::coverage::{Condition as Row, Coverage, Covered};
use shared::cost::Cost;

/// The errors of all recordings, by the place of their condition, as a document.
pub fn tally(
    seed: u64,
    conditions: &[Condition],
    found: &[(usize, Option<Vec<Standardised>>)],
    interrupted: bool,
) -> Coverage {
    let row = |(place, condition): (usize, &Condition)| {
        let own = found.iter().filter(|(at, _)| *at == place);
        let errors: Vec<&[Standardised]> =
            own.filter_map(|(_, errors)| errors.as_deref()).collect();
        let parameters = errors.first().map_or(0, |errors| errors.len());
        Row {
            excitation: condition.excitation.to_owned(),
            seconds: condition.seconds,
            counts_per_rev: condition.counts_per_rev,
            effect: condition.effect.map(|kind| kind.name().to_owned()),
            cost: Some(condition.cost)
                .filter(|cost| *cost != Cost::Squared)
                .map(|cost| cost_name(cost).to_owned()),
            angle_noise_counts: Some(condition.angle_noise_counts).filter(|x| *x > 0.0),
            torque_noise: Some(condition.torque_noise).filter(|x| *x > 0.0),
            closed_loop: condition.closed_loop,
            parameters: (0..parameters).map(|k| covered(&errors, k)).collect(),
        }
    };
    let failures = found.iter().filter(|(_, errors)| errors.is_none()).count() as u64;
    Coverage {
        schema: "servoid.coverage/1".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed,
        recordings: found.len() as u64 - failures,
        failures,
        conditions: conditions.iter().enumerate().map(row).collect(),
        interrupted,
    }
}

/// Parameter `k` over all recordings.
fn covered(errors: &[&[Standardised]], k: usize) -> Covered {
    let of_parameter = errors.iter().filter_map(|errors| errors.get(k));
    let stated: Vec<Option<f64>> = of_parameter.map(|error| error.z).collect();
    let z: Vec<f64> = stated.iter().copied().flatten().collect();
    let name = (errors.first()).map_or_else(String::new, |errors| errors[k].name.clone());
    let not_stated = (stated.len() - z.len()) as u64;
    spread(name, z, not_stated)
}

/// How these errors lie, in standard errors.
pub fn spread(name: String, z: Vec<f64>, not_stated: u64) -> Covered {
    let count = z.len() as f64;
    let mean = z.iter().sum::<f64>() / count;
    let squares: f64 = z.iter().map(|z| (z - mean).powi(2)).sum();
    let some = |least: usize, x: f64| Some(x).filter(|_| z.len() >= least);
    Covered {
        name,
        within_1: Count::of(&z, |z| z.abs() <= 1.0).share("within_1"),
        within_2: Count::of(&z, |z| z.abs() <= 1.96).share("within_2"),
        not_stated,
        z_mean: some(1, mean),
        z_sd: some(2, (squares / (count - 1.0)).sqrt()),
        z,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prove::Draws;

    /// Errors that are as normal as they promise, and ones that are twice as large.
    #[test]
    fn normal_errors_are_covered_as_normal_errors_are() {
        let seed = 20_261_125;
        let mut draws = Draws::of(&[seed]);
        let mut normal = || (0..12).map(|_| draws.uniform(0.0, 1.0)).sum::<f64>() - 6.0;
        for (scale, expected) in [(1.0, 0.95), (2.0, 0.673)] {
            let found: Vec<(usize, Option<Vec<Standardised>>)> = (0..4000)
                .map(|_| {
                    let error = |z: Option<f64>| Standardised {
                        name: "gain".to_owned(),
                        z,
                    };
                    (0, Some(vec![error(Some(scale * normal())), error(None)]))
                })
                .collect();
            let document = tally(seed, &Condition::linear(), &found, false);
            let [gain, nothing] = &document.conditions[0].parameters[..] else {
                panic!("{document:?}");
            };
            let part = gain.within_2.rate.unwrap().part;
            assert!(
                (part - expected).abs() < 0.03,
                "seed {seed}, {scale}: {part}"
            );
            assert!(
                (gain.z_sd.unwrap() / scale - 1.0).abs() < 0.05,
                "seed {seed}"
            );
            assert_eq!((nothing.not_stated, nothing.z_sd), (4000, None));
            assert!(document.conditions[1].parameters.is_empty());
        }
    }
}
