//! Steps a motor with and without an effect: a slow triangle of voltage, through which Coulomb friction holds the shaft.
//!
//! `cargo run -p shared --example simulate_effect`

use shared::effects::Kind;
use shared::error::ModelError;
use shared::model::{Model, Plan, State};
use shared::motor::Physical;
use shared::units::PerUnit;

const INTERVAL_S: f64 = 1e-3;
const SUPPLY_V: f64 = 6.0;
const FRICTION_V: f64 = 0.7;

fn main() -> Result<(), ModelError> {
    let motor = Physical {
        resistance: 8.0,
        inductance: 2e-3,
        kt: 0.55,
        kb: 0.55,
        inertia: 2e-3,
        viscous: 2e-2,
    };
    let units = PerUnit::new(SUPPLY_V, 10.0, INTERVAL_S, 2800.0)?;
    let linear = Plan::linear(motor.machine(), units);
    let mut with_friction = linear;
    with_friction.effects.push(Kind::Coulomb, &[FRICTION_V])?;

    let models = [Model::<f64>::new(&linear)?, Model::new(&with_friction)?];
    let mut states = [State::default(); 2];
    println!("time s  volts  linear rad/s  with friction rad/s");
    for k in 0..=1000 {
        // 1 V up and down, once a second.
        let volts = 4.0 * (0.25 - ((k as f64 / 1000.0 + 0.75) % 1.0 - 0.5).abs());
        if k % 50 == 0 {
            let [a, b] = states.map(|state| state.motion.speed * units.speed);
            let stuck = if b == 0.0 { "  stuck" } else { "" };
            let time = k as f64 * INTERVAL_S;
            println!("{time:6.3} {volts:6.2} {a:13.3} {b:20.3}{stuck}");
        }
        for (model, state) in models.iter().zip(&mut states) {
            model.step(state, volts / SUPPLY_V, false);
        }
    }
    Ok(())
}
