//! A first guess at the model by linear regression, with no simulation at all.
//!
//! Integrated once, the machine's equation with amplitudes `A_j` of the effects reads
//!
//! ```text
//! ∫v dt = D·θ + a1·D·θ' + a2·D·θ'' + Σ A_j·∫(effect j per unit of amplitude) dt + const
//! ```
//!
//! All terms pass the same low-pass filter (`filter.rs`). Several filter times are tried side by side, sample by sample
//! with nothing kept but what the samples say together; the caller keeps the best.

use super::filter::{Behind, Filter};
use nalgebra::{DMatrix, DVector};
use servoid_engine::lanes::{Triangles, with_vectors};
use servoid_engine::problem::{Base, Data, Structure};
use shared::effects::{EffectSet, Kind, Lowered, Shaft};
use shared::motor::Machine;
use std::array::from_fn;

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

/// Side by side.
const TIMES: usize = FILTER_SAMPLES.len();
/// Four lags leave 43 % of a step after 4 filter times, 0.05 % after 14.
const SETTLED_TIMES: f64 = 14.0;
/// Singular values below this part of the largest are none.
const FLAT: f64 = 1e-10;

/// One number for each filter time.
type Each = [f64; TIMES];

/// Guesses with every filter time that gives one. Times at which the data do not excite the machine give none.
pub fn guesses(data: &Data, structure: &Structure) -> Vec<Guess> {
    let amplitudes = amplitudes(data, structure);
    let second_order = structure.base != Base::CurrentDriven;
    let width = 3 + usize::from(second_order) + amplitudes.len();
    let mut equations = Equations {
        triangles: Triangles::new(width + 1),
        rows: [0; TIMES],
    };
    let filter = Filter::new(
        data,
        FILTER_SAMPLES.map(|samples| samples * data.units.interval),
    );
    with_vectors(
        #[inline(always)]
        || equations.take(data, &filter, &amplitudes, second_order),
    );
    let triangles = equations.triangles.each();
    triangles
        .iter()
        .zip(equations.rows)
        .filter(|(_, rows)| *rows >= 4 * width)
        .filter_map(|(triangle, _)| {
            let solution = least_squares(triangle, width)?;
            let machine = machine(solution.as_slice(), second_order)?;
            let amplitudes = &solution.as_slice()[3 + usize::from(second_order)..];
            Some(Guess {
                machine,
                effects: effect_values(data, structure, amplitudes),
            })
        })
        .collect()
}

/// What the samples say, in one least-squares problem for each filter time: a column for the angle, the speed, a constant,
/// the acceleration where the winding lags, and each amplitude; the drive last.
struct Equations {
    triangles: Triangles<TIMES>,
    /// Rows that say something.
    rows: [usize; TIMES],
}

impl Equations {
    #[inline(always)]
    fn take(
        &mut self,
        data: &Data,
        filter: &Filter<TIMES>,
        amplitudes: &[Amplitude],
        second_order: bool,
    ) {
        let radians = core::f64::consts::TAU / data.units.counts_per_rev;
        let angle = |k: usize| data.centre(k) * radians;
        let times = FILTER_SAMPLES.map(|samples| samples * data.units.interval);
        let (mut motion_behind, mut drive_behind) = (Behind::default(), Behind::default());
        let mut taken = vec![Taken::default(); amplitudes.len()];
        let mut drive = 0.0;
        let mut origin = 0.0;
        let mut closed_since = 0.0;
        for k in 0..data.len() {
            if data.recordings.is_first(k) {
                // Every integral begins anew.
                (motion_behind, drive_behind) = (Behind::default(), Behind::default());
                taken.fill(Taken::default());
                (drive, origin, closed_since) = (0.0, angle(k), 0.0);
            }
            let motion = filter.output(&motion_behind, [angle(k) - origin; TIMES]);
            let target = filter.output(&drive_behind, [drive; TIMES]);
            // Where the bridge is open the equation is another; skip those samples and the filter's tail.
            let open = data.is_open(k);
            if open {
                closed_since = data.time_s[k];
            }
            let settled = |time: f64| {
                !open
                    && (data.time_s[k] - closed_since > SETTLED_TIMES * time || closed_since == 0.0)
            };
            let counts: Each = from_fn(|l| f64::from(u8::from(settled(times[l]))));
            for (rows, counts) in self.rows.iter_mut().zip(counts) {
                *rows += counts as usize;
            }
            let base = [motion.value, motion.rate, [1.0; TIMES]];
            let lag = second_order.then_some(motion.acceleration);
            let effects = taken
                .iter()
                .map(|taken| filter.output(&taken.behind, taken.sum).value);
            let row = base
                .into_iter()
                .chain(lag)
                .chain(effects)
                .chain([target.value]);
            self.triangles
                .push(row.map(|entry| from_fn(|l| entry[l] * counts[l])));
            if data.recordings.is_last(k) {
                continue;
            }
            let interval = data.lengths[data.length_of[k] as usize] * data.units.interval;
            for (taken, amplitude) in taken.iter_mut().zip(amplitudes) {
                let rise = amplitude.lost(data, k, &motion.rate).map(|x| x * interval);
                filter.pass(data, k, &mut taken.behind, rise);
                taken.sum = from_fn(|l| taken.sum[l] + rise[l]);
            }
            let rise = angle(k + 1) - angle(k);
            filter.pass(data, k, &mut motion_behind, [rise; TIMES]);
            let volts = if open {
                0.0
            } else {
                data.command[k] * data.units.volts
            };
            filter.pass(data, k, &mut drive_behind, [volts * interval; TIMES]);
            drive += volts * interval;
        }
    }
}

