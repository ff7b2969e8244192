//! `servoid demo`: the main job on built-in data.
//!
//! The virtual bench records a motor twice, with something hidden in it. The linear model is fitted to the one
//! recording and fails; the diagnosis sees where, names what is missing and adds it, and the error falls to the
//! encoder's own, on both. Then the bench tells the truth.

use super::diagnosing::diagnosed;
use super::report;
use super::simulate::{describe, hidden, wrong_flag};
use crate::bench::{Bench, DriveSample, Hidden, Machine};
use crate::cli::DemoArgs;
use crate::diagnose::{Effort, HeldOut};
use crate::error::Error;
use crate::fit::Options;
use crate::output::write_whole;
use crate::problem::Data;
use crate::prove::surprise;
use crate::recording::Recording;
use crate::report::demo::{DemoJson, DemoReport};
use crate::report::sheet::{self, Recordings};
use crate::session::Session;
use shared::excite::{COMMISSIONING, commands};

const INTERVAL_S: f64 = 1e-3;
const COUNTS_PER_REV: u32 = 2000;

pub(super) fn run(session: &Session, args: &DemoArgs) -> Result<(), Error> {
    session.check_outputs(&[("--out", &args.out)], &[])?;
    let machine = Machine::gearmotor();
    let secret = if args.blind {
        surprise(&machine, session.seed)?
    } else {
        hidden(&args.hide, &machine)?
    };
    let data = Data::new(&record(machine, &secret, session.seed, "demo recording")?)?;
    let other = "held-out recording";
    let held_out = Data::new(&record(
        machine,
        &secret,
        session.seed.wrapping_add(1),
        other,
    )?)?;
    let options = Options {
        seed: session.seed,
        ..Options::default()
    };
    let diagnosed = diagnosed(
        session,
        &data,
        &held_out,
        &options,
        &Effort::usual(session.stop()),
    )?;
    let kind = HeldOut::Recording(other.to_owned());
    let story = DemoReport {
        diagnosis: diagnosed.report(session, &data, &kind, Vec::new()),
        machine,
        hidden: &secret,
        described: describe(&secret),
        blind: args.blind,
        counts_per_rev: COUNTS_PER_REV,
    };
    let json = DemoJson::from(&story);
    let drawn = Recordings {
        fitted: Some(&data),
        held_out: Some(&held_out),
    };
    let page = sheet::page(&report::kept(&json)?, drawn)?;
    write_whole(&args.out, |out| out.write_all(page.render().as_bytes()))?;
    let text = format!(
        "{}\npage with the drawings: {}\n",
        story.text(),
        args.out.display()
    );
    session.deliver(&text, &json)
}

fn record(machine: Machine, secret: &Hidden, seed: u64, name: &str) -> Result<Recording, Error> {
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = COUNTS_PER_REV;
    bench.sample_s = INTERVAL_S;
    bench.seed = seed;
    bench.effects = vec![secret.clone()];
    let drive: Vec<DriveSample> = commands::<f64>(&COMMISSIONING, INTERVAL_S, seed)
        .map(|c| DriveSample {
            volts: c.drive * machine.supply_v,
            enabled: c.enabled,
        })
        .collect();
    bench.record(&drive, name, false).map_err(wrong_flag)
}
