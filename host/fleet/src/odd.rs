//! Units that are not like the others, each with the reason.

use crate::multiple::discoveries;
use crate::quantity::{Quantity, Table};
use crate::robust::{Distances, centre, median};
use crate::unit::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Fewer units have no usual one.
const LEAST: usize = 20;
/// Part of the odd units that may be none.
const FALSE: f64 = 0.05;
/// Spreads beyond which a quantity is named as a reason.
const FAR: f64 = 3.0;
/// How many times the variance of an estimate's own error units must vary to differ measurably.
const MEASURABLE: f64 = 2.0;
/// The least that logarithms of errors are taken to spread by, and the spreads beyond which one is odd.
const ERROR_SPREAD: f64 = 0.05;
const ERROR_FAR: f64 = 6.0;
/// Part of the units below which a set of effects is rare.
const RARE: f64 = 0.02;
/// How many times an effect must lower the error for its name alone to make a unit odd.
const LOWERS: f64 = 1.5;

/// A unit that is not like the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Odd {
    /// The recording.
    pub unit: String,
    /// Its motor, where a serial number is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub serial: Option<String>,
    /// Probability that a usual unit is as far from the middle of all parameters together.
    pub p_value: Option<f64>,
    /// Why, the strongest first.
    pub reasons: Vec<Reason>,
}

/// Why a unit is odd.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reason {
    /// `parameter`, `combination`, `error`, `effect` or `no_effect`.
    pub kind: String,
    /// The parameter or effect; null for the other kinds.
    pub name: Option<String>,
    /// Its value here.
    pub value: Option<f64>,
    /// What is usual.
    pub usual: Option<f64>,
    /// Distance from it in spreads of the fleet.
    pub spreads: Option<f64>,
    /// In words.
    pub text: String,
}

/// The odd ones, by their numbers.
pub(crate) fn odd(
    units: &[Unit],
    table: &Table,
    results: &dyn Fn(&BTreeSet<usize>) -> HashMap<usize, String>,
) -> Vec<(usize, Odd)> {
    if units.len() < LEAST {
        return Vec::new();
    }
    let standard = standard(table);
    let mut reasons: HashMap<usize, Vec<Reason>> = HashMap::new();
    let p = p_values(&standard);
    let tested: Vec<usize> = (0..units.len()).filter(|unit| p[*unit].is_some()).collect();
    let own: Vec<f64> = tested.iter().filter_map(|unit| p[*unit]).collect();
    for (&unit, far) in tested.iter().zip(discoveries(&own, FALSE)) {
        if far {
            reasons.insert(unit, of_parameters(table, &standard, unit));
        }
    }
    for (unit, reason) in of_errors(units) {
        reasons.entry(unit).or_default().push(reason);
    }
    for (unit, reason) in of_effects(units, results) {
        reasons.entry(unit).or_default().push(reason);
    }
    let mut found: Vec<(usize, Odd)> = reasons
        .into_iter()
        .map(|(unit, reasons)| {
            let odd = Odd {
                unit: units[unit].name.clone(),
                serial: units[unit].labels.serial.clone(),
                p_value: p[unit],
                reasons,
            };
            (unit, odd)
        })
        .collect();
    found.sort_by(|(a, left), (b, right)| {
        // What a model lacks is stranger than any value of its parameters.
        let lacks = |odd: &Odd| {
            odd.reasons
                .iter()
                .any(|reason| reason.kind == "error" || reason.kind == "effect")
        };
        let size = |odd: &Odd| {
            if lacks(odd) {
                0.0
            } else {
                odd.p_value.unwrap_or(1.0)
            }
        };
        size(left).total_cmp(&size(right)).then(a.cmp(b))
    });
    found
}

/// Readings as distances from the middle, in spreads of the fleet.
struct Standard {
    /// One row a unit, one distance a quantity.
    rows: Vec<Vec<Option<f64>>>,
    /// Whether units differ by more of the quantity than each estimate errs by.
    differs: Vec<bool>,
}

