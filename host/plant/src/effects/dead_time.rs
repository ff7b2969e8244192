//! Dead time of a switched bridge.

use super::{Effect, Kind, Machine, Param};
use crate::bridge::Bridge;

/// The bridge that gives the command as its mean, edge by edge. Nothing here is an average: what is lost follows from the circuit.
struct DeadTime {
    bridge: Bridge,
}

/// Currents below this part of that at stall are zero.
const NO_CURRENT: f64 = 1e-7;

pub(super) static KIND: Kind = Kind {
    name: "dead_time",
    about: "both transistors of a leg are off for a while at each edge",
    electrical: Some(|values, at| lost_v(values, at.supply_v)),
    params: &[
        Param {
            name: "dead_time",
            unit: "s",
            about: "time in which both transistors of a leg are off",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |_| 1e-6,
        },
        Param {
            name: "carrier",
            unit: "Hz",
            about: "frequency of the carrier",
            scales: false,
            range: (1e3, 1e6),
            typical: |_| 20e3,
        },
    ],
    other_laws: &[],
    build: |values, machine| {
        Box::new(DeadTime {
            bridge: Bridge {
                supply_v: machine.supply_v,
                period_s: 1.0 / values[1],
                dead_s: values[0],
                no_current_a: NO_CURRENT * machine.stall_current_a(),
            },
        })
    },
    draw: |typical, _, random| vec![("carrier", typical[1] * random.log_uniform(0.7, 1.5))],
    truth: |values, machine, _| vec![lost_v(values, machine.supply_v), ripple_v(values, machine)],
};

/// Two legs lose a dead time each in each carrier wave, V.
fn lost_v(values: &[f64], supply_v: f64) -> f64 {
    2.0 * values[0] * values[1] * supply_v
}

/// Reach of the ripple at half of the supply, as the voltage across the resistance, V: a quarter of the supply is left across the
/// inductance for a quarter of the carrier's period on either side of the mean.
fn ripple_v(values: &[f64], machine: &Machine) -> f64 {
    machine.supply_v * machine.resistance_ohm / (16.0 * machine.inductance_h * values[1])
}

impl Effect for DeadTime {
    fn bridge(&self) -> Option<Bridge> {
        // Without dead time the mean is all that the motor sees.
        (self.bridge.dead_s > 0.0).then_some(self.bridge)
    }
}
