//! The position loop behind a recording, in a line.

use super::fold::folded;
use crate::number_text::{short, with_error};
use crate::schema::PositionLoop;
use servoid_engine::problem::Data;

/// The position loops that made the volts of these recordings, a line each.
pub(super) fn lines(data: &Data) -> String {
    let loops = PositionLoop::all(data);
    let described = loops.iter().map(|control| {
        let text = described(control);
        match data.recordings.are_several() {
            true => format!("{}: {text}", control.recording),
            false => text,
        }
    });
    described.map(|line| folded(&line, "  ") + "\n").collect()
}

/// One of them.
pub(super) fn described(control: &PositionLoop) -> String {
    let gain = control.gain_v_per_rad.unwrap_or(f64::NAN);
    let (gain, from) = match control.gain_estimated {
        true => (with_error(gain, control.gain_std), "estimated"),
        false => (short(gain), "given"),
    };
    let mut text = format!("position loop of {gain} V/rad ({from})");
    let mut say = |what: &str, value: Option<f64>, unit: &str| {
        if let Some(value) = value.filter(|value| *value > 0.0) {
            text += &format!(", {what} {} {unit}", short(value));
        }
    };
    say("damping", control.damping_v_s_per_rad, "V s/rad");
    say("up to", control.limit_v, "V");
    say("dead band", control.dead_band_rad, "rad");
    say("at", control.rate_hz, "Hz");
    text
}
