//! The power stage clips.

use super::{At, Effect, Kind, Law, Param, only_its_size};

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
    other_laws: &[Law {
        name: "soft",
        about: "rounded: u/(1 + (u/V1)^6)^(1/6)",
        build: |values, machine| {
            Box::new(SoftVoltageSat {
                limit_v: (machine.supply_v - values[0]).max(0.0),
                none: values[0] == 0.0,
            })
        },
        form: Some(1.0),
    }],
    build: |values, machine| {
        Box::new(VoltageSat {
            limit_v: (machine.supply_v - values[0]).max(0.0),
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.supply_v - values[0], 0.0],
};

impl Effect for VoltageSat {
    fn volts(&self, volts: f64, _: &At) -> f64 {
        volts.clamp(-self.limit_v, self.limit_v)
    }
}

/// v = u/(1 + (u/V1)⁶)^(1/6): a stage that rounds before it clips (Rapp, "Effects of HPA nonlinearity", 1991, with
/// smoothness 3).
struct SoftVoltageSat {
    limit_v: f64,
    none: bool,
}

impl Effect for SoftVoltageSat {
    fn volts(&self, volts: f64, _: &At) -> f64 {
        if self.none {
            return volts;
        }
        volts / (1.0 + (volts / self.limit_v).powi(6)).powf(1.0 / 6.0)
    }
}
