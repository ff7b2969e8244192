//! Laws of the drive and of the back-EMF.

use super::{NOTHING, between, speed};
use crate::outside::{Outside, Remembered, Variable};

pub(super) const SATURATING_BACK_EMF: Outside = Outside {
    name: "saturating_back_emf",
    about: "back-EMF kb*w/(1 + |w|/ws)",
    draw: |machine, chance| vec![machine.kb_v_s_rad, speed(machine, chance, 2.0, 6.0)],
    volts: |v, at| v[0] * at.speed * (1.0 - 1.0 / (1.0 + at.speed.abs() / v[1])),
    ..NOTHING
};

pub(super) const SLEW_LIMIT: Outside = Outside {
    name: "slew_limit",
    about: "a drive that changes by r volts a second at most",
    draw: |machine, chance| {
        let supply = machine.supply_v;
        vec![supply * 10.0 * 10f64.powf(chance.uniform()), 0.01 * supply]
    },
    volts: |_, at| at.memory[0] - at.volts,
    memory: Some(Remembered::Command(|v| [v[0], v[0] / v[1]])),
    depends_on: &[Variable::Load, Variable::Memory],
    ..NOTHING
};

pub(super) const QUADRATIC_DRIVE: Outside = Outside {
    name: "quadratic_drive",
    about: "a drive that gives u - a*u*|u|/us",
    draw: |machine, chance| vec![between(chance, 0.04, 0.15), machine.supply_v],
    volts: |v, at| -v[0] * at.volts * at.volts.abs() / v[1],
    depends_on: &[Variable::Load],
    ..NOTHING
};

pub(super) const WEAK_SIDE: Outside = Outside {
    name: "weak_side",
    about: "a drive that gives less backward than forward: (1 - a)*u below zero",
    draw: |_, chance| vec![between(chance, 0.05, 0.2)],
    volts: |v, at| -v[0] * at.volts.min(0.0),
    depends_on: &[Variable::Load],
    ..NOTHING
};
