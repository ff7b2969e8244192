//! Dead zone of the power stage.

use super::{At, Effect, Kind, Law, Param, only_its_size};

/// Commands within ±D give no voltage. Beyond, the output is v − D·sgn v, as in a bridge that loses
/// the same pulse width of every period, or the whole v with `cut = 1`, as in a stage that ignores
/// short pulses and passes long ones; values between mix the two (Tao and Kokotović, "Adaptive
/// Control of Systems with Actuator and Sensor Nonlinearities", 1996, ch. 2).
struct DeadZone {
    width_v: f64,
    cut: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "dead_zone",
    about: "small commands give no voltage",
    electrical: Some(|values, _| values[0]),
    params: &[
        Param {
            name: "width",
            unit: "V",
            about: "half width D of the zone",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.04 * machine.supply_v,
        },
        Param {
            name: "cut",
            unit: "1",
            about: "0: larger commands are shifted by D; 1: they pass whole",
            scales: false,
            range: (0.0, 1.0),
            typical: |_| 0.0,
        },
    ],
    other_laws: &[Law {
        name: "minimum_pulse",
        about: "commands beyond the zone pass whole",
        build: |values, _| {
            Box::new(DeadZone {
                width_v: values[0],
                cut: 1.0,
            })
        },
        form: None,
    }],
    build: |values, _| {
        Box::new(DeadZone {
            width_v: values[0],
            cut: values[1],
        })
    },
    draw: only_its_size,
    truth: |values, _, _| vec![values[0]],
};

impl Effect for DeadZone {
    fn volts(&self, volts: f64, _: &At) -> f64 {
        if volts.abs() <= self.width_v {
            0.0
        } else {
            volts - (1.0 - self.cut) * self.width_v.copysign(volts)
        }
    }
}
