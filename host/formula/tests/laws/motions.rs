//! A motor with a stated law moves as the law's equation does.

use super::{COUNTS, INTERVAL, SUPPLY, plan};
use servoid_formula::{define, law_of};
use shared::effects::Kind;
use shared::model::{Plan, State};
use std::f64::consts::TAU;
use testing::motion;

/// Steps and reversals of several sizes, per unit.
fn command(k: usize) -> f64 {
    [0.6, -0.3, 0.1, 0.9, -0.8, 0.0, 0.25, -0.05][k / 150 % 8]
}

const SAMPLES: usize = 2400;

fn angles(plan: &Plan<f64>) -> Vec<f64> {
    let commands: Vec<(f64, bool)> = (0..SAMPLES).map(|k| (command(k), false)).collect();
    let motion = motion::exact(plan, State::default(), &commands).unwrap();
    motion.readings[1..].to_vec()
}

fn furthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Effects of the catalogue as formulas.
fn twins() -> Vec<(&'static str, Vec<f64>, Kind, Vec<f64>)> {
    let by = |name| Kind::by_name(name).unwrap();
    vec![
        (
            "drag: torque = -c*w*abs(w); c in [0, 1] V*s^2/rad^2",
            vec![1.5e-6],
            by("windage"),
            vec![1.5e-6],
        ),
        (
            "dry: friction = c; c in [0, 5] V",
            vec![0.9],
            by("coulomb"),
            vec![0.9],
        ),
        (
            "load: torque = -c; c in [-5, 5] V",
            vec![0.7],
            by("load_torque"),
            vec![0.7],
        ),
        (
            "shunt: current = -c; c in [-5, 5] V",
            vec![0.7],
            by("load_torque"),
            vec![0.7],
        ),
        (
            "bias: voltage = c; c in [-5, 5] V",
            vec![0.7],
            by("offset_voltage"),
            vec![0.7],
        ),
        (
            "teeth: torque = -(a*cos(12*theta) + b*sin(12*theta)); a, b in [-1, 1] V",
            vec![0.3, 0.2],
            by("cogging"),
            vec![0.3, 0.2, 12.0],
        ),
        (
            "slow: friction = c + s*exp(-(abs(w)/ws)^2); c, s in [0, 5] V; ws in [1, 100] rad/s",
            vec![0.5, 0.6, 20.0],
            by("stribeck"),
            vec![0.5, 0.6, 20.0, 2.0, 0.0],
        ),
        (
            "bent: torque = -c*z; z' = (w - abs(w)*z)/h; c in [0, 5] V; h in [1e-3, 1] rad",
            vec![0.9, 0.01],
            by("lugre"),
            vec![0.9, 0.0, 10.0, 0.01, 0.0, 0.0],
        ),
    ]
}

#[test]
fn a_formula_moves_as_the_effect_of_the_catalogue_that_it_states() {
    for (text, values, kind, own) in twins() {
        let stated = define(text).unwrap_or_else(|fault| panic!("{fault}"));
        let (one, other) = (
            angles(&plan(&[(stated, values)])),
            angles(&plan(&[(kind, own)])),
        );
        let off = furthest(&one, &other);
        let without = furthest(&one, &angles(&plan(&[])));
        assert!(without > 50.0, "{text}: moves nothing ({without} counts)");
        assert!(off < 6.0, "{text}: {off} counts off {}", kind.name());
    }
}

/// A mass that no angle changes is the motor's own, whatever moves it. A friction stops the shaft within a part under the torque that
/// was predicted for the whole of it.
#[test]
fn an_inertia_that_is_added_is_a_heavier_motor() {
    let stated = define("mass: inertia = a; a in [0, 4]").unwrap();
    for (dry, most) in [(0.0, 1.0), (0.9, 6.0)] {
        for more in [0.1, 0.5, 3.0] {
            let friction = (Kind::by_name("coulomb").unwrap(), vec![dry]);
            let mut heavier = plan(std::slice::from_ref(&friction));
            heavier.machine.inertia *= 1.0 + more;
            let (one, other) = (
                angles(&plan(&[friction, (stated, vec![more])])),
                angles(&heavier),
            );
            let off = furthest(&one, &other);
            assert!(off < most, "{more} more beside {dry} V: {off} counts");
        }
    }
}

