//! Backlash: the load hangs behind a gap.

use super::{Effect, Kind, Param};
use crate::Coupling;
use crate::coupling::{LOAD_FRICTION, share_alone};
use std::f64::consts::TAU;

/// Part of the inertia is the load's, and it is driven only while the flanks touch: the torque passed on
/// is k·(δ ∓ α) + d·δ̇ beyond the half gap, never pulling, and 0 within (Nordin and Gutman, "Controlling
/// mechanical systems with backlash – a survey", Automatica 38(10), 2002). The encoder sits on the motor side.
/// The flanks are stiff and well damped, so that hardly more than the gap and the load's share matter.
struct Backlash {
    half_gap_rad: f64,
    load_share: f64,
    contact_hz: f64,
    damping_ratio: f64,
    inertia_kg_m2: f64,
    friction_n_m: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "backlash",
    about: "a gap between the motor and its load",
    electrical: None,
    params: &[
        Param {
            name: "gap",
            unit: "rad",
            about: "whole gap 2α, flank to flank, at the motor shaft",
            scales: true,
            range: (0.0, 10.0),
            typical: |_| 0.06,
        },
        Param {
            name: "load_share",
            unit: "1",
            about: "share of the machine's inertia behind the gap",
            scales: false,
            range: (0.01, 0.99),
            typical: |_| 0.4,
        },
        Param {
            name: "contact_hz",
            unit: "Hz",
            about: "frequency of the two inertias on the touching flanks",
            scales: false,
            range: (1.0, 5000.0),
            typical: |_| 500.0,
        },
        Param {
            name: "damping",
            unit: "1",
            about: "damping ratio of that oscillation",
            scales: false,
            range: (0.0, 2.0),
            typical: |_| 0.7,
        },
        LOAD_FRICTION,
    ],
    other_laws: &[],
    build: |values, machine| {
        Box::new(Backlash {
            half_gap_rad: 0.5 * values[0],
            load_share: values[1],
            contact_hz: values[2],
            damping_ratio: values[3],
            inertia_kg_m2: machine.inertia_kg_m2,
            friction_n_m: values[4],
        })
    },
    draw: |_, _, random| {
        vec![
            ("load_share", random.uniform(0.2, 0.7)),
            ("contact_hz", random.log_uniform(250.0, 1000.0)),
            ("damping", random.uniform(0.4, 1.0)),
        ]
    },
    truth: |values, _, _| {
        let share = share_alone(values[4]);
        vec![values[0], values[1], 1.0 / values[2], values[3], share]
    },
};

impl Effect for Backlash {
    fn coupling(&self) -> Option<Coupling> {
        if self.half_gap_rad == 0.0 {
            return None;
        }
        let reduced = self.load_share * (1.0 - self.load_share) * self.inertia_kg_m2;
        Some(Coupling {
            load_share: self.load_share,
            compliance_rad_n_m: 1.0 / (reduced * (TAU * self.contact_hz).powi(2)),
            damping_ratio: self.damping_ratio,
            half_gap_rad: self.half_gap_rad,
            friction_n_m: self.friction_n_m,
        })
    }
}
