//! Gauss and Newton's steps from the end of a search (Levenberg, 1944; Marquardt, 1963), and the curvature there.
//!
//! The sensitivity of the error to each unknown is a difference of two runs. Three models run side by side: the centre and
//! two others, each displaced along one axis, for each pair of axes in turn. So the normal equations are summed up in the
//! room of three models, however many unknowns there are, and d·(d − 1)/2 passes give all of them.

use super::evaluation::{Room, Runs, build, explained};
use super::{Arithmetic, MOST, Point, Space};
use crate::scalar::Real;
use crate::trace::Trace;

/// Most rounds.
const ROUNDS: u32 = 20;
/// Damping of the first step, as a part of the curvature along each axis.
const DAMPING: f32 = 1e-3;
const LEAST_DAMPING: f32 = 1e-6;
const MOST_DAMPING: f32 = 1e6;
/// First displacement along an axis, of the cube's edge.
const REACH: f32 = 1e-4;
const LONGEST: f32 = 0.02;
const SHORTEST: f32 = 1e-7;
/// A displacement should move the reading by about this, counts RMS: far above f32's rounding, well within what is linear.
const VISIBLE: f32 = 1.0;
/// … or by this part of the error, where that is large: stops and releases make the cost rough in small.
const ROUGH: f32 = 0.3;
/// Within this factor of it, a displacement is good enough.
const TOLERABLE: f32 = 5.0;
/// A step that promises, or gains, less than this part of the cost is the last.
const NEGLIGIBLE: f32 = 1e-4;

/// A pivot that is no more than this part of its diagonal is rounding.
const SINGULAR: f32 = 1e-6;

type Matrix = [[f32; MOST]; MOST];

/// Sums of products of the sensitivities over the trace.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Normal {
    /// Sensitivity by sensitivity.
    matrix: Matrix,
    /// Sensitivity by error.
    slope: [f32; MOST],
}

/// Curvature of the sum of squares over the unit cube, halved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    inverse: Matrix,
    periods: f32,
}

impl Curvature {
    /// Standard deviation of what changes by `gradient` over the cube, where the mean squared error is `least` and so many
    /// `readings` of the trace say something new.
    pub fn std(&self, gradient: &Point, least: f32, readings: usize) -> f32 {
        let repeats = self.periods / readings.max(1) as f32;
        let mut variance = 0.0;
        for (row, &a) in self.inverse.iter().zip(gradient) {
            for (entry, &b) in row.iter().zip(gradient) {
                if a != 0.0 && b != 0.0 {
                    variance += entry * a * b;
                }
            }
        }
        Real::sqrt(least * repeats * variance.max(0.0))
    }
}

/// What the centre and two displaced models differ by, summed up along the trace.
#[derive(Clone, Copy, Debug, Default)]
struct Differences {
    at: usize,
    /// Of the error and of both differences; of the error by both; of the differences by themselves and by each other, row by
    /// row of the upper triangle.
    sums: [f32; 8],
    /// The same since the last whole block.
    block: [f32; 8],
}

/// Periods that are summed up by themselves first: a sum of sums rounds less than one long sum.
const BLOCK: usize = 32;

impl Differences {
    /// Runs the models side by side for a while; returns how many periods they ran in all.
    fn run<S: Arithmetic>(&mut self, runs: &mut Runs<S>, trace: &Trace<'_>, samples: u32) -> u32 {
        let to = (self.at + samples as usize / 3 + 1).min(trace.len());
        let from = self.at;
        for k in from..to {
            let mut errors = [0.0f32; 3];
            for (run, error) in runs.iter_mut().filter_map(Room::model).zip(&mut errors) {
                run.step(trace.duties[k], trace.steps[k]);
                *error = run.error();
            }
            let [e, a, b] = errors;
            let (a, b) = (a - e, b - e);
            let terms = [e, a, b, e * a, e * b, a * a, a * b, b * b];
            for (sum, term) in self.block.iter_mut().zip(terms) {
                *sum += term;
            }
            if (k + 1).is_multiple_of(BLOCK) || k + 1 == trace.len() {
                for (sum, block) in self.sums.iter_mut().zip(&mut self.block) {
                    *sum += *block;
                    *block = 0.0;
                }
            }
        }
        self.at = to;
        3 * (to - from) as u32
    }