/// Classical Runge–Kutta steps within a sample.
const FINE: usize = 200;

/// Counts by which two motions may part that begin alike: where the mass changes much they part exponentially.
const MOST_OFF: f64 = 25.0;

/// Readings of a motor with the state angle, speed, current and whatever follows, whose `rate` is given at the commanded volts: in steps
/// so fine that they leave nothing.
fn integrated<const N: usize>(rate: impl Fn([f64; N], f64) -> [f64; N]) -> Vec<f64> {
    integrated_along(|state, volts, _| rate(state, volts))
}

/// The same, whose `rate` depends on the sample, too.
fn integrated_along<const N: usize>(rate: impl Fn([f64; N], f64, usize) -> [f64; N]) -> Vec<f64> {
    let ahead = |state: [f64; N], by: [f64; N], h: f64| -> [f64; N] {
        std::array::from_fn(|n| state[n] + h * by[n])
    };
    let h = INTERVAL / FINE as f64;
    let mut state = [0.0; N];
    (0..SAMPLES)
        .map(|sample| {
            let volts = command(sample) * SUPPLY;
            let rate = |state, volts| rate(state, volts, sample);
            for _ in 0..FINE {
                let one = rate(state, volts);
                let two = rate(ahead(state, one, 0.5 * h), volts);
                let three = rate(ahead(state, two, 0.5 * h), volts);
                let four = rate(ahead(state, three, h), volts);
                let mean = std::array::from_fn(|n| {
                    (one[n] + 2.0 * two[n] + 2.0 * three[n] + four[n]) / 6.0
                });
                state = ahead(state, mean, h);
            }
            state[0] * COUNTS / TAU
        })
        .collect()
}

/// Lagrange's equation of a shaft with the inertia `m·(1 + a·(1 + cos(kθ − f)))`.
#[test]
fn an_inertia_that_the_angle_changes_moves_as_its_equation_does() {
    for (a, k, f) in [(0.05, 1.0, 0.0), (0.3, 2.0, 0.7), (0.6, 1.0, -2.0)] {
        let text = format!(
            "crank: inertia = a*(1 + cos({k}*theta - f)); a in [0, 4]; f in [-6.3, 6.3] rad"
        );
        let plan = plan(&[(define(&text).unwrap(), vec![a, f])]);
        let machine = plan.machine;
        let truth = integrated(|[angle, speed, current], volts| {
            let (sine, cosine) = (k * angle - f).sin_cos();
            let (part, slope) = (1.0 + a * (1.0 + cosine), -a * k * sine);
            let torque = current - machine.damping * speed;
            let gained = torque / machine.inertia - 0.5 * slope * speed * speed;
            [
                speed,
                gained / part,
                (volts - current - machine.kb * speed) / machine.electrical,
            ]
        });
        let off = furthest(&angles(&plan), &truth);
        println!("{text}: {off} counts off");
        assert!(off < MOST_OFF, "{text}: {off} counts off its equation");
    }
}

/// The volts at the winding that a law adds, from the state, the speed, the current and the command; and the rate of its state.
type Added = fn(f64, f64, f64, f64) -> [f64; 2];

