//! Whether the motor follows its command, in which sense, and how late.
//!
//! Two regressions tell. The acceleration over short blocks is regressed on the command, the speed, its sign, a constant and gravity's sine and
//! cosine: what a load or friction explains is not taken for the command's. The command's coefficient over its standard error
//! says whether the motor is driven at all, and its sign whether the angle counts the right way. Where the motion is too steady
//! for that, the command is regressed on the motion: an equation of motion that holds explains it.

use super::{Finding, Severity};
use nalgebra::{DMatrix, DVector};
use servoid_io::recording::Recording;

/// Blocks, in samples; the clearest answer counts.
const BLOCKS: [usize; 4] = [2, 5, 12, 30];
/// Fewest blocks that say anything.
const FEWEST: usize = 30;
/// Standard errors from which on a coefficient is no chance.
const SURE: f64 = 6.0;
/// Part of the command's spread that an equation of motion explains where it holds.
const MOST: f64 = 0.5;
/// Rest before an edge after which the first motion is timed, s.
const REST_S: f64 = 0.03;
/// Edges of at least this part of the largest command.
const EDGE: f64 = 0.3;
/// Longest time in which a motor must answer, s.
const ANSWER_S: f64 = 0.3;
/// Counts of motion that are no jitter.
pub(crate) const BEGUN: f64 = 2.0;
/// Counts of which the beginning of a motion is told.
const ROOTS: usize = 8;
/// A motor that answers later than this, and than so many samples, is late.
const LATE: (f64, f64) = (0.003, 2.0);

/// How the motor answers its command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DriveResponse {
    /// A rising command speeds it up.
    Follows,
    /// A rising command slows it down: the angle or the command has the wrong sign.
    Reversed,
    /// Neither is sure.
    Unclear,
}

/// What is driven and how it moves, of a recording in any form.
pub(crate) struct Driven<'a> {
    pub time_s: &'a [f64],
    pub command: &'a [f64],
    pub counts: &'a [f64],
    pub counts_per_rev: f64,
    /// Whether the bridge is closed after a sample.
    pub closed: &'a dyn Fn(usize) -> bool,
}

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let mut findings = Vec::new();
    let driven = Driven {
        time_s: &recording.time_s,
        command: &recording.command,
        counts: &recording.counts,
        counts_per_rev: recording.counts_per_rev,
        closed: &|k| recording.enabled.as_ref().is_none_or(|on| on[k]),
    };
    match drive_response(&driven) {
        DriveResponse::Follows => {}
        DriveResponse::Reversed => findings.push(Finding::new(
            "reversed",
            Severity::Refusal,
            "the angle falls where the voltage should raise it, whatever gravity and friction do: the sign of the angle (or of \
             the voltage) is reversed",
            match recording.position {
                None => "swap the encoder's channels or negate the column",
                Some(_) => "negate the column of the angle or that of the target",
            },
        )),
        DriveResponse::Unclear => findings.push(Finding::new(
            "no_response",
            Severity::Warning,
            "the acceleration does not follow the command",
            "check the columns, their units and time stamps, and that the motor was driven",
        )),
    }
    if let Some((late_s, edges)) = first_motion(recording) {
        findings.push(Finding::new(
            "late",
            Severity::Remark,
            format!(
                "after rest the motion begins {:.1} ms after the command, more than its own acceleration explains (median of {edges} edges)",
                1e3 * late_s
            ),
            "a bus, a driver or the log delays it; fit with --with delay, or log both at the same instant",
        ));
    }
    findings
}

/// How the motor answers its command.
pub(crate) fn drive_response(driven: &Driven<'_>) -> DriveResponse {
    let scores = BLOCKS
        .iter()
        .filter_map(|&block| command_score(driven, block));
    let clearest = scores.fold(
        0.0f64,
        |best, t| if t.abs() > best.abs() { t } else { best },
    );
    if clearest > SURE {
        DriveResponse::Follows
    } else if clearest < -SURE {
        DriveResponse::Reversed
    } else if BLOCKS.iter().any(|&block| motion_explains(driven, block)) {
        DriveResponse::Follows
    } else {
        DriveResponse::Unclear
    }
}

