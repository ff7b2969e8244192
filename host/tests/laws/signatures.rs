//! What the workbench draws of an effect: its own equation goes through what the recording asks for, for every effect that a quantity
//! tells; and a right model stays within the band of its cumulative error, which a wrong one leaves.

use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use servoid_identify::fit::scores::whole;
use servoid_identify::residual_analysis::{cumulative, signature};
use servoid_identify::truth;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use testing::length::cases;

/// The bench's recording with an effect hidden in it, and the model that is true of it.
fn recorded(hidden: &Hidden, seed: u64) -> (Data, Candidate, Kind) {
    let machine = showcase::machine();
    let recording =
        showcase::record(std::slice::from_ref(hidden), seed, "bench").expect("a recording");
    let kind = Kind::by_name(hidden.name()).expect("the catalogues agree");
    let candidate = truth::model(
        &machine,
        std::slice::from_ref(hidden),
        showcase::COUNTS_PER_REV,
    )
    .expect("a valid effect");
    (Data::new(&recording).expect("data"), candidate, kind)
}

/// Effects whose volts depend on no quantity that can be drawn: they pass by, or are no volts at all.
const NOT_DRAWN: [&str; 6] = [
    "backlash",
    "compliance",
    "delay",
    "l_sat",
    "missed_counts",
    "torque_sat",
];

#[test]
fn the_equation_of_an_effect_goes_through_what_the_recording_asks_for() {
    let machine = showcase::machine();
    let mut wrong = Vec::new();
    for &kind in Kind::ALL {
        for seed in 1..=cases(2, 1) {
            let hidden = Hidden::typical(kind.name(), &machine).expect("an effect");
            let (data, candidate, kind) = recorded(&hidden, seed);
            let name = kind.name();
            let Some(found) = signature(&data, &candidate, kind, Method::default()) else {
                if !NOT_DRAWN.contains(&name) {
                    wrong.push(format!("{name} is not drawn, seed {seed}"));
                }
                continue;
            };
            let most = found
                .curve
                .iter()
                .fold(0.0f64, |most, p| most.max(p.1.abs()));
            // Where the curve is level, and in bins that it covers.
            let mut off: Vec<f64> = (found.bins.iter())
                .filter_map(|bin| {
                    let inside = found
                        .curve
                        .iter()
                        .filter(|p| (bin.low..=bin.high).contains(&p.0));
                    let within: Vec<f64> = inside.map(|p| p.1).collect();
                    let mean = within.iter().sum::<f64>() / within.len() as f64;
                    (within.len() > 1).then(|| (bin.mean_v - mean).abs() / most)
                })
                .collect();
            off.sort_by(f64::total_cmp);
            let median = off.get(off.len() / 2).copied().unwrap_or(f64::INFINITY);
            println!(
                "{name}, seed {seed}: {:?} off by {median:.3} of {most:.4} V",
                found.axis
            );
            wrong.extend((median >= 0.3).then(|| format!("{name}, seed {seed}: {off:?}")));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_right_model_stays_within_the_band_and_a_wrong_one_leaves_it() {
    let hidden = Hidden::typical("coulomb", &showcase::machine()).expect("an effect");
    let mut outside = 0;
    let seeds = cases(30, 10);
    for seed in 1..=seeds {
        let (data, candidate, kind) = recorded(&hidden, seed);
        let leaves = |candidate: &Candidate| {
            let errors = whole(&data, candidate, Method::default()).expect("it runs");
            let residual: Vec<f64> = errors
                .iter()
                .map(|error| error - data.half_cell())
                .collect();
            let found = cumulative(&data, &residual, true);
            found.map(|curve| {
                let points = curve.share.iter().zip(&curve.band);
                let beyond = points.map(|(share, [low, high])| (low - share).max(share - high));
                beyond.fold(0.0f64, f64::max)
            })
        };
        let right = leaves(&candidate);
        let wrong = leaves(&candidate.without(kind));
        println!("seed {seed}: right {right:?}, wrong {wrong:?}");
        outside += usize::from(right.iter().any(|beyond| *beyond > 0.01));
        assert!(
            wrong.iter().any(|beyond| *beyond > 0.05),
            "seed {seed}: {wrong:?}"
        );
    }
    assert!(
        15 * outside <= seeds as usize,
        "{outside} of {seeds} right models leave the band by more than 1 %"
    );
}
