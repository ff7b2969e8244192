//! `servoid simulate --plan`: what to record next, as commands.

use super::formula;
use crate::cli::{PlanArgs, SimulateArgs};
use crate::error::Error;
use crate::session::Session;
use servoid_identify::plan::{Hypothesis, Limits, PlanTask, Setup, candidate_count, rank};
use servoid_io::output::write_commands;
use servoid_plant::Machine;
use servoid_results::report::plan::Plan;
use servoid_results::schema::hypotheses;
use shared::effects::Kind;
use std::path::Path;

/// Usual length, s.
const USUAL_SECONDS: f64 = 20.0;
/// Fewest samples: shorter excitations hold none of the shapes.
const FEWEST_SAMPLES: f64 = 100.0;
/// Most samples: every candidate is simulated some hundred times.
const MOST_SAMPLES: f64 = 2e6;

pub(super) fn run(session: &Session, args: &SimulateArgs) -> Result<(), Error> {
    let out = args
        .out
        .as_deref()
        .ok_or_else(|| Error::Usage("--out FILE: say where to".into()))?;
    let diagnosis = (args.plan.after.as_deref()).map(|path| ("the diagnosis", path));
    session.check_outputs(&[("--out", out)], diagnosis.as_slice())?;
    super::simulate::check_replaceable(out)?;
    let limits = limits(&args.plan)?;
    let (hypotheses, setup) = match &args.plan.after {
        Some(path) => diagnosed(path)?,
        None => typical(args)?,
    };
    let seconds = seconds(args, setup.sample_s)?;
    let bar = session.progress(0, "plan");
    // How many will be refitted beyond the screening shows as it goes.
    let done = || {
        bar.inc(1);
        if bar.length() == Some(bar.position()) {
            bar.inc_length(1);
        }
    };
    let work = PlanTask {
        hypotheses: &hypotheses,
        setup,
        limits,
        seconds,
        seed: session.seed,
        stop: session.stop(),
        done: &done,
    };
    bar.set_length(candidate_count(&work) as u64);
    let ranked = rank(&work);
    bar.finish_and_clear();
    let plan = Plan {
        ranked: ranked?,
        work: &work,
        resistance_ohm: args.plan.resistance,
        out,
    };
    if plan.separable() {
        let commands = plan.best().excitation.commands(&setup, session.seed);
        write_commands(out, &commands, &plan.provenance())?;
    }
    session.deliver(&plan.text(), &plan.document())
}

fn diagnosed(path: &Path) -> Result<(Vec<Hypothesis>, Setup), Error> {
    hypotheses::read(path).map_err(|error| Error::Failed(error.to_string()))
}

/// The effects of `--between` with typical values on the preset, and the laws of `--effect` with those from which they start.
fn typical(args: &SimulateArgs) -> Result<(Vec<Hypothesis>, Setup), Error> {
    let names = &args.plan.between;
    let refuse = |why: &str| {
        Err(Error::Usage(format!(
            "--between {}: {why}",
            names.join(",")
        )))
    };
    if let Some(twice) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        return refuse(&format!("{} is named twice", names[twice]));
    }
    let laws = formula::stated(&args.formulas)?;
    if names.len() + laws.len() < 2 {
        return refuse(
            "names one effect; name at least two that look alike, like --between coulomb,brush_drop, or state a law beside it with --effect",
        );
    }
    let machine =
        Machine::preset(&args.machine).map_err(|e| Error::Usage(format!("--machine: {e}")))?;
    let named = names.iter().filter_map(|name| Kind::by_name(name));
    let hypotheses = (named.chain(laws))
        .map(|kind| Hypothesis::typical(kind, &machine))
        .collect();
    if args.counts_per_rev == 0 {
        return Err(Error::Usage("--counts-per-rev 0: needs at least 1".into()));
    }
    let setup = Setup {
        supply_v: machine.supply_v,
        no_load_rad_s: machine.top_speed_rad_s(),
        counts_per_rev: f64::from(args.counts_per_rev),
        sample_s: positive("--sample", args.sample)?,
    };
    Ok((hypotheses, setup))
}

fn limits(args: &PlanArgs) -> Result<Limits, Error> {
    let checked = |flag, value: Option<f64>| value.map(|x| positive(flag, x)).transpose();
    let voltage_v = checked("--max-voltage", args.max_voltage)?;
    let current_a = checked("--max-current", args.max_current)?;
    let resistance_ohm = checked("--resistance", args.resistance)?;
    let current_v = match (current_a, resistance_ohm) {
        (Some(amperes), Some(ohm)) => Some(amperes * ohm),
        (Some(amperes), None) => {
            return Err(Error::Usage(format!(
                "--max-current {amperes}: needs --resistance OHM, since voltage and angle do not tell the current; \
                 measure the armature with an ohmmeter, or take it from the datasheet"
            )));
        }
        (None, _) => None,
    };
    Ok(Limits {
        voltage_v,
        current_v,
        travel_rev: checked("--travel", args.travel)?,
        commands: None,
    })
}

fn positive(flag: &str, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(Error::Usage(format!(
        "{flag} {value}: must be a positive number"
    )))
}

fn seconds(args: &SimulateArgs, sample_s: f64) -> Result<f64, Error> {
    let seconds = positive("--seconds", args.seconds.unwrap_or(USUAL_SECONDS))?;
    if (FEWEST_SAMPLES..=MOST_SAMPLES).contains(&(seconds / sample_s)) {
        return Ok(seconds);
    }
    Err(Error::Usage(format!(
        "--seconds {seconds}: must give between {FEWEST_SAMPLES} and {MOST_SAMPLES:e} samples of {sample_s} s"
    )))
}
