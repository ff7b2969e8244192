//! Fits a motor as a device does, without a heap: excite, record duties and counts, search and polish a slice at a time.
//!
//! `cargo run -p shared --example fit_on_device`

use shared::effects::Kind;
use shared::error::ModelError;
use shared::excite::{Experiment, Shape, commands};
use shared::fit::{Fit, Method, Settings};
use shared::model::{Model, Plan, State};
use shared::motor::Response;
use shared::scalar::{Fixed, Readable};
use shared::trace::{DUTY, Trace};
use shared::units::PerUnit;

const PERIODS: usize = 2_000;

fn main() -> Result<(), ModelError> {
    // The motor to find, per supply, period and count: 80 counts a period, time constants of 45 and 0.8 periods.
    let (gain, a1, a2, coulomb) = (80.0, 45.0, 36.0, 0.03);
    let units = PerUnit::new(1.0, gain, 1.0, std::f64::consts::TAU)?;
    let mut plan = Plan::linear(Response { gain, a1, a2 }.machine(), units);
    plan.effects.push(Kind::Coulomb, &[coulomb])?;
    let plant = Model::<f64>::new(&plan)?;

    let (levels, hold_s) = (9, 60.0);
    let excitation = [Experiment {
        shape: Shape::Telegraph { levels, hold_s },
        seconds: PERIODS as f64,
        amplitude: 0.95,
    }];
    let (mut duties, mut steps) = ([0; PERIODS], [0; PERIODS]);
    let (mut state, mut before) = (State::default(), 0);
    for (k, command) in commands(&excitation, 1.0, 1).take(PERIODS).enumerate() {
        duties[k] = (command.drive * 32_767.0) as i16;
        plant.step(&mut state, f64::from(duties[k]) * DUTY, false);
        let count = Readable::<f64>::floor(plant.reading(&state));
        steps[k] = (count - before) as i16;
        before = count;
    }

    let trace = Trace::new(&duties, &steps);
    let mut settings = Settings::USUAL;
    settings.method = Method::Pso;
    let mut fit = Fit::<Fixed>::idle();
    assert!(fit.begin(&trace, settings), "the shaft did not move");
    let outcome = loop {
        // Between two slices a device has time for its control loop.
        if let Some(outcome) = fit.work(&trace, 3_000) {
            break outcome;
        }
    };
    let names = ["counts a period", "periods", "periods", "of supply"];
    for (estimate, name) in outcome.estimates.iter().zip(names) {
        println!("{:9.4} ± {:.4} {name}", estimate.value, estimate.std);
    }
    let rms = outcome.mean_square.sqrt();
    println!("{rms:.3} counts RMS, {} runs", outcome.evaluations);
    Ok(())
}
