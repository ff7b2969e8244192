//! The power stage clips.

use super::{At, Effect, Kind, Param, only_its_size};

/// |v| ≤ Vs − ΔV: the stage does not reach the last ΔV below its supply, by its switches' drop or by a
/// limit on the duty cycle. Smaller commands pass unchanged.
struct VoltageSat {
    limit_v: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "voltage_sat",
    about: "large commands are clipped",
    electrical: Some(|values, stall| values[0] - (stall.supply_v - stall.command_v)),
    params: &[Param {
        name: "lost",
        unit: "V",
        about: "missing voltage ΔV below the supply",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 0.15 * machine.supply_v,
    }],
    build: |values, machine| {
        Box::new(VoltageSat {
            limit_v: (machine.supply_v - values[0]).max(0.0),
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.supply_v - values[0]],
};

impl Effect for VoltageSat {
    fn volts(&self, volts: f64, _: &At) -> f64 {
        volts.clamp(-self.limit_v, self.limit_v)
    }
}