    /// Products about the means: where within a count the shaft stood is not known. But if the mean error is more than that can
    /// explain, where it stood is at the end of its range and stays there: the cost has no other mean to take off.
    fn products(&self) -> [f32; 5] {
        let [e, a, b, ea, eb, aa, ab, bb] = self.sums;
        let mut part = 1.0 / self.at.max(1) as f32;
        let mean = e * part;
        let start = explained(mean);
        if start != mean {
            part = 0.0;
        }
        [
            ea - start * a,
            eb - start * b,
            aa - a * a * part,
            ab - a * b * part,
            bb - b * b * part,
        ]
    }
}

/// What comes next. Models are not part of it: they are built where they stay, since a device has no room to hand them on.
#[derive(Clone, Copy, Debug)]
enum Work {
    /// Build the models of a pair of axes.
    Displace(usize, usize),
    /// Run them.
    Run(usize, usize),
    /// Build the trial, and run it.
    Build,
    Try,
    Done,
}

/// Levenberg and Marquardt's method, a slice at a time.
#[derive(Clone, Copy, Debug)]
pub struct Polish {
    centre: Point,
    /// Where the coordinates' zero is in the unit cube.
    from: Point,
    cost: f32,
    reach: Point,
    /// Displacements of the present pair that were no good.
    tries: u32,
    periods: f32,
    normal: Normal,
    damping: f32,
    trial: Point,
    promised: f32,
    rounds: u32,
    evaluations: u32,
    work: Work,
    differences: Differences,
}

impl Polish {
    /// Not begun: all zeros, so that no image is copied for it.
    pub(super) const EMPTY: Self = Polish {
        centre: [0.0; MOST],
        from: [0.0; MOST],
        cost: 0.0,
        reach: [0.0; MOST],
        tries: 0,
        periods: 0.0,
        normal: Normal {
            matrix: [[0.0; MOST]; MOST],
            slope: [0.0; MOST],
        },
        damping: 0.0,
        trial: [0.0; MOST],
        promised: 0.0,
        rounds: 0,
        evaluations: 0,
        work: Work::Displace(0, 0),
        differences: Differences {
            at: 0,
            sums: [0.0; 8],
            block: [0.0; 8],
        },
    };

    /// Begins an empty one from `centre`, where the mean squared error is `cost`. Puts the origin of `space` there, see
    /// [`Space::about`].
    pub(super) fn begin(&mut self, space: &mut Space, centre: &Point, cost: f32) {
        self.centre = *centre;
        self.from = space.about(&mut self.centre);
        self.cost = cost;
        self.reach = [REACH; MOST];
        self.damping = DAMPING;
        self.work = Work::Displace(0, 1);
    }

    /// The best point so far, and its cost.
    pub fn best(&self) -> (Point, f32) {
        (self.centre, self.cost)
    }

    /// Models that were run.
    pub fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// The curvature, once the work is done; `None` in it if there is none in some direction.
    pub fn done(&self, space: &Space, periods: usize) -> Option<Option<Curvature>> {
        matches!(self.work, Work::Done).then(|| {
            let every = [true; MOST];
            inverse(&self.normal.matrix, space.dim(), 0.0, &every).map(|inverse| Curvature {
                inverse,
                periods: periods as f32,
            })
        })
    }

