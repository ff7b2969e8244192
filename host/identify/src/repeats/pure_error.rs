//! The split of a model's residual over repeats, and its test.

use super::aligned::{Group, Member, Repeats};
use super::settings::{FEWEST_WINDOWS, FLIPS, REPEATED, SEED};
use servoid_engine::problem::{Candidate, Horizon, StartAngle, errors};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use shared::rng::{self, Rng};

/// What a model's error over repeats consists of. All errors are of free runs in windows, each from the measured state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LackOfFit {
    /// Runs that repeat another or are repeated.
    pub runs: usize,
    /// Length of the windows, s.
    pub window_s: f64,
    /// RMS error of the model, counts.
    pub model_counts: f64,
    /// RMS of what differs between repeats, counts: no model can explain it.
    pub noise_counts: f64,
    /// RMS of what all repeats have in common, counts: it lacks in the model.
    pub systematic_counts: f64,
    /// Probability of so much in common by chance. The signs of whole windows are drawn at random; so errors that last for less than a
    /// window count once.
    pub p_value: f64,
    /// RMS deviation of whole runs from their mean, counts.
    pub over_run_counts: f64,
}

impl LackOfFit {
    /// The model's error over what the motor repeats.
    pub fn ratio(&self) -> f64 {
        self.model_counts / self.noise_counts
    }

    /// Whether the model's error is what the motor does not repeat.
    pub fn is_repeatability(&self) -> bool {
        self.ratio() <= REPEATED
    }

    /// Part of what is explainable that the model explains, where `before` explains nothing of it.
    pub fn explained_share(&self, before: &LackOfFit) -> f64 {
        let part = self.systematic_counts / before.systematic_counts;
        (1.0 - part * part).clamp(0.0, 1.0)
    }
}

/// Products of the members' errors in one window, row by row.
struct Gram {
    products: Vec<f64>,
    members: usize,
}

impl Repeats<'_> {
    /// What the error of a model in windows of `window_s` consists of; `None` where the model cannot run, or too little repeats.
    pub fn lack_of_fit(
        &self,
        candidate: &Candidate,
        method: Method,
        window_s: f64,
    ) -> Option<LackOfFit> {
        let mut windows = Vec::new();
        let (mut readings, mut freedom) = (0.0, 0.0);
        for group in &self.groups {
            let length = group.window(window_s);
            let runs: Vec<Vec<f64>> = group
                .members
                .iter()
                .map(|member| member.errors(group, candidate, method, length))
                .collect::<Option<_>>()?;
            let covered = group.common - group.common % length;
            readings += (runs.len() * covered) as f64;
            freedom += ((runs.len() - 1) * covered) as f64;
            windows.extend((0..covered).step_by(length).map(|from| {
                let own = |run: &Vec<f64>| run[from..from + length].to_vec();
                Gram::of(&runs.iter().map(own).collect::<Vec<_>>())
            }));
        }
        if windows.len() < FEWEST_WINDOWS {
            return None;
        }
        let all: f64 = windows.iter().map(Gram::trace).sum();
        let runs: f64 = self.runs() as f64 / self.groups.len() as f64;
        let in_common: f64 = windows.iter().map(|w| w.in_common(|_| 1.0)).sum();
        let noise = (all - in_common) / freedom;
        let model = all / readings;
        let mut draws = rng::seeded(SEED);
        let mut flipped = || -> f64 {
            let window = |gram: &Gram| {
                let signs = draws.next_u64();
                gram.in_common(|member| {
                    if signs >> (member % 64) & 1 == 0 {
                        1.0
                    } else {
                        -1.0
                    }
                })
            };
            windows.iter().map(window).sum()
        };
        let as_much = (0..FLIPS).filter(|_| flipped() >= in_common).count();
        let found = LackOfFit {
            runs: self.runs(),
            window_s,
            model_counts: model.sqrt(),
            noise_counts: noise.sqrt(),
            // The mean of the runs keeps a part of what differs between them.
            systematic_counts: (in_common / readings - noise / runs).max(0.0).sqrt(),
            p_value: (as_much + 1) as f64 / (FLIPS + 1) as f64,
            over_run_counts: self.over_run(),
        };
        (found.noise_counts > 0.0 && found.model_counts.is_finite()).then_some(found)
    }
}

impl Gram {
    fn of(runs: &[Vec<f64>]) -> Self {
        let product = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(x, y)| x * y).sum();
        Gram {
            products: (runs.iter())
                .flat_map(|a| runs.iter().map(move |b| product(a, b)))
                .collect(),
            members: runs.len(),
        }
    }

    /// Sum of all squares.
    fn trace(&self) -> f64 {
        self.products.iter().step_by(self.members + 1).sum()
    }

    /// Squares of the mean of the runs, once for each of them; each run with a sign.
    fn in_common(&self, sign: impl Fn(usize) -> f64) -> f64 {
        let n = self.members;
        let of = |place: (usize, &f64)| sign(place.0 / n) * sign(place.0 % n) * place.1;
        self.products.iter().enumerate().map(of).sum::<f64>() / n as f64
    }
}

impl Member<'_> {
    /// Errors of a model over the common samples, counts, in windows of `length` samples.
    fn errors(
        &self,
        group: &Group<'_>,
        candidate: &Candidate,
        method: Method,
        length: usize,
    ) -> Option<Vec<f64>> {
        let ranges = (0..group.common / length).map(|window| {
            let from = self.first + window * length;
            from..from + length
        });
        let horizon = Horizon::windows_over(self.data, ranges);
        let (start, cost) = (StartAngle::Free, Cost::Squared);
        let all = errors(self.data, candidate, method, &horizon, start, cost).ok()?;
        let centre = self.data.half_cell();
        let common = &all[self.first..self.first + group.common];
        Some(common.iter().map(|error| error - centre).collect())
    }
}
