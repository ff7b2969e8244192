//! Motor + effects + encoder: the few lines to read first.
//!
//! A [`Model`] holds coefficients and never changes; a [`State`] is what runs. Without effects a
//! step is one linear map. With effects, torques are taken at the middle of the (sub)step, and
//! friction is a budget whose stops and releases are located inside the step: whenever the speed
//! would change sign, or a held shaft would break loose, the step is halved, down to 1/32, and its
//! parts are taken by the exact maps of the half steps. No root finding, no division; and the same
//! path for every lane.

use crate::discretise::{Connection, Discretisation, StepMap};
use crate::effects::{Budget, EffectSet, Lowered, Shaft};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Angle, Mask, Real, Scalar};
use crate::units::PerUnit;

/// Halvings of a step while a stop or a release is located.
const LEVELS: usize = 5;

/// What a model is made of, in SI.
#[derive(Clone, Copy, Debug)]
pub struct Plan<R> {
    /// The linear machine.
    pub machine: Machine<R>,
    /// Effects with their parameters.
    pub effects: EffectSet<R>,
    /// Bases of the per-unit system; one interval is one step.
    pub units: PerUnit<R>,
    /// Exact, or the paper's Euler step.
    pub discretisation: Discretisation,
    /// Steps that an interval is cut into where effects bend the path; at least 1.
    pub substeps: u16,
}

impl<R: Real> Plan<R> {
    /// The linear machine, discretised exactly.
    pub fn linear(machine: Machine<R>, units: PerUnit<R>) -> Self {
        Plan {
            machine,
            effects: EffectSet::default(),
            units,
            discretisation: Discretisation::Exact,
            substeps: 1,
        }
    }
}

/// Coefficients of one model in the number format `S`. Immutable.
#[derive(Clone, Copy, Debug)]
pub struct Model<S: Scalar> {
    /// Maps of a substep and of its half, quarter, … with the bridge closed.
    driven: [StepMap<S::Coefficient>; LEVELS + 1],
    open: [StepMap<S::Coefficient>; LEVELS + 1],
    held: [StepMap<S::Coefficient>; LEVELS + 1],
    counts_per_unit: S::Coefficient,
    /// Whole, for the position within a revolution.
    counts_per_rev: u32,
    effects: Lowered<S>,
    substeps: u16,
}

/// What runs. `Default` is rest at angle zero.
#[derive(Clone, Copy, Debug, Default)]
pub struct State<S: Scalar> {
    /// Current, as the voltage across the resistance; per unit.
    pub current: S,
    /// Speed, per unit. Exactly zero while friction holds the shaft.
    pub speed: S,
    /// Shaft angle.
    pub angle: S::Angle,
}

/// What a step adds to the state.
struct Increment<S> {
    current: S,
    speed: S,
    angle: S,
}

impl<S: Scalar> Model<S> {
    /// Discretises and lowers a plan.
    ///
    /// # Errors
    /// A parameter that is not physical, or a coefficient beyond the range of `S`: in fixed point,
    /// per-unit coefficients up to 2 in magnitude are guaranteed to fit.
    pub fn new<R: Real>(plan: &Plan<R>) -> Result<Self, ModelError> {
        plan.machine.check()?;
        let machine = plan.machine.lower(&plan.units);
        let effects = Lowered::new(&plan.effects, &plan.units);
        let substeps = if effects.is_empty() {
            1
        } else {
            plan.substeps.max(1)
        };
        let step = R::from_f64(1.0) / R::from_f64(substeps as f64);
        // Without effects nothing is ever located inside a step: one map will do.
        let depth = if effects.is_empty() { 0 } else { LEVELS };
        let maps =
            |connection| ladder::<S, R>(&machine, connection, step, depth, plan.discretisation);
        Ok(Model {
            driven: maps(Connection::Driven)?,
            open: maps(Connection::Open)?,
            held: maps(Connection::Held)?,
            counts_per_unit: S::coefficient(plan.units.counts_per_unit().to_f64()),
            counts_per_rev: (plan.units.counts_per_rev.to_f64() + 0.5) as u32,
            effects,
            substeps,
        })
    }

    /// Advances by one interval with `command` held; `open` while the bridge is open.
    #[inline]
    pub fn step(&self, state: &mut State<S>, command: S, open: bool) {
        if self.effects.is_empty() {
            let map = if open { &self.open[0] } else { &self.driven[0] };
            let by = increment(state, map, command, S::zero());
            self.add(state, &by);
        } else {
            for _ in 0..self.substeps {
                self.substep(state, command, open);
            }
        }
    }

    #[inline(always)]
    fn add(&self, state: &mut State<S>, by: &Increment<S>) {
        state.current = state.current + by.current;
        state.speed = state.speed + by.speed;
        state.angle = state.angle.advance(by.angle, self.counts_per_unit);
    }

    fn shaft(&self, state: &State<S>) -> Shaft<S> {
        Shaft {
            turns: state.angle.turns(self.counts_per_rev),
            speed: state.speed,
            current: state.current,
        }
    }

    /// One substep with effects.
    fn substep(&self, state: &mut State<S>, command: S, open: bool) {
        let maps = if open { &self.open } else { &self.driven };
        let mut shaft = self.shaft(state);
        let mut volts = self.effects.drive(command, &shaft);
        let mut torque = self.effects.torque(&shaft);
        let mut budget = self.effects.friction(&shaft);
        if self.effects.bends {
            // Second order: look again at the middle of the substep.
            let drag = direction(state, torque, &budget) * budget.moving;
            let mut middle = *state;
            self.add(
                &mut middle,
                &increment(state, &maps[1], volts, torque + drag),
            );
            shaft = self.shaft(&middle);
            volts = self.effects.drive(command, &shaft);
            torque = self.effects.torque(&shaft);
            budget = self.effects.friction(&shaft);
        }
        if self.effects.friction {
            self.slide_and_stick(state, volts, torque, &budget, open);
        } else {
            let by = increment(state, &maps[0], volts, torque);
            self.add(state, &by);
        }
    }

