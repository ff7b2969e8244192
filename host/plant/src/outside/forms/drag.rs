//! Drags of the speed.

use super::{NOTHING, between, speed, torque};
use crate::outside::Outside;

pub(super) const POWER_DRAG: Outside = Outside {
    name: "power_drag",
    about: "-c*sgn(w)*(|w|/w0)^p, p from 0.3 to 0.7 or from 2.4 to 3",
    draw: |machine, chance| {
        let p = if chance.uniform() < 0.5 {
            between(chance, 0.3, 0.7)
        } else {
            between(chance, 2.4, 3.0)
        };
        vec![torque(machine, chance), machine.top_speed_rad_s(), p]
    },
    torque: |v, at| -v[0] * (at.speed.abs() / v[1]).powf(v[2]) * at.speed.signum(),
    ..NOTHING
};

pub(super) const CUBIC_DRAG: Outside = Outside {
    name: "cubic_drag",
    about: "-c*(w/w0)^3",
    draw: |machine, chance| vec![torque(machine, chance), machine.top_speed_rad_s()],
    torque: |v, at| -v[0] * (at.speed / v[1]).powi(3),
    ..NOTHING
};

pub(super) const SATURATING_DRAG: Outside = Outside {
    name: "saturating_drag",
    about: "-c*(w/ws)/(1 + |w|/ws)",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.05, 0.3)],
    torque: |v, at| -v[0] * (at.speed / v[1]) / (1.0 + at.speed.abs() / v[1]),
    ..NOTHING
};

pub(super) const STEP_ABOVE: Outside = Outside {
    name: "step_above",
    about: "-c*sgn(w) where |w| > w1",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.15, 0.6)],
    torque: |v, at| {
        if at.speed.abs() > v[1] {
            -v[0] * at.speed.signum()
        } else {
            0.0
        }
    },
    jump_rad_s: Some(|v| v[1]),
    ..NOTHING
};

pub(super) const TANH_FRICTION: Outside = Outside {
    name: "tanh_friction",
    about: "-c*tanh(w/ws)",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.03, 0.4)],
    torque: |v, at| -v[0] * (at.speed / v[1]).tanh(),
    ..NOTHING
};

pub(super) const ONE_SIDED_DRAG: Outside = Outside {
    name: "one_sided_drag",
    about: "-c*(max(w, 0)/w0)^2",
    draw: |machine, chance| vec![2.0 * torque(machine, chance), machine.top_speed_rad_s()],
    torque: |v, at| -v[0] * (at.speed.max(0.0) / v[1]).powi(2),
    ..NOTHING
};

pub(super) const EDDY_BRAKE: Outside = Outside {
    name: "eddy_brake",
    about: "-2*c*x/(1 + x^2), x = w/ws",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.05, 0.3)],
    torque: |v, at| {
        let x = at.speed / v[1];
        -2.0 * v[0] * x / (1.0 + x * x)
    },
    ..NOTHING
};

pub(super) const HUMP_DRAG: Outside = Outside {
    name: "hump_drag",
    about: "-e*c*x*exp(-|x|), x = w/ws",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.05, 0.25)],
    torque: |v, at| {
        let x = at.speed / v[1];
        -std::f64::consts::E * v[0] * x * (-x.abs()).exp()
    },
    ..NOTHING
};

pub(super) const LOGARITHMIC_DRAG: Outside = Outside {
    name: "logarithmic_drag",
    about: "-c*sgn(w)*ln(1 + |w|/ws)",
    draw: |machine, chance| {
        vec![
            0.5 * torque(machine, chance),
            speed(machine, chance, 0.01, 0.05),
        ]
    },
    torque: |v, at| -v[0] * at.speed.signum() * (at.speed.abs() / v[1]).ln_1p(),
    ..NOTHING
};

pub(super) const RISING_DRAG: Outside = Outside {
    name: "rising_drag",
    about: "-c*sgn(w)*(1 - exp(-|w|/ws))",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.05, 0.2)],
    torque: |v, at| v[0] * at.speed.signum() * (-at.speed.abs() / v[1]).exp_m1(),
    ..NOTHING
};
