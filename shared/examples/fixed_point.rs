//! Steps one model in f64 and in fixed point, which a core without a floating-point unit has, and compares the counts.
//!
//! `cargo run -p shared --example fixed_point`

use shared::effects::Kind;
use shared::error::ModelError;
use shared::excite::{COMMISSIONING, commands};
use shared::model::{Model, Plan, State};
use shared::motor::Machine;
use shared::scalar::{Fixed, Readable, Scalar};
use shared::units::PerUnit;

const INTERVAL_S: f64 = 1e-3;
const SEED: u64 = 1;

/// Readings of the encoder under the commissioning mix.
fn readings<S: Scalar<Angle: Readable<S>>>(plan: &Plan<f64>) -> Result<Vec<i32>, ModelError> {
    let model = Model::<S>::new(plan)?;
    let mut state = State::default();
    Ok(commands::<f64>(&COMMISSIONING, INTERVAL_S, SEED)
        .map(|command| {
            model.step(&mut state, S::from_f64(command.drive), !command.enabled);
            model.reading(&state).floor()
        })
        .collect())
}

fn main() -> Result<(), ModelError> {
    let machine = Machine {
        kb: 0.03,
        damping: 0.002,
        inertia: 1.1e-3,
        electrical: 0.7e-3,
    };
    let mut plan = Plan::linear(machine, PerUnit::new(24.0, 1024.0, INTERVAL_S, 400.0)?);
    plan.effects.push(Kind::Coulomb, &[0.9])?;

    let (float, fixed) = (readings::<f64>(&plan)?, readings::<Fixed>(&plan)?);
    let travelled: i64 = float
        .windows(2)
        .map(|w| i64::from(w[0].abs_diff(w[1])))
        .sum();
    let off = float.iter().zip(&fixed).filter(|(a, b)| a != b).count();
    println!(
        "seed {SEED}: {} samples, {travelled} counts travelled",
        float.len()
    );
    println!("f64 and fixed point read another count at {off} samples");
    Ok(())
}