/// Voltages that change within an interval: with the speed, with the current as of a resistance, a contact or a winding that heats up, and by
/// a state that follows the command at once, late, or at a limited rate.
#[test]
fn a_voltage_that_changes_within_an_interval_moves_as_its_equation_does() {
    let cases: [(&str, Vec<f64>, Added); 8] = [
        (
            "emf: voltage = -c*w; c in [0, 1] V*s/rad",
            vec![0.01],
            |_, w, _, _| [-0.01 * w, 0.0],
        ),
        (
            "flat: voltage = c*w*abs(w)/(w0 + abs(w)); c in [0, 1] V*s/rad; w0 = 900 rad/s",
            vec![0.03],
            |_, w, _, _| [0.03 * w * w.abs() / (900.0 + w.abs()), 0.0],
        ),
        (
            "lag: z' = (u - z)/s; voltage = z - u; s in [1e-4, 1] s; z in [-24, 24] V",
            vec![0.004],
            |z, _, _, u| [z - u, (u - z) / 0.004],
        ),
        (
            "slew: z' = max(-r, min(r, (u - z)/s)); voltage = z - u; r in [1, 1e5] V/s; s = 5e-4 s; z in [-24, 24] V",
            vec![800.0],
            |z, _, _, u| [z - u, ((u - z) / 5e-4).clamp(-800.0, 800.0)],
        ),
        (
            "more: voltage = -a*i; a in [-1, 4]",
            vec![0.3],
            |_, _, i, _| [-0.3 * i, 0.0],
        ),
        (
            "contact: voltage = -d*i/(e + abs(i)); d in [0, 9] V; e = 1.5 V",
            vec![1.2],
            |_, _, i, _| [-1.2 * i / (1.5 + i.abs()), 0.0],
        ),
        (
            "sparks: voltage = -d*tanh(i/e)*(1 + w/w0); d in [0, 9] V; e = 0.8 V; w0 = 2000 rad/s",
            vec![0.7],
            |_, w, i, _| [-0.7 * (i / 0.8).tanh() * (1.0 + w / 2000.0), 0.0],
        ),
        (
            "warm: z' = h*i^2 - z/s; voltage = -z*i; h in [0, 1] 1/V^2/s; s = 0.5 s; z in [0, 4]",
            vec![0.05],
            |z, _, i, _| [-z * i, 0.05 * i * i - z / 0.5],
        ),
    ];
    for (text, values, added) in cases {
        let kind = define(text).unwrap_or_else(|fault| panic!("{fault}"));
        let plan_of = plan(&[(kind, values)]);
        let machine = plan_of.machine;
        let truth = integrated(|[_, speed, current, z], volts| {
            let [more, rate] = added(z, speed, current, volts);
            let torque = current - machine.damping * speed;
            [
                speed,
                torque / machine.inertia,
                (volts + more - current - machine.kb * speed) / machine.electrical,
                rate,
            ]
        });
        let found = angles(&plan_of);
        let off = furthest(&found, &truth);
        let without = furthest(&found, &angles(&plan(&[])));
        println!("{text}: {off} counts off, {without} without");
        assert!(without > 50.0, "{text}: moves nothing ({without} counts)");
        assert!(off < 2.0, "{text}: {off} counts off its equation");
    }
}

/// The torque and the volts that a law with two states adds, from these, the speed and the command; and the rates of the states.
type AddedByTwo = fn([f64; 2], f64, f64) -> ([f64; 2], [f64; 2]);

/// Two states: each by itself, the second behind the first, and either behind the other as of a mass on a spring.
#[test]
fn a_law_with_two_states_moves_as_its_equation_does() {
    let cases: [(&str, Vec<f64>, AddedByTwo, f64); 3] = [
        (
            "slip: x' = (w - abs(w)*x)/h; y' = (w - abs(w)*y)/k; torque = -(a*x + b*y); a, b in [0, 5] V; h, k in [1e-3, 1] rad",
            vec![0.5, 0.4, 0.02, 0.3],
            |[x, y], w, _| {
                let rates = [(w - w.abs() * x) / 0.02, (w - w.abs() * y) / 0.3];
                ([-(0.5 * x + 0.4 * y), 0.0], rates)
            },
            6.0,
        ),
        (
            "late: x' = (u - x)/s; y' = (x - y)/s; voltage = y - u; s in [1e-4, 1] s; x, y in [-24, 24] V",
            vec![0.004],
            |[x, y], _, u| ([0.0, y - u], [(u - x) / 0.004, (x - y) / 0.004]),
            1.0,
        ),
        (
            "mass: x' = w - y; y' = k*x; torque = -c*x; c in [0, 100] V/rad; k in [1, 1e6] 1/s^2; x in [-1, 1] rad; y in [-2000, 2000] rad/s",
            vec![20.0, 1e4],
            |[x, y], w, _| ([-20.0 * x, 0.0], [w - y, 1e4 * x]),
            // Some sixty periods without damping, six samples to a radian, by a method of second order: a thousandth of the way.
            MOST_OFF,
        ),
    ];
    for (text, values, added, most) in cases {
        let kind = define(text).unwrap_or_else(|fault| panic!("{fault}"));
        let plan_of = plan(&[(kind, values)]);
        let machine = plan_of.machine;
        let truth = integrated(|[_, speed, current, x, y], volts| {
            let ([torque, more], [x, y]) = added([x, y], speed, volts);
            let torque = torque + current - machine.damping * speed;
            [
                speed,
                torque / machine.inertia,
                (volts + more - current - machine.kb * speed) / machine.electrical,
                x,
                y,
            ]
        });
        let found = angles(&plan_of);
        let off = furthest(&found, &truth);
        let without = furthest(&found, &angles(&plan(&[])));
        println!("{text}: {off} counts off, {without} without");
        assert!(without > 50.0, "{text}: moves nothing ({without} counts)");
        assert!(off < most, "{text}: {off} counts off its equation");
    }
}

