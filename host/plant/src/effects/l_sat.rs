//! Saturation of the armature inductance.

use super::{At, Effect, Kind, Law, Param, Winding, only_its_size};

/// L(i) = L0/(1 + k·i²): the incremental inductance dλ/di of an iron path that saturates, alike in both
/// directions of the current, so that v = R·i + L(i)·di/dt + Kb·ω holds as it stands. It is the simplest
/// even form that stays positive.
struct LSat {
    falloff_per_a2: f64,
    /// R/L0 of the unsaturated winding, 1/s.
    rate_per_s: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "l_sat",
    about: "the inductance falls as the current grows",
    electrical: Some(|_, _| 0.0),
    params: &[Param {
        name: "falloff",
        unit: "1/A^2",
        about: "coefficient k; the inductance halves at 1/√k",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 1.0 / machine.stall_current_a().powi(2),
    }],
    other_laws: &[Law {
        name: "sech_squared",
        about: "L0/cosh^2(i*sqrt(k)), of a flux L0*Is*tanh(i/Is)",
        build: |values, machine| {
            Box::new(SechLSat {
                scale_per_a: values[0].sqrt(),
                rate_per_s: machine.resistance_ohm / machine.inductance_h,
            })
        },
        form: Some(1.0),
    }],
    build: |values, machine| {
        Box::new(LSat {
            falloff_per_a2: values[0],
            rate_per_s: machine.resistance_ohm / machine.inductance_h,
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.per_square_volt(values[0]), 0.0],
};

impl Effect for LSat {
    fn winding(&self, winding: &mut Winding, at: &At) {
        winding.inductance_h /= 1.0 + self.falloff_per_a2 * at.current * at.current;
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        // The winding's own R/L counts already; this leaves room for a current that grows within the substep.
        self.rate_per_s * self.falloff_per_a2 * at.current * at.current
    }
}

/// L(i) = L0/cosh²(i/Is) with Is = 1/√k: the slope of a flux linkage L0·Is·tanh(i/Is) (Jiles, "Introduction to
/// Magnetism and Magnetic Materials", 2015, ch. 5, with tanh for the Langevin function). Its series begins alike.
struct SechLSat {
    scale_per_a: f64,
    /// R/L0 of the unsaturated winding, 1/s.
    rate_per_s: f64,
}

impl SechLSat {
    /// cosh²(i/Is), kept where a winding still has some inductance.
    fn divisor(&self, current: f64) -> f64 {
        (current * self.scale_per_a).cosh().powi(2).min(50.0)
    }
}

impl Effect for SechLSat {
    fn winding(&self, winding: &mut Winding, at: &At) {
        winding.inductance_h /= self.divisor(at.current);
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        self.rate_per_s * (self.divisor(at.current) - 1.0)
    }
}