/// A reading that is less certain than usual counts for less, and nothing counts for more than its own error lets it.
fn standard(table: &Table) -> Standard {
    let mut standard = Standard {
        rows: vec![Vec::new(); table.readings.len()],
        differs: Vec::new(),
    };
    for k in 0..table.quantities.len() {
        let values: Vec<f64> = table.column(k).map(|(_, reading)| reading.y).collect();
        let errors: Vec<f64> = table.column(k).map(|(_, r)| r.std * r.std).collect();
        let ((middle, spread), usual) = (centre(&values), median(&errors));
        let variance = (spread * spread).max(usual);
        standard.differs.push(spread * spread > MEASURABLE * usual);
        for (row, readings) in standard.rows.iter_mut().zip(&table.readings) {
            row.push(readings[k].filter(|_| variance > 0.0).map(|reading| {
                let more = (reading.std * reading.std - usual).max(0.0);
                (reading.y - middle) / (variance + more).sqrt()
            }));
        }
    }
    standard
}

/// Probability that a usual unit is as far from the middle as each: all quantities that units differ by together, and each of the
/// others by itself. Of what a unit lacks nothing is said.
fn p_values(standard: &Standard) -> Vec<Option<f64>> {
    let differ = || (0..standard.differs.len()).filter(|k| standard.differs[*k]);
    let whole = |row: &Vec<Option<f64>>| -> Option<Vec<f64>> { differ().map(|k| row[k]).collect() };
    let rows: Vec<Option<Vec<f64>>> = standard.rows.iter().map(whole).collect();
    let complete: Vec<Vec<f64>> = rows.iter().flatten().cloned().collect();
    let together = Distances::of(&complete);
    let one = ChiSquared::new(1.0);
    let mut place = 0;
    let mut all = Vec::new();
    for (row, whole) in standard.rows.iter().zip(rows) {
        let mut own: Vec<f64> = Vec::new();
        if whole.is_some() {
            own.extend(together.p_value(place));
            place += 1;
        }
        for (k, z) in row.iter().enumerate() {
            let alone = whole.is_none() || !standard.differs[k];
            if let (true, Some(z), Ok(one)) = (alone, z, &one) {
                own.push(one.sf(z * z));
            }
        }
        // As many tests, as many times as likely.
        let least = own.iter().copied().fold(f64::INFINITY, f64::min);
        all.push((!own.is_empty()).then(|| (least * own.len() as f64).min(1.0)));
    }
    all
}

fn of_parameters(table: &Table, standard: &Standard, unit: usize) -> Vec<Reason> {
    let mut far: Vec<(usize, f64)> = standard.rows[unit]
        .iter()
        .enumerate()
        .filter_map(|(k, z)| Some((k, (*z)?)))
        .filter(|(_, z)| z.abs() > FAR)
        .collect();
    far.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
    if far.is_empty() {
        return vec![Reason {
            kind: "combination".to_owned(),
            name: None,
            value: None,
            usual: None,
            spreads: None,
            text: "each parameter is usual, but not all of them together".to_owned(),
        }];
    }
    far.into_iter()
        .filter_map(|(k, spreads)| {
            let quantity = &table.quantities[k];
            let values: Vec<f64> = table.column(k).map(|(_, reading)| reading.y).collect();
            let value = quantity.scale.raise(table.readings[unit][k]?.y);
            let usual = quantity.scale.raise(median(&values));
            Some(Reason {
                kind: "parameter".to_owned(),
                name: Some(quantity.name.clone()),
                value: Some(value),
                usual: Some(usual),
                spreads: Some(spreads),
                text: in_words(quantity, value, usual, spreads),
            })
        })
        .collect()
}

fn in_words(quantity: &Quantity, value: f64, usual: f64, spreads: f64) -> String {
    use servoid_results::number_text::short;
    let unit = match quantity.unit.as_str() {
        "1" => String::new(),
        unit => format!(" {unit}"),
    };
    format!(
        "{} is {}{unit}, {:.1} spreads {} the usual {}{unit}",
        quantity.name,
        short(value),
        spreads.abs(),
        if spreads > 0.0 { "above" } else { "below" },
        short(usual)
    )
}

