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

/// The true value of an effect's parameter.
fn truth(hidden: &Hidden, key: &str) -> f64 {
    hidden
        .parameters()
        .find(|(name, ..)| *name == key)
        .unwrap()
        .1
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
        drive.extend(hold(level * machine.supply_v, 0.1));
    }
    drive.extend(coast(0.1));
    for step in 0..200 {
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
        let driven = &drive[..900];
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
        let torque = truth(&friction, "torque");
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
        for (friction, direction, keys) in [
            ("coulomb", 1.0, &["torque"][..]),
            ("coulomb", -1.0, &["torque"]),
            ("stribeck", 1.0, &["coulomb", "extra"]),
            ("stribeck", -1.0, &["coulomb", "extra"]),
            ("asym_coulomb", 1.0, &["forward"]),
            ("asym_coulomb", -1.0, &["backward"]),
        ] {
            let hidden = hide(&machine, friction, 1.0);
            let holding: f64 = keys.iter().map(|key| truth(&hidden, key)).sum();
            let volts = holding / machine.kt_n_m_a * machine.resistance_ohm;
            let bench = bench(machine, vec![hidden]);
            let below = bench.run(&hold(0.999 * direction * volts, 1.0)).unwrap();
            let stuck = below.counts.iter().all(|count| *count == below.counts[0]);
            assert!(stuck, "{name}, {friction}: moves below break-away");
            let above = bench.run(&hold(1.001 * direction * volts, 1.0)).unwrap();
            let moved = (above.angle_rad.last().unwrap() - above.angle_rad[0]) * direction;
            assert!(moved > 0.0, "{name}, {friction}: holds above break-away");
        }
    }
}

