//! `servoid simulate`: the virtual bench makes a recording.

use super::formula;
use super::motor;
use super::motor_beside::write_motor;
use super::simulate_list::Offer;
use crate::cli::SimulateArgs;
use crate::error::Error;
use crate::session::Session;
use crate::stated_law::StatedLaw;
use serde::Serialize;
use servoid_io::excitation;
use servoid_io::input::MotorFile;
use servoid_io::input::suggest::did_you_mean;
use servoid_io::output::write_recording;
use servoid_io::position_loop::LoopSettings;
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_plant::{
    Amplifier, Bench, BenchError, Hidden, Machine, PositionControl, STATED_MEMORIES, Stated,
};
use shared::excite::Experiment;
use std::f64::consts::{PI, TAU};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// Longest recording, samples: a day at 1 kHz would be a slip of a unit.
const MOST_SAMPLES: f64 = 2e7;

/// How a recording that the virtual bench made begins.
const MADE: &str = "# made by servoid ";

/// Refuses to replace a file that is no recording of the virtual bench: it may be a measurement.
pub(super) fn check_replaceable(out: &Path) -> Result<(), Error> {
    let mut begin = Vec::new();
    // A pipe or a device has no content to lose.
    let regular = out.metadata().is_ok_and(|it| it.is_file());
    let Some(file) = regular.then(|| File::open(out).ok()).flatten() else {
        return Ok(());
    };
    // A file that cannot be read is not one to replace either.
    let read = file.take(MADE.len() as u64).read_to_end(&mut begin);
    if read.is_ok() && (begin.is_empty() || begin == MADE.as_bytes()) {
        return Ok(());
    }
    Err(Error::Usage(format!(
        "--out {}: stands there and was not made by simulate; give another name, or remove it first",
        out.display()
    )))
}

#[derive(Serialize)]
struct Simulated<'a> {
    schema: &'static str,
    recording: String,
    machine: &'a str,
    hidden: Vec<String>,
    excitation: &'a str,
    samples: usize,
    seed: u64,
}

pub(super) fn run(session: &Session, args: &SimulateArgs) -> Result<(), Error> {
    if args.plan.plan {
        return super::plan::run(session, args);
    }
    if args.list {
        session.check_outputs(&[], &[])?;
        let offer = Offer::new();
        return session.deliver(&offer.text(), &offer);
    }
    let out = args
        .out
        .as_deref()
        .ok_or_else(|| Error::Usage("--out FILE: say where to".into()))?;
    let motor_path = out.with_file_name("motor.toml");
    session.check_outputs(&[("--out", out)], &[("the motor file", &motor_path)])?;
    check_replaceable(out)?;
    let mut bench = bench(args, session.seed)?;
    let machine = bench.machine;
    let control = position(args, &machine)?;
    let mut largest = machine.supply_v;
    if let Some(control) = control {
        bench.amplifier = Amplifier::Position(control);
        largest = TAU * args.reach;
    }
    let plan = plan(args)?;
    let drive = excitation::drive(&plan, args.sample, session.seed, largest);
    let with_current = args.current || bench.current_noise_a > 0.0;
    if drive.len() < 2 {
        return Err(Error::Usage(format!(
            "--sample {}: leaves {} of the excitation, and a fit needs at least two samples; take a shorter interval \
             or more --seconds",
            args.sample,
            if drive.is_empty() {
                "nothing"
            } else {
                "one sample"
            }
        )));
    }
    let recording = bench
        .record(&drive, &out.display().to_string(), with_current)
        .map_err(wrong_flag)?;
    check_counts(&recording, args)?;
    let mut hidden: Vec<String> = bench.effects.iter().map(Hidden::described).collect();
    hidden.extend(args.formulas.effect.iter().cloned());
    write_recording(out, &recording, &provenance(args, &hidden, session.seed))?;
    let mut text = format!(
        "{}: {} samples, {:.3} s",
        out.display(),
        recording.len(),
        recording.duration_s()
    );
    if !args.no_motor {
        let motor = MotorFile {
            name: Some(args.machine.clone()),
            counts_per_rev: Some(f64::from(args.counts_per_rev)),
            supply_v: Some(machine.supply_v),
            position: control.map(settings),
            ..MotorFile::default()
        };
        text += "; ";
        text += &write_motor(session, &motor_path, &motor)?;
    }
    text.push('\n');
    session.deliver(
        &text,
        &Simulated {
            schema: "servoid.simulate/1",
            recording: out.display().to_string(),
            machine: &args.machine,
            hidden,
            excitation: &args.excite,
            samples: recording.len(),
            seed: session.seed,
        },
    )
}

