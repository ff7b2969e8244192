//! How well volts explain the measured motion: the equation of motion of a motor with Coulomb friction, an offset and a
//! weight, integrated over blocks of samples.
//!
//! ```text
//! Δω = (∫u dt − kb Δθ − c ∫sign ω dt − o Δt − ∫(g sin θ + h cos θ) dt) / a
//! ```
//!
//! Nothing is simulated and nothing differentiated twice. The rise of the speed is what is explained, since it does not
//! depend on the scale of `u`: where the loop never reaches its limit, every gain explains it equally well.

use super::output::Follower;
use nalgebra::{DMatrix, DVector};

/// Reading's change within a block that is no rounding, counts.
const MOVED_COUNTS: f64 = 3.0;
/// Fewest blocks that say anything.
const FEWEST: usize = 30;
/// Back-EMF with viscous friction, and Coulomb friction: they can only take from the volts.
const LOSSES: [usize; 2] = [1, 2];
/// Columns: volts, the two losses, offset, and the weight's sine and cosine.
const COLUMNS: usize = 6;

/// The motion over blocks of one length.
pub(super) struct Motion {
    /// First and last sample of each.
    blocks: Vec<(usize, usize)>,
    /// Columns of the equation, the volts' still empty.
    matrix: DMatrix<f64>,
    /// Rise of the speed over each, rad/s.
    rises: DVector<f64>,
}

impl Motion {
    /// Over blocks of so many samples, each begun in the middle of the one before; `None` where too few of them show motion.
    pub(super) fn new(follower: &Follower<'_>, block: usize) -> Option<Self> {
        let samples = follower.time_s.len();
        let rad = follower.rad_per_count();
        let mut speeds = Speeds::new(follower, (block / 8).max(2));
        let mut blocks = Vec::new();
        let mut rows: Vec<[f64; COLUMNS]> = Vec::new();
        let mut rises = Vec::new();
        let mut begin = 0;
        while begin + block < samples {
            let end = begin + block;
            let read = &follower.counts[begin..=end];
            let far = read.iter().any(|c| (c - read[0]).abs() >= MOVED_COUNTS);
            if far && (begin..=end).all(|k| follower.is_closed(k)) {
                blocks.push((begin, end));
                rows.push(row(follower, begin, end));
                rises.push(rad * (speeds.at(end) - speeds.at(begin)));
            }
            begin += block / 2;
        }
        (rows.len() >= FEWEST).then(|| Motion {
            matrix: DMatrix::from_fn(rows.len(), COLUMNS, |i, j| rows[i][j]),
            rises: DVector::from_vec(rises),
            blocks,
        })
    }

    /// How many blocks share no sample.
    pub(super) fn independent(&self) -> f64 {
        0.5 * self.blocks.len() as f64
    }

    /// The part of the speed's rises that `volts` do not explain, as a part of their square sum; 1 where the volts would have to
    /// brake.
    pub(super) fn unexplained(&mut self, time_s: &[f64], volts: &[f64]) -> f64 {
        for (i, &(begin, end)) in self.blocks.iter().enumerate() {
            self.matrix[(i, 0)] = (begin..end)
                .map(|k| volts[k] * (time_s[k + 1] - time_s[k]))
                .sum();
        }
        let whole = self.rises.norm_squared();
        // Losses that would drive are left out.
        let bounded = || {
            let left = [&LOSSES[..1], &LOSSES[1..], &LOSSES];
            let left = left.iter().filter_map(|out| self.left_without(out));
            left.fold(whole, f64::min)
        };
        self.left_without(&[]).unwrap_or_else(bounded) / whole
    }

    /// Square sum that the equation without these columns leaves; `None` where a coefficient has the wrong sign.
    fn left_without(&self, out: &[usize]) -> Option<f64> {
        let columns: Vec<usize> = (0..COLUMNS).filter(|j| !out.contains(j)).collect();
        let mut matrix = self.matrix.select_columns(&columns);
        for mut column in matrix.column_iter_mut() {
            let norm = column.norm();
            if norm > 0.0 {
                column /= norm;
            }
        }
        let normal = matrix.transpose() * &matrix;
        let inverse = normal.pseudo_inverse(1e-12).ok()?;
        let solution = inverse * (matrix.transpose() * &self.rises);
        let drives = solution[0] > 0.0;
        let losses = columns.iter().zip(&solution);
        let takes = losses
            .filter(|(column, _)| LOSSES.contains(column))
            .all(|(_, value)| *value <= 0.0);
        (drives && takes).then(|| (&self.rises - matrix * &solution).norm_squared())
    }
}

/// A block's columns but for the volts'.
fn row(follower: &Follower<'_>, begin: usize, end: usize) -> [f64; COLUMNS] {
    let rad = follower.rad_per_count();
    let (time, counts) = (follower.time_s, follower.counts);
    let mut row = [0.0; COLUMNS];
    row[1] = rad * (counts[end] - counts[begin]);
    row[3] = time[end] - time[begin];
    for k in begin..end {
        let (length, step) = (time[k + 1] - time[k], counts[k + 1] - counts[k]);
        let (sine, cosine) = libm::sincos(0.5 * rad * (counts[k] + counts[k + 1]));
        if step != 0.0 {
            row[2] += length * step.signum();
        }
        row[4] += length * sine;
        row[5] += length * cosine;
    }
    row
}

/// Speeds in counts per second, each the slope of a parabola through its neighbourhood.
struct Speeds<'a> {
    follower: &'a Follower<'a>,
    half: usize,
    last: Option<(usize, f64)>,
}

impl<'a> Speeds<'a> {
    fn new(follower: &'a Follower<'a>, half: usize) -> Self {
        Speeds {
            follower,
            half,
            last: None,
        }
    }

    fn at(&mut self, k: usize) -> f64 {
        if let Some((_, speed)) = self.last.filter(|(sample, _)| *sample == k) {
            return speed;
        }
        let speed = self.slope(k);
        self.last = Some((k, speed));
        speed
    }

    fn slope(&self, k: usize) -> f64 {
        let samples = self.follower.time_s.len();
        let range = k.saturating_sub(self.half)..(k + self.half + 1).min(samples);
        let origin = self.follower.time_s[k];
        let scale = self.follower.time_s[range.end - 1] - self.follower.time_s[range.start];
        let rows: Vec<(f64, f64)> = range
            .map(|j| {
                let x = (self.follower.time_s[j] - origin) / scale;
                (x, self.follower.counts[j] - self.follower.counts[k])
            })
            .collect();
        let matrix = DMatrix::from_fn(rows.len(), 3, |i, j| rows[i].0.powi(j as i32));
        let right = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.1));
        let normal = matrix.transpose() * &matrix;
        match normal.pseudo_inverse(1e-12) {
            Ok(inverse) => (inverse * (matrix.transpose() * right))[1] / scale,
            Err(_) => 0.0,
        }
    }
}
