//! A first guess at the model by linear regression, with no simulation at all.
//!
//! Integrated once, the machine's equation with amplitudes `A_j` of the effects reads
//!
//! ```text
//! ∫v dt = D·θ + a1·D·θ' + a2·D·θ'' + Σ A_j·∫(effect j per unit of amplitude) dt + const
//! ```
//!
//! All terms pass the same low-pass filter (`filter.rs`). Several filter times are tried; the
//! caller keeps the best.

use super::filter::{Filtered, filtered};
use crate::problem::{Base, Data, Structure};
use nalgebra::{DMatrix, DVector};
use shared::effects::{EffectSet, Lowered, Shaft};
use shared::motor::Machine;
use shared::scalar::Real;

/// Filter times to try, in sample intervals.
pub const FILTER_SAMPLES: [f64; 4] = [3.0, 10.0, 30.0, 100.0];

/// A machine and the amplitudes of the effects, as far as regression can tell.
#[derive(Clone, Debug)]
pub struct Guess {
    /// The linear machine.
    pub machine: Machine<f64>,
    /// Parameters of the effects, in the order of the structure's unknowns.
    pub effects: Vec<f64>,
}

/// Integral of a held signal.
fn integral(data: &Data, held: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sum = 0.0;
    (0..data.len())
        .map(|k| {
            let now = sum;
            if k + 1 < data.len() {
                sum += held(k) * (data.time_s[k + 1] - data.time_s[k]);
            }
            now
        })
        .collect()
}

/// Guesses at the machine and the effects' amplitudes with filter time `time` (s). `None` where the
/// data do not excite the machine.
pub fn guess(data: &Data, structure: &Structure, time: f64) -> Option<Guess> {
    let radians = core::f64::consts::TAU / data.units.counts_per_rev;
    let angle: Vec<f64> = (0..data.len())
        .map(|k| (data.centre(k) - data.centre(0)) * radians)
        .collect();
    let motion = filtered(data, time, &angle, false);
    let drive = integral(data, |k| {
        if data.is_open(k) {
            0.0
        } else {
            data.command[k] * data.units.volts
        }
    });
    let target = filtered(data, time, &drive, false);
    let columns = effect_columns(data, structure, &motion, time);

    // Where the bridge is open the equation is another; skip those samples and the filter's tail.
    let mut usable = Vec::new();
    let mut closed_since = 0.0;
    for k in 0..data.len() {
        if data.is_open(k) {
            closed_since = data.time_s[k];
        }
        // Four lags leave 43 % of a step after 4 filter times, 0.05 % after 14.
        let settled = data.time_s[k] - closed_since > 14.0 * time || closed_since == 0.0;
        if !data.is_open(k) && settled {
            usable.push(k);
        }
    }
    let current_driven = structure.base == Base::CurrentDriven;
    let second_order = !current_driven;
    let width = 3 + usize::from(second_order) + columns.len();
    if usable.len() < 4 * width {
        return None;
    }
    let row = |k: usize, column: usize| match column {
        0 => motion[k].value,
        1 => motion[k].rate,
        2 => 1.0,
        3 if second_order => motion[k].acceleration,
        j => columns[j - 3 - usize::from(second_order)][k],
    };
    let solution = least_squares(&usable, width, &row, &|k| target[k].value)?;
    let (total, inertial) = (solution[0], solution[1]);
    let machine = if current_driven {
        Machine {
            kb: 0.0,
            damping: total.max(0.0),
            inertia: inertial,
            electrical: 0.0,
        }
    } else {
        let lag = solution[3] / inertial;
        Machine {
            kb: total,
            damping: 0.0,
            inertia: inertial,
            electrical: lag.max(0.0),
        }
    };
    if !(machine.inertia > 0.0
        && machine.inertia.is_finite()
        && (current_driven || machine.kb > 0.0))
    {
        return None;
    }
    let amplitudes = &solution.as_slice()[3 + usize::from(second_order)..];
    Some(Guess {
        machine,
        effects: effect_values(data, structure, amplitudes),
    })
}

