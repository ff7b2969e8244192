//! The supply's voltage sags under load.

use super::{At, Effect, Kind, Param, only_its_size};

/// The bridge chops the bus, so that it draws d·i with the duty cycle d = u/Vs, and the bus gives
/// Vs − Rs·d·i; the armature gets d times that: v = u − Rs·d²·i (averaged chopper; Mohan, Undeland and
/// Robbins, "Power Electronics", 2003, ch. 7). A braking motor lifts the bus by the same law, as on a battery.
struct SupplySag {
    resistance_ohm: f64,
    supply_v: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "supply_sag",
    about: "the supply's voltage falls with the current drawn from it",
    electrical: Some(|values, stall| {
        values[0] * (stall.command_v / stall.supply_v).powi(2) * stall.current_a
    }),
    params: &[Param {
        name: "resistance",
        unit: "ohm",
        about: "internal resistance Rs of the supply and its leads",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 0.06 * machine.resistance_ohm,
    }],
    other_laws: &[],
    build: |values, machine| {
        Box::new(SupplySag {
            resistance_ohm: values[0],
            supply_v: machine.supply_v,
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| {
        let supply = machine.supply_v;
        vec![values[0] / machine.resistance_ohm / (supply * supply)]
    },
};

impl Effect for SupplySag {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        let duty = volts / self.supply_v;
        volts - self.resistance_ohm * duty * duty * at.current
    }
}
