//! The fit, a slice at a time: up to three searches, each with its polish.

use super::covariance::Covariance;
use super::evaluation::{BUILD, Room, Runs, build};
use super::polish::Polish;
use super::stage::Stage;
use super::{Arithmetic, MOST, Outcome, Point, Settings, Space, Stop};
use crate::trace::Trace;

/// Where a search, or its polish, is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub space: Space,
    pub best: Point,
    /// Mean squared error there, counts².
    pub least: f32,
    pub covariance: Covariance,
}

impl Found {
    /// Nothing yet: all zeros.
    const NONE: Self = Found {
        space: Space::NONE,
        best: [0.0; MOST],
        least: 0.0,
        covariance: Covariance::NONE,
    };
}

/// A fit under way.
#[derive(Clone, Debug)]
pub struct Fit<S: Arithmetic> {
    settings: Settings,
    pub(super) stage: Stage,
    pub(super) runs: Runs<S>,
    /// The search has asked for the cost of the model in the first run.
    pub(super) asked: bool,
    evaluations: u32,
    /// Evaluations left of the search.
    left: u32,
    pub(super) now: Found,
    /// The best of the searches that are over, and how many those are.
    kept: Found,
    over: u32,
    /// The supply's resistance was added to the best.
    extended: bool,
}

/// Most searches in a fit.
pub const SEARCHES: u32 = 3;
/// Mean squared error, counts², of a model that the encoder's reading cannot be told from: a reading that is anywhere within a count has 1/12.
/// Above it a search from elsewhere may find better.
const FLOOR: f32 = 0.25;
/// The supply's resistance is kept where no more than this part of the mean squared error is left by it.
const EXPLAINS: f32 = 0.5;
/// Rounds that a polish usually takes.
const USUAL_ROUNDS: u32 = 6;
/// Two searches end alike within this part of the mean squared error.
const ALIKE: f32 = 0.01;

impl<S: Arithmetic> Fit<S> {
    /// Not begun. A fit begins where it stays, because it is larger than a device's stack. All of it is zero, so a static of it
    /// needs no image.
    pub const fn idle() -> Self {
        Fit {
            settings: Settings::NONE,
            stage: Stage::Idle,
            runs: [Room::EMPTY; 3],
            asked: false,
            evaluations: 0,
            left: 0,
            now: Found::NONE,
            kept: Found::NONE,
            over: 0,
            extended: false,
        }
    }

    /// Begins a fit. Returns false if the shaft did not move with the drive: there is nothing to fit.
    pub fn begin(&mut self, trace: &Trace<'_>, settings: Settings) -> bool {
        let Some(space) = Space::around(trace, &settings) else {
            return false;
        };
        self.settings = settings;
        self.now.space = space;
        self.evaluations = 0;
        self.over = 0;
        self.extended = false;
        self.search();
        self.kept = self.now;
        true
    }

    /// Begins a search in the space.
    fn search(&mut self) {
        let mut settings = self.settings;
        settings.seed = settings.seed.wrapping_add(self.over.into());
        self.stage.search(&settings, self.now.space.searched());
        for run in &mut self.runs {
            run.clear();
        }
        self.asked = false;
        self.left = settings.evaluations.into();
        self.now.best = [0.5; MOST];
        self.now.least = f32::INFINITY;
        self.now.covariance = Covariance::NONE;
    }

    /// Goes on from the end of a search to another from elsewhere, or to the end with the best of all.
    // Out of line, for the sake of the stack.
    #[inline(never)]
    fn go_on(&mut self, trace: &Trace<'_>, stop: Stop) {
        if self.extended {
            if self.now.least < EXPLAINS * self.kept.least {
                self.kept = self.now;
            }
            return self.finish(stop);
        }
        self.over += 1;
        let gained = self.kept.least - self.now.least;
        if gained > 0.0 {
            self.kept = self.now;
        }
        // Two searches from different places that end alike have found what there is.
        let alike = self.over > 1 && gained.abs() < ALIKE * self.kept.least;
        if self.kept.least <= FLOOR {
            return self.finish(stop);
        }
        if self.over < SEARCHES
            && !alike
            && let Some(mut space) = Space::around(trace, &self.settings)
        {
            match self.over {
                1 => space.hold_elsewhere(),
                _ => space.hold_as(&self.kept.best),
            }
            self.now.space = space;
            self.search();
        } else if self.settings.supply && self.kept.least.is_finite() {
            self.extended = true;
            self.now = self.kept;
            self.now.space.add_supply();
            self.polish();
        } else {
            self.finish(stop);
        }
    }

