//! The model in motion, in each number format.
//!
//! A step is the whole model with every effect in it, over which the compiler takes half a minute a format: it is made once, here, and
//! every test takes its steps by [`Steps`].

use shared::error::ModelError;
use shared::model::{Model, Plan, State};
use shared::scalar::{Fixed, Readable, Scalar};
use shared::units::Quantity;

/// A number format whose step is compiled here.
pub trait Steps: Scalar<Angle: Readable<Self>> {
    /// One sample interval of a model, as [`Model::step`].
    fn step(model: &Model<Self>, state: &mut State<Self>, command: Self, open: bool);
}

macro_rules! steps {
    ($($format:ty),*) => {$(
        impl Steps for $format {
            #[inline(never)]
            fn step(model: &Model<Self>, state: &mut State<Self>, command: Self, open: bool) {
                model.step(state, command, open);
            }
        }
    )*};
}

steps!(f64, f32, Fixed);

/// What a model does.
pub struct Motion {
    /// Encoder readings before each step and after the last, counts.
    pub readings: Vec<f64>,
    /// Speeds likewise, per unit.
    pub speeds: Vec<f64>,
}

/// Takes a step a command, per unit, which comes with whether the bridge is open.
///
/// # Errors
/// A plan that is no model.
pub fn exact(
    plan: &Plan<f64>,
    mut state: State<f64>,
    commands: &[(f64, bool)],
) -> Result<Motion, ModelError> {
    let model = Model::<f64>::new(plan)?;
    let mut motion = Motion {
        readings: vec![model.reading(&state)],
        speeds: vec![state.motion.speed],
    };
    for &(command, open) in commands {
        f64::step(&model, &mut state, command, open);
        motion.readings.push(model.reading(&state));
        motion.speeds.push(state.motion.speed);
    }
    Ok(motion)
}

/// Angles after each of so many samples, from rest, counts: of each its command, per unit, and its temperature, °C.
///
/// # Errors
/// A plan that is no model.
pub fn warmed(
    plan: &Plan<f64>,
    at: &dyn Fn(usize) -> (f64, f64),
    samples: usize,
) -> Result<Vec<f64>, ModelError> {
    let model = Model::<f64>::new(plan)?;
    let mut state = State::default();
    let after = |k: usize| {
        let (command, celsius) = at(k);
        state.temperature = plan.units.lower(celsius, Quantity::Temperature);
        f64::step(&model, &mut state, command, false);
        model.reading(&state)
    };
    Ok((0..samples).map(after).collect())
}

/// Counts after each command, from rest, in f32.
///
/// # Errors
/// A plan that is no model in this format.
pub fn single(plan: &Plan<f64>, commands: &[f64]) -> Result<Vec<i32>, ModelError> {
    counts::<f32>(plan, commands)
}

/// Counts after each command, from rest, in fixed point.
///
/// # Errors
/// A plan that is no model in this format.
pub fn fixed(plan: &Plan<f64>, commands: &[f64]) -> Result<Vec<i32>, ModelError> {
    counts::<Fixed>(plan, commands)
}

fn counts<S: Steps>(plan: &Plan<f64>, commands: &[f64]) -> Result<Vec<i32>, ModelError> {
    let model = Model::<S>::new(plan)?;
    let mut state = State::default();
    let after = |&command: &f64| {
        S::step(&model, &mut state, S::from_f64(command), false);
        model.reading(&state).floor()
    };
    Ok(commands.iter().map(after).collect())
}
