//! A run that is under way, as the page draws it: the last seconds of what was measured, models that run along, and what they foresee of
//! an experiment whose commands are known.

use super::device::UnderWay;
use super::planned::Planned;
use super::series::picked;
use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle, errors};
use servoid_engine::simulation::Method;
use servoid_io::channel::Measured;
use servoid_results::picture::Run;
use shared::cost::Cost;
use shared::wire::Stage;

/// Seconds that are drawn.
const SECONDS: f64 = 8.0;
/// Seconds ahead of the last reading that are drawn of an experiment.
const AHEAD_S: f64 = 1.6;
/// Most points of a curve.
const POINTS: usize = 700;
/// Fewest readings along which a model runs.
const FEWEST: usize = 20;
/// Memory of the observer whose innovations are shown, control periods.
const MEMORY_PERIODS: f64 = 20.0;

/// A model that runs along.
struct Along {
    name: String,
    candidate: Candidate,
    method: Method,
}

/// What is drawn of the run that is under way; null without one.
pub(super) fn view(bench: &Bench) -> Result<Value, Error> {
    let device = bench.device()?;
    let Some(run) = device.under_way() else {
        return Ok(Value::Null);
    };
    let period = device.period_s();
    let recording = device.so_far(&run);
    let samples = recording.len();
    let first = samples.saturating_sub((SECONDS / period) as usize);
    let drawn = |values: &[f64], scale: f64| -> Vec<f64> {
        picked(values, first..samples, POINTS, |x| x * scale)
    };
    let turns = 1.0 / recording.counts_per_rev;
    let start = recording.counts.first().copied().unwrap_or(0.0);
    let counts: Vec<f64> = recording.counts.iter().map(|c| c - start).collect();
    let drives = matches!(
        run.recorded.stage,
        Stage::Excite | Stage::Record | Stage::Verify
    );
    let data = (drives && samples >= FEWEST)
        .then(|| Data::new(&recording).ok())
        .flatten();
    // Where each model has come to, counts.
    let mut reached = Vec::new();
    let models: Vec<Value> = (data.iter())
        .flat_map(|data| along(bench, &run).into_iter().map(move |one| (data, one)))
        .filter_map(|(data, one)| {
            let run = Run::fitted(&one.name, data, &one.candidate, one.method).ok()?;
            let horizon = Horizon::Observer(MEMORY_PERIODS * period);
            let (start, cost) = (StartAngle::Free, Cost::Squared);
            let innovations =
                errors(data, &one.candidate, one.method, &horizon, start, cost).ok()?;
            let centre = data.half_cell();
            let innovations: Vec<f64> = innovations.iter().map(|e| e - centre).collect();
            let angle: Vec<f64> = (counts.iter().zip(&run.residual))
                .map(|(count, off)| count + off)
                .collect();
            reached.push(*angle.last()?);
            let recent = run.residual.get(first..)?;
            let square = recent.iter().map(|e| e * e).sum::<f64>() / recent.len().max(1) as f64;
            Some(json!({
                "name": one.name,
                "angle": drawn(&angle, turns),
                "residual": drawn(&run.residual, 1.0),
                "innovation": drawn(&innovations, 1.0),
                "rms_counts": square.sqrt(),
            }))
        })
        .collect();
    let speed = samples.checked_sub(11).map(|from| {
        let (a, b) = (recording.counts[from], recording.counts[samples - 1]);
        (b - a) * turns * std::f64::consts::TAU / (10.0 * period)
    });
    Ok(json!({
        "what": run.what,
        "stage": format!("{:?}", run.recorded.stage).to_lowercase(),
        "seconds": samples as f64 * period,
        "of_seconds": of_seconds(&run, period),
        "missing": run.recorded.missing(),
        "models_run": run.models,
        "time": drawn(&recording.time_s, 1.0),
        "angle": drawn(&counts, turns),
        "drive": drawn(&recording.command, 1.0),
        "open": recording.enabled.as_ref().map(|on| picked(on, first..samples, POINTS, |on| u8::from(!on))),
        "models": models,
        "ahead": run.planned.as_deref().filter(|_| drives).map(|planned| ahead(planned, samples, &reached, turns)),
        "current_a": recording.measured.get(Measured::Current).and_then(<[f64]>::last),
        "speed_rad_s": speed,
    }))
}

/// The models that run along: those between which an experiment decides, else the one that is looked at.
fn along(bench: &Bench, run: &UnderWay) -> Vec<Along> {
    if let Some(planned) = &run.planned {
        let rivals = planned.rivals.iter().map(|rival| Along {
            name: rival.effect.name().to_owned(),
            candidate: rival.candidate,
            method: rival.method,
        });
        return rivals.collect();
    }
    let state = bench.state();
    let chosen = state.chosen_model().ok().map(|model| Along {
        name: model.name(),
        candidate: model.fit.candidate,
        method: model.fit.method,
    });
    chosen.into_iter().collect()
}

/// Length of the present stage, s: an experiment has that of its commands.
fn of_seconds(run: &UnderWay, period: f64) -> Option<f64> {
    let planned = run
        .planned
        .as_deref()
        .filter(|_| run.recorded.stage == Stage::Excite);
    match planned {
        Some(planned) => planned.commands.time_s.last().copied(),
        None => run.length.map(|length| f64::from(length) * period),
    }
}

/// What comes next of an experiment, and how each rival foresees the shaft to go on from where its run has `reached`, counts.
fn ahead(planned: &Planned, from: usize, reached: &[f64], turns: f64) -> Value {
    let time = &planned.commands.time_s;
    let period = time.get(1).copied().unwrap_or(1e-3);
    let to = (from + (AHEAD_S / period) as usize).min(time.len());
    let range = from.min(to)..to;
    let drawn = |values: &[f64], scale: f64, shift: f64| -> Vec<f64> {
        picked(values, range.clone(), POINTS / 4, |x| (x + shift) * scale)
    };
    let shift = |k: usize, counts: &[f64]| {
        let here = counts.get(range.start).or(counts.last());
        reached.get(k).zip(here).map_or(0.0, |(at, here)| at - here)
    };
    let rivals = planned.rivals.iter().enumerate();
    let angles = rivals.map(|(k, rival)| drawn(&rival.counts, turns, shift(k, &rival.counts)));
    json!({
        "time": drawn(time, 1.0, 0.0),
        "drive": drawn(&planned.commands.voltage_v, 1.0, 0.0),
        "angles": angles.collect::<Vec<_>>(),
    })
}
