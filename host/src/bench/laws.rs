//! Laws of the bench: its linear machine against the exact solution, friction against energy, and what
//! every effect of the catalogue must obey.

use super::effects::CATALOGUE;
use super::*;
use nalgebra::{Matrix4, Vector4};
use std::f64::consts::TAU;

fn machines() -> impl Iterator<Item = (&'static str, Machine)> {
    PRESETS
        .iter()
        .map(|name| (*name, Machine::preset(name).unwrap()))
}

fn hide(machine: &Machine, name: &str, strength: f64) -> Hidden {
    Hidden::typical(name, machine)
        .unwrap()
        .scaled(strength)
        .unwrap()
}

/// A bench with a fixed start, so that runs differ by nothing but what a test changes.
fn bench(machine: Machine, effects: Vec<Hidden>) -> Bench {
    Bench {
        effects,
        start_angle_rad: Some(0.3),
        ..Bench::new(machine)
    }
}

fn hold(volts: f64, seconds: f64) -> Vec<DriveSample> {
    vec![
        DriveSample {
            volts,
            enabled: true
        };
        (seconds / 1e-3) as usize
    ]
}

fn coast(seconds: f64) -> Vec<DriveSample> {
    vec![
        DriveSample {
            volts: 0.0,
            enabled: false
        };
        (seconds / 1e-3) as usize
    ]
}

/// Both directions, all levels, standstill, reversal and coasting.
fn lively(machine: &Machine) -> Vec<DriveSample> {
    let mut drive = Vec::new();
    for level in [0.02, 0.3, -0.6, 0.9, 0.0, -0.05, -1.0, 1.0, 0.15] {
        drive.extend(hold(level * machine.supply_v, 0.25));
    }
    drive.extend(coast(0.4));
    for step in 0..300 {
        let level = 0.3 * (TAU * f64::from(step * step) / 15_000.0).sin();
        drive.extend(hold(level * machine.supply_v, 1e-3));
    }
    drive
}

fn rms_counts(a: &Run, b: &Run) -> f64 {
    let squares: f64 = a
        .counts
        .iter()
        .zip(&b.counts)
        .map(|(a, b)| ((a - b) as f64).powi(2))
        .sum();
    (squares / a.counts.len() as f64).sqrt()
}

fn largest_gap_counts(a: &Run, b: &Run) -> f64 {
    let gaps = a
        .angle_rad
        .iter()
        .zip(&b.angle_rad)
        .map(|(a, b)| (a - b).abs());
    gaps.fold(0.0, f64::max) * 4096.0 / TAU
}

#[test]
fn the_plain_machine_equals_the_matrix_exponential() {
    for (name, machine) in machines() {
        let m = &machine;
        let drive = lively(m);
        let driven = &drive[..2250];
        let run = bench(machine, vec![]).run(driven).unwrap();
        #[rustfmt::skip]
        let system = Matrix4::new( // angle, speed, current, volts
            0.0, 1.0, 0.0, 0.0,
            0.0, -m.viscous_n_m_s / m.inertia_kg_m2, m.kt_n_m_a / m.inertia_kg_m2, 0.0,
            0.0, -m.kb_v_s_rad / m.inductance_h, -m.resistance_ohm / m.inductance_h, 1.0 / m.inductance_h,
            0.0, 0.0, 0.0, 0.0,
        );
        let sample = (system * 1e-3).exp();
        let mut state = Vector4::new(0.3, 0.0, 0.0, 0.0);
        for (row, command) in driven.iter().enumerate() {
            let error = (state[0] - run.angle_rad[row]).abs() * 4096.0 / TAU;
            assert!(error < 1e-6, "{name}, row {row}: {error} counts");
            assert_eq!(
                run.counts[row],
                (run.angle_rad[row] * 4096.0 / TAU).floor() as i64
            );
            state[3] = command.volts;
            state = sample * state;
        }
    }
}

#[test]
fn a_constant_load_slows_the_machine_along_its_torque_speed_line() {
    for (name, machine) in machines() {
        let volts = 0.5 * machine.supply_v;
        let stall = 0.5 * machine.stall_torque_n_m();
        for share in [0.0, 0.4, 1.0] {
            let mut load = hide(&machine, "load_torque", 1.0);
            load.set("torque", share * stall).unwrap();
            let run = bench(machine, vec![load]).run(&hold(volts, 4.0)).unwrap();
            let speed = run.speed_rad_s.last().unwrap();
            let expected = (1.0 - share) * machine.no_load_speed_rad_s(volts);
            let top = machine.top_speed_rad_s();
            assert!(
                (speed - expected).abs() < 1e-6 * top,
                "{name}, {share}: {speed}, {expected}"
            );
        }
    }
}

