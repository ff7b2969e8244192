//! Settings of a moteus as a file for `moteus_tool --restore-config`, which sends each line behind `conf set` and passes over comments
//! (mjbots/moteus, `fw/bldc_servo_structs.h`: phase to centre, ohm and H; `Kv` in rpm/V between lines, of which the firmware makes
//! 8.27/Kv N·m/A).

use super::brushless::{Phase, Setting, lines};
use super::digits::rounded;
use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use std::f64::consts::TAU;

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let phase = Phase::of(subject, options, "moteus", &mut written)?;
    let mut settings = Vec::new();
    let mut set = |to, from, unit, value| {
        settings.push(Setting {
            to,
            from,
            unit,
            value,
        });
    };
    if let Some(pairs) = phase.pole_pairs {
        set("motor.poles", "--pole-pairs", "1", f64::from(2 * pairs));
    }
    set(
        "motor.resistance_ohm",
        "resistance",
        "ohm",
        phase.resistance,
    );
    if let Some(henry) = phase.inductance {
        let from = "electrical_time_constant";
        set("motor.inductance_d_H", from, "H", henry);
        set("motor.inductance_q_H", from, "H", henry);
    }
    set("motor.Kv", "kb", "rpm/V", phase.kv());
    set(
        "servo.pid_dq_hz",
        "--current-bandwidth",
        "Hz",
        rounded(phase.bandwidth / TAU),
    );
    if phase.pole_pairs.is_none() {
        written.lacks(
            "poles",
            "give them with --pole-pairs N, or leave them to moteus_tool --calibrate",
        );
    }
    if let Some([kp, ki]) = phase.current_loop() {
        written.remarks.push(format!(
            "a firmware without servo.pid_dq_hz takes servo.pid_dq.kp {kp:?} and servo.pid_dq.ki {ki:?}; one without \
             motor.inductance_d_H measures it itself"
        ));
    }
    written.remarks.push(
        "the offsets of the commutation are not the motor's alone: moteus_tool --calibrate finds them; --restore-config keeps what it wrote".to_owned(),
    );
    let line = |setting: &Setting| {
        let Setting {
            to, value, unit, ..
        } = setting;
        // A count is no fraction there.
        if *to == "motor.poles" {
            format!("{to} {value:.0}  # {unit}")
        } else {
            format!("{to} {value:?}  # {unit}")
        }
    };
    Ok(lines(subject, &settings, "# ", line, written))
}