/// The loop of `--drive position`; `None` where the excitation is a voltage. Half a revolution of error takes all of the
/// supply, if nothing else is said.
fn position(args: &SimulateArgs, machine: &Machine) -> Result<Option<PositionControl>, Error> {
    if args.drive.as_deref() != Some("position") {
        return match args.position_loop.first() {
            None => Ok(None),
            Some(pair) => Err(Error::Usage(format!(
                "--loop {pair}: is of a position loop; add --drive position"
            ))),
        };
    }
    if !(args.reach.is_finite() && args.reach > 0.0) {
        return Err(Error::Usage(format!(
            "--reach {}: must be a positive number of revolutions",
            args.reach
        )));
    }
    let said = motor::loop_settings(&args.position_loop)?;
    let usual = PositionControl::proportional(machine.supply_v / PI, machine.supply_v);
    Ok(Some(PositionControl {
        gain_v_per_rad: said.gain_v_per_rad.unwrap_or(usual.gain_v_per_rad),
        damping_v_s_per_rad: (said.damping_v_s_per_rad).unwrap_or(usual.damping_v_s_per_rad),
        limit_v: said.limit_v.unwrap_or(usual.limit_v),
        dead_band_rad: said.dead_band_rad.unwrap_or(usual.dead_band_rad),
        rate_hz: said.rate_hz.unwrap_or(usual.rate_hz),
    }))
}

/// What the owner of the drive knows of it.
fn settings(control: PositionControl) -> LoopSettings {
    LoopSettings {
        gain_v_per_rad: Some(control.gain_v_per_rad),
        damping_v_s_per_rad: Some(control.damping_v_s_per_rad).filter(|x| *x > 0.0),
        limit_v: Some(control.limit_v),
        dead_band_rad: Some(control.dead_band_rad).filter(|x| *x > 0.0),
        rate_hz: Some(control.rate_hz),
    }
}

/// One `--hide`.
pub(super) fn hidden(text: &str, machine: &Machine) -> Result<Hidden, Error> {
    let settings = text.split_once(':').map(|(_, settings)| settings);
    if settings.is_some_and(|settings| settings.trim_matches([',', ' ']).is_empty()) {
        return Err(Error::Usage(format!(
            "--hide {text}: nothing follows the colon; leave it out, or write it like --hide coulomb:strength=2"
        )));
    }
    Hidden::parse(text, machine).map_err(|error| Error::Usage(format!("--hide: {error}")))
}

/// What the bench refuses because of a flag, under the flag's name.
pub(super) fn wrong_flag(error: BenchError) -> Error {
    match &error {
        BenchError::BadSetting {
            setting,
            value,
            need,
        } => {
            let flag = match *setting {
                "counts_per_rev" => "--counts-per-rev",
                "sample_s" => "--sample",
                "jitter_s" => "--jitter",
                "substep_hz" => "--substep-hz",
                "rate_hz" => "--loop rate_hz",
                "current_noise_a" => "--current-noise",
                "angle_noise_counts" => "--angle-noise",
                "torque_noise_n_m" => "--torque-noise",
                _ => return error.into(),
            };
            Error::Usage(format!("{flag} {value}: needs {need}"))
        }
        BenchError::Twice(_) | BenchError::OutOfRange { .. } | BenchError::TooStiff { .. } => {
            Error::Usage(format!("--hide: {error}"))
        }
        _ => error.into(),
    }
}

