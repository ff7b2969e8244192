//! Magnetic saturation of the torque.

use super::{At, Effect, Kind, Law, Param, Winding, only_its_size};

/// T = Kt·Is·tanh(i/Is) with Is = 1/√(3·k3), a bounded law whose series begins with the cubic one,
/// Kt·(i − k3·i³): armature reaction bends the field, and large currents give less torque than their
/// share. The back-EMF keeps Kb.
struct TorqueSat {
    scale_per_a: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "torque_sat",
    about: "large currents give less torque than their share",
    electrical: None,
    params: &[Param {
        name: "cubic",
        unit: "1/A^2",
        about: "cubic coefficient k3",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 0.08 / machine.stall_current_a().powi(2),
    }],
    other_laws: &[Law {
        name: "quotient",
        about: "i/(1 + k3*i^2)",
        build: |values, _| {
            Box::new(QuotientTorqueSat {
                cubic_per_a2: values[0],
            })
        },
        form: Some(1.0),
    }],
    build: |values, _| {
        Box::new(TorqueSat {
            scale_per_a: (3.0 * values[0]).sqrt(),
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.per_square_volt(values[0]), 0.0],
};

impl Effect for TorqueSat {
    fn winding(&self, winding: &mut Winding, at: &At) {
        let bend = at.current * self.scale_per_a;
        if bend != 0.0 {
            winding.kt_n_m_a *= bend.tanh() / bend;
        }
    }
}

/// T = Kt·i/(1 + k3·i²): the flux falls as a magnetising curve of Fröhlich's form does when the armature's field
/// weakens it (Fitzgerald, Kingsley, Umans, "Electric Machinery", 2003, ch. 7). Its series begins with the same cubic.
struct QuotientTorqueSat {
    cubic_per_a2: f64,
}

impl Effect for QuotientTorqueSat {
    fn winding(&self, winding: &mut Winding, at: &At) {
        winding.kt_n_m_a /= 1.0 + self.cubic_per_a2 * at.current * at.current;
    }
}
