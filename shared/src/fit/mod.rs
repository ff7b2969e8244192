//! The fit on the device, a slice at a time: swarm or fireflies, then Levenberg and Marquardt's method.
//!
//! ```text
//! trace → space (what is searched, and where) → search → polish → outcome
//!              └── candidate → rigid motor → evaluation, so many samples a slice
//! ```
//!
//! It searches over what voltage and angle determine: gain and the two time constants, in logarithms, and friction and
//! load if asked for. Behind a bridge with dead time the polish adds what that takes, and the viscous part of the damping; behind a supply
//! that is not measured, its resistance.
//! All is per supply, per period and in counts: a device need not know its supply voltage nor its encoder's resolution. The search itself is in f32 on every device; the model runs in `S`, f32 or fixed point. The same
//! trace, settings and `S` give the same bits anywhere, which is how the host checks a device.

mod arithmetic;
mod cholesky;
mod covariance;
mod differences;
mod evaluation;
mod outcome;
mod polish;
mod prediction;
mod space;
mod verdict;

pub use arithmetic::Arithmetic;
use covariance::Covariance;
pub use evaluation::Evaluation;
use evaluation::{Room, Runs, build};
pub use outcome::{Estimate, Outcome, Stop};
use polish::Polish;
pub use prediction::Predicted;
use prediction::Prediction;
pub use space::{MOST, Point, Space, Unknown};
pub use verdict::{Grade, Reason, Verdict};

use crate::optim::{Firefly, FireflySettings, Optimiser, Pso, PsoSettings};
use crate::rng;
use crate::servo::Gains;
use crate::trace::Trace;
use serde::{Deserialize, Serialize};

/// Largest population.
pub const POPULATION: usize = 20;

/// How to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// Particle swarm.
    Pso,
    /// Fireflies.
    Firefly,
}

/// What to search for, and how. Hosts keep it in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// The method.
    pub method: Method,
    /// Particles or fireflies, at most [`POPULATION`].
    pub population: u8,
    /// Evaluations of the search; those of the polish come on top.
    pub evaluations: u16,
    /// Seed of the search.
    pub seed: u64,
    /// Search for Coulomb friction.
    pub coulomb: bool,
    /// Search for a constant load.
    pub load: bool,
    /// Waves of the bridge's carrier in a control period, to fit what its dead time takes; zero takes a bridge that loses nothing.
    pub carriers: u16,
    /// What the dead time takes by the board's own figure, as a duty: the search takes it for granted, and the polish begins there.
    pub dead_time: u16,
    /// Fit the resistance of a supply that is not measured.
    pub supply: bool,
    /// Duty that is the whole supply, which the carrier's ripple and the supply's current depend on; zero for 32,768.
    pub full: u16,
}

impl Settings {
    /// Settings that suit most motors.
    pub const USUAL: Settings = Settings {
        method: Method::Firefly,
        population: 20,
        evaluations: 4000,
        seed: 1,
        coulomb: true,
        load: false,
        carriers: 0,
        dead_time: 0,
        supply: false,
        full: 0,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self::USUAL
    }
}

/// The swarm's settings for a population of 20: Clerc and Kennedy's constriction (2002).
const SWARM: PsoSettings = PsoSettings {
    inertia: 0.7298,
    cognitive: 1.496,
    social: 1.496,
    fastest: 1.0,
};

/// The stage of the fit; all stages share the same memory.
// The first is a zero at the front, see `Room`.
#[allow(
    clippy::large_enum_variant,
    reason = "there is no heap to put the larger ones on"
)]
#[derive(Clone, Debug)]
#[repr(u8)]
enum Stage {
    Idle,
    Pso(Pso<f32, POPULATION, MOST>),
    Firefly(Firefly<f32, POPULATION, MOST>),
    Polish(Polish),
    /// A search is over: another from elsewhere, or none. By the next slice, for the sake of the stack.
    Over(Stop),
    Done(Stop),
    Predict(Prediction),
}

impl Stage {
    /// Begins the search.
    // Out of line: what it needs of the stack is free again when the search runs.
    #[inline(never)]
    fn search(&mut self, settings: &Settings, dim: usize) {
        let population = settings.population.clamp(2, POPULATION as u8) as usize;
        let (evaluations, seed) = (settings.evaluations, settings.seed);
        match settings.method {
            Method::Pso => self.swarm(seed),
            Method::Firefly => self.fireflies(seed),
        }
        match self {
            Stage::Pso(pso) => pso.begin(dim, population, SWARM),
            Stage::Firefly(firefly) => {
                let cooled = FireflySettings {
                    evaluations: evaluations.into(),
                    ..FireflySettings::default()
                };
                firefly.begin(dim, population, cooled);
            }
            _ => {}
        }
    }

    // Each is made on the stack and moved here: apart, so that there is never room for both.
    #[inline(never)]
    fn swarm(&mut self, seed: u64) {
        *self = Stage::Pso(Pso::idle(rng::seeded(seed)));
    }

    #[inline(never)]
    fn fireflies(&mut self, seed: u64) {
        *self = Stage::Firefly(Firefly::idle(rng::seeded(seed)));
    }

    /// The search, while it runs.
    fn searching(&mut self) -> Option<&mut dyn Optimiser<f32, MOST>> {
        match self {
            Stage::Pso(pso) => Some(pso),
            Stage::Firefly(firefly) => Some(firefly),
            _ => None,
        }
    }
}

