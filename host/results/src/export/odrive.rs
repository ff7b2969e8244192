//! Settings of an ODrive (firmware 0.6) as lines of `odrivetool`: `axis0.config.motor` in ohm, H and N·m/A, `axis0.controller.config` in turns
//! (docs.odriverobotics.com; of `torque_constant` they say `8.27/KV`). The controller's gains are those of `gains/`, as torques.

use super::brushless::{Phase, Setting, lines};
use super::digits::rounded;
use super::error::ExportError;
use super::gains::{Loops, design};
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use std::f64::consts::TAU;

const FORMAT: &str = "odrive";

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let phase = Phase::of(subject, options, FORMAT, &mut written)?;
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
        set(
            "config.motor.pole_pairs",
            "--pole-pairs",
            "1",
            f64::from(pairs),
        );
    }
    set(
        "config.motor.phase_resistance",
        "resistance",
        "ohm",
        phase.resistance,
    );
    if let Some(henry) = phase.inductance {
        set(
            "config.motor.phase_inductance",
            "electrical_time_constant",
            "H",
            henry,
        );
    }
    set("config.motor.torque_constant", "kb", "N*m/A", phase.torque);
    set(
        "config.motor.current_control_bandwidth",
        "--current-bandwidth",
        "rad/s",
        phase.bandwidth,
    );
    // A turn is 2π rad.
    if let Some(inertia) = phase.inertia {
        set(
            "controller.config.inertia",
            "inertia",
            "N*m/(turn/s^2)",
            rounded(inertia * TAU),
        );
    }
    match speed_loop(subject, options, &mut written) {
        Ok([kp, ki]) => {
            set(
                "controller.config.vel_gain",
                "the linear machine",
                "N*m/(turn/s)",
                kp,
            );
            set(
                "controller.config.vel_integrator_gain",
                "the linear machine",
                "N*m/turn",
                ki,
            );
        }
        Err(error) => written.lacks("the speed loop", &error.to_string()),
    }
    if phase.pole_pairs.is_none() {
        written.lacks(
            "pole_pairs",
            "give them with --pole-pairs N, or leave them to the drive's set-up",
        );
    }
    written.remarks.push(
        "paths are those of firmware 0.6; on 0.5 it is axis0.motor.config instead of axis0.config.motor".to_owned(),
    );
    let line = |setting: &Setting| {
        let Setting {
            to, value, unit, ..
        } = setting;
        // A count is no fraction there.
        let number = if to.ends_with("pole_pairs") {
            format!("{value:.0}")
        } else {
            format!("{value:?}")
        };
        format!("odrv0.axis0.{to} = {number}  # {unit}")
    };
    Ok(lines(subject, &settings, "# ", line, written))
}

/// The gains of the speed loop around a current loop, N·m/(turn/s) and N·m/turn.
fn speed_loop(
    subject: &Subject,
    options: &Options,
    written: &mut Written,
) -> Result<[f64; 2], ExportError> {
    let mut options = *options;
    options.gains.loops = Some(Loops::Cascade);
    let controllers = design(subject, &options)?;
    let undetermined = |needs: &str| ExportError::Undetermined {
        format: FORMAT,
        needs: needs.to_owned(),
        remedy: super::error::NAME_RESISTANCE,
    };
    let speed = controllers.section("speed_loop");
    let pi = speed.ok_or_else(|| undetermined("a speed loop"))?.closed.pi;
    let kt = subject.physical("kt", "N*m/A");
    let kt = kt.ok_or_else(|| undetermined("Kt"))?;
    written.remarks.push(format!(
        "vel_gain and vel_integrator_gain are safe for a controller with a period of {:?} s; give the drive's with --sample 125e-6",
        controllers.period
    ));
    Ok([pi.kp, pi.ki].map(|gain| rounded(gain * kt * TAU)))
}
