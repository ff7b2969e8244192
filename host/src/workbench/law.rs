//! A law that is typed on the page: read, and drawn over what the chosen model misses.

use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use servoid_formula::{Definition, Fault, Point, Used};
use servoid_identify::discovery::{Carrier, Curve};
use servoid_io::channel::Measured;
use shared::effects::formula::{Output, Variable};
use std::f64::consts::TAU;

/// Points of a drawn law.
const POINTS: usize = 81;
/// Where a variable stands that is not drawn, parts of its greatest value.
const ELSEWHERE: f64 = 0.5;

/// A law's text as it is understood, or what is wrong with it and at which character.
pub(super) fn read(text: &str) -> Result<Definition, Value> {
    Definition::parse(text.trim()).map_err(|Fault { text, at, what }| {
        let at = text.get(..at).map_or(0, |before| before.chars().count());
        json!({ "fault": { "at": at, "what": what } })
    })
}

/// What the chosen model misses along each variable, as points with half of their bands.
pub(super) fn missing(bench: &Bench) -> Result<Value, Error> {
    let (recordings, model) = {
        let state = bench.state();
        let chosen = state
            .chosen
            .map(|id| state.model(id).cloned())
            .transpose()?;
        (state.recordings()?, chosen)
    };
    let curves = model.map(|model| Curve::missing(recordings.shown(), &model.fit.candidate));
    let along = curves.unwrap_or_default().into_iter();
    let along = along.map(|(carrier, points)| {
        let bins = points.iter().map(|p| json!([p.at, p.found, 0.5 * p.band]));
        (carrier.name().to_owned(), bins.collect())
    });
    Ok(Value::Object(along.collect()))
}

/// A law over what the chosen model misses.
pub(super) fn drawn(
    bench: &Bench,
    definition: &Definition,
    missing: &Value,
) -> Result<Value, Error> {
    let recordings = bench.state().recordings()?;
    let data = recordings.shown();
    let values: Vec<f64> = definition.parameters.iter().map(|own| own.start).collect();
    let curves = carriers(definition).map(|carrier| {
        let bins = missing.get(carrier.name());
        json!({
            "against": carrier.name(),
            "unit": carrier.unit(),
            "curve": curve(definition, &values, data, carrier),
            "bins": bins.cloned().unwrap_or_else(|| json!([])),
        })
    });
    let parameters = definition.parameters.iter().map(
        |own| json!({ "name": own.name, "low": own.range.0, "high": own.range.1, "unit": own.unit }),
    );
    Ok(json!({
        "name": definition.name,
        "place": definition.place(),
        "parameters": parameters.collect::<Vec<_>>(),
        "curves": curves.collect::<Vec<_>>(),
    }))
}

/// The variables along which a law that acts on the shaft is drawn.
fn carriers(definition: &Definition) -> impl Iterator<Item = Carrier> + use<> {
    let uses = definition.uses();
    let shaft = matches!(definition.output, Output::Torque | Output::Friction);
    Carrier::ALL.into_iter().filter(move |carrier| {
        shaft
            && uses.iter().any(|used| {
                matches!(
                    (carrier, used),
                    (
                        Carrier::Speed,
                        Used::Variable(Variable::Speed) | Used::State
                    ) | (Carrier::Angle, Used::Variable(Variable::Angle))
                        | (
                            Carrier::Current,
                            Used::Variable(Variable::Current | Variable::Transmitted)
                        )
                )
            })
    })
}

/// The drive that a law asks for along one variable, with the others at half of their greatest value.
fn curve(
    definition: &Definition,
    values: &[f64],
    data: &Data,
    carrier: Carrier,
) -> Vec<(f64, f64)> {
    let (fastest, supply) = (data.units.speed, data.supply);
    let at = |k: usize| 2.0 * k as f64 / (POINTS - 1) as f64 - 1.0;
    let points = (0..POINTS).map(|k| {
        let part = at(k);
        let (mut speed, mut angle, mut current) = (ELSEWHERE * fastest, 0.0, ELSEWHERE * supply);
        let x = match carrier {
            Carrier::Speed => {
                speed = part * fastest;
                // It drives where it turns to.
                current *= part.signum();
                speed
            }
            Carrier::Angle => {
                angle = 0.5 * (part + 1.0) * TAU;
                angle
            }
            Carrier::Current => {
                current = part * supply;
                current
            }
        };
        let point = Point {
            speed,
            angle,
            current,
            transmitted: current,
            command: current,
            time: 0.0,
            temperature: data
                .measured
                .get(Measured::Temperature)
                .map_or(0.0, |all| all[0]),
            states: [speed.signum(), 0.0],
        };
        let value = definition.value(values, &point);
        // A friction stands against the motion.
        let asked = match definition.output {
            Output::Friction => speed.signum() * value.max(0.0),
            _ => -value,
        };
        (x, asked)
    });
    points.filter(|(_, y)| y.is_finite()).collect()
}
