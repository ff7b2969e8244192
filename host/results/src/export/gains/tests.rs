//! Loops are closed around the model itself, with a period of computing, and must do what was said of them.

use super::super::samples::{Known, linear, result, subject};
use super::super::side::Side;
use super::loops::{C, Pi, hz};
use super::*;
use servoid_plant as bench;
use shared::effects::Kind;
use shared::model::{Model, Plan, State};
use shared::rng;
use shared::units::PerUnit;
use testing::motion::Steps;

const DRAWS: usize = 30;

/// Motors as different as those of the proving ground: time constants over two decades.
fn motors() -> Vec<bench::Machine> {
    let mut source = rng::seeded(20_261_121);
    let mut within =
        |low: f64, high: f64| low * (high / low).powf(rng::uniform::<f64>(&mut source));
    let drawn = (0..DRAWS).map(|_| {
        let (resistance_ohm, k) = (within(0.3, 10.0), within(0.01, 0.3));
        let (electrical, mechanical) = (within(0.05e-3, 5e-3), within(25e-3, 0.3));
        bench::Machine {
            resistance_ohm,
            inductance_h: electrical * resistance_ohm,
            kt_n_m_a: k,
            kb_v_s_rad: k,
            inertia_kg_m2: mechanical * k * k / resistance_ohm,
            viscous_n_m_s: within(0.01, 0.3) * k * k / resistance_ohm,
            supply_v: 24.0,
        }
    });
    drawn.collect()
}

fn asked(gains: Asked) -> Options {
    Options {
        gains,
        ..Options::default()
    }
}

/// What the simulated loop answers to a unit sine at `omega`: current (A) of the inner, speed of the outer. Without a speed
/// loop the sine goes to the current loop.
fn simulated(subject: &Subject, loops: &[&Section], ohm: f64, period: f64, omega: f64) -> C {
    let units = PerUnit::new(1.0, 1.0, period, TAU).expect("units");
    let model: Model<f64> = Model::new(&Plan::linear(subject.machine, units)).expect("a model");
    let mut state = State::default();
    let mut memory = vec![0.0; loops.len()];
    let (mut command, mut before) = (0.0, 0.0);
    let turn = TAU / (omega * period);
    let settled = ((80.0 * turn) as usize).max((1.5 / period) as usize);
    let samples = settled + (20.0 * turn) as usize;
    // Least squares of sine and cosine over the settled part.
    let [mut ss, mut sc, mut cc, mut sy, mut cy] = [0.0; 5];
    for k in 0..samples {
        let (sine, cosine) = (omega * period * k as f64).sin_cos();
        let angle = state.motion.angle;
        let (speed, current) = ((angle - before) / period, state.motion.current / ohm);
        before = angle;
        let mut wanted = sine;
        let mut answer = 0.0;
        // The outer loop first: both from the same readings.
        for (section, memory) in loops.iter().rev().zip(&mut memory) {
            let seen = if section.input == "A" { current } else { speed };
            if std::ptr::eq(*section, loops[loops.len() - 1]) {
                answer = seen;
            }
            let error = wanted - seen;
            let Pi { kp, ki } = section.closed.pi;
            wanted = kp * error + *memory;
            *memory += ki * period * error;
        }
        f64::step(&model, &mut state, command, false);
        command = wanted;
        if k >= settled {
            ss += sine * sine;
            sc += sine * cosine;
            cc += cosine * cosine;
            sy += sine * answer;
            cy += cosine * answer;
        }
    }
    let determinant = ss * cc - sc * sc;
    C::new(
        (sy * cc - cy * sc) / determinant,
        (cy * ss - sy * sc) / determinant,
    )
}

/// The loops do at their crossover and at their bandwidth what is said of them.
fn holds(subject: &Subject, loops: &[&Section], ohm: f64, period: f64, case: &str) {
    let closed = loops[loops.len() - 1].closed;
    let answer = simulated(subject, loops, ohm, period, closed.crossover);
    let open = answer / (C::new(1.0, 0.0) - answer);
    assert!(
        (open.norm() - 1.0).abs() < 0.02,
        "{case}: {closed:?} passes {open} at its crossover"
    );
    let margin = 180.0 + open.arg().to_degrees();
    let margin = if margin > 180.0 {
        margin - 360.0
    } else {
        margin
    };
    assert!(
        (margin - closed.phase_margin).abs() < 1.0,
        "{case}: {margin} degrees, {closed:?}"
    );
    if let Some(bandwidth) = closed.bandwidth {
        let answer = simulated(subject, loops, ohm, period, bandwidth).norm();
        assert!(
            (answer * 2f64.sqrt() - 1.0).abs() < 0.03,
            "{case}: {answer} at {closed:?}"
        );
    }
}

