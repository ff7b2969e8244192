//! The forms of law that no effect of the catalogue states.

use super::{Outside, Remembered, Variable};
use crate::{Chance, Machine};

const NOTHING: Outside = Outside {
    name: "",
    about: "",
    draw: |_, _| Vec::new(),
    torque: |_, _| 0.0,
    friction: |_, _| 0.0,
    volts: |_, _| 0.0,
    inertia: |_, _| [0.0; 2],
    memory: None,
    jump_rad_s: None,
    depends_on: &[Variable::Speed],
};

/// Parts of a machine's stall torque, as large as effects of the catalogue typically are.
fn torque(machine: &Machine, chance: &mut Chance) -> f64 {
    let part = 0.02 * 4f64.powf(chance.uniform());
    part * machine.stall_torque_n_m()
}

fn between(chance: &mut Chance, low: f64, high: f64) -> f64 {
    low + (high - low) * chance.uniform()
}

/// A part of the top speed, rad/s.
fn speed(machine: &Machine, chance: &mut Chance, low: f64, high: f64) -> f64 {
    between(chance, low, high) * machine.top_speed_rad_s()
}

/// A whole number of cycles in a revolution, and a phase.
fn order_and_phase(chance: &mut Chance, most: f64) -> [f64; 2] {
    let order = between(chance, 1.0, most + 1.0).floor();
    [order, between(chance, 0.0, std::f64::consts::TAU)]
}

impl Outside {
    /// Every form.
    pub const ALL: &'static [Outside] = &[
        Outside {
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
        },
        Outside {
            name: "cubic_drag",
            about: "-c*(w/w0)^3",
            draw: |machine, chance| vec![torque(machine, chance), machine.top_speed_rad_s()],
            torque: |v, at| -v[0] * (at.speed / v[1]).powi(3),
            ..NOTHING
        },
        Outside {
            name: "saturating_drag",
            about: "-c*(w/ws)/(1 + |w|/ws)",
            draw: |machine, chance| {
                vec![torque(machine, chance), speed(machine, chance, 0.05, 0.3)]
            },
            torque: |v, at| -v[0] * (at.speed / v[1]) / (1.0 + at.speed.abs() / v[1]),
            ..NOTHING
        },
        Outside {
            name: "decaying_friction",
            about: "dry friction c*exp(-|w|/ws)",
            draw: |machine, chance| {
                vec![torque(machine, chance), speed(machine, chance, 0.05, 0.4)]
            },
            friction: |v, sliding| v[0] * (-sliding.speed / v[1]).exp(),
            ..NOTHING
        },
        Outside {
            name: "current_square",
            about: "-c*i*|i|/i0^2, a torque lost to the square of the current",
            draw: |machine, chance| vec![2.0 * torque(machine, chance), machine.stall_current_a()],
            torque: |v, at| -v[0] * at.current * at.current.abs() / (v[1] * v[1]),
            depends_on: &[Variable::Load],
            ..NOTHING
        },
        Outside {
            name: "viscous_by_angle",
            about: "-c*(w/w0)*cos(k*theta + phase)",
            draw: |machine, chance| {
                let [order, phase] = order_and_phase(chance, 6.0);
                let c = torque(machine, chance);
                vec![c, machine.top_speed_rad_s(), order, phase]
            },
            torque: |v, at| -v[0] * at.speed / v[1] * (v[2] * at.angle + v[3]).cos(),
            depends_on: &[Variable::Speed, Variable::Angle],
            ..NOTHING
        },
        Outside {
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
        },
        Outside {
            name: "saturating_back_emf",
            about: "back-EMF kb*w/(1 + |w|/ws)",
            draw: |machine, chance| vec![machine.kb_v_s_rad, speed(machine, chance, 2.0, 6.0)],
            volts: |v, at| v[0] * at.speed * (1.0 - 1.0 / (1.0 + at.speed.abs() / v[1])),
            ..NOTHING
        },
        Outside {
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
        },
        Outside {
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
        },
        Outside {
            name: "crank",
            about: "1/2*a*k*J*w^2*sin(k*theta + phase), what an inertia J*(1 + a*cos) asks of a steady speed",
            draw: |machine, chance| {
                let [order, phase] = order_and_phase(chance, 4.0);
                let c = 2.0 * torque(machine, chance);
                vec![c, machine.top_speed_rad_s(), order, phase]
            },
            torque: |v, at| v[0] * (at.speed / v[1]).powi(2) * (v[2] * at.angle + v[3]).sin(),
            depends_on: &[Variable::Speed, Variable::Angle],
            ..NOTHING
        },
        Outside {
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
        },
        Outside {
            name: "step_above",
            about: "-c*sgn(w) where |w| > w1",
            draw: |machine, chance| {
                vec![torque(machine, chance), speed(machine, chance, 0.15, 0.6)]
            },
            torque: |v, at| {
                if at.speed.abs() > v[1] {
                    -v[0] * at.speed.signum()
                } else {
                    0.0
                }
            },
            jump_rad_s: Some(|v| v[1]),
            ..NOTHING
        },
        Outside {
            name: "tanh_friction",
            about: "-c*tanh(w/ws)",
            draw: |machine, chance| {
                vec![torque(machine, chance), speed(machine, chance, 0.03, 0.4)]
            },
            torque: |v, at| -v[0] * (at.speed / v[1]).tanh(),
            ..NOTHING
        },
        Outside {
            name: "one_sided_drag",
            about: "-c*(max(w, 0)/w0)^2",
            draw: |machine, chance| vec![2.0 * torque(machine, chance), machine.top_speed_rad_s()],
            torque: |v, at| -v[0] * (at.speed.max(0.0) / v[1]).powi(2),
            ..NOTHING
        },
        Outside {
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
        },
        Outside {
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
        },
    ];
}
