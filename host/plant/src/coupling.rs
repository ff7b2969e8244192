//! The elastic, perhaps loose, coupling between the motor and a second inertia.

use super::effects::Param;

/// Coupling between motor and load. The bench splits the machine's inertia between the two, so
/// that a stiff coupling without gap is the plain machine again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Share of the total inertia that sits on the load side, in 0…1.
    pub load_share: f64,
    /// Compliance 1/k, rad/(N·m).
    pub compliance_rad_n_m: f64,
    /// Damping ratio of the oscillation of the two inertias against each other.
    pub damping_ratio: f64,
    /// Half of the gap, rad: the load is free while the twist is smaller.
    pub half_gap_rad: f64,
    /// Dry friction of the load, N·m.
    pub friction_n_m: f64,
}

/// Dry friction of the load, as a parameter of an effect.
pub(super) const LOAD_FRICTION: Param = Param {
    name: "friction",
    unit: "N*m",
    about: "dry friction of the load",
    scales: false,
    range: (0.0, f64::INFINITY),
    typical: |_| 0.0,
};

/// Share of the dry friction that the load has, if the motor has none.
pub(super) fn share_alone(friction_n_m: f64) -> f64 {
    if friction_n_m > 0.0 { 1.0 } else { 0.0 }
}

impl Coupling {
    /// Both couplings in series, in front of one load.
    pub(super) fn in_series_with(self, other: Coupling) -> Coupling {
        Coupling {
            load_share: self.load_share.max(other.load_share),
            compliance_rad_n_m: self.compliance_rad_n_m + other.compliance_rad_n_m,
            damping_ratio: self.damping_ratio.max(other.damping_ratio),
            half_gap_rad: self.half_gap_rad + other.half_gap_rad,
            friction_n_m: self.friction_n_m + other.friction_n_m,
        }
    }
}

/// Contact state of the coupling's flanks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flank {
    /// There is no gap: the coupling is a shaft that pushes and pulls.
    None,
    /// The load is free within the gap.
    Free,
    /// The motor drives the load forward.
    Front,
    /// The motor drives the load backward.
    Back,
}

/// A coupling on a given machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaft {
    pub(super) motor_inertia_kg_m2: f64,
    pub(super) load_inertia_kg_m2: f64,
    stiffness_n_m_rad: f64,
    damping_n_m_s: f64,
    half_gap_rad: f64,
    /// Dry friction of the load, N·m.
    pub(super) friction_n_m: f64,
}

impl Shaft {
    pub(super) fn new(coupling: Coupling, inertia_kg_m2: f64) -> Self {
        let load = coupling.load_share * inertia_kg_m2;
        let motor = inertia_kg_m2 - load;
        let stiffness = 1.0 / coupling.compliance_rad_n_m;
        let reduced = motor * load / inertia_kg_m2;
        Shaft {
            motor_inertia_kg_m2: motor,
            load_inertia_kg_m2: load,
            stiffness_n_m_rad: stiffness,
            damping_n_m_s: 2.0 * coupling.damping_ratio * (stiffness * reduced).sqrt(),
            half_gap_rad: coupling.half_gap_rad,
            friction_n_m: coupling.friction_n_m,
        }
    }

    /// Torque that the motor side passes to the load side, N·m, at `twist` = motor − load, rad, and its
    /// rate, rad/s, on the given flank (Nordin and Gutman, "Controlling mechanical systems with
    /// backlash – a survey", Automatica 38(10), 2002, dead-zone model with damping).
    pub(super) fn torque(&self, flank: Flank, twist: f64, twist_rate: f64) -> f64 {
        let bend = match flank {
            Flank::Free => return 0.0,
            Flank::None => twist,
            Flank::Front => twist - self.half_gap_rad,
            Flank::Back => twist + self.half_gap_rad,
        };
        self.stiffness_n_m_rad * bend + self.damping_n_m_s * twist_rate
    }

    /// The flank in contact at a twist, rad, and its rate, rad/s. A flank pushes and never pulls.
    pub(super) fn flank(&self, twist: f64, twist_rate: f64) -> Flank {
        if self.half_gap_rad == 0.0 {
            return Flank::None;
        }
        let push = |flank| self.torque(flank, twist, twist_rate);
        if twist > self.half_gap_rad && push(Flank::Front) > 0.0 {
            Flank::Front
        } else if twist < -self.half_gap_rad && push(Flank::Back) < 0.0 {
            Flank::Back
        } else {
            Flank::Free
        }
    }

    /// Fastest rate of the relative motion of the two inertias, 1/s.
    pub(super) fn stiffness_per_s(&self) -> f64 {
        let mobility = 1.0 / self.motor_inertia_kg_m2 + 1.0 / self.load_inertia_kg_m2;
        (self.stiffness_n_m_rad * mobility).sqrt() + self.damping_n_m_s * mobility
    }
}
