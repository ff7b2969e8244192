//! What a model's equation misses along the measured motion, and what its own parameters could take of it.

use super::blocks::Blocks;
use super::motion::Motion;
use super::term::{Place, Term};
use crate::fit::filter::filtered;
use crate::fit::regression::typical;
use crate::fit::scores::{EquationResidual, equation_residuals, motor_coefficients};
use crate::residual_analysis::simulated;
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use shared::effects::Kind;
use shared::motor::Machine;

/// Filter time, sample intervals: as in the drawings of the residual.
const FILTER_SAMPLES: f64 = 5.0;
/// Filter times for which the four lags remember what a resting shaft was held by: less than 2 % is older.
const MEMORY: f64 = 9.0;
/// Most rows of a regression; one of so many samples is taken, as neighbours say the same through the filter.
const ROWS: usize = 12_000;
/// Fewest samples between rows.
const STRIDE: usize = 3;
/// Fewest rows that say anything.
const FEWEST: usize = 200;
/// Parts of a parameter by which it is moved for a derivative.
const MOVE: f64 = 1e-4;
/// A column of which less than this part is its own repeats the others.
const OWN_PART: f64 = 1e-6;
/// The same of a law beside the model's own parameters: with less, differences between filters count as much as a law.
const LAW_PART: f64 = 0.05;
/// With less of its own than this part a torque repeats an effect that the model has: the two differ where the shaft may rest.
const REPEATED: f64 = 0.02;
/// Factors by which a law may change the motor's back-EMF with its friction, and its inertia: the one, and both.
const ONE_CHANGED: f64 = 1.5;
const BOTH_CHANGED: f64 = 1.25;

/// Square of the correlation with the current, or with the command, over which a law is like it: that of `|i|^p`, with its sign, is less
/// where `p` is under 0.75 or over 1.35, if all currents are as frequent.
const LIKE_THE_DRIVE: f64 = 0.99;

/// A function of the angle.
type Wave = fn(f64) -> f64;

/// The regression's rows of one recording.
pub struct Equation<'a> {
    data: &'a Data,
    time: f64,
    machine: Machine<f64>,
    /// The measured motion.
    pub motion: Motion,
    /// Samples of the rows.
    pub rows: Vec<usize>,
    /// Volts that the shaft is given beyond the model.
    pub missing: Vec<f64>,
    /// What changes of the model's own parameters would give, V.
    pub own: Vec<Vec<f64>>,
    /// An orthonormal basis of `own`.
    basis: Vec<Vec<f64>>,
    /// The current, and the command, each of length one.
    drives: Vec<Vec<f64>>,
}

impl<'a> Equation<'a> {
    /// Of a recording and a model. `None` where the motor turned too little.
    pub fn new(data: &'a Data, candidate: &Candidate) -> Option<Self> {
        let time = FILTER_SAMPLES * data.units.interval;
        let motion = Motion::new(data, candidate);
        let residuals = equation_residuals(data, candidate, time);
        let mut since = f64::NEG_INFINITY;
        let rested: Vec<bool> = (0..data.len())
            .map(|k| {
                if motion.rests[k] || data.recordings.is_first(k) {
                    since = data.time_s[k];
                }
                data.time_s[k] - since < MEMORY * time
            })
            .collect();
        let used: Vec<_> = residuals.iter().filter(|r| !rested[r.sample]).collect();
        let stride = used.len().div_ceil(ROWS).max(STRIDE);
        let used: Vec<_> = used.into_iter().step_by(stride).collect();
        if used.len() < FEWEST {
            return None;
        }
        let mut own = vec![
            used.iter().map(|r| r.speed).collect(),
            used.iter().map(|r| r.acceleration).collect(),
            jerk(data, time, &used),
        ];
        let rows: Vec<usize> = used.iter().map(|r| r.sample).collect();
        let missing = used.iter().map(|r| -r.volts).collect();
        own.extend(own_columns(data, candidate, time, &rows));
        let mut equation = Equation {
            data,
            time,
            machine: candidate.machine,
            motion,
            rows,
            missing,
            basis: orthonormal(&own),
            own,
            drives: Vec::new(),
        };
        let drives = [
            equation.seen(&equation.motion.current, Place::Torque),
            equation.seen(&equation.motion.command, Place::Voltage),
        ];
        let drives = drives.into_iter().filter_map(|drive| direction(drive, 0.0));
        equation.drives = drives.collect();
        Some(equation)
    }

