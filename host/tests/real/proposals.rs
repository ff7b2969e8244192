//! What the workbench proposes beside a model of a real motor: what a diagnosis would believe, and nothing where only the motor's own
//! repeatability is left.

use crate::source::{data, elsewhere};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{Budget, Criterion, FloorKind, Suggestions, suggest};
use servoid_identify::fit::Options;
use servoid_identify::{Silent, identify_data};
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

fn beside(fitted: &Data, held_out: &Data, effects: &[Kind]) -> Suggestions {
    let stop = AtomicBool::new(false);
    let plain = Options::default();
    let criterion = Criterion::of(fitted, held_out, &plain, &Budget::usual(&stop));
    let options = Options {
        effects: effects.to_vec(),
        window_s: criterion.span.window_s,
        ..plain.clone()
    };
    let fit = identify_data(fitted, Some(held_out), &options, &Silent::default()).expect("a fit");
    let budget = Budget::usual(&stop);
    let found = suggest(
        fitted,
        held_out,
        &fit.candidate,
        &criterion,
        &plain,
        &budget,
        &|| (),
    );
    found.expect("proposals")
}

fn believed(found: &Suggestions) -> Vec<Kind> {
    let believed = found.list.iter().filter(|one| one.believed);
    believed.map(|one| one.effect).collect()
}

/// Of a kit's chirps friction that differs between the directions is what repeats of them confirm.
#[test]
fn what_is_not_believed_is_no_proposal() {
    let [Some(fitted), Some(held_out)] =
        ["chirp_1", "chirp_2"].map(|name| elsewhere(&format!("fra233_g04/{name}")))
    else {
        return;
    };
    let (fitted, held_out) = (data(&fitted), data(&held_out));
    let first = beside(&fitted, &held_out, &[]);
    assert!(
        believed(&first).contains(&Kind::Coulomb),
        "{:?}",
        believed(&first)
    );
    assert_eq!(
        first.floor.map(|floor| floor.kind),
        Some(FloorKind::Unknown)
    );
    let all = [Kind::Coulomb, Kind::OffsetVoltage, Kind::AsymViscous];
    let last = beside(&fitted, &held_out, &all);
    assert_eq!(believed(&last), []);
    assert_eq!(
        last.floor.map(|floor| floor.kind),
        Some(FloorKind::Repeatability)
    );
}