/// A stretch of samples in motion.
struct Block {
    /// Command, speed, its sign, one, and gravity's sine and cosine.
    row: [f64; 6],
    acceleration: f64,
}

/// A regression on some columns of the blocks.
struct Regression {
    solution: DVector<f64>,
    /// Of the columns' products.
    inverse: DMatrix<f64>,
    /// The squares that it leaves.
    left: f64,
    blocks: usize,
}

impl Regression {
    /// Of what `of` says of a block; `None` where there are too few. Sums are all that is kept: a recording may have millions of blocks.
    fn new(
        driven: &Driven<'_>,
        block: usize,
        columns: &[usize],
        of: &dyn Fn(&Block) -> f64,
    ) -> Option<Self> {
        let width = columns.len();
        let (mut products, mut right) = (DMatrix::zeros(width, width), DVector::zeros(width));
        let mut count = 0;
        each_block(driven, block, &mut |block| {
            count += 1;
            for (i, &one) in columns.iter().enumerate() {
                right[i] += block.row[one] * of(block);
                for (j, &other) in columns.iter().enumerate() {
                    products[(i, j)] += block.row[one] * block.row[other];
                }
            }
        });
        if count < FEWEST {
            return None;
        }
        let inverse = products.pseudo_inverse(1e-12).ok()?;
        let solution: DVector<f64> = &inverse * right;
        let mut left = 0.0;
        each_block(driven, block, &mut |block| {
            let parts = columns.iter().zip(solution.iter());
            let explained: f64 = parts.map(|(&k, part)| block.row[k] * part).sum();
            left += (of(block) - explained).powi(2);
        });
        Some(Regression {
            solution,
            inverse,
            left,
            blocks: count,
        })
    }
}

/// Whether the motion explains most of the command, at a steady speed that rises with it or by a weight.
fn motion_explains(driven: &Driven<'_>, block: usize) -> bool {
    // The speed may be left out; then gravity and friction alone must do. What a constant leaves is the spread.
    let command = |columns: &[usize]| Regression::new(driven, block, columns, &|b| b.row[0]);
    let Some(spread) = command(&[3]).map(|constant| constant.left) else {
        return false;
    };
    let explained = |columns: &[usize]| {
        command(columns).map(|found| (1.0 - found.left / spread, found.solution[0]))
    };
    let moving = explained(&[1, 2, 3]).is_some_and(|(part, damping)| part > MOST && damping > 0.0);
    let lifting = explained(&[2, 3, 4, 5]).is_some_and(|(part, _)| part > MOST);
    spread > 0.0 && (moving || lifting)
}

/// The command's coefficient in the regression of the acceleration, over its standard error.
fn command_score(driven: &Driven<'_>, block: usize) -> Option<f64> {
    let columns = [0, 1, 2, 3, 4, 5];
    let found = Regression::new(driven, block, &columns, &|block| block.acceleration)?;
    // Neighbouring blocks share half of their readings.
    let freedom = 0.5 * (found.blocks - columns.len()) as f64;
    let error = (found.left / freedom * found.inverse[(0, 0)]).sqrt();
    let score = found.solution[0] / error;
    score.is_finite().then_some(score)
}

