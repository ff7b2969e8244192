//! Load side, heat and drive against closed forms.

use super::*;

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
        for kind in CATALOGUE {
            let Some(lost) = kind.electrical else {
                continue;
            };
            let hidden = hide(&machine, kind.name, 1.0);
            if hidden.build(&machine).unwrap().bridge().is_some() {
                // Its current is read at an instant of its ripple: the speed below has the mean.
                continue;
            }
            let mut lock = hide(&machine, "coulomb", 1.0);
            lock.set("torque", 2.0 * machine.stall_torque_n_m())
                .unwrap();
            let run = bench(machine, vec![hidden.clone(), lock])
                .run(&hold(volts, 1.0))
                .unwrap();
            let amps = *run.current_a.last().unwrap();
            let values: Vec<f64> = hidden.parameters().map(|(_, value, _)| value).collect();
            let stall = Stall {
                command_v: volts,
                supply_v: supply,
                current_a: amps,
            };
            let expected = (volts - lost(&values, &stall)) / machine.resistance_ohm;
            assert!(
                (amps / expected - 1.0).abs() < 1e-9,
                "{name}, {}: {amps} A",
                kind.name
            );
        }
    }
}

/// A loaded motor's speed shows the mean of the voltage that the bridge loses.
#[test]
fn a_bridge_loses_two_dead_times_of_each_carrier_wave_once_the_current_flows_one_way() {
    for (name, machine) in machines() {
        let supply = machine.supply_v;
        let load = hide(&machine, "load_torque", 2.0);
        let speed = |effects, volts: f64| {
            let run = bench(machine, effects).run(&hold(volts, 1.0)).unwrap();
            let [.., a, b] = [run.angle_rad[700], *run.angle_rad.last().unwrap()];
            (b - a) / (run.angle_rad.len() - 701) as f64
        };
        for (dead_s, carrier_hz) in [(5e-7, 20e3), (1e-6, 20e3), (5e-7, 40e3)] {
            let mut bridge = hide(&machine, "dead_time", 1.0);
            bridge.set("dead_time", dead_s).unwrap();
            bridge.set("carrier", carrier_hz).unwrap();
            let lost = 2.0 * dead_s * carrier_hz * supply;
            let volts = 0.8 * supply;
            let switched = speed(vec![load.clone(), bridge.clone()], volts);
            let as_much_less = speed(vec![load.clone()], volts - lost);
            assert!(
                (switched / as_much_less - 1.0).abs() < 1e-3,
                "{name}, {bridge}: {switched} is not {as_much_less}"
            );
        }
    }
}