    /// Speed of a shaft that broke loose within the smallest part of a step, in which the pull rose
    /// evenly from `before` to `pull`: the excess over friction acts for the rest of the part.
    fn started(&self, map: &StepMap<S::Coefficient>, pull: S, before: S, budget: &Budget<S>) -> S {
        let excess = pull.abs() - budget.holding;
        let rest = excess.part_of(pull.abs() - before.abs());
        let mean = excess * S::from_f64(0.5) + (budget.holding - budget.moving);
        let torque = mean * rest * pull.signum();
        // The map's last column answers to a torque against positive rotation.
        (-torque).times(map.speed[3])
    }

    /// Takes one substep in the largest parts that hold no stop and no release.
    fn slide_and_stick(
        &self,
        state: &mut State<S>,
        volts: S,
        torque: S,
        budget: &Budget<S>,
        open: bool,
    ) {
        const PARTS: u32 = 1 << LEVELS;
        let zero = S::zero();
        let (maps, held) = if open {
            (&self.open, &self.open)
        } else {
            (&self.driven, &self.held)
        };
        let mut done = 0;
        let mut level = 0;
        while done < PARTS {
            let sense = direction(state, torque, budget);
            let holds = is_zero(sense);
            let slide = increment(state, &maps[level], volts, torque + sense * budget.moving);
            // A held shaft: the current settles, nothing turns.
            let settle = increment(state, &held[level], volts, zero);
            let current = state.current + S::select(holds, settle.current, slide.current);
            let speed = state.speed + slide.speed;
            let turns_back = (speed * sense).less(zero);
            let breaks_loose = budget.holding.less((current - torque).abs()).and(holds);
            if turns_back.or(breaks_loose).any() {
                if level < LEVELS {
                    level += 1;
                    continue;
                }
                let pull = current - torque;
                let started = self.started(&maps[level], pull, state.current - torque, budget);
                let passed = passed_through(speed, pull, budget);
                state.speed = S::select(
                    holds,
                    S::select(breaks_loose, started, zero),
                    S::select(turns_back, passed, speed),
                );
            } else {
                state.speed = S::select(holds, zero, speed);
            }
            state.current = current;
            state.angle = state
                .angle
                .advance(S::select(holds, zero, slide.angle), self.counts_per_unit);
            done += PARTS >> level;
            while level > 0 && done.is_multiple_of(PARTS >> (level - 1)) {
                level -= 1;
            }
        }
    }
}

/// Speed after a reversal within the smallest part of a step. The part was run with friction on
/// the old side throughout; beyond the reversal the same pull meets friction on the new side, so
/// the speed gained there shrinks as the net torque does. Zero if friction holds the pull.
fn passed_through<S: Scalar>(speed: S, pull: S, budget: &Budget<S>) -> S {
    let pull = pull.abs();
    let share = (pull - budget.moving).part_of(pull + budget.moving);
    let held = budget.holding.less(pull).not();
    S::select(held, S::zero(), speed * share)
}

/// One linear map: held voltage, held torque.
#[inline(always)]
fn increment<S: Scalar>(
    state: &State<S>,
    map: &StepMap<S::Coefficient>,
    volts: S,
    torque: S,
) -> Increment<S> {
    let row = |k: &[S::Coefficient; 4]| {
        state.current.times(k[0]) + state.speed.times(k[1]) + volts.times(k[2]) + torque.times(k[3])
    };
    Increment {
        current: row(&map.current),
        speed: row(&map.speed),
        angle: row(&map.angle),
    }
}

/// Sense of the motion that friction opposes: of the speed, or of the torque that breaks a resting
/// shaft loose; zero while it is held.
#[inline(always)]
fn direction<S: Scalar>(state: &State<S>, torque: S, budget: &Budget<S>) -> S {
    let pull = state.current - torque;
    let loose = budget.holding.less(pull.abs());
    let start = S::select(loose, pull.signum(), S::zero());
    S::select(is_zero(state.speed), start, state.speed.signum())
}

#[inline(always)]
fn is_zero<S: Scalar>(x: S) -> S::Mask {
    x.less(S::zero()).or(S::zero().less(x)).not()
}

/// The map of a step and of its half, quarter, … down to `depth` halvings (the rest repeats the
/// last one). The shortest is computed, the others follow by doubling.
fn ladder<S: Scalar, R: Real>(
    machine: &Machine<R>,
    connection: Connection,
    step: R,
    depth: usize,
    how: Discretisation,
) -> Result<[StepMap<S::Coefficient>; LEVELS + 1], ModelError> {
    let mut shortest = step;
    for _ in 0..depth {
        shortest = shortest * R::from_f64(0.5);
    }
    let mut map = StepMap::new(machine, connection, shortest, how)?;
    let mut rungs = [map.lower::<S>()?; LEVELS + 1];
    for level in (0..depth).rev() {
        map = match how {
            Discretisation::Exact => map.twice(),
            // Euler's step is what it is at each length: two half steps are not one whole step.
            Discretisation::Euler => {
                let mut length = step;
                for _ in 0..level {
                    length = length * R::from_f64(0.5);
                }
                StepMap::new(machine, connection, length, how)?
            }
        };
        rungs[level] = map.lower::<S>()?;
    }
    Ok(rungs)
}
