//! The recordings of a demonstration: a gearmotor of the virtual bench with something hidden in it.

use crate::excitation;
use crate::record::Record;
use crate::recording::Recording;
use servoid_plant::{Bench, BenchError, Hidden, Machine};
use shared::excite::COMMISSIONING;

/// Sample interval, s.
const INTERVAL_S: f64 = 1e-3;
/// Encoder counts per revolution.
pub const COUNTS_PER_REV: u32 = 2000;

/// The motor.
pub fn machine() -> Machine {
    Machine::gearmotor()
}

/// One recording of it with `hidden` in it; `name` is its source.
///
/// # Errors
/// Parameters of a hidden effect that the bench refuses.
pub fn record(hidden: &[Hidden], seed: u64, name: &str) -> Result<Recording, BenchError> {
    let machine = machine();
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = COUNTS_PER_REV;
    bench.sample_s = INTERVAL_S;
    bench.seed = seed;
    bench.effects = hidden.to_vec();
    let drive = excitation::drive(&COMMISSIONING, INTERVAL_S, seed, machine.supply_v);
    bench.record(&drive, name, false)
}
