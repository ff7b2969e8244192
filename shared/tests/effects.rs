//! Laws over the whole catalogue of effects.

mod motors;

use motors::{BENCHES, Bench, INTERVAL, furthest, run};
use shared::effects::Kind;
use shared::excite::{COMMISSIONING, commands};

/// Readings in counts under the commissioning mix, with typical parameters of the effects.
fn readings(bench: &Bench, kinds: &[Kind]) -> Vec<f64> {
    let values: Vec<Vec<f64>> = kinds.iter().map(|kind| bench.typical(*kind)).collect();
    let effects: Vec<(Kind, &[f64])> = kinds
        .iter()
        .copied()
        .zip(values.iter().map(Vec::as_slice))
        .collect();
    let drive: Vec<_> = commands::<f64>(&COMMISSIONING, INTERVAL, 1).collect();
    run::<f64>(&bench.plan(&effects, 2), &drive)
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
                let most = furthest(&readings(bench, &with), &without);
                let case = format!("{}: {} beside {companion:?}", bench.name, kind.name());
                assert!(most > 0.1, "{case} changes {most} counts at most");
            }
        }
    }
}
