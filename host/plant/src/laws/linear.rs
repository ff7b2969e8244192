//! The plain machine against its exact solutions.

use super::*;
use nalgebra::{Matrix4, Vector4};

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
        let sample = exponential(system * 1e-3);
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

/// The matrix exponential by its series, of the matrix halved until it is small, and squared as often.
fn exponential(matrix: Matrix4<f64>) -> Matrix4<f64> {
    const HALVINGS: i32 = 12;
    let small = matrix / 2f64.powi(HALVINGS);
    let (mut sum, mut term) = (Matrix4::identity(), Matrix4::identity());
    for order in 1..16 {
        term = term * small / f64::from(order);
        sum += term;
    }
    (0..HALVINGS).fold(sum, |power, _| power * power)
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
        assert_eq!(refused, kind.electrical.is_some(), "{}", kind.name);
    }
}