    /// What changes of the linear motor would give: speed, acceleration, jerk.
    pub fn linear(&self) -> &[Vec<f64>] {
        &self.own[..3]
    }

    /// What another candidate misses at the rows, V.
    pub fn missing_by(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        missing_at(self.data, candidate, self.time, &self.rows)
    }

    /// What a signal that is held from sample to sample gives at the rows.
    pub fn seen(&self, signal: &[f64], place: Place) -> Vec<f64> {
        let filtered = filtered(self.data, self.time, signal, true);
        // A torque passes the winding's lag backwards: its volts lead.
        let lead = match place {
            Place::Torque | Place::Inertia => self.machine.electrical,
            Place::Voltage | Place::Drop => 0.0,
        };
        let at = |&k: &usize| filtered[k].value + lead * filtered[k].rate;
        self.rows.iter().map(at).collect()
    }

    /// The angle at the rows, rad, as late as the volts.
    pub fn angle(&self) -> Vec<f64> {
        let per_count = core::f64::consts::TAU / self.data.units.counts_per_rev;
        let first = self.data.centre(0);
        let turned: Vec<f64> = (0..self.data.len())
            .map(|k| (self.data.centre(k) - first) * per_count)
            .collect();
        let filtered = filtered(self.data, self.time, &turned, false);
        let at = |&row: &usize| filtered[row].value + first * per_count;
        self.rows.iter().map(at).collect()
    }

    /// Typical parameters of an effect, SI.
    pub fn typical(&self, kind: Kind) -> Vec<f64> {
        typical(self.data, kind)
    }

    /// The columns of a term, one for each amplitude.
    pub fn columns(&self, term: &Term) -> Vec<Vec<f64>> {
        if let (Place::Inertia, Some(order)) = (term.place, term.order) {
            return self.inertia_columns(f64::from(order));
        }
        let factors = term.factors(&self.motion);
        factors.iter().map(|f| self.seen(f, term.place)).collect()
    }

    /// Of inertias `m·cos kθ` and `m·sin kθ`, `m` the motor's: each, `m·g(θ)`, takes `m·(g·dω/dt + ω²/2·dg/dθ)` from the shaft, which is
    /// `m·(d²G/dt² − ω²/2·dg/dθ)` with `dG/dθ = g`. So the acceleration is taken of readings alone, as the motor's own is.
    fn inertia_columns(&self, order: f64) -> Vec<Vec<f64>> {
        let per_count = core::f64::consts::TAU / self.data.units.counts_per_rev;
        let angle = |k: usize| order * self.data.centre(k) * per_count;
        let pairs = self.motion.speed.iter().zip(&self.motion.angle);
        let squares: Vec<(f64, f64)> = pairs.map(|(w, angle)| (w * w, order * angle)).collect();
        // G and dg/dθ.
        let waves: [[Wave; 2]; 2] = [
            [libm::sin, |x| -libm::sin(x)],
            [|x| -libm::cos(x), libm::cos],
        ];
        let column = |[gathered, slope]: [Wave; 2]| -> Vec<f64> {
            let gathered: Vec<f64> = (0..self.data.len())
                .map(|k| gathered(angle(k)) / order)
                .collect();
            let gathered = filtered(self.data, self.time, &gathered, false);
            let squares: Vec<f64> = (squares.iter())
                .map(|(square, angle)| 0.5 * order * slope(*angle) * square)
                .collect();
            let squares = self.seen(&squares, Place::Inertia);
            let rows = self.rows.iter().zip(squares);
            rows.map(|(&row, square)| {
                let second =
                    gathered[row].acceleration + self.machine.electrical * gathered[row].jerk;
                self.machine.inertia * (square - second)
            })
            .collect()
        };
        waves.map(column).into()
    }