#[test]
fn a_coasting_shaft_stops_where_the_closed_form_says() {
    for (name, machine) in machines() {
        let friction = hide(&machine, "coulomb", 1.0);
        let torque = friction.parameters().next().unwrap().1;
        let mut drive = hold(0.8 * machine.supply_v, 0.5);
        let released = drive.len();
        drive.extend(coast(8.0));
        let run = bench(machine, vec![friction]).run(&drive).unwrap();
        // J dω/dt = −Tc − b ω from ω0 to 0.
        let (speed, viscous) = (run.speed_rad_s[released], machine.viscous_n_m_s);
        let log = (viscous * speed / torque).ln_1p();
        let way = machine.inertia_kg_m2 / viscous * (speed - torque / viscous * log);
        let error = run.angle_rad.last().unwrap() - run.angle_rad[released] - way;
        assert!(
            error.abs() * 4096.0 / TAU < 1e-5,
            "{name}: {error} rad of {way}"
        );
        assert_eq!(*run.speed_rad_s.last().unwrap(), 0.0, "{name}");
    }
}

#[test]
fn friction_holds_the_shaft_until_the_torque_outgrows_it() {
    for (name, machine) in machines() {
        for friction in ["coulomb", "stribeck"] {
            let hidden = hide(&machine, friction, 1.0);
            let torques = hidden.parameters().filter(|(_, _, unit)| *unit == "N*m");
            let holding: f64 = torques.map(|(_, value, _)| value).sum();
            let volts = holding / machine.kt_n_m_a * machine.resistance_ohm;
            for direction in [1.0, -1.0] {
                let bench = bench(machine, vec![hidden.clone()]);
                let below = bench.run(&hold(0.999 * direction * volts, 1.0)).unwrap();
                let stuck = below.counts.iter().all(|count| *count == below.counts[0]);
                assert!(stuck, "{name}, {friction}: moves below break-away");
                let above = bench.run(&hold(1.001 * direction * volts, 1.0)).unwrap();
                let moved = (above.angle_rad.last().unwrap() - above.angle_rad[0]) * direction;
                assert!(moved > 0.0, "{name}, {friction}: holds above break-away");
            }
        }
    }
}

#[test]
fn friction_never_adds_energy_to_a_coasting_shaft() {
    for (name, machine) in machines() {
        for friction in ["coulomb", "stribeck"] {
            for direction in [1.0, -1.0] {
                let mut drive = hold(0.5 * direction * machine.supply_v, 0.3);
                let released = drive.len();
                drive.extend(coast(3.0));
                let run = bench(machine, vec![hide(&machine, friction, 1.0)])
                    .run(&drive)
                    .unwrap();
                for pair in run.speed_rad_s[released..].windows(2) {
                    let slower = (0.0..=pair[0] * direction).contains(&(pair[1] * direction));
                    assert!(slower, "{name}, {friction}: {pair:?}");
                }
            }
        }
    }
}

#[test]
fn an_effect_of_no_strength_is_the_plain_machine_bit_for_bit() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        let plain = bench(machine, vec![]).run(&drive).unwrap();
        for kind in CATALOGUE {
            let absent = bench(machine, vec![hide(&machine, kind.name, 0.0)])
                .run(&drive)
                .unwrap();
            assert!(absent == plain, "{name}, {}: differs", kind.name);
        }
    }
}