/// The machine of a solution, if it is one.
fn machine(solution: &[f64], second_order: bool) -> Option<Machine<f64>> {
    let (total, inertial) = (solution[0], solution[1]);
    let machine = if second_order {
        let lag = solution[3] / inertial;
        Machine {
            kb: total,
            damping: 0.0,
            inertia: inertial,
            electrical: lag.max(0.0),
        }
    } else {
        Machine {
            kb: 0.0,
            damping: total.max(0.0),
            inertia: inertial,
            electrical: 0.0,
        }
    };
    let turns = machine.inertia > 0.0 && machine.inertia.is_finite();
    let settles = !second_order || machine.kb > 0.0;
    (turns && settles).then_some(machine)
}

/// Column-scaled least squares by SVD of the triangle, so that a column that is nearly zero does no harm.
fn least_squares(triangle: &DMatrix<f64>, width: usize) -> Option<DVector<f64>> {
    let mut matrix = triangle.view((0, 0), (width, width)).into_owned();
    let right: DVector<f64> = triangle.view((0, width), (width, 1)).column(0).into_owned();
    let scales: Vec<f64> = matrix
        .column_iter()
        .map(|column| column.norm().max(f64::MIN_POSITIVE))
        .collect();
    for (mut column, scale) in matrix.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    if !(matrix.iter().chain(&right)).all(|x| x.is_finite()) {
        return None;
    }
    let solution = matrix.svd(true, true).solve(&right, FLAT).ok()?;
    let unscaled = DVector::from_iterator(width, solution.iter().zip(&scales).map(|(x, s)| x / s));
    unscaled.iter().all(|x| x.is_finite()).then_some(unscaled)
}

/// An amplitude of an effect, and the effect with that amplitude alone.
struct Amplitude {
    value: f64,
    effect: Lowered<f64>,
}

/// What an effect took from the drive so far per unit of its amplitude, evaluated along the filtered motion.
#[derive(Clone, Copy, Default)]
struct Taken {
    sum: Each,
    behind: Behind<TIMES>,
}

impl Amplitude {
    /// What the effect takes from the drive at sample `k` per unit of its amplitude, V, at each of the speeds.
    fn lost(&self, data: &Data, k: usize, rates: &Each) -> Each {
        let turns = (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0);
        let volts = data.command[k];
        rates.map(|rate| {
            let shaft = Shaft {
                volts,
                temperature: data.temperature(k),
                ..Shaft::at(turns, rate / data.units.speed, 0.0)
            };
            let budget = self.effect.friction(&shaft);
            let friction = budget.moving * shaft.speed.signum() + budget.bias;
            let torque = self.effect.torque(&shaft, &Default::default());
            let lost = volts - self.effect.drive(volts) + torque + friction;
            lost * data.units.volts / self.value
        })
    }
}

fn amplitudes(data: &Data, structure: &Structure) -> Vec<Amplitude> {
    let mut amplitudes = Vec::new();
    for (slot, &kind) in structure.effects.iter().enumerate() {
        for (index, parameter) in kind.parameters().iter().enumerate() {
            if !parameter.amplitude {
                continue;
            }
            let mut values = typical(data, structure.effects[slot]);
            for (k, other) in kind.parameters().iter().enumerate() {
                if other.amplitude && k != index {
                    values[k] = 0.0;
                }
            }
            let mut set = EffectSet::default();
            if set.push(kind, &values).is_err() || values[index] == 0.0 {
                continue;
            }
            amplitudes.push(Amplitude {
                value: values[index],
                effect: Lowered::new(&set, &data.units),
            });
        }
    }
    amplitudes
}

/// Typical values of an effect, SI.
pub fn typical(data: &Data, kind: Kind) -> Vec<f64> {
    let parameters = kind.parameters().iter();
    let typical = parameters.map(|p| p.scaled(p.typical, data.supply, data.units.speed));
    typical.collect()
}

/// The effects' parameters: amplitudes as found (kept inside their ranges), the rest typical.
fn effect_values(data: &Data, structure: &Structure, amplitudes: &[f64]) -> Vec<f64> {
    let mut found = amplitudes.iter();
    let mut values = Vec::new();
    for &kind in &structure.effects {
        let typical = typical(data, kind);
        for (parameter, typical) in kind.parameters().iter().zip(typical) {
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
