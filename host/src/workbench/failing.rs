//! Where the models that are looked at fail: their squared error over time, speed and order of the angle, and what each effect takes of
//! the drive.

use super::model::Model;
use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{Criterion, order_lines};
use servoid_identify::residual_analysis::{Cumulative, cumulative, own_volts};

/// Orders that are shown.
const ORDERS: usize = 30;
/// Parts of the time in which it is said what an effect takes.
const PARTS: usize = 120;

/// Of the chosen model, and of the one beside it.
pub(super) fn of(bench: &Bench) -> Result<Value, Error> {
    let (recordings, models) = {
        let state = bench.state();
        (state.recordings()?, state.both())
    };
    let data = recordings.shown();
    let criterion = recordings.criterion();
    let of = |model: &Model| of_model(data, criterion, model);
    let models = models.iter().map(of).collect::<Result<Vec<_>, Error>>()?;
    Ok(json!({ "models": models }))
}

fn of_model(data: &Data, criterion: &Criterion, model: &Model) -> Result<Value, Error> {
    let (candidate, method) = (&model.fit.candidate, model.fit.method);
    let residual = criterion.residual(data, candidate, method)?;
    let [time, speed] = cumulative(data, &residual, criterion.span.window_s.is_none());
    let curve =
        |summed: &Cumulative| json!({ "x": summed.x, "share": summed.share, "band": summed.band });
    let mut orders = vec![0.0; ORDERS];
    for line in order_lines(data, &model.fit.candidate) {
        if let Some(order) = orders.get_mut(line.order - 1) {
            *order = line.amplitude();
        }
    }
    Ok(json!({
        "id": model.id,
        "time": curve(&time),
        "speed": curve(&speed),
        "orders_v": orders,
        "taken": taken(data, model)?,
    }))
}

/// RMS of the volts that each effect takes of the drive, in parts of equal length.
fn taken(data: &Data, model: &Model) -> Result<Vec<Value>, Error> {
    let end = data.time_s.last().copied().unwrap_or(0.0);
    let mut all = Vec::new();
    for (kind, _) in model.fit.candidate.effects.iter() {
        let (candidate, method) = (&model.fit.candidate, model.fit.method);
        let volts = own_volts(data, candidate, kind, method)?;
        let mut sums = [(0usize, 0.0); PARTS];
        for residual in &volts {
            let place = data.time_s[residual.sample] / end * PARTS as f64;
            let sum = &mut sums[(place as usize).min(PARTS - 1)];
            *sum = (sum.0 + 1, sum.1 + residual.volts.powi(2));
        }
        let rms = sums.map(|(count, squares)| (squares / count.max(1) as f64).sqrt());
        let count = volts.len().max(1) as f64;
        let squares: f64 = volts.iter().map(|r| r.volts.powi(2)).sum();
        all.push(json!({
            "effect": kind.name(), "rms_v": (squares / count).sqrt(), "parts_v": rms.to_vec(), "seconds": end,
        }));
    }
    Ok(all)
}
