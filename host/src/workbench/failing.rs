//! Where the models that are looked at fail: their squared error over time, speed and order of the angle, and what each effect takes of
//! the drive.

use super::model::Model;
use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::order_lines;
use servoid_identify::diagnose::residual_analysis::{Cumulative, cumulative};

/// Orders that are shown.
const ORDERS: usize = 30;

/// Of the chosen model, and of the one beside it.
pub(super) fn of(bench: &Bench) -> Result<Value, Error> {
    let (recordings, models) = {
        let state = bench.state();
        let looked_at = [state.chosen, state.against];
        let models: Vec<Model> = looked_at
            .into_iter()
            .flatten()
            .filter_map(|id| state.model(id).ok().cloned())
            .collect();
        (state.recordings()?, models)
    };
    let data = recordings.shown();
    let of = |model: &Model| of_model(data, model);
    let models = models.iter().map(of).collect::<Result<Vec<_>, Error>>()?;
    Ok(json!({ "models": models }))
}

fn of_model(data: &Data, model: &Model) -> Result<Value, Error> {
    let [time, speed] = cumulative(data, &model.fit.candidate, model.fit.method)?;
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
    }))
}