/// Where a search, or its polish, is.
#[derive(Clone, Copy, Debug)]
struct Found {
    space: Space,
    best: Point,
    /// Mean squared error there, counts².
    least: f32,
    covariance: Covariance,
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
    stage: Stage,
    runs: Runs<S>,
    /// The search has asked for the cost of the model in the first run.
    asked: bool,
    evaluations: u32,
    /// Evaluations left of the search.
    left: u32,
    now: Found,
    /// The best of the searches that are over, and how many those are.
    kept: Found,
    over: u32,
    /// The supply's resistance was added to the best.
    extended: bool,
}

/// Most searches in a fit.
const SEARCHES: u32 = 3;
/// Mean squared error, counts², of a model that the encoder's reading cannot be told from: a reading that is anywhere within a count has 1/12.
/// Above it a search from elsewhere may find better.
const FLOOR: f32 = 0.25;
/// The supply's resistance is kept where no more than this part of the mean squared error is left by it.
const EXPLAINS: f32 = 0.5;
/// Two searches end alike within this part of the mean squared error.
const ALIKE: f32 = 0.01;

impl<S: Arithmetic> Fit<S> {
    /// Not begun. A fit begins where it stays, because it is larger than a device's stack. All of it is zero, so a static of it
    /// needs no image.
    pub const fn idle() -> Self {
        Fit {
            settings: Settings {
                method: Method::Pso,
                population: 0,
                evaluations: 0,
                seed: 0,
                coulomb: false,
                load: false,
                carriers: 0,
                dead_time: 0,
                supply: false,
                full: 0,
            },
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
        let on = self.kept.least > FLOOR && self.over < SEARCHES && !alike;
        match Space::around(trace, &self.settings) {
            Some(mut space) if on => {
                match self.over {
                    1 => space.hold_elsewhere(),
                    _ => space.hold_as(&self.kept.best),
                }
                self.now.space = space;
                self.search();
            }
            _ if self.settings.supply && self.kept.least > FLOOR && self.kept.least.is_finite() => {
                self.extended = true;
                self.now = self.kept;
                self.now.space.add_supply();
                self.polish();
            }
            _ => self.finish(stop),
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
        (
            self.evaluations,
            self.evaluations + self.left + 3 * dim * dim,
        )
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
        self.asked = build(&mut self.runs[0], &self.now.space, &x, bound);
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

    /// Gets the best motor ready to predict about so many periods, judged over windows of `window` periods; the fit of the `fitted` periods is
    /// over. Returns false if there is none.
    pub fn predict(&mut self, fitted: usize, periods: u32, window: u32) -> bool {
        self.asked = false;
        self.stage = Stage::Predict(Prediction::EMPTY);
        let Stage::Predict(prediction) = &mut self.stage else {
            return false;
        };
        prediction.begin(
            &mut self.runs,
            &self.now.space,
            &self.now.best,
            &self.now.covariance,
            (self.now.least, fitted),
            (periods, window),
        )
    }

    /// One period of what the motor predicts: the duty acted, and the reading is `step` counts further.
    pub fn observe(&mut self, duty: i16, step: i16) {
        if let Stage::Predict(prediction) = &mut self.stage {
            prediction.step(&mut self.runs, duty, step);
        }
    }

    /// How well it predicted so far; `None` if it does not.
    // Out of line, for the sake of the stack.
    #[inline(never)]
    pub fn predicted(&mut self) -> Option<Predicted> {
        match &self.stage {
            Stage::Predict(prediction) => {
                Some(prediction.so_far(&mut self.runs, &self.now.space, &self.now.best))
            }
            _ => None,
        }
    }

    /// Gains by the fitted motor, whose gain over time constant may be off by the part `off`.
    pub fn gains(&self, off: f32) -> Gains {
        let mut values = [0.0; 3];
        for (k, value) in values.iter_mut().enumerate() {
            *value = self.now.space.value(k, &self.now.best);
        }
        let [gain, first_order, electrical] = values;
        let coulomb = (self.now.space.unknowns().iter()).position(|own| *own == Unknown::Coulomb);
        let friction = coulomb.map_or(0.0, |k| self.now.space.value(k, &self.now.best));
        Gains::of(gain, [first_order, electrical], friction, off)
    }

    /// Puts the fitted motor to rest, to be [`moved`](Self::moved). Returns false if there is none.
    pub fn rest(&mut self) -> bool {
        let (space, best) = (&self.now.space, &self.now.best);
        build(&mut self.runs[0], space, best, f32::INFINITY)
    }

    /// Moves the fitted motor for a period; gives its angle then, counts from where it rested.
    pub fn moved(&mut self, duty: i16) -> f32 {
        let Some(model) = self.runs[0].model() else {
            return 0.0;
        };
        model.step(duty, 0);
        model.error()
    }

    /// What the motor is good for, by how well it `predicted`; `within` is the largest error of an encoder, counts RMS.
    #[inline(never)]
    pub fn verdict(&self, predicted: &Predicted, within: f32) -> Verdict {
        let gradients = [0, 1].map(|k| {
            let gradient = self.now.space.gradient(k, &self.now.best);
            let value = self.now.space.value(k, &self.now.best);
            gradient.map(|x| x / value)
        });
        let [gain, mechanical] = gradients.map(|gradient| self.now.covariance.std(&gradient));
        let [g, m] = gradients;
        let mut ratio = g;
        for (x, m) in ratio.iter_mut().zip(m) {
            *x -= m;
        }
        let stds = [gain, mechanical, self.now.covariance.std(&ratio)];
        Verdict::of(stds, self.now.least, predicted, within)
    }
}

/// Cost of building a model, in samples: with friction there are eight maps to make.
const BUILD: u32 = 100;