    /// Runs models along at most about `samples` periods of the trace; returns how many it ran.
    // Out of line: in one with what calls it, its stack is beyond the reach of a small core's short instructions.
    #[inline(never)]
    pub(super) fn work<S: Arithmetic>(
        &mut self,
        space: &Space,
        trace: &Trace<'_>,
        runs: &mut Runs<S>,
        samples: u32,
    ) -> u32 {
        match self.work {
            Work::Done => samples,
            Work::Displace(a, b) => {
                let points = [self.centre, self.displaced(a).0, self.displaced(b).0];
                let mut built = true;
                for (k, x) in points.iter().enumerate() {
                    built &= build(&mut runs[k], space, x, f32::INFINITY);
                }
                self.differences = Differences::default();
                self.work = if built { Work::Run(a, b) } else { Work::Done };
                3 * super::BUILD
            }
            Work::Run(_, _) if self.differences.at < trace.len() => {
                self.differences.run(runs, trace, samples)
            }
            Work::Run(a, b) => {
                let products = self.differences.products();
                self.evaluations += 3;
                self.take(space, a, b, products, trace.len());
                1
            }
            Work::Build => {
                let (trial, bound) = (self.trial, self.cost);
                self.work = Work::Try;
                if !build(&mut runs[0], space, &trial, bound) {
                    self.judge(space, f32::INFINITY);
                }
                super::BUILD
            }
            Work::Try => {
                let Some(trial) = runs[0].model() else {
                    self.work = Work::Done;
                    return 1;
                };
                if let Some(cost) = trial.result() {
                    self.evaluations += 1;
                    self.judge(space, cost);
                    return 1;
                }
                trial.run(trace, samples)
            }
        }
    }

    /// The centre moved along `axis`, away from a wall of friction, load or winding if there is one; the logarithms' walls are
    /// where nothing happens.
    // Called from four places.
    #[inline(never)]
    fn displaced(&self, axis: usize) -> (Point, f32) {
        let mut x = self.centre;
        let reach = self.reach[axis];
        let reach = if x[axis] + reach > 1.0 { -reach } else { reach };
        x[axis] += reach;
        // What f32 made of it.
        (x, x[axis] - self.centre[axis])
    }

    /// Enters a pair into the normal equations, or tries better displacements.
    fn take(&mut self, space: &Space, a: usize, b: usize, products: [f32; 5], periods: usize) {
        let [ea, eb, aa, ab, bb] = products;
        self.periods = periods.max(1) as f32;
        if self.tries < 4 {
            let mut unfit = false;
            let visible = VISIBLE.max(ROUGH * Real::sqrt(self.cost));
            for (axis, square) in [(a, aa), (b, bb)] {
                let moved = Real::sqrt(square.max(0.0) / self.periods);
                let widest = LONGEST.min(self.centre[axis].max(1.0 - self.centre[axis]));
                let wanted = if moved > 0.0 {
                    self.reach[axis] * visible / moved
                } else {
                    widest
                };
                let wanted = wanted.max(SHORTEST).min(widest);
                let off = moved > visible * TOLERABLE || moved * TOLERABLE < visible;
                if off && wanted != self.reach[axis] {
                    self.reach[axis] = wanted;
                    unfit = true;
                }
            }
            if unfit {
                self.tries += 1;
                self.work = Work::Displace(a, b);
                return;
            }
        }
        self.tries = 0;
        let (ha, hb) = (self.displaced(a).1, self.displaced(b).1);
        let normal = &mut self.normal;
        normal.slope[a] = ea / ha;
        normal.slope[b] = eb / hb;
        normal.matrix[a][a] = aa / (ha * ha);
        normal.matrix[b][b] = bb / (hb * hb);
        normal.matrix[a][b] = ab / (ha * hb);
        normal.matrix[b][a] = normal.matrix[a][b];
        self.work = if b + 1 < space.dim() {
            Work::Displace(a, b + 1)
        } else if a + 2 < space.dim() {
            Work::Displace(a + 1, a + 2)
        } else {
            self.aim(space)
        };
    }

    /// Judges a trial; goes on from it, or tries a shorter step.
    fn judge(&mut self, space: &Space, cost: f32) {
        if cost < self.cost {
            let gained = self.cost - cost;
            let worthwhile = gained.max(self.promised / self.periods) > NEGLIGIBLE * cost;
            self.centre = self.trial;
            self.cost = cost;
            self.rounds += 1;
            self.damping = (self.damping * 0.1).max(LEAST_DAMPING);
            self.work = if worthwhile && self.rounds < ROUNDS {
                Work::Displace(0, 1)
            } else {
                Work::Done
            };
        } else {
            self.damping *= 10.0;
            self.work = self.aim(space);
        }
    }

