//! Motor + effects + encoder: read this file first.
//!
//! A [`Model`] holds coefficients and never changes; a [`State`] runs. Without effects a step is one
//! linear map. With effects it is cut into substeps, and in each substep
//!
//! * what depends on speed, angle and current is held at its predicted mean, and a substep that is
//!   too long for that is halved (`predict`, `substep`);
//! * a changed winding, and the drop of brushes, are solved for as volts (`winding`);
//! * friction is a budget; its stops and releases are located by halving (`friction`);
//! * a load behind a spring or a gap moves by maps of its own (`coupled`).
//!
//! The maps of a step, of its half, quarter, … are in `step_map`, `substep_map` and `dyadic`. The folder
//! `fast` holds shorter forms of the same step; skip it at first, a law says that they give the same bits.
//!
//! The voltage jumps at the start of a step, and where the winding is much faster than a step the
//! current follows at once. Effects of the current then get graded substeps: short after the jump,
//! longer later; the larger the jump, the shorter the first.

mod coupled;
mod dyadic;
mod fast;
mod friction;
mod mechanics;
mod plan;
mod predict;
mod series_parallel;
mod state;
mod step_map;
mod stretch;
mod substep;
mod substep_iter;
mod substep_map;
mod winding;

use crate::effects::Lowered;
use crate::error::ModelError;
use crate::scalar::{Angle, Real, Scalar, lanes};
use crate::units::Quantity;
use coupled::MotorAndLoad;
pub use fast::{ConstantForce, Increments, Rigid, RigidPlan};
use friction::Forces;
pub use plan::Plan;
pub use series_parallel::MeasuredInterval;
pub use state::{MAX_DELAY, Motion, Past, State};
use stretch::Stretch;

/// Coefficients of one model in the number format `S`. Immutable.
///
/// A step takes the command that is held over one interval, per unit:
///
/// ```
/// use shared::effects::Kind;
/// use shared::model::{Model, Plan, State};
/// use shared::motor::Machine;
/// use shared::units::PerUnit;
///
/// // 24 V, 800 rad/s, 1 ms, 4096 counts per revolution.
/// let units = PerUnit::new(24.0, 800.0, 1e-3, 4096.0)?;
/// let machine = Machine { kb: 0.03, damping: 0.002, inertia: 1.1e-3, electrical: 0.7e-3 };
/// let mut plan = Plan::linear(machine, units);
/// plan.effects.push(Kind::Coulomb, &[0.9])?;
///
/// let model = Model::<f64>::new(&plan)?;
/// let mut state = State::default();
/// for _ in 0..100 {
///     model.step(&mut state, 0.5, false);
/// }
/// let counts = model.reading(&state);
/// // 347 rad/s in the end, reached with a time constant of 34 ms.
/// assert!((15_000.0..15_500.0).contains(&counts));
/// # Ok::<(), shared::error::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Model<S: Scalar> {
    /// From the moment at which the command reaches the bridge to the end of the step.
    rest: Stretch<S>,
    /// Before that moment, while the previous command still acts.
    first: Option<Stretch<S>>,
    /// Whole samples by which commands are late.
    late: usize,
    counts_per_unit: S::Coefficient,
    /// Revolutions by angle in base speed × interval.
    turns_per_unit: S::Coefficient,
    counts_per_turn: S::Coefficient,
    /// Whole, for the position within a revolution.
    counts_per_rev: u32,
    effects: Lowered<S>,
    /// Largest change of the predicted torque, times the length, that needs no halving.
    tolerated: S,
    /// The forces, if nothing of them depends on the state.
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
        for (kind, values) in plan.effects.present() {
            kind.check::<S, R>(values, units)?;
        }
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
            let by = self
                .rest
                .motor
                .whole()
                .step_free(&state.motion, command, S::zero(), open);
            let motion = &mut state.motion;
            motion.current = motion.current + by.current;
            motion.speed = motion.speed + by.speed;
            motion.angle = motion.angle.advance(by.angle, self.counts_per_unit);
        } else {
            self.step_with_effects(state, command, open);
        }
    }

    /// Records a command that was given before the first step, so that it can arrive late.
    pub fn recall(&self, state: &mut State<S>, command: S, open: bool) {
        state.past.push(command, open);
    }

    /// The angle that the encoder senses, in counts before it rounds down.
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
        for _ in 0..stretch.substeps {
            // Graded: an eighth, an eighth, a quarter, a half; together one substep.
            self.take_substep(stretch, grade, state, volts, open);
            while grade > 0 {
                self.take_substep(stretch, grade, state, volts, open);
                grade -= 1;
            }
        }
    }

    #[inline(always)]
    fn take_substep(
        &self,
        stretch: &Stretch<S>,
        level: usize,
        state: &mut State<S>,
        volts: S,
        open: bool,
    ) {
        let motor = &stretch.motor;
        match &stretch.coupled {
            None => self.substep(motor, level, state, volts, open),
            Some(coupled) => {
                self.substep(&MotorAndLoad { motor, coupled }, level, state, volts, open);
            }
        }
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
