//! Dry friction.

use super::{NOTHING, between, speed, torque};
use crate::outside::{Outside, Variable};
use std::f64::consts::{PI, TAU};

pub(super) const DECAYING_FRICTION: Outside = Outside {
    name: "decaying_friction",
    about: "dry friction c*exp(-|w|/ws)",
    draw: |machine, chance| vec![torque(machine, chance), speed(machine, chance, 0.05, 0.4)],
    friction: |v, sliding| v[0] * (-sliding.speed / v[1]).exp(),
    ..NOTHING
};

pub(super) const LOAD_FRICTION_THAT_FALLS: Outside = Outside {
    name: "load_friction_that_falls",
    about: "dry friction m*|tau|*exp(-|w|/ws)",
    draw: |machine, chance| {
        vec![
            between(chance, 0.05, 0.25),
            speed(machine, chance, 0.05, 0.4),
        ]
    },
    friction: |v, sliding| v[0] * sliding.transmitted * (-sliding.speed / v[1]).exp(),
    depends_on: &[Variable::Speed, Variable::Load],
    ..NOTHING
};

pub(super) const RUB: Outside = Outside {
    name: "rub",
    about: "dry friction c*exp(-(d/h)^2), d the angle from one place of the revolution",
    draw: |machine, chance| {
        let place = between(chance, 0.0, TAU);
        vec![torque(machine, chance), between(chance, 0.3, 0.8), place]
    },
    friction: |v, sliding| {
        let away = (sliding.angle - v[2] + PI).rem_euclid(TAU) - PI;
        v[0] * (-(away / v[1]).powi(2)).exp()
    },
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};