#[test]
fn simulated_loops_have_the_crossover_the_margin_and_the_bandwidth_that_are_claimed() {
    let mut seen = [0; 3];
    for (k, motor) in motors().iter().enumerate() {
        let subject = subject(&linear(motor, Known::All), Side::Motor);
        let wanted = [
            (None, None, None),
            (None, Some(Method::Cancel), None),
            (Some(Loops::Voltage), None, None),
            (Some(Loops::Voltage), Some(Method::Symmetrical), None),
            (Some(Loops::Voltage), None, Some(5.0)),
        ];
        for (index, (loops, method, speed_hz)) in wanted.into_iter().enumerate() {
            let case = format!("motor {k}, {loops:?}, {method:?}, {speed_hz:?}: {motor:?}");
            let gains = Asked {
                current_hz: None,
                speed_hz,
                method,
                loops,
            };
            let found = design(&subject, &asked(gains)).unwrap_or_else(|e| panic!("{case}: {e}"));
            let period = found.period;
            let ohm = motor.resistance_ohm;
            let speed = found.section("speed_loop").expect("a loop");
            if let Some(hertz) = speed_hz {
                assert!(
                    (hz(speed.closed.crossover) / hertz - 1.0).abs() < 1e-9,
                    "{case}"
                );
            }
            match found.section("current_loop") {
                Some(current) => {
                    if index == 0 {
                        holds(
                            &subject,
                            &[current],
                            ohm,
                            period,
                            &format!("current loop of {case}"),
                        );
                        seen[0] += 1;
                    }
                    holds(&subject, &[current, speed], ohm, period, &case);
                    seen[1] += 1;
                }
                None => {
                    holds(&subject, &[speed], ohm, period, &case);
                    seen[2] += 1;
                }
            }
        }
    }
    assert_eq!(seen, [DRAWS, 2 * DRAWS, 3 * DRAWS]);
}

#[test]
fn what_is_asked_too_fast_is_refused_and_the_highest_that_is_named_can_be_had() {
    for motor in motors() {
        let subject = subject(&linear(&motor, Known::All), Side::Motor);
        for (flag, loops) in [
            ("--current-bandwidth", Loops::Cascade),
            ("--speed-bandwidth", Loops::Cascade),
            ("--speed-bandwidth", Loops::Voltage),
        ] {
            let ask = |hertz: f64| {
                let hertz = Some(hertz);
                let current = flag == "--current-bandwidth";
                let gains = Asked {
                    current_hz: hertz.filter(|_| current),
                    speed_hz: hertz.filter(|_| !current),
                    method: None,
                    loops: Some(loops),
                };
                design(&subject, &asked(gains))
            };
            for hertz in [400.0, 499.0, 5000.0] {
                let error = ask(hertz).expect_err("too fast").to_string();
                assert!(
                    error.contains(flag) && error.contains("--sample"),
                    "{error}"
                );
                let highest = error
                    .split("the highest that leaves 45 is ")
                    .nth(1)
                    .expect(&error);
                let highest: f64 = highest
                    .split(' ')
                    .next()
                    .expect("a number")
                    .parse()
                    .expect("Hz");
                let had = ask(0.999 * highest).unwrap_or_else(|e| panic!("{e}: {motor:?}"));
                let least = had.sections.iter().map(|s| s.closed.phase_margin);
                assert!(least.fold(f64::INFINITY, f64::min) > 44.0, "{had:?}");
            }
        }
    }
}

#[test]
fn the_zero_of_a_current_loop_is_l_over_r_as_the_period_vanishes() {
    let motor = bench::Machine::paper();
    let subject = subject(&linear(&motor, Known::All), Side::Motor);
    let options = Options {
        sample_s: Some(1e-5),
        gains: Asked {
            current_hz: Some(100.0),
            ..Asked::default()
        },
        ..Options::default()
    };
    let found = design(&subject, &options).expect("loops");
    let closed = found.section("current_loop").expect("a loop").closed;
    let zero = closed.pi.kp / closed.pi.ki;
    assert!(
        (zero / (motor.inductance_h / motor.resistance_ohm) - 1.0).abs() < 1e-3,
        "{zero}"
    );
    assert!(
        (closed.pi.kp / (TAU * 100.0 * motor.inductance_h) - 1.0).abs() < 0.02,
        "{closed:?}"
    );
    // Nothing is left but an integrator and 1.5 periods.
    let dead = 90.0 - 1.5e-5 * TAU * 100.0 * 360.0 / TAU;
    assert!(
        (closed.phase_margin - dead).abs() < 2.0,
        "{closed:?}, {dead}"
    );
}