    /// Sets the trial to where the normal equations lead, damped as much as it takes. Where that is beyond a wall, the step
    /// ends at the wall and the others are solved for again beside it: merely cut off, it would climb the valley's side.
    fn aim(&mut self, space: &Space) -> Work {
        let n = space.dim();
        let matrix = &self.normal.matrix;
        let mut free = [true; MOST];
        let mut step = [0.0; MOST];
        while self.damping <= MOST_DAMPING {
            let Some(inverse) = inverse(matrix, n, self.damping, &free) else {
                self.damping *= 10.0;
                continue;
            };
            let solved = free;
            let slope = |j: usize| {
                let beside = (0..n)
                    .filter(|&w| !solved[w])
                    .map(|w| matrix[j][w] * step[w]);
                beside.fold(self.normal.slope[j], |sum, term| sum + term)
            };
            let mut slopes = [0.0; MOST];
            for j in (0..n).filter(|&j| solved[j]) {
                slopes[j] = slope(j);
            }
            let mut stopped = false;
            for k in (0..n).filter(|&k| solved[k]) {
                let terms = (0..n)
                    .filter(|&j| solved[j])
                    .map(|j| inverse[k][j] * slopes[j]);
                step[k] = terms.fold(0.0, |sum, term| sum - term);
                let room = self.from[k] + self.centre[k];
                let to = room + step[k];
                if !(0.0..=1.0).contains(&to) {
                    step[k] = if to < 0.0 { -room } else { 1.0 - room };
                    free[k] = false;
                    stopped = true;
                }
            }
            if stopped {
                continue;
            }
            self.promised = 0.0;
            self.trial = self.centre;
            for k in 0..n {
                let bent = (0..n).fold(0.0, |sum, j| sum + matrix[k][j] * step[j]);
                self.promised -= step[k] * (2.0 * self.normal.slope[k] + bent);
                self.trial[k] = self.centre[k] + step[k];
            }
            return if self.trial == self.centre {
                Work::Done
            } else {
                Work::Build
            };
        }
        Work::Done
    }
}

/// Inverse of a symmetric matrix whose diagonal is enlarged by the part `damping`, by Cholesky's method without roots
/// (`L·D·Lᵀ`), for the `free` coordinates; none if that is not positive definite.
fn inverse(matrix: &Matrix, n: usize, damping: f32, free: &[bool; MOST]) -> Option<Matrix> {
    let entry = |a: usize, b: usize| match (free[a] && free[b], a == b) {
        (true, true) => matrix[a][a] * (1.0 + damping),
        (true, false) => matrix[a][b],
        (false, same) => f32::from(u8::from(same)),
    };
    let (mut lower, mut pivots) = ([[0.0; MOST]; MOST], [0.0; MOST]);
    for a in 0..n {
        for b in 0..=a {
            let terms = (0..b).map(|k| lower[a][k] * lower[b][k] * pivots[k]);
            let rest = terms.fold(entry(a, b), |rest, term: f32| rest - term);
            if a != b {
                lower[a][b] = rest / pivots[b];
            } else if rest > SINGULAR * entry(a, a) && rest.is_finite() {
                pivots[a] = rest;
            } else {
                return None;
            }
        }
    }
    let mut inverse = [[0.0; MOST]; MOST];
    for column in 0..n {
        let mut x = [0.0f32; MOST];
        for a in 0..n {
            let terms = (0..a).map(|k| lower[a][k] * x[k]);
            let unit = f32::from(u8::from(a == column));
            x[a] = terms.fold(unit, |rest, term| rest - term);
        }
        for a in (0..n).rev() {
            let terms = (a + 1..n).map(|k| lower[k][a] * x[k]);
            x[a] = terms.fold(x[a] / pivots[a], |rest, term| rest - term);
        }
        for (row, x) in inverse.iter_mut().zip(x) {
            row[column] = x;
        }
    }
    Some(inverse)
}
