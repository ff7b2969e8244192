//! Repeats the device's fit on the host: same recording, seed and number format, and so the same bits.

use servoid_results::schema::DeviceRun;
use shared::fit::{Arithmetic, Fit, Outcome};
use shared::scalar::Fixed;
use shared::trace::Trace;

/// Result of the repeated fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// The host's outcome.
    pub outcome: Option<Outcome>,
    /// Names of the values whose bits differ from the device's; empty if none does.
    pub differ: Vec<String>,
}

/// Repeats the device's fit.
pub fn replay(saved: &DeviceRun, duties: &[i16], steps: &[i16]) -> Replayed {
    let trace = Trace::new(duties, steps);
    let outcome = if saved.format == "fixed" {
        fit::<Fixed>(saved, &trace)
    } else {
        fit::<f32>(saved, &trace)
    };
    Replayed {
        differ: differences(saved, outcome.as_ref()),
        outcome,
    }
}

fn fit<S: Arithmetic>(saved: &DeviceRun, trace: &Trace<'_>) -> Option<Outcome> {
    let mut fit = Fit::<S>::idle();
    if !fit.begin(trace, saved.fit) {
        return None;
    }
    loop {
        if let Some(outcome) = fit.work(trace, u32::MAX) {
            return Some(outcome);
        }
    }
}

fn differences(saved: &DeviceRun, host: Option<&Outcome>) -> Vec<String> {
    let (Some(reported), Some(host)) = (&saved.outcome, host) else {
        return match (&saved.outcome, host) {
            (None, None) => Vec::new(),
            _ => vec!["whether there is a fit at all".to_owned()],
        };
    };
    let device = reported.outcome();
    let mut differ = Vec::new();
    if device.estimates.len() != host.estimates.len() {
        differ.push("the number of parameters".to_owned());
    }
    for (k, (a, b)) in device.estimates.iter().zip(&host.estimates).enumerate() {
        let name = reported
            .parameters
            .get(k)
            .map_or("?", |parameter| parameter.name.as_str());
        if a.value.to_bits() != b.value.to_bits() {
            differ.push(name.to_owned());
        }
        if a.std.to_bits() != b.std.to_bits() {
            differ.push(format!("standard deviation of {name}"));
        }
    }
    if device.mean_square.to_bits() != host.mean_square.to_bits() {
        differ.push("error".to_owned());
    }
    if device.evaluations != host.evaluations {
        differ.push("evaluations".to_owned());
    }
    differ
}
