//! `servoid demo`: the main job on built-in data.
//!
//! The virtual bench records a motor twice; the model is fitted to the one and judged on the other.

use crate::bench::{Bench, DriveSample, Machine};
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
use crate::solve;
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
    let options = Options {
        seed: session.seed,
        ..Options::default()
    };
    let problem = fit::problem(&fitted, &options)?;
    let solver = solve::by_name("lm").ok_or_else(|| Error::Failed("no method `lm`".to_owned()))?;
    let bar = session.progress(options.budget as u64, "fit");
    let found = fit::search(
        &problem,
        solver.as_ref(),
        &options,
        session.stop(),
        &mut |count, _| {
            bar.set_position(count as u64);
        },
    );
    bar.finish_and_clear();
    let fit = Fit::conclude(&problem, "lm", "squared", &found, &options, Some(&held_out))?;
    let mut text = report::text::fit(&fit, &fitted);
    text += &against_truth(&fit, &machine);

    let drawing = plot::overlay(&fitted, &fit.candidate, options.method)?;
    let page = Page {
        title: "servoid demo".to_owned(),
        sections: vec![Section {
            heading: "A motor on the virtual bench, and the model that was fitted to it".to_owned(),
            text: text.clone(),
            drawing: Some(drawing),
        }],
    };
    write_whole(&args.out, |out| out.write_all(page.render().as_bytes()))?;
    text += &format!("\npage with the drawing: {}\n", args.out.display());
    session.deliver(&text, &report::json::FitJson::from(&fit))
}

fn record(machine: Machine, seed: u64, name: &str) -> Result<Recording, Error> {
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = COUNTS_PER_REV;
    bench.sample_s = INTERVAL_S;
    bench.seed = seed;
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
