//! Laws of position loops, on motions that are known and on the virtual bench.

use super::{Follower, GainOrigin, GainUnknown, LoopSettings, PositionLoop};
use crate::record::Record;
use crate::recording::Recording;
use servoid_plant::{Amplifier, Bench, DriveSample, Hidden, Machine, PRESETS, PositionControl};
use shared::excite::{COMMISSIONING, commands};
use std::f64::consts::{PI, TAU};

const COUNTS_PER_REV: f64 = 4096.0;

fn control(settings: LoopSettings) -> PositionLoop {
    settings.with(2.0, 6.0, GainOrigin::Given)
}

/// Volts of a loop whose reading runs ahead as a cubic of time and whose target stands still.
fn volts_of_a_cubic(settings: LoopSettings) -> (Vec<f64>, Vec<f64>, impl Fn(f64) -> f64) {
    let angle = |t: f64| 0.3 * t + 0.4 * t * t - 0.2 * t * t * t;
    let time_s: Vec<f64> = (0..400).map(|k| 5e-3 * f64::from(k)).collect();
    let counts: Vec<f64> = (time_s.iter())
        .map(|&t| angle(t) / TAU * COUNTS_PER_REV)
        .collect();
    let target_counts = vec![COUNTS_PER_REV / TAU; time_s.len()];
    let follower = Follower {
        time_s: &time_s,
        target_counts: &target_counts,
        counts: &counts,
        enabled: None,
        counts_per_rev: COUNTS_PER_REV,
    };
    (follower.volts(&control(settings)), time_s, angle)
}

#[test]
fn below_its_limit_a_loop_gives_its_gain_times_the_error_in_the_middle_of_the_interval() {
    let (volts, time, angle) = volts_of_a_cubic(LoopSettings::default());
    for k in 1..time.len() - 2 {
        let middle = 0.5 * (time[k] + time[k + 1]);
        let right = 2.0 * (1.0 - angle(middle));
        assert!((volts[k] - right).abs() < 2e-5, "{k}: {} {right}", volts[k]);
    }
}

#[test]
fn a_loop_of_a_stated_rate_is_late_by_half_its_period() {
    let settings = LoopSettings {
        rate_hz: Some(100.0),
        ..LoopSettings::default()
    };
    let (volts, time, angle) = volts_of_a_cubic(settings);
    for k in 2..time.len() - 2 {
        let middle = 0.5 * (time[k] + time[k + 1]) - 5e-3;
        let right = 2.0 * (1.0 - angle(middle));
        assert!((volts[k] - right).abs() < 2e-5, "{k}: {} {right}", volts[k]);
    }
}

#[test]
fn damping_takes_its_gain_times_the_speed_and_the_dead_band_all() {
    let settings = LoopSettings {
        damping_v_s_per_rad: Some(0.5),
        dead_band_rad: Some(0.2),
        ..LoopSettings::default()
    };
    let (volts, time, angle) = volts_of_a_cubic(settings);
    for k in 1..time.len() - 2 {
        let middle = 0.5 * (time[k] + time[k + 1]);
        let speed = (angle(time[k + 1]) - angle(time[k])) / 5e-3;
        let error = 1.0 - angle(middle);
        let right = if error.abs() < 0.2 {
            0.0
        } else {
            2.0 * error - 0.5 * speed
        };
        let near_its_edge = (error.abs() - 0.2).abs() < 0.01;
        assert!(
            near_its_edge || (volts[k] - right).abs() < 1e-4,
            "{k}: {} {right}",
            volts[k]
        );
    }
}

#[test]
fn no_number_makes_a_voltage_beyond_the_limit() {
    for gain in [1e-300, 1.0, 1e300] {
        for damping in [0.0, 1e300] {
            let settings = LoopSettings {
                damping_v_s_per_rad: Some(damping),
                ..LoopSettings::default()
            };
            let control = settings.with(gain, 6.0, GainOrigin::Given);
            for (error, speed) in [(1e9, 1e9), (-1e300, 1e300), (0.0, -1.0)] {
                let volts = control.volts(error, speed);
                assert!(volts.abs() <= 6.0, "{gain} {damping} {error}: {volts}");
            }
        }
    }
}

/// The bench's motor behind a loop, following targets of up to `reach` rad.
fn recorded(machine: Machine, gain: f64, reach: f64) -> Recording {
    let mut bench = Bench::new(machine);
    bench.effects = vec![Hidden::typical("coulomb", &machine).expect("an effect")];
    bench.amplifier = Amplifier::Position(PositionControl::proportional(gain, machine.supply_v));
    bench.seed = 3;
    let targets: Vec<DriveSample> = commands::<f64>(&COMMISSIONING, bench.sample_s, 3)
        .map(|command| DriveSample {
            volts: reach * command.drive,
            enabled: true,
        })
        .collect();
    bench.record(&targets, "bench", false).expect("a recording")
}

fn told(recording: &Recording, limit_v: f64) -> Result<f64, GainUnknown> {
    let drive = recording.position.as_ref().expect("a position drive");
    let follower = Follower {
        time_s: &recording.time_s,
        target_counts: &drive.target_counts,
        counts: &recording.counts,
        enabled: None,
        counts_per_rev: recording.counts_per_rev,
    };
    let control = follower.control(&LoopSettings::default(), limit_v)?;
    println!("{:?}", control.origin);
    Ok(control.gain_v_per_rad)
}

#[test]
fn every_motor_tells_a_gain_that_reaches_the_limit_and_none_that_does_not() {
    for name in PRESETS {
        let machine = Machine::preset(name).expect("a preset");
        let gain = machine.supply_v / PI;
        let limited = recorded(machine, gain, TAU);
        let ratio = told(&limited, machine.supply_v).expect(name) / gain;
        println!("{name}: {ratio:.4} of the gain");
        // Within the least error that is stated.
        assert!((ratio - 1.0).abs() < 0.04, "{name}: {ratio}");
        let free = recorded(machine, gain, 0.3);
        assert_eq!(
            told(&free, machine.supply_v),
            Err(GainUnknown::NeverLimited),
            "{name}"
        );
    }
}