    /// Whether changes of the first of the model's own columns, beside a law, leave a motor. A law that is like the command explains
    /// all without one: it takes the drive away, and back-EMF and inertia with it.
    pub fn leaves_a_motor(&self, changes: &[f64]) -> bool {
        // Of speed and acceleration.
        let [total, second, _] = motor_coefficients(&self.machine);
        let factors = [total, second]
            .into_iter()
            .zip(changes)
            .map(|(own, change)| {
                let part = (own - change) / own;
                if part > 0.0 {
                    part.max(1.0 / part)
                } else {
                    f64::INFINITY
                }
            });
        let (least, most) = factors.fold((f64::INFINITY, 1.0), |(least, most), factor| {
            (factor.min(least), factor.max(most))
        });
        least <= BOTH_CHANGED && most <= ONE_CHANGED
    }

    /// Whether columns say something that the model's own parameters and the ones before do not, and none is like the drive: whatever is
    /// missing is as well a part of that.
    pub fn are_distinct(&self, columns: &[Vec<f64>]) -> bool {
        let mut found = Vec::new();
        columns.iter().all(|column| {
            !self.is_like_the_drive(column) && self.adds(LAW_PART, &mut found, column)
        })
    }

    fn is_like_the_drive(&self, column: &[f64]) -> bool {
        let most = LIKE_THE_DRIVE * dot(column, column);
        let along = |drive: &Vec<f64>| dot(column, drive);
        self.drives.iter().any(|drive| along(drive).powi(2) > most)
    }

    /// Whether more than a part of a column is neither along the model's own columns nor along those that were found before, among which
    /// it then is.
    fn adds(&self, part: f64, found: &mut Vec<Vec<f64>>, column: &[f64]) -> bool {
        let whole = dot(column, column);
        let mut rest = column.to_vec();
        take_out(&self.basis, &mut rest);
        take_out(found, &mut rest);
        let own = direction(rest, part * part * whole);
        let adds = own.is_some();
        found.extend(own);
        adds
    }

    /// Changes of speed, acceleration and jerk's coefficients, V per each, beside those of some torques along the samples that the model
    /// has not.
    pub fn changes_beside(&self, torques: &[Vec<f64>]) -> Option<[f64; 3]> {
        let mut found = Vec::new();
        let columns = torques.iter().map(|torque| self.torque(torque));
        let columns: Vec<Vec<f64>> = columns
            .filter(|column| self.adds(REPEATED, &mut found, column))
            .collect();
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let blocks = Blocks::new(self, &columns);
        let all: Vec<usize> = (0..columns.len()).collect();
        let by = blocks.coefficients(&blocks.with(&all))?;
        Some([by[0], by[1], by[2]])
    }

    /// What a torque along the samples gives at the rows.
    pub fn torque(&self, torque: &[f64]) -> Vec<f64> {
        self.seen(torque, Place::Torque)
    }

    /// Mean square of what a perfect model would leave, V²: of what this one leaves of its own run, floored to counts.
    pub fn perfect(&self, candidate: &Candidate) -> Option<f64> {
        if !self.data.quantised {
            return None;
        }
        let mut own = simulated(self.data, candidate, Method::default()).ok()?;
        for count in &mut own.counts {
            *count = count.floor();
        }
        let motion = Motion::new(&own, candidate);
        let mut since = f64::NEG_INFINITY;
        let residuals = equation_residuals(&own, candidate, self.time);
        let (mut squares, mut n) = (0.0, 0.0);
        let mut next = residuals.iter().peekable();
        for k in 0..own.len() {
            if motion.rests[k] || own.recordings.is_first(k) {
                since = own.time_s[k];
            }
            while next.peek().is_some_and(|r| r.sample < k) {
                next.next();
            }
            let turns = own.time_s[k] - since >= MEMORY * self.time;
            if let Some(r) = next.peek().filter(|r| r.sample == k && turns) {
                squares += r.volts * r.volts;
                n += 1.0;
            }
        }
        let noise: f64 = squares / n;
        noise.is_finite().then_some(noise)
    }
}

