//! `servoid demo`: the main job on built-in data.
//!
//! The virtual bench records a motor with Coulomb friction twice. The linear model is fitted to the
//! one and fails; with the friction added the error falls to the encoder's own, on both.

use super::search::search;
use crate::bench::{Bench, DriveSample, Hidden, Machine};
use crate::cli::DemoArgs;
use crate::error::Error;
use crate::fit::{self, Fit, Options};
use crate::output::write_whole;
use crate::plot;
use crate::problem::Data;
use crate::recording::Recording;
use crate::report;
use crate::report::html::{Page, Section};
use crate::session::Session;
use shared::effects::Kind;
use shared::excite::{COMMISSIONING, commands};

const INTERVAL_S: f64 = 1e-3;
const COUNTS_PER_REV: u32 = 2000;

pub(super) fn run(session: &Session, args: &DemoArgs) -> Result<(), Error> {
    session.check_outputs(&[("--out", &args.out)], &[])?;
    let machine = Machine::gearmotor();
    let fitted = Data::new(&record(machine, session.seed, "demo recording")?)?;
    let held_out = Data::new(&record(
        machine,
        session.seed.wrapping_add(1),
        "held-out recording",
    )?)?;
    let linear = fitted_with(session, &fitted, &held_out, &[])?;
    let full = fitted_with(session, &fitted, &held_out, &[Kind::Coulomb])?;
    let first = report::text::fit(&linear, &fitted);
    let second = report::text::fit(&full, &fitted) + &against_truth(&full, &machine);
    let ladder = format!(
        "error on the held-out recording: linear motor {:.1} counts, with Coulomb friction {:.4}, encoder floor {:.4}\n",
        linear.validate_rms_counts.unwrap_or(f64::NAN),
        full.validate_rms_counts.unwrap_or(f64::NAN),
        shared::encoder::FLOOR_RMS_COUNTS,
    );
    let method = Options::default().method;
    let section = |heading: &str, text: &str, fit: &Fit| {
        Ok::<_, Error>(Section {
            heading: heading.to_owned(),
            text: text.to_owned(),
            drawing: Some(plot::overlay(&fitted, &fit.candidate, method)?),
        })
    };
    let page = Page {
        title: "servoid demo".to_owned(),
        sections: vec![
            section(
                "A motor on the virtual bench, and the linear model: it fails",
                &first,
                &linear,
            )?,
            section(
                "With Coulomb friction the error falls",
                &format!("{ladder}\n{second}"),
                &full,
            )?,
        ],
    };
    write_whole(&args.out, |out| out.write_all(page.render().as_bytes()))?;
    let text = format!(
        "== the linear model\n{first}\n== with Coulomb friction (--with coulomb)\n{second}\n{ladder}\
         page with the drawings: {}\n",
        args.out.display()
    );
    session.deliver(&text, &report::json::FitJson::from(&full))
}

/// Fits the demo's recording and judges the fit on the other one.
fn fitted_with(
    session: &Session,
    data: &Data,
    held_out: &Data,
    effects: &[Kind],
) -> Result<Fit, Error> {
    let options = Options {
        seed: session.seed,
        effects: effects.to_vec(),
        ..Options::default()
    };
    let problem = fit::problem(data, &options)?;
    let found = search(session, &problem, "lm", &options)?;
    Fit::conclude(&problem, "lm", "squared", &found, &options, Some(held_out))
}

fn record(machine: Machine, seed: u64, name: &str) -> Result<Recording, Error> {
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = COUNTS_PER_REV;
    bench.sample_s = INTERVAL_S;
    bench.seed = seed;
    bench.effects = vec![Hidden::typical("coulomb", &machine)?];
    let drive: Vec<DriveSample> = commands::<f64>(&COMMISSIONING, INTERVAL_S, seed)
        .map(|c| DriveSample {
            volts: c.drive * machine.supply_v,
            enabled: c.enabled,
        })
        .collect();
    Ok(bench.record(&drive, name, false)?)
}

/// How far off the fit is, which only a bench can tell.
fn against_truth(fit: &Fit, machine: &Machine) -> String {
    let total =
        machine.kt_n_m_a * machine.kb_v_s_rad + machine.resistance_ohm * machine.viscous_n_m_s;
    let gain = machine.kt_n_m_a / total;
    let a1 = (machine.resistance_ohm * machine.inertia_kg_m2
        + machine.inductance_h * machine.viscous_n_m_s)
        / total;
    format!(
        "\nthe bench knows the truth: gain is off by {:.5} %, a1 by {:.5} %\n",
        100.0 * (fit.response.gain / gain - 1.0).abs(),
        100.0 * (fit.response.a1 / a1 - 1.0).abs()
    )
}
