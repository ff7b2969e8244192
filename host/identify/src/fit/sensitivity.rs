//! Sums over the Jacobian of the residuals, which is never held as a whole: for an hour's recording it would be larger
//! than the recording.

use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{Candidate, Centring, FitProblem, Moments};

/// Places of the fitted path in its cell, over which its rounding errors are counted.
const PLACES: usize = 64;
/// Times by which the residuals are shifted.
const SHIFTS: usize = 32;
/// Time segments that count as independent.
pub(super) const SEGMENTS: usize = 24;
/// Wanted RMS change of the residual for a difference quotient, counts: far above rounding, far below any bend.
const PROBE_COUNTS: f64 = 0.02;
/// Rounding error of a column's sum of squares about its mean, relative to its plain sum of squares.
const ROUNDING: f64 = 1e-12;

/// Sums over the Jacobian J (a row a sample, a column an unknown) and the residuals r, counts.
pub(super) struct Sensitivity {
    /// Jᵀ·J, unknowns × unknowns.
    pub squares: DMatrix<f64>,
    /// Jᵀ·r of each time segment, a vector of unknowns each.
    pub gradients: Vec<DVector<f64>>,
    /// Jᵀ·e of errors e that the fitted path may as well have had, a list for each way to draw them: the rounding errors that the
    /// counter makes in each place that the path may have in its cell, where the reading is a count, and the residuals
    /// themselves at other times.
    pub redrawn: Vec<Vec<DVector<f64>>>,
}

/// Which errors are drawn again.
#[derive(Clone, Copy, Default)]
pub(super) struct Redraw {
    /// Places of the fitted path in its cell.
    places: usize,
    /// Shifts of the residuals in time, around the end.
    shifts: usize,
}

/// The models to both sides of an unknown's value, and the distance between them in the unknown's unit.
struct Pair {
    ahead: Candidate,
    behind: Candidate,
    width: f64,
}

/// Central differences at `values`. `None` where a model cannot run.
pub(super) fn sensitivity(
    problem: &FitProblem<'_>,
    values: &[f64],
    residuals: &[f64],
) -> Option<Sensitivity> {
    let redraw = Redraw {
        places: if problem.data.quantised { PLACES } else { 0 },
        shifts: SHIFTS,
    };
    sensitivities(problem, values, &[residuals], redraw)?.pop()
}

/// As [`sensitivity`], for each of several series of residuals.
pub(super) fn sensitivities(
    problem: &FitProblem<'_>,
    values: &[f64],
    series: &[&[f64]],
    redraw: Redraw,
) -> Option<Vec<Sensitivity>> {
    let mut sums: Vec<Sums<'_>> = (series.iter())
        .map(|residuals| Sums::new(values.len(), residuals, redraw))
        .collect();
    let centring = columns(problem, values, |columns| {
        for sums in &mut sums {
            sums.add(columns);
        }
    })?;
    let finite = |found: &Sensitivity| {
        let gradients = found.gradients.iter().flat_map(DVector::iter);
        found.squares.iter().chain(gradients).all(|x| x.is_finite())
    };
    let found: Vec<Sensitivity> = sums
        .into_iter()
        .map(|sums| sums.centred(centring))
        .collect();
    found.iter().all(finite).then_some(found)
}

/// Calls `each` with the columns of the Jacobian, counts per unit of each unknown, a range of samples at a time in their order.
/// `None` where a model cannot run.
pub(super) fn columns(
    problem: &FitProblem<'_>,
    values: &[f64],
    mut each: impl FnMut(&[Vec<f64>]),
) -> Option<Centring> {
    let pairs = pairs(problem, values)?;
    let models: Vec<Candidate> = pairs
        .iter()
        .flat_map(|pair| [pair.ahead, pair.behind])
        .collect();
    let mut columns = vec![Vec::new(); pairs.len()];
    let here = problem.structure.candidate(values);
    problem.stream_changes(&here, &models, |changes| {
        for ((column, pair), change) in columns.iter_mut().zip(&pairs).zip(changes.chunks(2)) {
            let quotient = |(up, down): (&f64, &f64)| match pair.width {
                0.0 => 0.0,
                width => (up - down) / width,
            };
            column.clear();
            column.extend(change[0].iter().zip(change[1]).map(quotient));
        }
        each(&columns);
    })
}