/// Column-scaled least squares by SVD, so that a column that is nearly zero does no harm.
fn least_squares(
    rows: &[usize],
    width: usize,
    row: &dyn Fn(usize, usize) -> f64,
    target: &dyn Fn(usize) -> f64,
) -> Option<DVector<f64>> {
    let mut matrix = DMatrix::from_fn(rows.len(), width, |i, j| row(rows[i], j));
    let right = DVector::from_iterator(rows.len(), rows.iter().map(|&k| target(k)));
    let scales: Vec<f64> = matrix
        .column_iter()
        .map(|column| column.norm().max(f64::MIN_POSITIVE))
        .collect();
    for (mut column, scale) in matrix.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    // The triangle of a QR decomposition holds all that the many rows say.
    let qr = matrix.qr();
    let mut projected = right;
    qr.q_tr_mul(&mut projected);
    let top = projected.rows(0, width).into_owned();
    let solution = qr.r().svd(true, true).solve(&top, 1e-10).ok()?;
    let unscaled = DVector::from_iterator(width, solution.iter().zip(&scales).map(|(x, s)| x / s));
    unscaled.iter().all(|x| x.is_finite()).then_some(unscaled)
}

/// For each effect: the integral of what it takes from the drive per unit of its first amplitude,
/// evaluated along the measured motion, filtered.
fn effect_columns(
    data: &Data,
    structure: &Structure,
    motion: &[Filtered],
    time: f64,
) -> Vec<Vec<f64>> {
    let mut columns = Vec::new();
    for (slot, &kind) in structure.effects.iter().enumerate() {
        for (index, parameter) in kind.description().parameters.iter().enumerate() {
            if !parameter.amplitude {
                continue;
            }
            let mut values = typical(data, structure, slot);
            for (k, other) in kind.description().parameters.iter().enumerate() {
                if other.amplitude && k != index {
                    values[k] = 0.0;
                }
            }
            let mut set = EffectSet::default();
            if set.push(kind, &values).is_err() || values[index] == 0.0 {
                continue;
            }
            let lowered = Lowered::<f64>::new(&set, &data.units);
            let lost = |k: usize| {
                let turns = (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0);
                let shaft = Shaft::at(turns, motion[k].rate / data.units.speed, 0.0);
                let volts = data.command[k];
                let budget = lowered.friction(&shaft);
                let friction = budget.moving * shaft.speed.signum() + budget.bias;
                let torque = lowered.torque(&shaft, &Default::default());
                let lost = volts - lowered.drive(volts) + torque + friction;
                lost * data.units.volts / values[index]
            };
            let integrated = integral(data, lost);
            columns.push(
                filtered(data, time, &integrated, false)
                    .iter()
                    .map(|f| f.value)
                    .collect(),
            );
        }
    }
    columns
}

/// Typical values of the effect in `slot`, SI.
fn typical(data: &Data, structure: &Structure, slot: usize) -> Vec<f64> {
    let parameters = structure.effects[slot].description().parameters;
    parameters
        .iter()
        .map(|p| p.scaled(p.typical, data.supply, data.units.speed))
        .collect()
}

/// The effects' parameters: amplitudes as found (kept inside their ranges), the rest typical.
fn effect_values(data: &Data, structure: &Structure, amplitudes: &[f64]) -> Vec<f64> {
    let mut found = amplitudes.iter();
    let mut values = Vec::new();
    for (slot, &kind) in structure.effects.iter().enumerate() {
        let typical = typical(data, structure, slot);
        for (parameter, typical) in kind.description().parameters.iter().zip(typical) {
            let (low, high) = parameter.range;
            let low = parameter.scaled(low, data.supply, data.units.speed);
            let high = parameter.scaled(high, data.supply, data.units.speed);
            let value = if parameter.amplitude && typical != 0.0 {
                found.next().copied().unwrap_or(typical)
            } else {
                typical
            };
            values.push(value.clamp(low, high));
        }
    }
    values
}

/// Guesses with every filter time that gives one.
pub fn guesses(data: &Data, structure: &Structure) -> Vec<Guess> {
    FILTER_SAMPLES
        .iter()
        .filter_map(|samples| guess(data, structure, samples * data.units.interval))
        .filter(|guess| guess.machine.damping.is_finite() && Real::is_finite(guess.machine.kb))
        .collect()
}
