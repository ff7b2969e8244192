//! Laws over the whole catalogue of effects.

mod motors;

use motors::{BENCHES, Bench};
use shared::effects::{EffectSet, Kind};
use shared::excite::{COMMISSIONING, commands};
use shared::model::{Model, Plan, State};

const INTERVAL: f64 = 1e-3;

/// Readings in counts under the commissioning mix, with typical parameters of the effects.
fn readings(bench: &Bench, kinds: &[Kind]) -> Vec<f64> {
    let no_load = bench.supply * bench.physical.machine().response().gain;
    let mut effects = EffectSet::default();
    for kind in kinds {
        let parameters = kind.description().parameters.iter();
        let values: Vec<f64> = parameters
            .map(|p| p.scaled(p.typical, bench.supply, no_load))
            .collect();
        effects.push(*kind, &values).expect("a valid effect");
    }
    let plan = Plan {
        effects,
        substeps: 2,
        ..Plan::linear(bench.physical.machine(), bench.units(INTERVAL))
    };
    let model = Model::<f64>::new(&plan).expect("a valid model");
    let mut state = State::default();
    commands::<f64>(&COMMISSIONING, INTERVAL, 1)
        .map(|command| {
            model.step(&mut state, command.drive, !command.enabled);
            model.reading(&state)
        })
        .collect()
}

/// A hook whose need was not declared is asked only if another effect declares it.
#[test]
fn every_effect_acts_alone_and_in_company() {
    for bench in &BENCHES {
        let bare = readings(bench, &[]);
        for &kind in Kind::ALL {
            for companion in [None, Some(Kind::Coulomb), Some(Kind::Windage)] {
                let with: Vec<Kind> = companion.into_iter().chain([kind]).collect();
                let without = companion.map_or(bare.clone(), |kind| readings(bench, &[kind]));
                let most = readings(bench, &with)
                    .iter()
                    .zip(&without)
                    .fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                let case = format!("{}: {} beside {companion:?}", bench.name, kind.name());
                assert!(most > 0.1, "{case} changes {most} counts at most");
            }
        }
    }
}
