//! Orders of the angle at which a torque repeats, read off the equation's residual.
//!
//! The error of a simulation as a function of the order has a narrow valley at each order that is there,
//! so a descent must start in the right one. Each order's cosine and sine, as the residual's filter leaves them, are
//! regressed on by themselves, beside friction each way and corrections of damping and inertia.

use super::settings::{FEWEST, FILTERS_SAMPLES, WAVES};
use super::waves::{HIGHEST, LANES, ROWS, Row, each_sample};
use crate::fit::scores::{EquationResidual, equation_residuals};
use nalgebra::{Matrix2, Matrix4, Matrix4x2, Vector2, Vector4};
use servoid_engine::problem::{Candidate, Data};

/// A line of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Waves a revolution.
    pub order: usize,
    /// Amplitude of `cos(kθ)`, V.
    pub cosine: f64,
    /// Amplitude of `sin(kθ)`, V.
    pub sine: f64,
    /// Part of the residual's square that it explains.
    pub explains: f64,
}

impl Line {
    /// Amplitude, V.
    pub fn amplitude(&self) -> f64 {
        libm::hypot(self.cosine, self.sine)
    }

    /// Angle of the shaft, rad, at which the first wave is highest, as a part of the wave: `atan2(sine,
    /// cosine)`.
    pub fn phase(&self) -> f64 {
        libm::atan2(self.sine, self.cosine)
    }
}

/// The strongest lines in what the model's equation leaves unexplained, strongest first.
pub fn lines(data: &Data, candidate: &Candidate) -> Vec<Line> {
    clearest(data, candidate).lines
}

/// What the model's equation leaves unexplained, through one filter.
pub struct Filtered {
    /// Time of the filter, s.
    pub time: f64,
    /// Its output.
    pub residuals: Vec<EquationResidual>,
    /// The lines there, strongest first.
    lines: Vec<Line>,
}

/// Through the filter where one line explains most.
pub fn clearest(data: &Data, candidate: &Candidate) -> Filtered {
    let [short, long] = FILTERS_SAMPLES.map(|samples| {
        let time = samples * data.units.interval;
        let residuals = equation_residuals(data, candidate, time);
        Filtered {
            time,
            lines: lines_of(data, &residuals, time),
            residuals,
        }
    });
    let clear = |through: &Filtered| through.lines.first().map_or(0.0, |line| line.explains);
    if clear(&short) > clear(&long) {
        short
    } else {
        long
    }
}

/// The lines of residuals that were filtered with `time` (s), strongest first.
pub fn lines_of(data: &Data, residuals: &[EquationResidual], time: f64) -> Vec<Line> {
    let mut beside = Beside::default();
    let mut rows = [Sums::default(); ROWS];
    let mut residuals = residuals.iter().peekable();
    each_sample(
        data,
        time,
        #[inline(always)]
        |k, waves| {
            let Some(residual) = residuals.next_if(|residual| residual.sample == k) else {
                return;
            };
            let others = others(residual);
            beside.add(residual.volts, &others);
            for (sums, waves) in rows.iter_mut().zip(waves) {
                sums.add(residual.volts, &others, waves);
            }
        },
    );
    let Some(inverse) = beside.own.try_inverse() else {
        return Vec::new();
    };
    let turned_through = data.travel_counts() / data.units.counts_per_rev;
    let lowest = (WAVES / turned_through).ceil() as usize;
    let mut lines: Vec<Line> = (lowest.max(1)..=HIGHEST)
        .filter_map(|order| {
            let (row, lane) = ((order - 1) / LANES, (order - 1) % LANES);
            rows[row].line(order, lane, &beside, &inverse)
        })
        .collect();
    lines.sort_by(|a, b| b.explains.total_cmp(&a.explains));
    lines
}

/// What is fitted beside an order: friction each way, and corrections of damping and inertia.
pub fn others(residual: &EquationResidual) -> [f64; 4] {
    let forward = f64::from(u8::from(residual.speed > 0.0));
    [
        forward,
        1.0 - forward,
        residual.speed,
        residual.acceleration,
    ]
}

/// Normal equations of what is fitted beside the orders.
#[derive(Default)]
struct Beside {
    own: Matrix4<f64>,
    volts: Vector4<f64>,
    squares: f64,
}

impl Beside {
    fn add(&mut self, volts: f64, others: &[f64; 4]) {
        let others = Vector4::from(*others);
        self.own += others * others.transpose();
        self.volts += others * volts;
        self.squares += volts * volts;
    }
}

/// Products of a row of waves, summed over the samples.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// With the residual.
    volts: Row,
    /// With what is fitted beside.
    others: [Row; 4],
    /// With each other: cosine's square, the mixed product, sine's square.
    own: [[f64; LANES]; 3],
    /// Square of the waves' own square: with it, how many samples show them.
    shown: [f64; LANES],
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, volts: f64, others: &[f64; 4], [cosine, sine]: &Row) {
        for lane in 0..LANES {
            let (c, s) = (cosine[lane], sine[lane]);
            self.volts[0][lane] += volts * c;
            self.volts[1][lane] += volts * s;
            for (sums, other) in self.others.iter_mut().zip(others) {
                sums[0][lane] += other * c;
                sums[1][lane] += other * s;
            }
            let square = c * c + s * s;
            self.own[0][lane] += c * c;
            self.own[1][lane] += c * s;
            self.own[2][lane] += s * s;
            self.shown[lane] += square * square;
        }
    }

    /// The line of one order; `None` where too few samples show it.
    fn line(
        &self,
        order: usize,
        lane: usize,
        beside: &Beside,
        inverse: &Matrix4<f64>,
    ) -> Option<Line> {
        let [cc, cs, ss] = self.own.map(|sums| sums[lane]);
        if (cc + ss).powi(2) < FEWEST * self.shown[lane] {
            return None;
        }
        let cross = Matrix4x2::from_fn(|other, wave| self.others[other][wave][lane]);
        let taken = inverse * cross;
        let own = Matrix2::new(cc, cs, cs, ss) - cross.tr_mul(&taken);
        let volts = Vector2::new(self.volts[0][lane], self.volts[1][lane]);
        let volts = volts - taken.tr_mul(&beside.volts);
        let found = own.try_inverse()? * volts;
        let left = beside.squares - beside.volts.dot(&(inverse * beside.volts));
        let explains = volts.dot(&found) / left;
        explains.is_finite().then(|| Line {
            order,
            cosine: found[0],
            sine: found[1],
            explains,
        })
    }
}