/// Units whose model errs much more than others' do.
fn of_errors(units: &[Unit]) -> Vec<(usize, Reason)> {
    let errors: Vec<(usize, f64)> = (units.iter().enumerate())
        .filter_map(|(unit, found)| Some((unit, found.rms_counts?)))
        .filter(|(_, rms)| *rms > 0.0)
        .collect();
    let logarithms: Vec<f64> = errors.iter().map(|(_, rms)| libm::log(*rms)).collect();
    let (middle, spread) = centre(&logarithms);
    let spread = spread.max(ERROR_SPREAD);
    errors
        .into_iter()
        .filter(|(_, rms)| (libm::log(*rms) - middle) / spread > ERROR_FAR)
        .map(|(unit, rms)| {
            use servoid_results::number_text::short;
            let usual = libm::exp(middle);
            let reason = Reason {
                kind: "error".to_owned(),
                name: None,
                value: Some(rms),
                usual: Some(usual),
                spreads: Some((libm::log(rms) - middle) / spread),
                text: format!(
                    "its model errs by {} counts RMS, where {} are usual: it does something that the model lacks",
                    short(rms),
                    short(usual)
                ),
            };
            (unit, reason)
        })
        .collect()
}

/// Units with an effect beside the usual ones that matters to them, and units that lack what the others have.
fn of_effects(
    units: &[Unit],
    results: &dyn Fn(&BTreeSet<usize>) -> HashMap<usize, String>,
) -> Vec<(usize, Reason)> {
    let mut sets: BTreeMap<BTreeSet<&str>, usize> = BTreeMap::new();
    let set = |unit: &'_ Unit| -> BTreeSet<String> { unit.effects.iter().cloned().collect() };
    for unit in units {
        let effects = unit.effects.iter().map(String::as_str).collect();
        *sets.entry(effects).or_insert(0) += 1;
    }
    let Some((usual, _)) = sets.iter().max_by_key(|(_, count)| **count) else {
        return Vec::new();
    };
    let usual: BTreeSet<String> = usual.iter().map(|name| (*name).to_owned()).collect();
    let mut having: HashMap<&str, usize> = HashMap::new();
    for (effects, count) in &sets {
        for name in effects {
            *having.entry(name).or_insert(0) += count;
        }
    }
    let with = |name: &str| {
        having
            .get(name)
            .map_or(0.0, |have| *have as f64 / units.len() as f64)
    };
    let rare: BTreeSet<usize> = (units.iter().enumerate())
        .filter(|(_, unit)| unit.effects.iter().any(|name| with(name) < RARE))
        .map(|(unit, _)| unit)
        .collect();
    let texts = if rare.is_empty() {
        HashMap::new()
    } else {
        results(&rare)
    };
    let mut found = Vec::new();
    for (number, unit) in units.iter().enumerate() {
        let own = set(unit);
        let part = |name: &str| format!("{:.1} %", 100.0 * with(name));
        // In the place of a usual effect a rare one is its look-alike, as which it may be named at any time.
        let beside = usual.is_subset(&own);
        for name in own.iter().filter(|name| beside && with(name) < RARE) {
            let lowers = texts.get(&number).and_then(|text| lowered(text, name));
            if let Some(times) = lowers.filter(|times| *times >= LOWERS) {
                found.push((
                    number,
                    Reason {
                        kind: "effect".to_owned(),
                        name: Some(name.clone()),
                        value: None,
                        usual: None,
                        spreads: None,
                        text: format!(
                            "has {name}, which {} of the recordings have; it lowers the error {times:.1} times",
                            part(name)
                        ),
                    },
                ));
            }
        }
        if own.len() < usual.len() && own.is_subset(&usual) {
            for name in usual
                .difference(&own)
                .filter(|name| with(name) > 1.0 - RARE)
            {
                found.push((
                    number,
                    Reason {
                        kind: "no_effect".to_owned(),
                        name: Some(name.clone()),
                        value: None,
                        usual: None,
                        spreads: None,
                        text: format!("lacks {name}, which {} of the recordings have", part(name)),
                    },
                ));
            }
        }
    }
    found
}

/// How many times a diagnosis' step that added an effect lowered the error.
fn lowered(result: &str, effect: &str) -> Option<f64> {
    #[derive(Deserialize)]
    struct Error {
        rms_counts: Option<f64>,
    }
    #[derive(Deserialize)]
    struct Step {
        added: String,
        rms_counts: Option<f64>,
    }
    #[derive(Deserialize)]
    struct Steps {
        base: Error,
        steps: Vec<Step>,
    }
    let found: Steps = serde_json::from_str(result).ok()?;
    let mut before = found.base.rms_counts?;
    for step in found.steps {
        let after = step.rms_counts?;
        if step.added == effect {
            return (after > 0.0).then_some(before / after);
        }
        before = after;
    }
    None
}