#[test]
fn a_symmetrical_optimum_has_its_published_margin() {
    // An integrator behind a current loop: atan a − atan(1/a), less what dead time costs beyond a lag.
    let motor = bench::Machine {
        viscous_n_m_s: 0.0,
        ..bench::Machine::gearmotor()
    };
    let subject = subject(&linear(&motor, Known::All), Side::Motor);
    let found = design(&subject, &asked(Asked::default())).expect("loops");
    let speed = found.section("speed_loop").expect("a loop");
    assert_eq!(speed.method, Method::Symmetrical);
    assert!(
        (44.9..50.0).contains(&speed.closed.phase_margin),
        "{speed:?}"
    );
}

#[test]
fn what_no_loop_can_be_made_of_says_why() {
    let says = |subject: &Subject, gains: Asked, words: &[&str]| {
        let error = design(subject, &asked(gains))
            .expect_err("refused")
            .to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let some = |method, loops| Asked {
        method,
        loops,
        ..Asked::default()
    };
    let motor = bench::Machine::gearmotor();
    let volts = subject(&linear(&motor, Known::Voltage), Side::Motor);
    says(
        &volts,
        some(None, Some(Loops::Cascade)),
        &["resistance", "--known"],
    );
    let current = Asked {
        current_hz: Some(10.0),
        ..Asked::default()
    };
    says(&volts, current, &["--current-bandwidth", "resistance_ohm"]);
    let close = subject(
        &linear(&bench::Machine::servo_400w(), Known::Voltage),
        Side::Motor,
    );
    says(&close, Asked::default(), &["complex", "resistance_ohm"]);
    let nothing = subject(&linear(&motor, Known::Nothing), Side::Motor);
    says(&nothing, Asked::default(), &["gain", "fit again"]);
    let mut cascade = linear(&motor, Known::All);
    cascade
        .parameters
        .retain(|p| !p.name.starts_with("viscous"));
    let cascade = subject(&cascade, Side::Motor);
    says(
        &cascade,
        some(Some(Method::Cancel), None),
        &["viscous", "coasting", "symmetrical"],
    );
}

#[test]
fn delay_costs_margin_and_a_second_inertia_is_warned_of() {
    let motor = bench::Machine::gearmotor();
    let at = |kinds: &[Kind]| {
        let subject = subject(&result(&motor, kinds, Known::All), Side::Motor);
        let gains = Asked {
            speed_hz: Some(10.0),
            loops: Some(Loops::Voltage),
            ..Asked::default()
        };
        design(&subject, &asked(gains)).expect("loops")
    };
    let margin = |found: &Controllers| found.sections[0].closed.phase_margin;
    let (alone, late) = (at(&[]), at(&[Kind::Delay]));
    let seconds = 0.002;
    assert!((margin(&alone) - margin(&late) - seconds * 10.0 * 360.0).abs() < 1e-6);
    assert!(
        at(&[Kind::Compliance])
            .remarks
            .iter()
            .any(|r| r.contains("resonance"))
    );
}

#[test]
fn behind_a_gear_counts_stay_counts_and_radians_weigh_more() {
    let found = linear(&bench::Machine::gearmotor(), Known::All);
    for loops in [Loops::Cascade, Loops::Voltage] {
        let sides = [Side::Motor, Side::Output { ratio: 30.0 }];
        let [motor, output] = sides.map(|side| {
            let subject = subject(&found, side);
            let gains = Asked {
                loops: Some(loops),
                ..Asked::default()
            };
            let found = design(&subject, &asked(gains)).expect("loops");
            let speed = found.section("speed_loop").expect("a loop").closed;
            let per_count = TAU / subject.counts_per_rev.expect("counts");
            [speed.pi.kp, speed.pi.kp * per_count, speed.phase_margin]
        });
        for (found, factor) in [(0, 30.0), (1, 1.0), (2, 1.0)] {
            assert!(
                (output[found] / motor[found] / factor - 1.0).abs() < 1e-6,
                "{loops:?}"
            );
        }
    }
}