/// A recording whose counts no 32-bit counter holds could be written but not read back.
fn check_counts(recording: &Recording, args: &SimulateArgs) -> Result<(), Error> {
    let counter = f64::from(i32::MIN)..=f64::from(i32::MAX);
    match recording
        .counts
        .iter()
        .find(|counts| !counter.contains(counts))
    {
        None => Ok(()),
        Some(counts) => Err(Error::Usage(format!(
            "--counts-per-rev {}: the encoder reads {counts} counts, more than a 32-bit counter holds; take fewer counts \
             or less --seconds",
            args.counts_per_rev
        ))),
    }
}

/// The bench of `--machine`, `--hide`, `--counts-per-rev` and `--seed`.
pub(super) fn bench_of(
    machine: &str,
    hide: &[String],
    counts_per_rev: u32,
    seed: u64,
) -> Result<Bench, Error> {
    let machine = Machine::preset(machine).map_err(|e| Error::Usage(format!("--machine: {e}")))?;
    let mut bench = Bench::new(machine);
    bench.effects = hide
        .iter()
        .map(|text| hidden(text, &machine))
        .collect::<Result<_, _>>()?;
    bench.counts_per_rev = counts_per_rev;
    bench.seed = seed;
    Ok(bench)
}

fn bench(args: &SimulateArgs, seed: u64) -> Result<Bench, Error> {
    let mut bench = bench_of(&args.machine, &args.hide, args.counts_per_rev, seed)?;
    bench.sample_s = args.sample;
    bench.jitter_s = args.jitter;
    bench.current_noise_a = args.current_noise;
    bench.angle_noise_counts = args.angle_noise;
    bench.torque_noise_n_m = args.torque_noise * bench.machine.stall_torque_n_m();
    let laws = formula::stated(&args.formulas)?;
    let laws: Vec<_> = laws
        .into_iter()
        .filter_map(servoid_formula::law_of)
        .collect();
    for law in laws {
        if law.definition.is_of_temperature() {
            return Err(Error::Usage(format!(
                "--effect {}: the bench tells no temperature; give a recording that has a column of it to `servoid fit`",
                law.definition.name
            )));
        }
        let effect = StatedLaw::new(law, bench.machine);
        bench.stated.push(Stated(Arc::new(effect)));
    }
    let remembered: usize = bench.stated.iter().map(|law| law.0.memories()).sum();
    if remembered > STATED_MEMORIES {
        return Err(Error::Usage(format!(
            "--effect: the bench hides laws with at most {STATED_MEMORIES} states together, `t` counted as one, and these have {remembered}; leave one away"
        )));
    }
    if let Some(hz) = args.substep_hz {
        bench.substep_hz = hz;
    }
    Ok(bench)
}

/// The experiments of the named excitation, stretched to the wanted length.
fn plan(args: &SimulateArgs) -> Result<Vec<Experiment>, Error> {
    if !(args.sample.is_finite() && args.sample > 0.0) {
        return Err(Error::Usage(format!(
            "--sample {}: must be a positive number of seconds",
            args.sample
        )));
    }
    if !(args.amplitude > 0.0 && args.amplitude <= 1.0) {
        return Err(Error::Usage(format!(
            "--amplitude {}: must be above 0 and at most 1",
            args.amplitude
        )));
    }
    let usual = excitation::named(&args.excite).ok_or_else(|| {
        let names: Vec<&str> = excitation::names().collect();
        let name = &args.excite;
        Error::Usage(format!(
            "--excite {name}: unknown; {}",
            did_you_mean(name, &names)
        ))
    })?;
    let seconds = args.seconds.unwrap_or(excitation::length(&usual));
    if !(seconds.is_finite()
        && seconds >= 2.0 * args.sample
        && seconds / args.sample <= MOST_SAMPLES)
    {
        return Err(Error::Usage(format!(
            "--seconds {seconds}: must give between 2 and {MOST_SAMPLES:e} samples of {} s",
            args.sample
        )));
    }
    Ok(excitation::stretched(&usual, seconds, args.amplitude))
}

fn provenance(args: &SimulateArgs, hidden: &[String], seed: u64) -> Vec<String> {
    let mut lines = vec![format!(
        "made by servoid {} simulate: machine {}, excitation {}, seed {seed}",
        env!("CARGO_PKG_VERSION"),
        args.machine,
        args.excite
    )];
    lines.extend(hidden.iter().map(|text| format!("hidden: {text}")));
    lines
}