/// The motion block by block, those left out in which the bridge was open or the motor stood still.
fn each_block(driven: &Driven<'_>, block: usize, take: &mut dyn FnMut(&Block)) {
    let (time, counts, closed) = (driven.time_s, driven.counts, driven.closed);
    let radians = core::f64::consts::TAU / driven.counts_per_rev;
    let mut begin = 0;
    while begin + 2 * block < counts.len() {
        let (middle, end) = (begin + block, begin + 2 * block);
        let speed = |a: usize, b: usize| (counts[b] - counts[a]) * radians / (time[b] - time[a]);
        let (before, after) = (speed(begin, middle), speed(middle, end));
        let apart = 0.5 * (time[end] - time[begin]);
        // The speeds are those of the halves' middles: what acts between them is the command there.
        let (from, to) = (
            begin + block / 2,
            (middle + block.div_ceil(2)).max(begin + block / 2 + 1),
        );
        let command = driven.command[from..to].iter().sum::<f64>() / (to - from) as f64;
        let (now, angle) = (0.5 * (before + after), counts[middle] * radians);
        if (begin..end).all(closed) && (before != 0.0 || after != 0.0) {
            take(&Block {
                row: [
                    command,
                    now,
                    sign(now),
                    1.0,
                    libm::sin(angle),
                    libm::cos(angle),
                ],
                acceleration: (after - before) / apart,
            });
        }
        begin = middle;
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// The median time from an edge of the command, after rest, to the first motion, s, and of how many edges; `None` where there is
/// none or it is not late.
fn first_motion(recording: &Recording) -> Option<(f64, usize)> {
    let (median, edges) = usual_answer(recording)?;
    let (seconds, samples) = LATE;
    let is_late = median > seconds && median > samples * recording.median_interval_s();
    is_late.then_some((median, edges))
}

/// The same, late or not.
pub(crate) fn usual_answer(recording: &Recording) -> Option<(f64, usize)> {
    let (time, counts) = (&recording.time_s, &recording.counts);
    let mut answers: Vec<f64> = edges_after_rest(recording)
        .filter_map(|edge| begun_s(&time[edge..], &counts[edge..]))
        .collect();
    answers.sort_by(f64::total_cmp);
    let median = *answers.get(answers.len() / 2)?;
    Some((median, answers.len()))
}

/// Samples at which the command steps after rest.
pub(crate) fn edges_after_rest(recording: &Recording) -> impl Iterator<Item = usize> + '_ {
    let (time, counts) = (&recording.time_s, &recording.counts);
    // Behind a position loop there is always some voltage: its edges are those of the target.
    let targets = recording.position.as_ref().map(|p| &p.target_counts);
    let command = targets.unwrap_or(&recording.command);
    let largest = command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let mut still_since = 0;
    (1..counts.len()).filter(move |&k| {
        if (counts[k] - counts[still_since]).abs() >= BEGUN {
            still_since = k;
        }
        let edge = (command[k] - command[k - 1]).abs() >= EDGE * largest;
        let unbiased = targets.is_some() || command[k - 1] == 0.0;
        edge && time[k] - time[still_since] >= REST_S && unbiased
    })
}

/// When a motion began whose first counts these are, s after the first sample. A motor that is driven from rest moves as the square of the time
/// since it was driven, so that the root of the count is a line: where it comes from is when the drive began. The first count alone comes
/// later, the coarser the encoder and the heavier the motor. `None` where it does not move.
pub(crate) fn begun_s(time: &[f64], counts: &[f64]) -> Option<f64> {
    let mut reached: Vec<(f64, f64)> = Vec::new();
    for k in 1..counts.len() {
        let (since, moved) = (time[k] - time[0], (counts[k] - counts[0]).abs());
        if since > ANSWER_S || reached.len() == ROOTS {
            break;
        }
        if moved >= BEGUN && reached.last().is_none_or(|(_, before)| moved > *before) {
            reached.push((since, moved));
        }
    }
    let (first, _) = *reached.first()?;
    // A reading has reached its count for half an interval, and begins anywhere in its cell.
    let interval = time.get(1)? - time[0];
    let points = reached.iter();
    let points: Vec<(f64, f64)> = points
        .map(|(since, moved)| ((moved - 0.5).sqrt(), since - 0.5 * interval))
        .collect();
    let count = points.len() as f64;
    if points.len() < 3 {
        return Some(0.0);
    }
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let slope =
        mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2)).max(f64::MIN_POSITIVE);
    Some((y - slope * x).clamp(0.0, first))
}