/// The models to both sides of each unknown, so far away that the residuals change by about [`PROBE_COUNTS`].
fn pairs(problem: &FitProblem<'_>, values: &[f64]) -> Option<Vec<Pair>> {
    let unknowns = &problem.structure.unknowns;
    let here = problem.structure.candidate(values);
    let model = |values: &[f64]| problem.structure.candidate(values);
    let widest = |k: usize| unknowns[k].range.1 - unknowns[k].range.0;
    let first = |k: usize| 1e-4 * values[k].abs().max(1e-4 * widest(k));
    let probes: Vec<Candidate> = (0..values.len())
        .map(|k| model(&moved(values, k, first(k), unknowns[k].range.1)))
        .collect();
    let mut changes = vec![Moments::default(); probes.len()];
    let centring = problem.stream_changes(&here, &probes, |some| {
        for (moments, change) in changes.iter_mut().zip(some) {
            moments.add(change);
        }
    })?;
    let pair = |(k, moments): (usize, &Moments)| {
        let squares = match centring {
            Centring::Pending => moments.squares_about_mean(),
            Centring::Done => moments.squares_about(0.0),
        };
        let change = (squares / problem.data.len() as f64).sqrt();
        let mut step = first(k);
        // One correction of the step brings the change near the wanted size.
        if change > 0.0 {
            step = (step * (PROBE_COUNTS / change).clamp(1e-4, 1e3)).min(0.02 * widest(k));
        }
        let (low, high) = unknowns[k].range;
        let ahead = moved(values, k, step, high);
        let behind = moved(values, k, -step, low);
        Pair {
            width: ahead[k] - behind[k],
            ahead: model(&ahead),
            behind: model(&behind),
        }
    };
    Some(changes.iter().enumerate().map(pair).collect())
}

/// `values` with unknown `k` moved by `step`, not beyond `limit`.
fn moved(values: &[f64], k: usize, step: f64, limit: f64) -> Vec<f64> {
    let mut values = values.to_vec();
    let target = values[k] + step;
    values[k] = if step > 0.0 {
        target.min(limit.max(values[k]))
    } else {
        target.max(limit.min(values[k]))
    };
    values
}

/// The sums so far.
struct Sums<'r> {
    residuals: &'r [f64],
    /// Samples so far.
    samples: usize,
    /// Σ J.
    sum: DVector<f64>,
    /// Lower triangle of Jᵀ·J.
    squares: DMatrix<f64>,
    /// Jᵀ·r and Σ r of each segment.
    segments: Vec<(DVector<f64>, f64)>,
    /// Jᵀ·e and Σ e of each place in the cell.
    places: Vec<(DVector<f64>, f64)>,
    /// The same of the residuals at each shift in time.
    shifts: Vec<(DVector<f64>, f64)>,
}

/// Error of a counter that rounds down to the centre of its cell, counts, of a path that is `from_centre` beside the centre of the
/// cell that was read, moved on by `place` of a cell.
fn rounding(from_centre: f64, place: f64) -> f64 {
    0.5 - (0.5 + from_centre + place).rem_euclid(1.0)
}

impl<'r> Sums<'r> {
    fn new(columns: usize, residuals: &'r [f64], redraw: Redraw) -> Self {
        let none = (DVector::zeros(columns), 0.0);
        Sums {
            places: vec![none.clone(); redraw.places],
            shifts: vec![none; redraw.shifts],
            residuals,
            samples: 0,
            sum: DVector::zeros(columns),
            squares: DMatrix::zeros(columns, columns),
            segments: Vec::new(),
        }
    }

    /// Samples of a segment.
    fn segment(&self) -> usize {
        self.residuals.len().div_ceil(SEGMENTS).max(1)
    }

    /// Adds the next samples of each column.
    fn add(&mut self, columns: &[Vec<f64>]) {
        let count = columns.first().map_or(0, Vec::len);
        let mut from = 0;
        while from < count {
            // Up to the end of the segment.
            let at = self.samples;
            let to = count.min(from + self.segment() - at % self.segment());
            let residuals = &self.residuals[at..at + to - from];
            let new = || (DVector::zeros(columns.len()), 0.0);
            let segment = at / self.segment();
            self.segments
                .resize_with(self.segments.len().max(segment + 1), new);
            let (gradient, residual) = &mut self.segments[segment];
            *residual += residuals.iter().sum::<f64>();
            for (i, column) in columns.iter().enumerate() {
                let column = &column[from..to];
                self.sum[i] += column.iter().sum::<f64>();
                gradient[i] += dot(column, residuals);
                for (k, other) in columns[..=i].iter().enumerate() {
                    self.squares[(i, k)] += dot(column, &other[from..to]);
                }
            }
            let cells = self.places.len() as f64;
            let mut errors = vec![0.0; residuals.len()];
            for (place, (gradient, sum)) in self.places.iter_mut().enumerate() {
                let moved = (place as f64 + 0.5) / cells;
                for (error, residual) in errors.iter_mut().zip(residuals) {
                    *error = rounding(*residual, moved);
                }
                *sum += errors.iter().sum::<f64>();
                for (gradient, column) in gradient.iter_mut().zip(columns) {
                    *gradient += dot(&column[from..to], &errors);
                }
            }
            let parts = self.shifts.len() + 1;
            for (number, (gradient, sum)) in self.shifts.iter_mut().enumerate() {
                let all = self.residuals;
                let ahead = at + (number + 1) * all.len() / parts;
                for (error, k) in errors.iter_mut().zip(ahead..) {
                    *error = all[k % all.len()];
                }
                *sum += errors.iter().sum::<f64>();
                for (gradient, column) in gradient.iter_mut().zip(columns) {
                    *gradient += dot(&column[from..to], &errors);
                }
            }
            self.samples += to - from;
            from = to;
        }
    }

