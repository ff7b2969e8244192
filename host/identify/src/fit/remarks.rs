//! What a user should be told about a fit before believing it.

use super::options::Options;
use super::uncertainty::Uncertainty;
use servoid_engine::problem::{Base, Data, FitProblem};
use servoid_engine::solve::Found;
use servoid_io::position_loop::GainOrigin;

/// Open-loop error up to which the model explains the recording down to the encoder, counts RMS.
pub const EXPLAINED_COUNTS: f64 = 0.35;
/// A sample interval this many times the usual one is a gap.
const GAP: f64 = 3.0;

/// Appends the remarks, those on search ranges among them.
pub(super) fn remarks(
    problem: &FitProblem<'_>,
    found: &Found,
    options: &Options,
    spread: Option<&Uncertainty>,
    rms_counts: f64,
    range_notes: &[String],
    notes: &mut Vec<String>,
) {
    let data = problem.data;
    if rms_counts > EXPLAINED_COUNTS && data.quantised {
        let times = rms_counts / shared::encoder::FLOOR_RMS_COUNTS;
        let mut text = format!(
            "the model does not explain this recording: its error is {times:.0} times the encoder's own. \
             Something is missing (try --with), or the columns, units or times are not what they seem"
        );
        if options.window_s.is_none() {
            text += "; a recording made in closed loop drifts in open loop (try --window)";
        }
        notes.insert(0, text);
    }
    let gaps = data.lengths.iter().filter(|length| **length > GAP).count();
    if gaps > 0 {
        let longest = data.lengths.iter().fold(0.0f64, |m, l| m.max(*l)) * data.units.interval;
        notes.push(format!(
            "there are gaps in time, up to {longest:.4} s: the command is taken as held throughout them"
        ));
    }
    notes.extend(estimated_gains(data));
    if found.evaluations >= options.budget {
        notes.push(format!(
            "the budget of {} evaluations ran out before the search had converged",
            options.budget
        ));
    }
    if spread.is_some_and(|s| !s.converged) {
        notes.push(
            "the search ended away from a minimum, so that no standard errors can be given: raise --budget, \
             or use --algorithm lm"
                .to_owned(),
        );
    }
    notes.extend_from_slice(range_notes);
    if problem.structure.base == (Base::Response { damping: false }) {
        notes.push(
            "the electrical time constant is stated for a motor without viscous friction; gain, a1 and a2 \
             hold in any case"
                .to_owned(),
        );
    }
}

/// Gains of position loops that recordings told.
fn estimated_gains(data: &Data) -> impl Iterator<Item = String> {
    let loops = data.recordings.loops();
    loops.filter_map(|(_, control)| match control.origin {
        GainOrigin::Given => None,
        GainOrigin::Estimated(estimate) => Some(format!(
            "the position loop's gain is estimated as {} V/rad, to {:.1} %: all that is in volts shares this error beside its \
             own",
            plain(control.gain_v_per_rad),
            100.0 * estimate.relative_std
        )),
    })
}

/// What a user should be told about the ends of the search ranges: which parameter ended on one, and which range was widened.
pub(super) fn range_notes(problem: &FitProblem<'_>, found: &Found) -> Vec<String> {
    let mut notes = Vec::new();
    for (unknown, x) in problem.structure.unknowns.iter().zip(&found.x) {
        let (low, high) = unknown.range;
        if unknown.is_beyond_usual(*x) {
            notes.push(format!(
                "{} lies beyond its usual range, up to {} {}: the search range was widened to {}",
                unknown.name,
                plain(unknown.usual),
                problem.data.drive.unit(unknown.unit),
                plain(high)
            ));
        }
        if unknown.ends_at(unknown.value(*x)) {
            notes.push(format!(
                "{} ended on a bound of its search range ({} to {} {}): widen it with `servoid fit --bounds`",
                unknown.name,
                plain(low),
                plain(high),
                problem.data.drive.unit(unknown.unit)
            ));
        }
    }
    notes
}

/// Four digits.
fn plain(x: f64) -> String {
    format!("{}", format!("{x:.3e}").parse::<f64>().unwrap_or(x))
}
