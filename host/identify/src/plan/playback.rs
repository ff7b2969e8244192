//! Simulates an excitation under a hypothesis: shaft, winding and encoder reading.

use super::hypothesis::{Hypothesis, Setup};
use crate::fit::Options;
use servoid_engine::data::Recordings;
use servoid_engine::problem::Data;
use servoid_engine::simulation::step;
use servoid_io::channel::Series;
use servoid_io::recording::Drive;
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::error::ModelError;
use shared::excite::Command;
use shared::model::{Model, Plan, State};
use std::ops::ControlFlow;

/// State at one sample: before its command acts, and the peak while it does.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Angle as the encoder sees it, counts, not rounded.
    pub angle_counts: f64,
    /// Speed, rad/s.
    pub speed_rad_s: f64,
    /// Largest current until the next sample, as the voltage across the resistance, V.
    pub current_v: f64,
}

/// Plays a drive from rest at `start_counts`; `each` may end it.
///
/// # Errors
/// A hypothesis that is no possible model.
pub fn play(
    hypothesis: &Hypothesis,
    setup: &Setup,
    drive: &[Command<f64>],
    start_counts: f64,
    mut each: impl FnMut(Moment) -> ControlFlow<()>,
) -> Result<(), ModelError> {
    let units = setup.units()?;
    let candidate = hypothesis.candidate()?;
    for (kind, _) in candidate.effects.iter() {
        kind.check_without_temperature()?;
    }
    let method = Options::default().method;
    let model = Model::<f64>::new(&Plan {
        machine: candidate.machine,
        effects: candidate.effects,
        units,
        discretisation: method.discretisation,
        substeps: method.substeps,
    })?;
    let machine = candidate.machine;
    let reached = 1.0 - libm::exp(-setup.sample_s / machine.electrical.max(f64::MIN_POSITIVE));
    let mut state = State::at(start_counts, 0.0);
    for command in drive {
        let current = state.motion.current * units.volts;
        let speed = state.motion.speed * units.speed;
        // With the shaft held still the current would get this far towards (u − Kb·ω)/R: it may peak
        // between two samples, and the turning shaft only lowers the peak.
        let target = if command.enabled {
            command.drive * units.volts - machine.kb * speed
        } else {
            0.0
        };
        let peak = current + (target - current) * reached;
        let moment = Moment {
            angle_counts: model.reading(&state),
            speed_rad_s: speed,
            current_v: current.abs().max(peak.abs()),
        };
        if each(moment).is_break() {
            break;
        }
        step(&model, &mut state, command.drive, !command.enabled);
    }
    Ok(())
}

/// The recording that `hypothesis` would give, with the encoder's rounding, ready to be fitted.
///
/// # Errors
/// As [`play`].
pub fn record(
    hypothesis: &Hypothesis,
    setup: &Setup,
    drive: &[Command<f64>],
) -> Result<Data, ModelError> {
    let mut counts = Vec::with_capacity(drive.len());
    play(hypothesis, setup, drive, FLOOR_OFFSET_COUNTS, |moment| {
        counts.push(moment.angle_counts.floor());
        ControlFlow::Continue(())
    })?;
    let coasts = drive.iter().any(|command| !command.enabled);
    Ok(Data {
        source: hypothesis.name(),
        units: setup.units()?,
        time_s: (0..drive.len())
            .map(|k| k as f64 * setup.sample_s)
            .collect(),
        command: drive.iter().map(|command| command.drive).collect(),
        counts,
        open: coasts.then(|| drive.iter().map(|command| !command.enabled).collect()),
        measured: Series::NONE,
        quantised: true,
        drive: Drive::Voltage,
        supply: setup.supply_v,
        lengths: vec![1.0],
        length_of: vec![0; drive.len()],
        recordings: Recordings::one("", drive.len()),
        end_of: None,
    })
}
