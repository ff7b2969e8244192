//! Hides an effect in a motor on the virtual bench, and has the diagnosis name it from two recordings.
//!
//! `cargo run --release -p host --example name_the_missing_effect [EFFECT]`

use servoid_identify::{Silent, diagnose, fit::Options};
use servoid_io::showcase;
use servoid_plant::Hidden;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let effect = std::env::args().nth(1).unwrap_or("cogging".to_owned());
    let hidden = Hidden::typical(&effect, &showcase::machine())?;
    let fitted = showcase::record(std::slice::from_ref(&hidden), 1, "fitted")?;
    let held_out = showcase::record(std::slice::from_ref(&hidden), 2, "held out")?;

    let found = diagnose(
        &fitted,
        Some(&held_out),
        &Options::default(),
        &Silent::default(),
    )?;

    let base = &found.diagnosis.base;
    println!(
        "linear motor: {:.2} counts RMS, held out {:.2}",
        base.rms_counts, base.validate_rms_counts
    );
    for step in &found.diagnosis.steps {
        let Some(model) = step.candidates.first() else {
            continue;
        };
        println!(
            "+ {}: {:.2} counts RMS, held out {:.2} (confidence {:.2})",
            step.added.name(),
            model.rms_counts,
            model.validate_rms_counts,
            step.confidence
        );
    }
    println!("verdict: {}", found.diagnosis.verdict.name());
    Ok(())
}
