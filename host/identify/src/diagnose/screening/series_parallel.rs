//! A fit of the series-parallel model, whose effects act along the measured motion: cheap, smooth, and for that a start
//! only.

use crate::diagnose::context::Motion;
use servoid_engine::problem::{Data, Horizon, StartAngle, Structure};
use servoid_engine::simulation::Batch;
use servoid_engine::simulation::{Candidate, Method, Simulation};
use servoid_engine::simulation::{Mode, Segment, segments};
use servoid_engine::solve::Objective;
use shared::effects::Kind;

/// The series-parallel model's error as a function of the unknowns.
pub struct SeriesParallel<'a> {
    /// The recording.
    pub data: &'a Data,
    /// Its motion.
    pub motion: &'a Motion,
    /// How far the model runs before it is set back to the measured state.
    pub horizon: &'a Horizon,
    /// The unknowns.
    pub structure: Structure,
    /// How the model is run.
    pub method: Method,
}

/// Whether a series-parallel model follows this effect. Those that it does not follow cost little to simulate in full, or
/// gain nothing by it.
pub fn follows(kind: Kind) -> bool {
    kind.facts().series_parallel
}

impl SeriesParallel<'_> {
    /// Model minus measurement in counts, with the best start angle. `None` where the model cannot run.
    pub fn errors(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        let simulation = Simulation::new(self.data, candidate, self.coarse()).ok()?;
        let mut errors = simulation.errors(self.mode(), &self.segments(candidate));
        self.centre(&mut errors);
        errors.iter().all(|e| e.is_finite()).then_some(errors)
    }

    /// One part a sample: what is held at the measured mean needs no more.
    fn coarse(&self) -> Method {
        Method {
            substeps: 1,
            ..self.method
        }
    }

    fn mode(&self) -> Mode<'_> {
        Mode::SeriesParallel {
            seen: &self.motion.seen,
            turns: &self.motion.turns,
        }
    }

    fn segments(&self, candidate: &Candidate) -> Vec<Segment> {
        segments(self.data, candidate, self.horizon, StartAngle::Free)
    }

    /// Takes the best start angle of a whole run; in windows the measured one stands.
    fn centre(&self, errors: &mut [f64]) {
        let middle = match self.horizon {
            Horizon::Windows(_) => self.data.half_cell(),
            _ => errors.iter().sum::<f64>() / errors.len().max(1) as f64,
        };
        for error in errors {
            *error -= middle;
        }
    }
}

impl Objective for SeriesParallel<'_> {
    fn dim(&self) -> usize {
        self.structure.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.residuals_and_cost(x)
            .map_or(f64::INFINITY, |(_, cost)| cost)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let errors = self.errors(&self.structure.candidate_at(x))?;
        let cost = errors.iter().map(|e| e * e).sum();
        Some((errors, cost))
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let candidate = |x: &[f64]| self.structure.candidate_at(x);
        let candidates: Vec<Candidate> = moved.iter().map(|x| candidate(x)).collect();
        let run = Batch {
            data: self.data,
            method: self.coarse(),
            mode: self.mode(),
        };
        run.changes(
            &candidate(x),
            &candidates,
            |candidate| self.segments(candidate),
            |_, errors| self.centre(errors),
        )
    }
}
