//! Whether the motors of one lot, or those that one station recorded, differ from the others (one-way analysis of variance, Fisher,
//! 1925; p-values over all quantities together by Holm).

use crate::multiple::adjust;
use crate::quantity::Table;
use crate::unit::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};
use std::collections::BTreeMap;

/// Units that a group needs to be compared.
const LEAST: usize = 3;

/// Named effects and means of one group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// Its name; empty where the recordings do not say.
    pub name: String,
    /// Its recordings with a result.
    pub recordings: usize,
    /// How many of them have each effect.
    pub effects: BTreeMap<String, usize>,
    /// Mean of each quantity, in its unit (geometric where its scale is `log`).
    pub means: BTreeMap<String, f64>,
}

/// How a quantity differs between groups.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Difference {
    /// The quantity.
    pub quantity: String,
    /// p-value of no difference, for all quantities together.
    pub p_value: f64,
    /// The group that is farthest from the mean of all.
    pub farthest: String,
    /// Its distance: in per cent where the scale is `log`, else in the quantity's unit.
    pub by: f64,
    /// Unit of the distance.
    pub by_unit: String,
}

/// The groups that a label makes; empty where no recording has it.
pub(crate) fn groups(
    units: &[Unit],
    table: &Table,
    label: impl Fn(&Unit) -> Option<&str>,
) -> Vec<Group> {
    if units.iter().all(|unit| label(unit).is_none()) {
        return Vec::new();
    }
    let mut members: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, unit) in units.iter().enumerate() {
        members
            .entry(label(unit).unwrap_or(""))
            .or_default()
            .push(number);
    }
    members
        .into_iter()
        .map(|(name, members)| {
            let mut effects = BTreeMap::new();
            for name in members.iter().flat_map(|unit| &units[*unit].effects) {
                *effects.entry(name.clone()).or_insert(0) += 1;
            }
            let mean = |k: usize| {
                let own: Vec<f64> = (members.iter())
                    .filter_map(|unit| Some(table.readings[*unit][k]?.y))
                    .collect();
                let mean = own.iter().sum::<f64>() / own.len() as f64;
                (!own.is_empty()).then(|| table.quantities[k].scale.raise(mean))
            };
            Group {
                name: name.to_owned(),
                recordings: members.len(),
                effects,
                means: (0..table.quantities.len())
                    .filter_map(|k| Some((table.quantities[k].name.clone(), mean(k)?)))
                    .collect(),
            }
        })
        .collect()
}

/// Differences between the groups of a label, of all quantities; units that are `odd` do not count.
pub(crate) fn differences(
    units: &[Unit],
    table: &Table,
    odd: &[bool],
    label: impl Fn(&Unit) -> Option<&str>,
) -> Vec<Difference> {
    let mut found = Vec::new();
    for (k, quantity) in table.quantities.iter().enumerate() {
        let mut groups: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        for (unit, reading) in table.column(k).filter(|(unit, _)| !odd[*unit]) {
            if let Some(name) = label(&units[unit]) {
                groups.entry(name).or_default().push(reading.y);
            }
        }
        groups.retain(|_, own| own.len() >= LEAST);
        if groups.len() < 2 {
            continue;
        }
        let total: usize = groups.values().map(Vec::len).sum();
        let all = groups.values().flatten().sum::<f64>() / total as f64;
        let mean = |own: &[f64]| own.iter().sum::<f64>() / own.len() as f64;
        let between: f64 = (groups.values())
            .map(|own| own.len() as f64 * (mean(own) - all).powi(2))
            .sum();
        let within: f64 = (groups.values())
            .flat_map(|own| own.iter().map(|y| (y - mean(own)).powi(2)))
            .sum();
        let (first, second) = ((groups.len() - 1) as f64, (total - groups.len()) as f64);
        let Ok(law) = FisherSnedecor::new(first, second) else {
            continue;
        };
        let p_value = if within > 0.0 {
            law.sf(between / first / (within / second))
        } else {
            1.0
        };
        let away = |own: &[f64]| (mean(own) - all).abs();
        let farthest = groups
            .iter()
            .max_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        let Some((farthest, own)) = farthest else {
            continue;
        };
        let (by, by_unit) = crate::words::difference(quantity, mean(own) - all);
        found.push(Difference {
            quantity: quantity.name.clone(),
            p_value,
            farthest: (*farthest).to_owned(),
            by,
            by_unit,
        });
    }
    adjust(&mut found, |one| &mut one.p_value);
    found
}
