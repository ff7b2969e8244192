//! Laws of stated effects: what runs is what was written, in every number format, beside the catalogue's own code.

mod faults;
mod fuzz;
mod motions;

use shared::effects::{EffectSet, Kind};
use shared::model::Plan;
use shared::motor::Machine;
use shared::units::PerUnit;

const SUPPLY: f64 = 24.0;
const FASTEST: f64 = 800.0;
const INTERVAL: f64 = 1e-3;
const COUNTS: f64 = 4096.0;

fn plan(kinds: &[(Kind, Vec<f64>)]) -> Plan<f64> {
    let units = PerUnit::new(SUPPLY, FASTEST, INTERVAL, COUNTS).unwrap();
    let machine = Machine {
        kb: 0.03,
        damping: 0.002,
        inertia: 1.1e-3,
        electrical: 0.7e-3,
    };
    let mut plan = Plan::linear(machine, units);
    let mut effects = EffectSet::default();
    for (kind, values) in kinds {
        effects.push(*kind, values).unwrap();
    }
    plan.effects = effects;
    plan
}
