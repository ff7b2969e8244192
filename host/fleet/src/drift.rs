//! Whether what a station measures changes with time: a straight line through its readings, and the test that it is level
//! (p-values over all stations and quantities together by Holm).

use crate::multiple::adjust;
use crate::quantity::Table;
use crate::unit::Unit;
use jiff::Timestamp;
use jiff::civil::{Date, DateTime};
use jiff::tz::TimeZone;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::collections::BTreeMap;

/// Readings that a line needs.
const LEAST: usize = 8;
const DAY_S: f64 = 86_400.0;

/// The change of a quantity at a station.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Drift {
    /// The station; empty where the recordings do not say.
    pub station: String,
    /// The quantity.
    pub quantity: String,
    /// Change over the time seen: in per cent where the scale is `log`, else in the quantity's unit.
    pub change: f64,
    /// Unit of the change.
    pub change_unit: String,
    /// The time seen, days.
    pub days: f64,
    /// p-value of no change, for all stations and quantities together.
    pub p_value: f64,
}

/// Days since 1970 of an ISO 8601 time, a date, or a number of seconds; without a zone, UTC.
pub(crate) fn days(text: &str) -> Option<f64> {
    let text = text.trim();
    let of = |time: Timestamp| Some(time.as_millisecond() as f64 / 1000.0 / DAY_S);
    if let Ok(seconds) = text.parse::<f64>() {
        return seconds.is_finite().then_some(seconds / DAY_S);
    }
    if let Ok(time) = text.parse::<Timestamp>() {
        return of(time);
    }
    let civil = (text.parse::<DateTime>().ok())
        .or_else(|| text.parse::<Date>().ok().map(DateTime::from))?;
    of(civil.to_zoned(TimeZone::UTC).ok()?.timestamp())
}

/// Lines through what each station measured; units that are `odd` do not count.
pub(crate) fn drifts(units: &[Unit], table: &Table, odd: &[bool]) -> Vec<Drift> {
    let mut found = Vec::new();
    for (k, quantity) in table.quantities.iter().enumerate() {
        let mut stations: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
        for (unit, reading) in table.column(k).filter(|(unit, _)| !odd[*unit]) {
            let labels = &units[unit].labels;
            if let Some(time) = labels.time.as_deref().and_then(days) {
                let station = labels.station.as_deref().unwrap_or("");
                stations.entry(station).or_default().push((time, reading.y));
            }
        }
        for (station, points) in stations {
            if let Some((slope, span, p_value)) = line(&points) {
                let (change, change_unit) = crate::words::difference(quantity, slope * span);
                found.push(Drift {
                    station: station.to_owned(),
                    quantity: quantity.name.clone(),
                    change,
                    change_unit,
                    days: span,
                    p_value,
                });
            }
        }
    }
    adjust(&mut found, |one| &mut one.p_value);
    found
}

/// Slope, length of time, and p-value of the slope.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64, f64)> {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (time, value) = (mean(|p| p.0), mean(|p| p.1));
    let times: f64 = points.iter().map(|p| (p.0 - time).powi(2)).sum();
    if points.len() < LEAST || times <= 0.0 {
        return None;
    }
    let both: f64 = points.iter().map(|p| (p.0 - time) * (p.1 - value)).sum();
    let slope = both / times;
    let left = points
        .iter()
        .map(|p| (p.1 - value - slope * (p.0 - time)).powi(2));
    let error = (left.sum::<f64>() / (count - 2.0) / times).sqrt();
    let span = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max)
        - points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let law = StudentsT::new(0.0, 1.0, count - 2.0).ok()?;
    let p_value = if error > 0.0 {
        2.0 * law.sf((slope / error).abs())
    } else {
        1.0
    };
    Some((slope, span, p_value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_as_people_write_them() {
        for (text, expected) in [
            ("1970-01-02", Some(1.0)),
            ("1970-01-02T12:00", Some(1.5)),
            ("1970-01-02 12:00:00", Some(1.5)),
            ("1970-01-02T12:00:00Z", Some(1.5)),
            ("1970-01-02T14:00:00+02:00", Some(1.5)),
            ("129600", Some(1.5)),
            ("yesterday", None),
            ("NaN", None),
            ("", None),
        ] {
            assert_eq!(days(text), expected, "{text}");
        }
    }
}
