//! Laws of the angle.

use super::{NOTHING, between, order_and_phase, speed, torque, wave};
use crate::outside::{Outside, Variable};

pub(super) const VISCOUS_BY_ANGLE: Outside = Outside {
    name: "viscous_by_angle",
    about: "-c*(w/w0)*cos(k*theta + phase)",
    draw: |machine, chance| wave(machine, chance, 1.0, machine.top_speed_rad_s(), 6.0),
    torque: |v, at| -v[0] * at.speed / v[1] * (v[2] * at.angle + v[3]).cos(),
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const COULOMB_BY_ANGLE: Outside = Outside {
    name: "coulomb_by_angle",
    about: "dry friction c*(1 + a*cos(k*theta + phase))",
    draw: |machine, chance| {
        let [order, phase] = order_and_phase(chance, 6.0);
        let c = torque(machine, chance);
        vec![c, between(chance, 0.3, 0.9), order, phase]
    },
    friction: |v, sliding| v[0] * (1.0 + v[1] * (v[2] * sliding.angle + v[3]).cos()),
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const CRANK: Outside = Outside {
    name: "crank",
    about: "1/2*a*k*J*w^2*sin(k*theta + phase), what an inertia J*(1 + a*cos) asks of a steady speed",
    draw: |machine, chance| wave(machine, chance, 2.0, machine.top_speed_rad_s(), 4.0),
    torque: |v, at| v[0] * (at.speed / v[1]).powi(2) * (v[2] * at.angle + v[3]).sin(),
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const CRANK_INERTIA: Outside = Outside {
    name: "crank_inertia",
    about: "inertia J*(1 + a*(1 + cos(k*theta + phase)))",
    draw: |machine, chance| {
        let [order, phase] = order_and_phase(chance, 3.0);
        let a = 0.1 * 4f64.powf(chance.uniform());
        vec![a * machine.inertia_kg_m2, order, phase]
    },
    inertia: |v, angle| {
        let (sine, cosine) = (v[1] * angle + v[2]).sin_cos();
        [v[0] * (1.0 + cosine), -v[0] * v[1] * sine]
    },
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const FADING_RIPPLE: Outside = Outside {
    name: "fading_ripple",
    about: "c*cos(k*theta + phase)*exp(-|w|/ws)",
    draw: |machine, chance| {
        let [order, phase] = order_and_phase(chance, 6.0);
        let c = torque(machine, chance);
        vec![c, order, phase, speed(machine, chance, 0.1, 0.6)]
    },
    torque: |v, at| v[0] * (v[1] * at.angle + v[2]).cos() * (-at.speed.abs() / v[3]).exp(),
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const TORQUE_RIPPLE: Outside = Outside {
    name: "torque_ripple",
    about: "c*i/i0*cos(k*theta + phase), the ripple of a commutated current",
    draw: |machine, chance| wave(machine, chance, 2.0, machine.stall_current_a(), 6.0),
    torque: |v, at| v[0] * at.current / v[1] * (v[2] * at.angle + v[3]).cos(),
    depends_on: &[Variable::Angle, Variable::Load],
    ..NOTHING
};

pub(super) const WINDING_RIPPLE: Outside = Outside {
    name: "winding_ripple",
    about: "a drop of a*R*i*cos(k*theta + phase) V, a resistance that depends on the angle",
    draw: |machine, chance| {
        let [order, phase] = order_and_phase(chance, 6.0);
        vec![
            between(chance, 0.05, 0.2) * machine.resistance_ohm,
            order,
            phase,
        ]
    },
    volts: |v, at| -v[0] * at.current * (v[1] * at.angle + v[2]).cos(),
    depends_on: &[Variable::Angle, Variable::Load],
    ..NOTHING
};

pub(super) const SPEED_RIPPLE: Outside = Outside {
    name: "speed_ripple",
    about: "c*|w|/w0*cos(k*theta + phase)",
    draw: |machine, chance| wave(machine, chance, 1.0, machine.top_speed_rad_s(), 6.0),
    torque: |v, at| v[0] * at.speed.abs() / v[1] * (v[2] * at.angle + v[3]).cos(),
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};

pub(super) const WINDAGE_BY_ANGLE: Outside = Outside {
    name: "windage_by_angle",
    about: "-c*w*|w|/w0^2*(1 + a*cos(theta + phase))",
    draw: |machine, chance| {
        let [_, phase] = order_and_phase(chance, 1.0);
        let c = 2.0 * torque(machine, chance);
        vec![
            c,
            machine.top_speed_rad_s(),
            between(chance, 0.3, 0.9),
            phase,
        ]
    },
    torque: |v, at| {
        let x = at.speed / v[1];
        -v[0] * x * x.abs() * (1.0 + v[2] * (at.angle + v[3]).cos())
    },
    depends_on: &[Variable::Speed, Variable::Angle],
    ..NOTHING
};