    /// The sums, with each column's mean subtracted if that is pending.
    fn centred(mut self, centring: Centring) -> Sensitivity {
        self.squares.fill_upper_triangle_with_lower_triangle();
        if centring == Centring::Pending {
            let mean = &self.sum / self.samples.max(1) as f64;
            let raw = self.squares.diagonal();
            self.squares -= &self.sum * mean.transpose();
            for k in 0..raw.len() {
                // A constant column has no slope left: what remains is rounding.
                if self.squares[(k, k)] <= ROUNDING * raw[k] {
                    self.squares.row_mut(k).fill(0.0);
                    self.squares.column_mut(k).fill(0.0);
                }
            }
            let redrawn = self.places.iter_mut().chain(&mut self.shifts);
            for (gradient, sum) in self.segments.iter_mut().chain(redrawn) {
                *gradient -= &mean * *sum;
            }
        }
        Sensitivity {
            squares: self.squares,
            gradients: self.segments.into_iter().map(|(g, _)| g).collect(),
            redrawn: [self.places, self.shifts]
                .into_iter()
                .filter(|drawn| !drawn.is_empty())
                .map(|drawn| drawn.into_iter().map(|(g, _)| g).collect())
                .collect(),
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng;

    /// However many samples come at a time, and wherever segments end.
    #[test]
    fn the_sums_are_those_over_the_whole_matrix() {
        for seed in 0..20 {
            let mut generator = rng::seeded(seed);
            let mut draw = || 3.0 * rng::uniform::<f64>(&mut generator) - 1.0;
            let (rows, columns) = (211 + 17 * seed as usize, 1 + seed as usize % 4);
            let mut matrix = DMatrix::from_fn(rows, columns, |_, _| draw());
            let residuals: Vec<f64> = (0..rows).map(|_| draw()).collect();
            let parts: Vec<usize> = (0..rows)
                .map(|_| 1 + (draw().abs() * 40.0) as usize)
                .collect();
            for centring in [Centring::Done, Centring::Pending] {
                let mut sums = Sums::new(columns, &residuals, Redraw::default());
                let mut from = 0;
                for part in &parts {
                    let to = (from + part).min(rows);
                    let some = |column: usize| {
                        matrix
                            .column(column)
                            .rows_range(from..to)
                            .iter()
                            .copied()
                            .collect()
                    };
                    sums.add(&(0..columns).map(some).collect::<Vec<Vec<f64>>>());
                    from = to;
                }
                let found = sums.centred(centring);
                if centring == Centring::Pending {
                    for mut column in matrix.column_iter_mut() {
                        let mean = column.mean();
                        column.add_scalar_mut(-mean);
                    }
                }
                let apart = (&found.squares - matrix.tr_mul(&matrix)).norm();
                assert!(
                    apart < 1e-9 * matrix.norm_squared(),
                    "seed {seed}: {apart:e}"
                );
                let segment = rows.div_ceil(SEGMENTS);
                assert_eq!(found.gradients.len(), rows.div_ceil(segment), "seed {seed}");
                for (k, gradient) in found.gradients.iter().enumerate() {
                    let range = k * segment..((k + 1) * segment).min(rows);
                    let residuals = DVector::from_column_slice(&residuals[range.clone()]);
                    let apart = (gradient - matrix.rows_range(range).tr_mul(&residuals)).norm();
                    assert!(
                        apart < 1e-9 * rows as f64,
                        "seed {seed}, segment {k}: {apart:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_change_that_is_the_same_everywhere_is_none() {
        let residuals = [0.3; 1000];
        let mut sums = Sums::new(2, &residuals, Redraw::default());
        sums.add(&[vec![0.1; 1000], (0..1000).map(f64::from).collect()]);
        let found = sums.centred(Centring::Pending);
        assert_eq!(found.squares[(0, 0)], 0.0);
        assert!(found.squares[(1, 1)] > 0.0);
    }
}