/// What a law adds to torque and friction, from the speed, the command and the temperature.
type Seen = fn(f64, f64, f64) -> [f64; 2];

/// The command and the temperature that a recording tells, in every place that sees them.
#[test]
fn a_law_of_the_command_or_the_temperature_moves_as_its_equation_does() {
    let celsius = |sample: usize| 20.0 + 60.0 * (sample as f64 / 400.0).sin();
    let cases: [(&str, Vec<f64>, Seen); 5] = [
        ("pull: current = -c*v; c in [0, 1]", vec![0.1], |_, u, _| {
            [-0.1 * u, 0.0]
        }),
        (
            "grip: friction = c*abs(v); c in [0, 1]",
            vec![0.1],
            |_, u, _| [0.0, 0.1 * u.abs()],
        ),
        (
            "lean: torque = c*v*temperature/t0; c in [-1, 1]; t0 = 25 degC",
            vec![0.05],
            |_, u, warm| [0.05 * u * warm / 25.0, 0.0],
        ),
        (
            "oil: torque = -c*w*exp(-temperature/t0); c in [0, 1] V*s/rad; t0 in [1, 90] degC",
            vec![0.02, 30.0],
            |w, _, warm| [-0.02 * w * (-warm / 30.0).exp(), 0.0],
        ),
        (
            "v: friction = v*(1 + b*abs(temperature)); v in [0, 5] V; b in [0, 1] 1/degC",
            vec![0.4, 0.02],
            |_, _, warm| [0.0, 0.4 * (1.0 + 0.02 * warm.abs())],
        ),
    ];
    for (text, values, seen) in cases {
        let kind = define(text).unwrap_or_else(|fault| panic!("{fault}"));
        let plan_of = plan(&[(kind, values)]);
        let machine = plan_of.machine;
        let truth = integrated_along(|[_, speed, current], volts, sample| {
            let [torque, budget] = seen(speed, volts, celsius(sample));
            let torque = torque + current - machine.damping * speed;
            // A stop is smoothed over a speed that takes nothing of a turn.
            let dry = budget * (speed / 0.05).tanh();
            [
                speed,
                (torque - dry) / machine.inertia,
                (volts - current - machine.kb * speed) / machine.electrical,
            ]
        });
        let found = motion::warmed(&plan_of, &|k| (command(k), celsius(k)), SAMPLES).unwrap();
        let off = furthest(&found, &truth);
        let without = furthest(&found, &angles(&plan(&[])));
        println!("{text}: {off} counts off, {without} without");
        assert!(without > 50.0, "{text}: moves nothing ({without} counts)");
        assert!(off < 6.0, "{text}: {off} counts off its equation");
    }
}

#[test]
fn every_number_format_moves_alike_or_refuses() {
    for (text, values, ..) in twins() {
        let stated = define(text).unwrap();
        let plan = plan(&[(stated, values)]);
        let exact = angles(&plan);
        let commands: Vec<f64> = (0..SAMPLES).map(command).collect();
        let single = motion::single(&plan, &commands).unwrap();
        let fixed = motion::fixed(&plan, &commands);
        if !law_of(stated).unwrap().definition.states.is_empty() {
            let refused = fixed
                .err()
                .map(|error| error.to_string())
                .unwrap_or_default();
            assert!(refused.contains("number format"), "{text}: {refused}");
            continue;
        }
        let fixed = fixed.unwrap();
        for (k, exact) in exact.iter().enumerate() {
            let off = [single[k], fixed[k]].map(|counts| f64::from(counts) - exact.floor());
            assert!(
                off.iter().all(|off| off.abs() <= 8.0),
                "{text}, sample {k}: {off:?} counts"
            );
        }
    }
}
