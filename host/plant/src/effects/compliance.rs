//! Compliance: the load hangs on an elastic shaft.

use super::{Effect, Kind, Param};
use crate::coupling::{LOAD_FRICTION, share_alone};
use crate::{Coupling, Machine};
use std::f64::consts::TAU;

/// Part of the inertia is the load's, driven by k·δ + d·δ̇ through the twist δ = θ − θl (two-mass system;
/// Ellis, "Control System Design Guide", 2012, ch. 16). The encoder sits on the motor side.
struct Compliance {
    compliance_rad_n_m: f64,
    load_share: f64,
    damping_ratio: f64,
    friction_n_m: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "compliance",
    about: "an elastic shaft between the motor and its load",
    electrical: None,
    params: &[
        Param {
            name: "compliance",
            unit: "rad/(N*m)",
            about: "compliance 1/k of the shaft",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: typical_compliance,
        },
        Param {
            name: "load_share",
            unit: "1",
            about: "share of the machine's inertia behind the shaft",
            scales: false,
            range: (0.01, 0.99),
            typical: |_| TYPICAL_SHARE,
        },
        Param {
            name: "damping",
            unit: "1",
            about: "damping ratio of the oscillation of the two inertias",
            scales: false,
            range: (0.0, 2.0),
            typical: |_| 0.05,
        },
        LOAD_FRICTION,
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(Compliance {
            compliance_rad_n_m: values[0],
            load_share: values[1],
            damping_ratio: values[2],
            friction_n_m: values[3],
        })
    },
    draw: |_, _, random| {
        vec![
            ("load_share", random.uniform(0.2, 0.7)),
            ("damping", random.log_uniform(0.02, 0.2)),
        ]
    },
    truth: |values, machine, _| {
        let share = values[1];
        let reduced = share * (1.0 - share) * machine.inertia_kg_m2;
        let period = TAU * (values[0] * reduced).sqrt();
        vec![period, share, values[2], share_alone(values[3])]
    },
};

const TYPICAL_SHARE: f64 = 0.4;

/// Lets the two inertias swing against each other at 30 Hz.
fn typical_compliance(machine: &Machine) -> f64 {
    let reduced = TYPICAL_SHARE * (1.0 - TYPICAL_SHARE) * machine.inertia_kg_m2;
    1.0 / (reduced * (TAU * 30.0).powi(2))
}

impl Effect for Compliance {
    fn coupling(&self) -> Option<Coupling> {
        (self.compliance_rad_n_m > 0.0).then_some(Coupling {
            load_share: self.load_share,
            compliance_rad_n_m: self.compliance_rad_n_m,
            damping_ratio: self.damping_ratio,
            half_gap_rad: 0.0,
            friction_n_m: self.friction_n_m,
        })
    }
}