#[test]
fn friction_never_adds_energy_to_a_coasting_shaft() {
    const FRICTIONS: [&str; 6] = [
        "coulomb",
        "asym_coulomb",
        "stribeck",
        "load_friction",
        "windage",
        "asym_viscous",
    ];
    for (name, machine) in machines() {
        for direction in [1.0, -1.0] {
            let mut drive = hold(0.5 * direction * machine.supply_v, 0.3);
            let released = drive.len();
            drive.extend(coast(1.0));
            for friction in FRICTIONS {
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
fn bristles_give_back_no_more_than_they_stored() {
    for (name, machine) in machines() {
        let hidden = hide(&machine, "lugre", 1.0);
        let static_torque = truth(&hidden, "coulomb") * (1.0 + truth(&hidden, "extra"));
        let stored = 0.5 * static_torque * truth(&hidden, "presliding");
        let mut drive = hold(0.5 * machine.supply_v, 0.3);
        let released = drive.len();
        drive.extend(coast(4.0));
        let run = bench(machine, vec![hidden]).run(&drive).unwrap();
        let kinetic = |speed: &f64| 0.5 * machine.inertia_kg_m2 * speed * speed;
        let mut least = f64::INFINITY;
        for energy in run.speed_rad_s[released..].iter().map(kinetic) {
            least = least.min(energy);
            assert!(
                energy <= least + stored,
                "{name}: {energy} J after {least} J"
            );
        }
        let top = machine.top_speed_rad_s();
        assert!(
            run.speed_rad_s.last().unwrap().abs() < 1e-6 * top,
            "{name}: no rest"
        );
    }
}

#[test]
fn a_share_of_the_transmitted_torque_is_lost_at_steady_speed() {
    for (name, machine) in machines() {
        let volts = 0.5 * machine.supply_v;
        let hidden = hide(&machine, "load_friction", 1.0);
        // The same current must carry load and friction: (1 − μ)·(Kt·i − T0) … with μ·|Kt·i + T0|.
        let mut load = hide(&machine, "load_torque", 1.0);
        load.set("torque", 0.2 * machine.stall_torque_n_m())
            .unwrap();
        let (share, held) = (truth(&hidden, "share"), truth(&load, "torque"));
        let run = bench(machine, vec![hidden, load])
            .run(&hold(volts, 6.0))
            .unwrap();
        let (speed, amps) = (
            run.speed_rad_s.last().unwrap(),
            run.current_a.last().unwrap(),
        );
        let motor = machine.kt_n_m_a * amps;
        let rest = motor - held - share * (motor + held) - machine.viscous_n_m_s * speed;
        assert!(
            *speed > 0.0 && rest.abs() < 1e-6 * motor,
            "{name}: {rest} N m of {motor}"
        );
    }
}

/// Mean frequency between the first and the last maximum of a signal, in cycles per sample.
fn frequency(signal: &[f64]) -> f64 {
    let mut peaks = Vec::new();
    for (row, near) in signal.windows(3).enumerate() {
        if near[0] < near[1] && near[1] >= near[2] {
            let bend = near[0] - 2.0 * near[1] + near[2];
            peaks.push(row as f64 + 0.5 * (near[0] - near[2]) / bend);
        }
    }
    (peaks.len() - 1) as f64 / (peaks[peaks.len() - 1] - peaks[0])
}

#[test]
fn a_load_behind_a_spring_swings_at_the_frequency_of_two_masses() {
    for (name, machine) in machines() {
        let mut spring = hide(&machine, "compliance", 1.0);
        spring.set("damping", 0.01).unwrap();
        let share = truth(&spring, "load_share");
        let reduced = share * (1.0 - share) * machine.inertia_kg_m2;
        let expected = (truth(&spring, "compliance") * reduced).sqrt().recip() / TAU;
        let mut drive = hold(machine.supply_v, 0.013);
        let released = drive.len();
        drive.extend(coast(0.5));
        let run = bench(machine, vec![spring]).run(&drive).unwrap();
        let hz = frequency(&run.speed_rad_s[released..]) / 1e-3;
        assert!(
            (hz / expected - 1.0).abs() < 0.01,
            "{name}: {hz} Hz, {expected} Hz"
        );
    }
}

#[test]
fn only_the_motor_moves_within_the_gap() {
    for (name, machine) in machines() {
        let gap = hide(&machine, "backlash", 1.0);
        let alone = (1.0 - truth(&gap, "load_share")) * machine.inertia_kg_m2;
        let light = Machine {
            inertia_kg_m2: alone,
            ..machine
        };
        let volts = 0.05 * machine.supply_v;
        let drive = hold(volts, 0.5);
        let half_gap = 0.5 * truth(&gap, "gap");
        let geared = bench(machine, vec![gap]).run(&drive).unwrap();
        let free = bench(light, vec![]).run(&drive).unwrap();
        for (row, angle) in geared.angle_rad.iter().enumerate() {
            let (geared_way, free_way) = (angle - 0.3, free.angle_rad[row] - 0.3);
            if geared_way < half_gap {
                assert!((geared_way - free_way).abs() < 1e-9, "{name}, row {row}");
            } else {
                assert!(
                    geared_way < free_way,
                    "{name}, row {row}: the load does not hold back"
                );
            }
        }
    }
}

#[test]
fn heat_settles_where_its_source_and_its_leak_balance() {
    for (name, machine) in machines() {
        let mut heat = hide(&machine, "heating", 1.0);
        heat.set("time_constant", 0.2).unwrap();
        let mut load = hide(&machine, "load_torque", 1.0);
        load.set("torque", 0.5 * machine.stall_torque_n_m())
            .unwrap();
        let (leak, copper) = (truth(&heat, "thermal_resistance"), truth(&heat, "copper"));
        let (magnet, held) = (truth(&heat, "magnet"), truth(&load, "torque"));
        let run = bench(machine, vec![heat, load])
            .run(&hold(machine.supply_v, 14.0))
            .unwrap();
        let (current, speed) = (
            run.current_a.last().unwrap(),
            run.speed_rad_s.last().unwrap(),
        );
        // ΔT = Rth·R·(1 + α·ΔT)·i² solved for ΔT, then the two equations of the machine.
        let cold = leak * machine.resistance_ohm * current * current;
        let rise = cold / (1.0 - copper * cold);
        let (hot, field) = (1.0 + copper * rise, 1.0 - magnet * rise);
        let volts = machine.resistance_ohm * hot * current + machine.kb_v_s_rad * field * speed;
        let torque = machine.kt_n_m_a * field * current - machine.viscous_n_m_s * speed;
        assert!(rise > 10.0, "{name}: {rise} K");
        assert!(
            (volts / machine.supply_v - 1.0).abs() < 1e-6,
            "{name}: {volts} V"
        );
        assert!((torque / held - 1.0).abs() < 1e-6, "{name}: {torque} N m");
    }
}

#[test]
fn a_stalled_armature_shows_each_loss_of_voltage_in_its_current() {
    for (name, machine) in machines() {
        let supply = machine.supply_v;
        let volts = 0.97 * supply;
        let lost = |hidden: &Hidden, amps: f64| match hidden.name() {
            "offset_voltage" => -truth(hidden, "offset"),
            "dead_zone" => truth(hidden, "width"),
            "voltage_sat" => truth(hidden, "lost") - (supply - volts),
            "supply_sag" => truth(hidden, "resistance") * (volts / supply).powi(2) * amps,
            "brush_drop" => truth(hidden, "drop"),
            "l_sat" => 0.0,
            other => panic!("{other} is electrical: say here what voltage it takes"),
        };
        for kind in CATALOGUE.iter().filter(|kind| kind.electrical) {
            let hidden = hide(&machine, kind.name, 1.0);
            let mut lock = hide(&machine, "coulomb", 1.0);
            lock.set("torque", 2.0 * machine.stall_torque_n_m())
                .unwrap();
            let run = bench(machine, vec![hidden.clone(), lock])
                .run(&hold(volts, 1.0))
                .unwrap();
            let amps = *run.current_a.last().unwrap();
            let expected = (volts - lost(&hidden, amps)) / machine.resistance_ohm;
            assert!(
                (amps / expected - 1.0).abs() < 1e-9,
                "{name}, {}: {amps} A",
                kind.name
            );
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
            let (full, weak) = (mark(3.0), mark(0.05));
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
            assert!(gap < 0.01, "{name}, {}: {gap} counts", kind.name);
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