#[test]
fn an_effect_shows_and_shows_less_with_less_strength() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        let plain = bench(machine, vec![]).run(&drive).unwrap();
        for kind in CATALOGUE {
            let mark = |strength| {
                let effects = vec![hide(&machine, kind.name, strength)];
                rms_counts(&bench(machine, effects).run(&drive).unwrap(), &plain)
            };
            let (full, weak) = (mark(1.0), mark(0.02));
            println!(
                "{name:>14} {:>16}: {full:10.2} counts, weak {weak:8.3}",
                kind.name
            );
            assert!(
                full > 0.3,
                "{name}, {}: invisible, {full} counts",
                kind.name
            );
            assert!(
                weak < 0.3 * full + 0.3,
                "{name}, {}: {weak} of {full}",
                kind.name
            );
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_does_not() {
    let machine = Machine::gearmotor();
    let drive = lively(&machine);
    let effects: Vec<_> = CATALOGUE
        .iter()
        .map(|kind| hide(&machine, kind.name, 0.5))
        .collect();
    let run = |seed, effects: Vec<Hidden>| {
        let noisy = Bench {
            seed,
            jitter_s: 2e-4,
            current_noise_a: 0.01,
            ..Bench::new(machine)
        };
        Bench { effects, ..noisy }.run(&drive).unwrap()
    };
    let first = run(5, effects.clone());
    assert!(
        first == run(5, effects.iter().rev().cloned().collect()),
        "the order matters"
    );
    assert!(first.counts != run(6, effects).counts);
    assert!(first.time_s.windows(2).all(|pair| pair[0] < pair[1]));
}

#[test]
fn half_the_substep_gives_the_same_recording() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        for kind in CATALOGUE {
            let coarse = bench(machine, vec![hide(&machine, kind.name, 1.0)]);
            let fine = Bench {
                substep_hz: 2.0 * coarse.substep_hz,
                ..coarse.clone()
            };
            let gap = largest_gap_counts(&coarse.run(&drive).unwrap(), &fine.run(&drive).unwrap());
            println!("{name:>14} {:>16}: {gap:.1e} counts", kind.name);
            assert!(gap < 0.05, "{name}, {}: {gap} counts", kind.name);
        }
    }
}

#[test]
fn a_current_loop_gives_the_current_commanded_and_refuses_effects_that_it_hides() {
    let machine = Machine::servo_400w();
    let amps = 0.01 * machine.stall_current_a();
    let ideal = Bench {
        amplifier: Amplifier::Current,
        ..bench(machine, vec![])
    };
    let run = ideal.run(&hold(amps, 1.0)).unwrap();
    // J dω/dt = Kt i − b ω.
    let rate = machine.viscous_n_m_s / machine.inertia_kg_m2;
    let expected = machine.kt_n_m_a * amps / machine.viscous_n_m_s * -(-rate * 0.999).exp_m1();
    let speed = run.speed_rad_s.last().unwrap();
    assert!(
        (speed - expected).abs() < 1e-9 * expected,
        "{speed}, {expected}"
    );
    assert!(run.current_a[1..].iter().all(|current| *current == amps));
    for kind in CATALOGUE {
        let effects = vec![hide(&machine, kind.name, 1.0)];
        let refused = Bench {
            effects,
            ..ideal.clone()
        }
        .run(&hold(amps, 0.1))
        .is_err();
        assert_eq!(refused, kind.electrical, "{}", kind.name);
    }
}

#[test]
fn impossible_orders_are_refused_by_name() {
    let machine = Machine::paper();
    let drive = hold(1.0, 0.01);
    let good = bench(machine, vec![]);
    let twice = vec![
        hide(&machine, "coulomb", 1.0),
        hide(&machine, "coulomb", 2.0),
    ];
    let broken = Machine {
        inertia_kg_m2: 0.0,
        ..machine
    };
    let cases = [
        (
            Bench {
                counts_per_rev: 0,
                ..good.clone()
            },
            "counts_per_rev = 0",
        ),
        (
            Bench {
                sample_s: -1.0,
                ..good.clone()
            },
            "sample_s = -1",
        ),
        (
            Bench {
                jitter_s: 1.0,
                ..good.clone()
            },
            "jitter_s = 1",
        ),
        (
            Bench {
                substep_hz: 1e3,
                ..good.clone()
            },
            "substep_hz = 1000",
        ),
        (
            Bench {
                current_noise_a: f64::NAN,
                ..good.clone()
            },
            "current_noise_a = NaN",
        ),
        (
            Bench {
                machine: broken,
                ..good.clone()
            },
            "machine.inertia_kg_m2 = 0",
        ),
        (
            Bench {
                effects: twice,
                ..good.clone()
            },
            "`coulomb` is listed twice",
        ),
    ];
    for (bench, expected) in cases {
        let message = bench.run(&drive).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    let mut drive = drive;
    drive[3].volts = f64::INFINITY;
    let message = good.run(&drive).unwrap_err().to_string();
    assert!(message.contains("drive sample 3"), "{message}");
}
