//! What everything is measured against.

use servoid_engine::problem::Data;
use shared::motor::Machine;

/// The paper's step, and the error that it is judged by: a scalar loop in f64.
pub fn cost(machine: &Machine<f64>, data: &Data) -> f64 {
    let machine = machine.lower(&data.units);
    let per_unit = data.units.counts_per_unit();
    let (mut current, mut speed, mut angle, mut sum) = (0.0, 0.0, data.counts[0], 0.0);
    for (volts, reading) in data.command.iter().zip(&data.counts) {
        sum += f64::abs(angle - reading);
        let rise = (volts - current - machine.kb * speed) / machine.electrical;
        let gain = (current - machine.damping * speed) / machine.inertia;
        angle += speed * per_unit;
        current += rise;
        speed += gain;
    }
    sum
}