/// The third derivative of the angle at the residuals' samples.
fn jerk(data: &Data, time: f64, used: &[&EquationResidual]) -> Vec<f64> {
    let per_count = core::f64::consts::TAU / data.units.counts_per_rev;
    let angle = |k: usize| (data.centre(k) - data.centre(0)) * per_count;
    let angles: Vec<f64> = (0..data.len()).map(angle).collect();
    let filtered = filtered(data, time, &angles, false);
    used.iter().map(|r| filtered[r.sample].jerk).collect()
}

/// What a candidate misses at some samples, V.
fn missing_at(data: &Data, candidate: &Candidate, time: f64, rows: &[usize]) -> Option<Vec<f64>> {
    let residuals = equation_residuals(data, candidate, time);
    let mut next = residuals.iter().peekable();
    let find = |&row: &usize| {
        while next.peek().is_some_and(|r| r.sample < row) {
            next.next();
        }
        next.peek().filter(|r| r.sample == row).map(|r| -r.volts)
    };
    rows.iter().map(find).collect()
}

/// Derivatives of the missing volts by the parameters of the model's effects.
fn own_columns(data: &Data, candidate: &Candidate, time: f64, rows: &[usize]) -> Vec<Vec<f64>> {
    let here = missing_at(data, candidate, time, rows).unwrap_or_else(|| vec![0.0; rows.len()]);
    let mut columns = Vec::new();
    let effects: Vec<_> = candidate.effects.iter().collect();
    for (index, (kind, values)) in effects.iter().enumerate() {
        for (slot, usual) in typical(data, *kind).into_iter().enumerate() {
            let step = MOVE * values[slot].abs().max(usual.abs()).max(1e-12);
            let mut moved = candidate.keeping(|_| false);
            for (other, (kind, values)) in effects.iter().enumerate() {
                let mut values = values.to_vec();
                if other == index {
                    values[slot] += step;
                }
                // They fitted in before.
                let _ = moved.effects.push(*kind, &values);
            }
            // As many columns for every recording: one of zeros takes nothing.
            let there = missing_at(data, &moved, time, rows).unwrap_or_else(|| here.clone());
            let pairs = there.iter().zip(&here);
            columns.push(pairs.map(|(there, here)| (there - here) / step).collect());
        }
    }
    columns
}

/// Columns with their parts along the ones before taken out, each of length one; those that have no part of their own are left out.
pub fn orthonormal(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let whole = dot(column, column);
        let mut rest = column.clone();
        take_out(&basis, &mut rest);
        take_out(&basis, &mut rest);
        basis.extend(direction(rest, OWN_PART * whole));
    }
    basis
}

/// A column scaled to length one; `None` where its square is not over `least`.
fn direction(mut column: Vec<f64>, least: f64) -> Option<Vec<f64>> {
    let square = dot(&column, &column);
    if !(square > least && square.is_normal()) {
        return None;
    }
    let length = square.sqrt();
    column.iter_mut().for_each(|x| *x /= length);
    Some(column)
}

/// Takes the parts along an orthonormal basis out of a column.
pub fn take_out(basis: &[Vec<f64>], column: &mut [f64]) {
    for direction in basis {
        let along = dot(direction, column);
        for (x, d) in column.iter_mut().zip(direction) {
            *x -= along * d;
        }
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
