//! Laws of the current.

use super::{NOTHING, between, torque};
use crate::outside::{Outside, Remembered, Variable};

pub(super) const CURRENT_SQUARE: Outside = Outside {
    name: "current_square",
    about: "-c*i*|i|/i0^2, a torque lost to the square of the current",
    draw: |machine, chance| vec![2.0 * torque(machine, chance), machine.stall_current_a()],
    torque: |v, at| -v[0] * at.current * at.current.abs() / (v[1] * v[1]),
    depends_on: &[Variable::Load],
    ..NOTHING
};

pub(super) const GEAR_LOSS: Outside = Outside {
    name: "gear_loss",
    about: "-(ma*|tau|*z + md*tau*z^2), z' = (w - |w|*z)/h",
    draw: |machine, chance| {
        vec![
            between(chance, 0.05, 0.25),
            between(chance, 0.05, 0.25),
            0.003 * 30f64.powf(chance.uniform()),
            machine.kt_n_m_a,
        ]
    },
    torque: |v, at| {
        let motor = v[3] * at.current;
        let [z, _] = at.memory;
        -(v[0] * motor.abs() * z + v[1] * motor * z * z)
    },
    memory: Some(Remembered::Way(|v| v[2])),
    depends_on: &[Variable::Load, Variable::Memory],
    ..NOTHING
};

pub(super) const LOAD_DRAG: Outside = Outside {
    name: "load_drag",
    about: "-c*|i|/i0*w/w0, a drag that depends on the load",
    draw: |machine, chance| {
        let c = 4.0 * torque(machine, chance);
        vec![c, machine.stall_current_a(), machine.top_speed_rad_s()]
    },
    torque: |v, at| -v[0] * at.current.abs() / v[1] * at.speed / v[2],
    depends_on: &[Variable::Speed, Variable::Load],
    ..NOTHING
};

pub(super) const CONTACT_DROP: Outside = Outside {
    name: "contact_drop",
    about: "a drop of d*x/(1 + |x|) V, x = i/ic",
    draw: |machine, chance| {
        let current = between(chance, 0.05, 0.25) * machine.stall_current_a();
        vec![between(chance, 0.03, 0.08) * machine.supply_v, current]
    },
    volts: |v, at| {
        let x = at.current / v[1];
        -v[0] * x / (1.0 + x.abs())
    },
    depends_on: &[Variable::Load],
    ..NOTHING
};