    /// Ends with the best.
    fn finish(&mut self, stop: Stop) {
        self.now = self.kept;
        let found = self.now.least.is_finite();
        self.stage = Stage::Done(if found { Stop::Converged } else { stop });
    }

    /// Begins the polish where the search ended.
    #[inline(never)]
    fn polish(&mut self) {
        self.stage = Stage::Polish(Polish::EMPTY);
        if let Stage::Polish(polish) = &mut self.stage {
            polish.begin(&mut self.now.space, &self.now.best, self.now.least);
        }
    }

    /// Evaluations so far, and about how many there will be.
    pub fn progress(&self) -> (u32, u32) {
        let dim = self.now.space.dim() as u32;
        let polished = match &self.stage {
            Stage::Polish(polish) => polish.evaluations(),
            _ => 0,
        };
        let done = self.evaluations + polished;
        let of_polish = (USUAL_ROUNDS * 3 * dim * (dim - 1) / 2).saturating_sub(polished);
        (done, done + self.left + of_polish)
    }

    /// Least mean squared error so far, counts².
    pub fn least(&self) -> f32 {
        self.now.least
    }

    /// Runs a model along at most about `samples` periods of the trace. Returns the outcome once there is one.
    pub fn work(&mut self, trace: &Trace<'_>, samples: u32) -> Option<Outcome> {
        let mut left = samples;
        while left > 0 {
            let used = match &mut self.stage {
                Stage::Idle | Stage::Predict(_) => return Some(self.outcome(Stop::NoModel)),
                Stage::Over(stop) => {
                    let stop = *stop;
                    self.go_on(trace, stop);
                    BUILD
                }
                Stage::Done(stop) => {
                    let stop = *stop;
                    return Some(self.outcome(stop));
                }
                Stage::Polish(polish) => {
                    let used = polish.work(&self.now.space, trace, &mut self.runs, left);
                    (self.now.best, self.now.least) = polish.best();
                    if polish.is_done() {
                        self.evaluations += polish.evaluations();
                        // Where the count stands still, readings repeat and say nothing new.
                        let readings = trace.steps.iter().filter(|&&step| step != 0).count();
                        let repeats = trace.len() as f32 / readings.max(1) as f32;
                        let dim = self.now.space.dim();
                        polish.covariance(&mut self.now.covariance, dim, self.now.least * repeats);
                        self.stage = Stage::Over(Stop::Converged);
                    }
                    used
                }
                Stage::Pso(_) | Stage::Firefly(_) => match self.runs[0].model() {
                    Some(evaluation) if self.asked => {
                        let used = evaluation.run(trace, left);
                        if let Some(mean_square) = evaluation.result() {
                            self.end(mean_square);
                        }
                        used
                    }
                    _ => {
                        self.next();
                        BUILD
                    }
                },
            };
            left = left.saturating_sub(used);
        }
        None
    }

    /// Asks for the next point and builds its model.
    fn next(&mut self) {
        let Some(search) = self.stage.searching() else {
            return;
        };
        let (x, bound) = (self.now.space.of_search(search.ask()), search.bound());
        self.asked = build(&mut self.runs[0], &self.now.space.motor(&x), bound);
        if !self.asked {
            self.end(f32::INFINITY);
        }
    }

    /// Tells the cost of the point, and goes on to the polish when the search is done.
    fn end(&mut self, mean_square: f32) {
        self.asked = false;
        self.evaluations += 1;
        self.left = self.left.saturating_sub(1);
        let Some(search) = self.stage.searching() else {
            return;
        };
        search.tell(mean_square);
        let best = search.best();
        (self.now.best, self.now.least) = (self.now.space.of_search(best.x), best.cost);
        if self.left == 0 {
            if !self.now.least.is_finite() {
                self.stage = Stage::Over(Stop::NoModel);
                return;
            }
            self.polish();
        }
    }

    fn outcome(&self, stop: Stop) -> Outcome {
        Outcome::new(
            &self.now.space,
            self.now.best,
            self.now.least,
            &self.now.covariance,
            self.evaluations,
            stop,
        )
    }
}
