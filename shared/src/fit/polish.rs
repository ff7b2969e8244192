//! The polish: Levenberg and Marquardt's method (1944, 1963) from the end of the search, a slice at a time.
//!
//! The sensitivity of the error to each unknown is a difference of two runs. Three models run side by side: the centre and
//! two others, each displaced along one axis, for each pair of axes in turn. So the normal equations need the room of three
//! models, however many unknowns there are, and d·(d − 1)/2 passes fill them.

use super::cholesky::{Matrix, inverse};
use super::covariance::Covariance;
use super::differences::{Differences, Products};
use super::evaluation::{BUILD, Runs, build};
use super::{Arithmetic, MOST, Point, Space};
use crate::scalar::Real;
use crate::trace::Trace;

/// Most rounds.
const ROUNDS: u32 = 20;
/// Damping of the first step, as a fraction of the curvature along each axis.
const DAMPING: f32 = 1e-3;
const LEAST_DAMPING: f32 = 1e-6;
const MOST_DAMPING: f32 = 1e6;
/// First displacement along an axis, of the cube's edge.
const REACH: f32 = 1e-4;
const LONGEST: f32 = 0.02;
const SHORTEST: f32 = 1e-7;
/// A displacement should move the reading by about this, counts RMS: far above f32's rounding, well within what is linear.
const VISIBLE: f32 = 1.0;
/// … or by this fraction of the error, where that is large: stops and releases make the cost rough on a small scale.
const ROUGH: f32 = 0.3;
/// Within this factor of it, a displacement is good enough.
const TOLERABLE: f32 = 5.0;
/// A step that promises, or gains, less than this fraction of the cost is the last.
const NEGLIGIBLE: f32 = 1e-4;

/// Sums of products of the sensitivities over the trace.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Normal {
    /// Sensitivity by sensitivity.
    matrix: Matrix,
    /// Sensitivity by error.
    slope: [f32; MOST],
    /// Slopes of the blocks of the trace, by each other.
    scatter: Matrix,
}

/// The next piece of work. Models are not part of it: a device has no room to move them, so they are built in place.
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
            scatter: [[0.0; MOST]; MOST],
        },
        damping: 0.0,
        trial: [0.0; MOST],
        promised: 0.0,
        rounds: 0,
        evaluations: 0,
        work: Work::Displace(0, 0),
        differences: Differences::EMPTY,
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

    /// Whether the work is done.
    pub fn is_done(&self) -> bool {
        matches!(self.work, Work::Done)
    }

    /// Sets the covariance of where it ended, with the variance of a reading, counts².
    // Out of line, for the sake of the stack.
    #[inline(never)]
    pub(super) fn covariance(&self, to: &mut Covariance, dim: usize, variance: f32) {
        to.set(dim, &self.normal.matrix, &self.normal.scatter, variance);
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
                    built &= build(&mut runs[k], &space.motor(x), f32::INFINITY);
                }
                self.differences.begin(trace.len());
                self.work = if built { Work::Run(a, b) } else { Work::Done };
                3 * BUILD
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
                if !build(&mut runs[0], &space.motor(&trial), bound) {
                    self.judge(space, f32::INFINITY);
                }
                BUILD
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

    /// The centre moved along `axis`, and by how much; away from the upper bound of friction, load or winding where it is
    /// near.
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
    fn take(&mut self, space: &Space, a: usize, b: usize, products: Products, periods: usize) {
        let ([ea, eb], [aa, ab, bb]) = (products.slopes, products.squares);
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
        let [aa, ab, bb] = products.scatter;
        normal.scatter[a][a] = aa / (ha * ha);
        normal.scatter[b][b] = bb / (hb * hb);
        normal.scatter[a][b] = ab / (ha * hb);
        normal.scatter[b][a] = normal.scatter[a][b];
        self.work = if b + 1 < space.dim() {
            Work::Displace(a, b + 1)
        } else if a + 2 < space.dim() {
            Work::Displace(a + 1, a + 2)
        } else {
            self.aim(space)
        };
    }

    /// Accepts a trial and goes on from it, or tries a shorter step.
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

    /// Sets the trial to the solution of the normal equations, damped as much as needed. Where it is beyond a bound, that
    /// coordinate ends at the bound and the others are solved for again: merely cut off, the step would climb the valley's
    /// side.
    fn aim(&mut self, space: &Space) -> Work {
        let n = space.dim();
        let matrix = &self.normal.matrix;
        // What nothing depends on stays where it is.
        let mut free = [false; MOST];
        for (k, free) in free.iter_mut().enumerate() {
            *free = matrix[k][k] > 0.0;
        }
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
