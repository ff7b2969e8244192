//! Motor + effects + encoder: the few lines to read first.
//!
//! A [`Model`] holds coefficients and never changes; a [`State`] is what runs. Without effects a
//! step is one linear map. With effects it is cut into parts, and in each part
//!
//! * what depends on speed, angle and current is held at its mean over the part (`foresee`), and a
//!   part that is too long for that is halved (`part`);
//! * a changed winding, and the drop of brushes, are solved for as volts (`winding`);
//! * friction is a budget whose stops and releases are located by halving (`friction`);
//! * a load behind a spring or a gap moves by maps of its own (`coupled`).
//!
//! The voltage jumps at the start of a step, and where the winding is much faster than a step the
//! current follows at once. What depends on the current then gets its first parts graded: short
//! after the jump, longer later; the larger the jump, the shorter the first.

mod body;
mod coupled;
mod foresee;
mod friction;
mod glide;
mod led;
mod linear;
mod located;
mod part;
mod pieces;
mod rigid;
mod rung;
mod state;
mod winding;

use crate::discretise::Discretisation;
use crate::effects::{EffectSet, Lowered};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Angle, FromLanes, Mask, Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};
use coupled::{Coupled, MotorAndLoad};
use friction::Forces;
pub use glide::Glide;
pub use led::Seen;
pub use linear::Increments;
pub use rigid::{Rigid, RigidPlan};
use rung::{RUNGS, Timed};
pub use state::{MAX_DELAY, Motion, Past, State};

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
    /// Parts that an interval is cut into where effects bend the path; at least 1.
    pub substeps: u16,
}

impl<R: Real> Plan<R> {
    /// The linear machine, discretised exactly.
    #[inline(always)]
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
    /// From the moment at which a command reaches the bridge to the end of the step.
    rest: Stretch<S>,
    /// Before that moment, the command before still acts.
    first: Option<Stretch<S>>,
    /// Whole samples that commands are late.
    late: usize,
    counts_per_unit: S::Coefficient,
    /// Revolutions by angle in base speed × interval.
    turns_per_unit: S::Coefficient,
    counts_per_turn: S::Coefficient,
    /// Whole, for the position within a revolution.
    counts_per_rev: u32,
    effects: Lowered<S>,
    /// Doubtful torque times its length that needs no shorter parts.
    tolerated: S,
    /// What acts on the shaft, if nothing of it depends on the state.
    constant: Forces<S>,
}

lanes!(Model {
    rest,
    first,
    late,
    counts_per_unit,
    turns_per_unit,
    counts_per_turn,
    counts_per_rev,
    effects,
    tolerated,
    constant
});

/// A stretch of a step under one command.
#[derive(Clone, Copy, Debug)]
struct Stretch<S: Scalar> {
    motor: [Timed<S>; RUNGS],
    coupled: Option<Coupled<S>>,
    /// Equal parts.
    parts: u16,
    /// Halvings of the first part after a large jump of the voltage.
    grade: usize,
}

impl<W, const N: usize> FromLanes<Stretch<f64>, N> for Stretch<W>
where
    W: Scalar<Coefficient = W, Angle = W> + From<[f64; N]>,
{
    fn from_lanes(each: [&Stretch<f64>; N]) -> Option<Self> {
        Some(Stretch {
            motor: FromLanes::from_lanes(each.map(|one| &one.motor))?,
            coupled: FromLanes::from_lanes(each.map(|one| &one.coupled))?,
            parts: FromLanes::from_lanes(each.map(|one| &one.parts))?,
            // More of them are only finer.
            grade: each.iter().fold(0, |most, one| most.max(one.grade)),
        })
    }
}

/// The first part after a jump of the voltage is at most this fraction of the electrical time
/// constant, if eight rungs suffice for that.
const FIRST_PART: f64 = 0.25;

/// Largest jump of the voltage, per unit, that needs no graded parts.
const SMALL_JUMP: f64 = 0.004;

impl<S: Scalar> Model<S> {
    /// Discretises and lowers a plan.
    ///
    /// # Errors
    /// A parameter that is not physical, a delay of more than [`MAX_DELAY`] samples, or a
    /// coefficient beyond the range of `S`: in fixed point, per-unit coefficients up to 2 in
    /// magnitude are guaranteed to fit.
    pub fn new<R: Real>(plan: &Plan<R>) -> Result<Self, ModelError> {
        plan.machine.check()?;
        let units = &plan.units;
        let effects = Lowered::new(&plan.effects, units);
        let one = R::from_f64(1.0);
        let (late, fraction) = whole_and_fraction(plan.effects.delay(units))?;
        let first = fraction
            .map(|fraction| Stretch::new(plan, &effects, fraction))
            .transpose()?;
        let rest = one - fraction.unwrap_or_default();
        let turns_per_unit = one / units.base(Quantity::Angle) * units.speed * units.interval;
        Ok(Model {
            rest: Stretch::new(plan, &effects, rest)?,
            first,
            late,
            counts_per_unit: S::coefficient(units.counts_per_unit().to_f64()),
            turns_per_unit: S::coefficient(turns_per_unit.to_f64()),
            counts_per_turn: S::coefficient(units.counts_per_rev.to_f64()),
            counts_per_rev: (units.counts_per_rev.to_f64() + 0.5) as u32,
            constant: Self::constant(&effects),
            tolerated: Self::tolerated(units.counts_per_unit().to_f64()),
            effects,
        })
    }

