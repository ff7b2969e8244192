//! Whether two recordings belong together: one motor, one encoder that counts all the time, one sign.

use super::evidence::plain;
use super::settings::{
    BEYOND, DIFFERENCE_SURE, DIFFERENT_MOTORS, EXPLAINED, JUMP_COUNTS, JUMP_TIMES, REVERSAL_S,
    SAME_MOTOR, SELDOM, STRANGE,
};
use crate::diagnose::models::NOISE_COUNTS;
use crate::diagnose::outcome::Diagnosis;
use crate::diagnose::recordings::{HeldOut, Remark};
use crate::error::Error;
use crate::fit::{self, Fit, Options, scores};
use servoid_engine::problem::Data;
use servoid_engine::problem::rms_counts;
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

/// Samples to each side over which a jump must stay, and which part of it.
const STAYS: (usize, f64) = (40, 0.7);

/// Samples to each side in which nothing else may change, beyond this part of the jump.
const ALONE: (usize, f64) = (3, 0.5);

/// What the two recordings say of each other once a diagnosis is made.
///
/// # Errors
/// Where the last model cannot run, which it could before.
pub fn remarks(
    diagnosis: &Diagnosis,
    data: &Data,
    held_out: &Data,
    kind: &HeldOut,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Vec<Remark>, Error> {
    let last = &diagnosis.last;
    let strange = last.validate_rms_counts > STRANGE * last.rms_counts.max(NOISE_COUNTS);
    if strange
        && *kind != HeldOut::Nothing
        && let Some(remark) = another_motor(diagnosis, data, held_out, kind, options, stop)
    {
        return Ok(vec![Remark::cause(remark)]);
    }
    if last.effects.iter().any(|kind| kind.facts().by_chance) {
        return Ok(Vec::new());
    }
    let own = scores::whole(data, &last.candidate, last.method)?;
    let other = fit::validation_errors(held_out, &last.candidate, last.method)?;
    let gap = last.effects.contains(&Kind::Backlash);
    let found = jumps(data, &own, gap).into_iter();
    Ok(found.chain(jumps(held_out, &other, gap)).collect())
}

/// Whether one kind of model explains each recording by itself, with constants that differ.
fn another_motor(
    diagnosis: &Diagnosis,
    data: &Data,
    held_out: &Data,
    kind: &HeldOut,
    options: &Options,
    stop: &AtomicBool,
) -> Option<String> {
    let mut sets = vec![diagnosis.last.effects.clone(), Vec::new()];
    if !sets[0].contains(&Kind::Coulomb) {
        sets.push(vec![Kind::Coulomb]);
    }
    let mut differ = None;
    for effects in sets {
        let one = own_fit(data, &effects, options, stop);
        let other = own_fit(held_out, &effects, options, stop);
        let (Some(one), Some(other)) = (one, other) else {
            continue;
        };
        let explained = one.rms_counts < EXPLAINED && other.rms_counts < EXPLAINED;
        if explained {
            differ =
                differences(&one, &other, DIFFERENT_MOTORS).map(|differ| {
                    match in_another_unit(&one, &other, data) {
                        Some(unit) => format!("{differ}; {unit}"),
                        None => differ,
                    }
                });
            break;
        }
        if effects.is_empty() {
            differ = differences(&one, &other, BEYOND - 1.0);
        }
    }
    let differ = differ?;
    let what = match kind {
        HeldOut::End { .. } => "the motor changes between the fitted part and the end",
        _ => "the held-out recording seems to be of another motor, or of this one changed",
    };
    Some(format!(
        "{what}: fitted by itself it has {differ}; check which recording belongs to which motor, the supply and \
         counts_per_rev"
    ))
}

/// Two motors with one time constant, whose gains alone differ, by a factor that a unit has.
fn in_another_unit(one: &Fit, other: &Fit, data: &Data) -> Option<String> {
    let ratio = |name: &str| {
        let value = |fit: &Fit| Some(fit.parameters.iter().find(|p| p.name == name)?.value);
        Some(value(other)? / value(one)?)
    };
    let near = |ratio: f64, factor: f64| (ratio / factor - 1.0).abs() < SAME_MOTOR;
    if !near(ratio("a1")?, 1.0) {
        return None;
    }
    let gain = ratio("gain")?;
    let turn = data.units.counts_per_rev;
    let units = [
        (
            data.supply,
            "its command looks like a duty (-1 ... 1) taken for V",
        ),
        (
            data.supply / 100.0,
            "its command looks like a percentage taken for V",
        ),
        (
            1e3,
            "its command looks like kV taken for V, or the other one's like mV",
        ),
        (1e-3, "its command looks like mV taken for V"),
        (
            360.0 / turn,
            "its angle looks like degrees taken for counts",
        ),
        (4.0, "its encoder looks counted four times as finely"),
        (0.25, "its encoder looks counted a fourth as finely"),
    ];
    let (_, what) = units.iter().find(|(factor, _)| near(gain, *factor))?;
    Some((*what).to_owned())
}

fn own_fit(data: &Data, effects: &[Kind], options: &Options, stop: &AtomicBool) -> Option<Fit> {
    let options = Options {
        effects: effects.to_vec(),
        budget: 400,
        ..options.clone()
    };
    let problem = fit::problem(data, &options).ok()?;
    let solver = LevenbergMarquardt::default();
    let found = fit::search(&problem, &solver, &options, stop, &mut |_, _| {});
    Fit::conclude(&problem, "lm", "squared", &found, &options, None).ok()
}

/// Parameters of two fits that differ beyond their intervals and by a part of at least `least`.
fn differences(one: &Fit, other: &Fit, least: f64) -> Option<String> {
    let mut said = Vec::new();
    for a in &one.parameters {
        let Some(b) = other.parameters.iter().find(|b| b.name == a.name) else {
            continue;
        };
        let (Some(s), Some(t)) = (a.std, b.std) else {
            continue;
        };
        let far = (a.value - b.value).abs();
        let smaller = a.value.abs().min(b.value.abs());
        if a.identifiable
            && b.identifiable
            && far > DIFFERENCE_SURE * libm::hypot(s, t)
            && far > least * smaller
        {
            said.push(format!(
                "{} {} instead of {} {}",
                a.name,
                plain(b.value),
                plain(a.value),
                a.unit
            ));
        }
    }
    said.truncate(3);
    (!said.is_empty()).then(|| said.join(", "))
}

/// Jumps of the reading that the motor cannot have made, a sentence for each recording that has any; `gap` where its model has one.
fn jumps(data: &Data, errors: &[f64], gap: bool) -> Vec<Remark> {
    if rms_counts(data, errors) < 2.0 * NOISE_COUNTS {
        return Vec::new();
    }
    let each = data.recordings.ranges().zip(data.recordings.sources());
    each.filter_map(|(range, source)| {
        let times = &data.time_s[range.clone()];
        let found = jumps_of_one(times, &errors[range.clone()])?;
        Some(remark(data, range.start, source, times, &found, gap))
    })
    .collect()
}

/// The samples of one recording before which the reading jumps, each with its height, counts.
fn jumps_of_one(times: &[f64], errors: &[f64]) -> Option<Vec<(usize, f64)>> {
    if errors.len().min(times.len()) < 4 * STAYS.0 {
        return None;
    }
    let change: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sizes: Vec<f64> = change.iter().map(|d| d.abs()).collect();
    let middle = sizes.len() / 2;
    let usual = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let least = JUMP_COUNTS.max(JUMP_TIMES * usual);
    let mean = |from: usize| errors[from..from + STAYS.0].iter().sum::<f64>() / STAYS.0 as f64;
    let stays = |k: usize| {
        let (jump, width) = (change[k], STAYS.0);
        let stayed = mean(k + 1) - mean(k + 1 - width);
        stayed * jump.signum() > STAYS.1 * jump.abs()
    };
    // A counter errs between two samples. A rotor that slips where the model's does not takes several for it.
    let alone = |k: usize| {
        let around = (k - ALONE.0..=k + ALONE.0).filter(|&j| j != k);
        let most = around.fold(0.0, |most: f64, j| most.max(change[j].abs()));
        most < ALONE.1 * change[k].abs()
    };
    let found: Vec<usize> = (STAYS.0..errors.len() - STAYS.0 - 1)
        .filter(|&k| change[k].abs() > least && alone(k) && stays(k))
        .collect();
    if found.is_empty() || found.len() * SELDOM > errors.len() {
        return None;
    }
    // The error is model minus reading.
    Some(found.into_iter().map(|k| (k + 1, -change[k])).collect())
}

/// What jumps of a reading tell. One alone explains no error of a whole recording, and jumps that each follow a reversal of the shaft, or
/// of a motor with a gap, may as well be impacts in a gear.
fn remark(
    data: &Data,
    start: usize,
    source: &str,
    times: &[f64],
    found: &[(usize, f64)],
    gap: bool,
) -> Remark {
    let (first, height) = found[0];
    let seen = format!(
        "{source}: the reading jumps {} time{} where the motor cannot have, first by {height:+.0} counts at {:.3} s",
        found.len(),
        if found.len() == 1 { "" } else { "s" },
        times[first] - times[0]
    );
    if gap {
        return Remark::aside(format!("{seen}: impacts in the gap, or lost counts"));
    }
    if found.len() > 1 && found.iter().all(|(k, _)| reverses_before(data, start + k)) {
        return Remark::aside(format!(
            "{seen}, each shortly after the shaft reverses: impacts in a gear with backlash, or lost counts"
        ));
    }
    let text = format!(
        "{seen}: the counter misses counts (or the shaft slips in its coupling); check the encoder's wiring and its highest speed"
    );
    if found.len() == 1 {
        Remark::aside(text)
    } else {
        Remark::cause(text)
    }
}

/// Whether the shaft reversed within a short time before a sample.
fn reverses_before(data: &Data, sample: usize) -> bool {
    let speed = |k: usize| data.rate_of(&data.counts, k, STAYS.0 / 4);
    let before = (0..sample).rev();
    let near = before.take_while(|k| data.time_s[sample] - data.time_s[*k] <= REVERSAL_S);
    let now = speed(sample);
    near.step_by(STAYS.0 / 4).any(|k| speed(k) * now < 0.0)
}
