//! `servoid fleet`, `servoid population` and `servoid draw`: what a batch says of all motors together.

use crate::cli::{DrawArgs, DrawFormat, FleetArgs, PopulationArgs, ResultsArgs};
use crate::error::Error;
use crate::session::Session;
use crate::titled::titled;
use serde::Serialize;
use servoid_fleet::{
    Fleet, LabelFile, Population, draw as draw_motors, page, population_text, summary_text,
    unit_page,
};
use servoid_io::output::write_whole;
use std::fs;
use std::path::Path;

/// The output of `draw --json`.
#[derive(Serialize)]
struct DrawJson {
    schema: &'static str,
    out: String,
    motors: u32,
    seed: u64,
    names: Vec<String>,
    units: Vec<String>,
}

fn read(args: &ResultsArgs) -> Result<Fleet, Error> {
    let labels = args.labels.as_deref().map(LabelFile::read).transpose()?;
    Ok(Fleet::read(&args.results, labels.as_ref())?)
}

/// Files that a result must not be written over.
fn inputs(args: &ResultsArgs) -> Vec<(&'static str, &Path)> {
    let labels = args.labels.as_deref().map(|path| ("the labels", path));
    labels.into_iter().collect()
}

pub(super) fn fleet(session: &Session, args: &FleetArgs) -> Result<(), Error> {
    let report = args.report.as_deref().map(|path| ("--report", path));
    session.check_outputs(report.as_slice(), &inputs(&args.results))?;
    let fleet = read(&args.results)?;
    if let Some(name) = &args.unit {
        return unit(session, args, &fleet, name);
    }
    let summary = fleet.summary();
    let mut text = summary_text(&summary);
    if let Some(path) = &args.report {
        // Too few motors for a population are enough for a page.
        let population = fleet.population().ok();
        let page = titled(page(&fleet, &summary, population.as_ref())?, None);
        write_whole(path, |out| out.write_all(page.render().as_bytes()))?;
        text += &format!("\npage with the drawings: {}\n", path.display());
    }
    session.deliver(&text, &summary)
}

/// One recording's own result.
fn unit(session: &Session, args: &FleetArgs, fleet: &Fleet, name: &str) -> Result<(), Error> {
    let result = fleet.result(name)?;
    let value: serde_json::Value =
        serde_json::from_str(&result).map_err(|error| Error::Failed(format!("{name}: {error}")))?;
    let page = titled(unit_page(name, &value)?, None);
    let mut text = format!("{name}\n");
    for words in &page.lead {
        text += &format!("{words}\n");
    }
    if let Some(path) = &args.report {
        write_whole(path, |out| out.write_all(page.render().as_bytes()))?;
        text += &format!("page: {}\n", path.display());
    }
    session.deliver(&text, &value)
}

pub(super) fn population(session: &Session, args: &PopulationArgs) -> Result<(), Error> {
    session.check_outputs(&[], &inputs(&args.results))?;
    let population = read(&args.results)?.population()?;
    session.deliver(&population_text(&population), &population)
}

pub(super) fn draw(session: &Session, args: &DrawArgs) -> Result<(), Error> {
    let population_file = [("the population", args.population.as_path())];
    let to_file = args.to != DrawFormat::Mujoco;
    let outputs = to_file.then_some(("--out", args.out.as_path()));
    session.check_outputs(outputs.as_slice(), &population_file)?;
    let population = Population::read(&args.population)?;
    let draws = draw_motors(&population, args.n as usize, session.seed)?;
    let file = |bytes: Vec<u8>| write_whole(&args.out, |out| out.write_all(&bytes));
    match args.to {
        DrawFormat::Npz => file(draws.npz()?)?,
        DrawFormat::Parquet => file(draws.parquet()?)?,
        DrawFormat::Mujoco => {
            // The first one says whether there can be any.
            draws.model(&population, 0, "mujoco")?;
            fs::create_dir_all(&args.out)
                .map_err(|error| Error::Failed(format!("--out {}: {error}", args.out.display())))?;
            let bar = session.progress(u64::from(args.n), "models");
            let digits = args.n.to_string().len();
            for number in 0..args.n as usize {
                if session.stop().load(std::sync::atomic::Ordering::Relaxed) {
                    return Err(Error::Failed(format!("stopped after {number} models")));
                }
                let model = draws.model(&population, number, "mujoco")?;
                let path = args.out.join(format!("motor-{number:0digits$}.xml"));
                write_whole(&path, |out| out.write_all(model.as_bytes()))?;
                bar.inc(1);
            }
            bar.finish_and_clear();
        }
    }
    let text = format!(
        "{}: {} motors, {} parameters each: {}\n",
        args.out.display(),
        args.n,
        draws.names.len(),
        draws.names.join(", ")
    );
    session.deliver(
        &text,
        &DrawJson {
            schema: "servoid.draw/1",
            out: args.out.display().to_string(),
            motors: args.n,
            seed: session.seed,
            names: draws.names,
            units: draws.units,
        },
    )
}
