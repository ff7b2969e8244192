//! Voltage drop of the brushes.

use super::{At, Effect, Kind, Law, Param};

/// v = u − Vb·sat(i/I0): linear up to the knee I0 and constant beyond, for both brushes together (Modelica
/// Standard Library, `Machines.Losses.DCMachines.Brush`).
struct BrushDrop {
    drop_v: f64,
    knee_a: f64,
    inductance_h: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "brush_drop",
    about: "a nearly constant voltage is lost against the current",
    electrical: Some(|values, _| values[0]),
    params: &[
        Param {
            name: "drop",
            unit: "V",
            about: "voltage drop Vb above the knee",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.04 * machine.supply_v,
        },
        Param {
            name: "knee",
            unit: "A",
            about: "current I0 at which the drop is reached",
            scales: false,
            range: (f64::MIN_POSITIVE, f64::INFINITY),
            typical: |machine| 0.01 * machine.stall_current_a(),
        },
    ],
    other_laws: &[Law {
        name: "tanh",
        about: "Vb*tanh(i/I0), smooth at the knee",
        build: |values, machine| {
            Box::new(SmoothBrushDrop {
                drop_v: values[0],
                knee_a: values[1],
                inductance_h: machine.inductance_h,
            })
        },
        form: Some(1.0),
    }],
    build: |values, machine| {
        Box::new(BrushDrop {
            drop_v: values[0],
            knee_a: values[1],
            inductance_h: machine.inductance_h,
        })
    },
    draw: |typical, _, random| vec![("knee", typical[1] * random.log_uniform(0.3, 3.0))],
    truth: |values, machine, _| vec![values[0], values[1] * machine.resistance_ohm, 0.0],
};

impl Effect for BrushDrop {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        volts - self.drop_v * (at.current / self.knee_a).clamp(-1.0, 1.0)
    }

    fn piece(&self, at: &At, _: f64) -> i8 {
        if self.drop_v == 0.0 {
            return 0;
        }
        i8::from(at.current > self.knee_a) - i8::from(at.current < -self.knee_a)
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        if at.current.abs() > 2.0 * self.knee_a {
            return 0.0;
        }
        self.drop_v / (self.knee_a * self.inductance_h)
    }
}

/// v = u − Vb·tanh(i/I0): the smooth curve that circuit simulators take for a contact (Hughes, Drury, "Electric
/// Motors and Drives", 2019, ch. 3, draws it rounded).
struct SmoothBrushDrop {
    drop_v: f64,
    knee_a: f64,
    inductance_h: f64,
}

impl Effect for SmoothBrushDrop {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        volts - self.drop_v * (at.current / self.knee_a).tanh()
    }

    // Wherever the current stands: nothing ends the step that reaches the bend, as the knee's event does above. Four times
    // the slope, since the bend is over within a time constant of it.
    fn stiffness_per_s(&self, _: &At) -> f64 {
        4.0 * self.drop_v / (self.knee_a * self.inductance_h)
    }
}
