//! Offset of the drive's output.

use super::{At, Effect, Kind, Param};

/// v = u + V0 while the bridge is enabled: an amplifier's offset or a duty cycle that is off centre.
struct OffsetVoltage {
    offset_v: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "offset_voltage",
    about: "a constant voltage is added to every command",
    electrical: Some(|values, _| -values[0]),
    params: &[Param {
        name: "offset",
        unit: "V",
        about: "added voltage V0",
        scales: true,
        range: (f64::NEG_INFINITY, f64::INFINITY),
        typical: |machine| 0.02 * machine.supply_v,
    }],
    other_laws: &[],
    build: |values, _| {
        Box::new(OffsetVoltage {
            offset_v: values[0],
        })
    },
    draw: |typical, _, random| vec![("offset", random.sign() * typical[0])],
    truth: |values, _, _| vec![values[0]],
};

impl Effect for OffsetVoltage {
    fn volts(&self, volts: f64, _: &At) -> f64 {
        volts + self.offset_v
    }
}
