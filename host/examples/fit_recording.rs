//! Fits two models to a recording and prints what it determines.
//!
//! `cargo run --release -p host --example fit_recording [FILE.csv [MOTOR.toml]]`; without a file the virtual bench makes one.

use servoid_identify::{Silent, fit::Options, identify};
use servoid_io::input::{MotorFile, read_recording};
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let recording = match arguments.next() {
        Some(file) => {
            let motor = match arguments.next() {
                Some(path) => MotorFile::read(Path::new(&path))?,
                None => MotorFile::default(),
            };
            read_recording(Path::new(&file), &motor)?
        }
        None => showcase::record(
            &[Hidden::typical("coulomb", &showcase::machine())?],
            1,
            "bench",
        )?,
    };
    for effects in [vec![], vec![Kind::Coulomb]] {
        let options = Options {
            effects,
            ..Options::default()
        };
        let fit = identify(&recording, &options, &Silent::default())?;
        println!("{:?}: {:.3} counts RMS", fit.effects, fit.rms_counts);
        for parameter in fit.parameters.iter().filter(|p| p.identifiable) {
            let std = parameter.std.unwrap_or(0.0);
            println!(
                "  {:24} {:>12.6} ± {std:.1e} {}",
                parameter.name, parameter.value, parameter.unit
            );
        }
    }
    Ok(())
}
