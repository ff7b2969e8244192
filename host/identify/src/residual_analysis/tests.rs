//! The drawings, against a motor of which the bench knows everything.

use super::*;
use crate::diagnose::evidence::sentence;
use crate::truth;
use servoid_io::excitation;
use servoid_io::record::Record;
use servoid_plant::{Bench, Hidden, Machine};
use shared::effects::{EffectSet, Kind};
use shared::excite::COMMISSIONING;

/// What the true linear machine misses, and what the true model does, with one effect hidden.
fn missing(kind: Kind) -> (ResidualAnalysis, ResidualAnalysis) {
    let machine = Machine::gearmotor();
    let hidden = Hidden::typical(kind.name(), &machine).expect("an effect");
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = 8000;
    bench.sample_s = 1e-3;
    bench.effects = vec![hidden.clone()];
    let drive = excitation::drive(&COMMISSIONING, 1e-3, 5, machine.supply_v);
    let recording = bench.record(&drive, "bench", false).expect("a recording");
    let data = Data::new(&recording).expect("data");
    let linear = Candidate {
        machine: truth::physical(&machine).machine(),
        effects: EffectSet::default(),
        start_speed: 0.0,
        start_offset: 0.0,
    };
    let mut complete = linear;
    let values = hidden.truth(&machine, 8000);
    complete.effects.push(kind, &values).expect("one effect");
    let look = |candidate| analyse_residual(&data, candidate, &complete, Method::default());
    (
        look(&linear).expect("it runs"),
        look(&complete).expect("it runs"),
    )
}

#[test]
fn what_is_missing_goes_with_what_the_effect_acts_on_and_is_gone_with_it() {
    for (kind, against, least) in [
        (Kind::Coulomb, Against::Speed, 0.8),
        (Kind::Windage, Against::Speed, 0.8),
        (Kind::OffsetVoltage, Against::Speed, 0.9),
        (Kind::VoltageSat, Against::Voltage, 0.5),
    ] {
        let (without, with) = missing(kind);
        let share = without.map(against).map_or(0.0, |map| map.share);
        assert!(share > least, "{}: {share}, {without:?}", kind.name());
        assert!(without.volts_rms > 2.0 * without.perfect_volts_rms);
        let ratio = with.volts_rms / with.perfect_volts_rms;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio}", kind.name());
        assert!(with.most().is_none_or(|map| map.share < 0.5), "{with:?}");
    }
}

#[test]
fn what_each_quantity_explains_sums_to_no_more_than_all() {
    for kind in [
        Kind::Coulomb,
        Kind::Windage,
        Kind::VoltageSat,
        Kind::Heating,
    ] {
        let (without, _) = missing(kind);
        let sum: f64 = without.maps.iter().map(|map| map.own_share).sum();
        assert!((0.0..=1.0 + 1e-12).contains(&sum), "{kind:?}: {sum}");
        let instant = |map: &&Map| map.beyond_chance && !map.against.turned();
        let first = without.maps.iter().find(instant);
        let first = first.expect("a map of speed, voltage or current");
        assert!(
            (first.own_share - first.share).abs() < 0.1,
            "{kind:?}: {first:?}"
        );
        assert!(sum >= first.own_share, "{kind:?}: {without:?}");
        let unbelieved = without.maps.iter().filter(|map| !map.beyond_chance);
        assert!(unbelieved.into_iter().all(|map| map.own_share == 0.0));
    }
}

#[test]
fn a_sentence_is_said_only_of_what_the_drawing_shows() {
    let (coulomb, nothing) = missing(Kind::Coulomb);
    let said = sentence(Kind::Coulomb, &[], &coulomb).expect("it shows");
    assert!(said.contains("does not grow with it"), "{said}");
    let wrong = sentence(Kind::OffsetVoltage, &[], &coulomb).unwrap_or_default();
    assert!(!wrong.contains("same constant voltage"), "{wrong}");
    let (offset, _) = missing(Kind::OffsetVoltage);
    let said = sentence(Kind::OffsetVoltage, &[], &offset).expect("it shows");
    assert!(said.contains("same constant voltage"), "{said}");
    let empty = sentence(Kind::Coulomb, &[], &nothing).unwrap_or_default();
    assert!(!empty.contains("changes sign"), "{empty}");
}
