//! Servos by the targets of their position loops, against the voltage that was measured behind the loop.

use crate::fits::fitted;
use crate::limits::within;
use crate::source::{data, vendored};
use servoid_engine::simulation::replayed;
use servoid_identify::fit::Fit;
use servoid_io::input::{MotorFile, read_recording};
use servoid_io::position_loop::GainOrigin;
use servoid_io::recording::Recording;
use shared::effects::Kind;
use std::f64::consts::TAU;
use testing::recordings::{self, Vendored};

/// Supply that the motor file states, V.
const SUPPLY_V: f64 = 7.3;
/// Steps of the PWM for all of it.
const PWM_STEPS: f64 = 885.0;
const GAINS: [u32; 4] = [100, 200, 400, 800];
const MOTIONS: [&str; 2] = ["sin_time_square", "up_and_down"];

/// Gain of the servo's loop, V/rad: see `bam_xl330_position.toml`.
fn gain_v_per_rad(kp: u32) -> f64 {
    f64::from(kp) / 256.0 * 4096.0 / TAU / PWM_STEPS * SUPPLY_V
}

/// A recording through a motor file that is changed.
fn read(name: &str, map: &str, change: impl Fn(&mut MotorFile)) -> Result<Recording, String> {
    let path = recordings::map(map);
    let mut motor = MotorFile::read(&path).unwrap_or_else(|error| panic!("{error}"));
    change(&mut motor);
    let recordings = Vendored::new();
    let read = read_recording(&recordings.unpack(&format!("bam_xl330/{name}.csv")), &motor);
    read.map_err(|error| error.to_string())
}

/// A recording of targets, with a given gain or with none.
fn by_target(name: &str, gain: Option<f64>) -> Result<Recording, String> {
    read(name, "bam_xl330_position.toml", |motor| {
        if let Some(settings) = &mut motor.position {
            settings.gain_v_per_rad = gain;
        }
    })
}

/// RMS of the difference of two columns over that of the first, per cent.
fn apart(right: &[f64], other: &[f64]) -> f64 {
    let squares = |values: Vec<f64>| values.iter().map(|x| x * x).sum::<f64>();
    let off = squares(right.iter().zip(other).map(|(a, b)| a - b).collect());
    100.0 * (off / squares(right.to_vec())).sqrt()
}

/// What the loop gives is what the servo reported of its bridge, and that times the supply of the motor file is the measured
/// voltage but for the supply's sag under load (6.1 to 9.2 V).
#[test]
fn the_voltage_behind_the_loop_is_the_measured_one() {
    for motion in MOTIONS {
        for kp in GAINS {
            let name = format!("{motion}_kp{kp}");
            let told = by_target(&name, Some(gain_v_per_rad(kp))).unwrap();
            let pwm = read(&name, "bam_xl330.toml", |motor| {
                motor.columns.set(
                    servoid_io::channel::Channel::Command,
                    Some("pwm_counts".into()),
                );
            });
            let duty: Vec<f64> = pwm.unwrap().command.iter().map(|x| x / PWM_STEPS).collect();
            let share: Vec<f64> = told.command.iter().map(|volts| volts / SUPPLY_V).collect();
            let duty = apart(&duty, &share);
            let measured = vendored(&format!("bam_xl330/{name}")).command;
            let volts = apart(&measured, &told.command);
            println!("{name}: duty {duty:.2} %, volts {volts:.2} %");
            within(&format!("{name}, duty, %"), duty, 0.1..1.5);
            within(&format!("{name}, volts, %"), volts, 1.0..11.5);
        }
    }
}

fn parameter(fit: &Fit, name: &str) -> f64 {
    let found = fit.parameters.iter().find(|p| p.name == name);
    found.unwrap_or_else(|| panic!("no {name}")).value
}

/// The motor behind the loop is the one that the measured voltage shows.
#[test]
fn a_motor_is_the_same_by_its_target_and_by_its_voltage() {
    let effects = [Kind::Unbalance, Kind::LoadFriction];
    for kp in [400, 800] {
        let name = format!("sin_time_square_kp{kp}");
        let by_voltage = fitted(
            &data(&vendored(&format!("bam_xl330/{name}"))),
            &effects,
            0.5,
        );
        let told = by_target(&name, Some(gain_v_per_rad(kp))).unwrap();
        let by_target = fitted(&data(&told), &effects, 0.5);
        for what in ["gain", "a1", "load_friction.share"] {
            let ratio = parameter(&by_target, what) / parameter(&by_voltage, what);
            println!("{name}, {what}: {ratio:.4}");
            within(&format!("{name}, {what}"), ratio, 0.97..1.03);
        }
    }
}

/// Behind its own loop the model goes where the servo goes: nearer to it than along the volts, since the loop takes back what the model does
/// wrong.
#[test]
fn a_motor_is_driven_by_its_loop_where_the_servo_goes() {
    let effects = [Kind::Unbalance, Kind::LoadFriction];
    for (kp, most) in [(400, 30.0), (800, 40.0)] {
        let told = by_target(&format!("sin_time_square_kp{kp}"), Some(gain_v_per_rad(kp)));
        let data = data(&told.unwrap());
        let fit = fitted(&data, &effects, 0.5);
        let replayed = replayed(&data, &fit.candidate, fit.method)[0].expect("a loop");
        println!(
            "kp {kp}: {replayed:.2} counts RMS, along the volts {:.2}",
            fit.rms_counts
        );
        within(&format!("kp {kp}, counts"), replayed, 5.0..most);
    }
}

/// The two lively motions of high gain reach the limit and tell the gain. Those of low gain do not, and the motions up and down
/// hardly turn.
#[test]
fn a_servo_tells_its_gain_where_it_reaches_its_limit_and_none_else() {
    for motion in MOTIONS {
        for kp in GAINS {
            let name = format!("{motion}_kp{kp}");
            let told = by_target(&name, None);
            if motion == "up_and_down" || kp < 400 {
                let refusal = told.expect_err(&name);
                assert!(
                    refusal.contains("volts cannot be told"),
                    "{name}: {refusal}"
                );
                continue;
            }
            let control = told.unwrap().position.expect("a position drive").control;
            let ratio = control.gain_v_per_rad / gain_v_per_rad(kp);
            println!("{name}: {ratio:.4} of the gain");
            within(&format!("{name}, gain over the true one"), ratio, 0.9..1.1);
            let GainOrigin::Estimated(estimate) = control.origin else {
                panic!("{name}: {control:?}");
            };
            within(
                &format!("{name}, its error"),
                estimate.relative_std,
                0.01..0.1,
            );
        }
    }
}
