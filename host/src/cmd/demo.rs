//! `servoid demo`: the main job on built-in data.
//!
//! The virtual bench records a motor twice, with something hidden in it. The linear model is fitted to the one
//! recording and fails; the diagnosis sees where, names what is missing and adds it, and the error falls to the
//! encoder's own, on both. Then the bench tells the truth.

use super::progress::Watched;
use super::report;
use super::simulate::{hidden, wrong_flag};
use crate::cli::DemoArgs;
use crate::error::Error;
use crate::prove::surprise;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{Budget, HeldOut};
use servoid_identify::diagnose_data;
use servoid_identify::fit::Options;
use servoid_io::output::write_whole;
use servoid_io::showcase;
use servoid_results::report::demo::DemoReport;
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::report::html::{self, Recordings};
use servoid_results::schema::Demo;

pub(super) fn run(session: &Session, args: &DemoArgs) -> Result<(), Error> {
    session.check_outputs(&[("--out", &args.out)], &[])?;
    let machine = showcase::machine();
    let secret = if args.blind {
        surprise(&machine, session.seed)?
    } else {
        hidden(&args.hide, &machine)?
    };
    let record = |seed: u64, name: &str| -> Result<Data, Error> {
        let recording =
            showcase::record(std::slice::from_ref(&secret), seed, name).map_err(wrong_flag)?;
        Ok(Data::new(&recording)?)
    };
    let data = record(session.seed, "demo recording")?;
    let other = "held-out recording";
    let held_out = record(session.seed.wrapping_add(1), other)?;
    let options = Options {
        seed: session.seed,
        ..Options::default()
    };
    let kind = HeldOut::Recording(other.to_owned());
    let watched = Watched::diagnosis(session);
    let budget = Budget::usual(session.stop());
    let found = diagnose_data(&data, &held_out, &kind, &options, &budget, &watched)?;
    drop(watched);
    let story = DemoReport {
        diagnosis: DiagnosisReport::new(&found, &data, &kind, session.seed, session.json_file()),
        machine,
        hidden: &secret,
        described: secret.described(),
        blind: args.blind,
        counts_per_rev: showcase::COUNTS_PER_REV,
    };
    let json = Demo::from(&story);
    let drawn = Recordings {
        fitted: Some(&data),
        held_out: Some(&held_out),
    };
    let page = html::page(&report::document(&json)?, drawn)?;
    write_whole(&args.out, |out| out.write_all(page.render().as_bytes()))?;
    let text = format!(
        "{}\npage with the drawings: {}\n",
        story.text(),
        args.out.display()
    );
    session.deliver(&text, &json)
}
