//! Friction against closed forms, and against energy.

use super::*;

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