    /// Advances by one interval with `command` held; `open` while the bridge is open.
    #[inline(always)]
    pub fn step(&self, state: &mut State<S>, command: S, open: bool) {
        if self.effects.is_empty() {
            let by = self.rest.motor[0].slide(&state.motion, command, S::zero(), open);
            let motion = &mut state.motion;
            motion.current = motion.current + by.current;
            motion.speed = motion.speed + by.speed;
            motion.angle = motion.angle.advance(by.angle, self.counts_per_unit);
        } else {
            self.step_with_effects(state, command, open);
        }
    }

    /// Takes note of a command that was given before the first step, so that it can arrive late.
    pub fn recall(&self, state: &mut State<S>, command: S, open: bool) {
        state.past.push(command, open);
    }

    /// What the encoder sees, in counts before it rounds down.
    #[inline(always)]
    pub fn reading(&self, state: &State<S>) -> S::Angle {
        let angle = state.motion.angle;
        if !self.effects.needs.sensed {
            return angle;
        }
        let turns = angle.turns(self.counts_per_rev);
        let error = self.effects.sensed(turns, &state.memory);
        angle.advance(error, self.counts_per_turn)
    }

    #[inline(always)]
    fn step_with_effects(&self, state: &mut State<S>, command: S, open: bool) {
        let (mut command, mut open) = (command, open);
        if self.late > 0 || self.first.is_some() {
            state.past.push(command, open);
            if let Some(first) = &self.first {
                let (before, open) = state.past.ago(self.late + 1);
                self.hold(first, state, before, open);
            }
            (command, open) = state.past.ago(self.late);
        }
        self.hold(&self.rest, state, command, open);
    }

    /// Holds a command for a stretch of the step.
    #[inline(always)]
    fn hold(&self, stretch: &Stretch<S>, state: &mut State<S>, command: S, open: bool) {
        let volts = self.effects.drive(command);
        let jump = (volts - state.volts).abs();
        let mut grade = match (state.open, open) {
            (_, true) => 0,
            (true, false) => stretch.grade,
            (false, false) => stretch.grade_after(jump),
        };
        state.volts = volts;
        state.open = open;
        for _ in 0..stretch.parts {
            // An eighth, an eighth, a quarter, a half: all together one part.
            self.move_on(stretch, grade, state, volts, open);
            while grade > 0 {
                self.move_on(stretch, grade, state, volts, open);
                grade -= 1;
            }
        }
    }

    #[inline(always)]
    fn move_on(
        &self,
        stretch: &Stretch<S>,
        level: usize,
        state: &mut State<S>,
        volts: S,
        open: bool,
    ) {
        let motor = &stretch.motor;
        match &stretch.coupled {
            None => self.part(motor, level, state, volts, open),
            Some(coupled) => {
                self.part(&MotorAndLoad { motor, coupled }, level, state, volts, open);
            }
        }
    }
}

impl<S: Scalar> Stretch<S> {
    /// Halvings of the first part after a jump of the voltage: one for each doubling beyond the
    /// largest jump that needs none.
    #[inline(always)]
    fn grade_after(&self, jump: S) -> usize {
        let mut tame = S::from_f64(SMALL_JUMP);
        let mut grade = 0;
        while grade < self.grade && tame.less(jump).any() {
            tame = tame + tame;
            grade += 1;
        }
        grade
    }

    /// A stretch of `length` intervals.
    fn new<R: Real>(plan: &Plan<R>, effects: &Lowered<S>, length: R) -> Result<Self, ModelError> {
        let machine = plan.machine.lower(&plan.units);
        let how = plan.discretisation;
        let needs = effects.needs;
        let coupling = plan.effects.coupling(&plan.units, &machine);
        // Held voltage and torque need no parts: one exact map does, and friction's stops are located
        // wherever they are.
        let straight = !(needs.mean || coupling.is_some());
        let parts = if straight { 1 } else { plan.substeps.max(1) };
        let step = length / R::from_f64(parts as f64);
        let mut grade = 0;
        if needs.current {
            let first = machine.electrical * R::from_f64(FIRST_PART);
            let mut part = step;
            while part > first && grade < RUNGS - 1 {
                part = part * R::from_f64(0.5);
                grade += 1;
            }
        }
        let depth = if straight && !needs.friction {
            0
        } else {
            RUNGS - 1
        };
        let (coupled, machine) = match coupling {
            None => (None, machine),
            Some(coupling) => {
                let (coupled, motor) = Coupled::new(&machine, &coupling, step, how)?;
                (Some(coupled), motor)
            }
        };
        Ok(Stretch {
            motor: rung::ladder(&machine, step, depth, how)?,
            coupled,
            parts,
            grade,
        })
    }
}

/// Whole samples of a delay, and the fraction of one that is left, if any.
#[inline(always)]
fn whole_and_fraction<R: Real>(delay: R) -> Result<(usize, Option<R>), ModelError> {
    const NEGLIGIBLE: f64 = 1e-9;
    let samples = delay.to_f64();
    let whole = libm::floor(samples + NEGLIGIBLE);
    let fraction = samples - whole;
    let fraction = (fraction > NEGLIGIBLE).then(|| R::from_f64(fraction));
    let limit = MAX_DELAY as f64;
    if !(0.0..=limit).contains(&(whole + if fraction.is_some() { 1.0 } else { 0.0 })) {
        return Err(ModelError::Range {
            name: "delay in samples",
            value: samples,
            limit,
        });
    }
    Ok((whole as usize, fraction))
}
