//! Work that drives the motor: a recording, the experiment that decides, commissioning. What is recorded comes onto the bench.

use super::loaded::{Loaded, Source};
use super::opened::{Role, placed};
use super::planned::{self, Planned};
use super::state::{Bench, Telling};
use super::work::{self, Watched};
use crate::device::{Kept, Order, segments};
use crate::error::Error;
use servoid_identify::LEAST_SQUARES;
use servoid_results::device_run::Folder;
use shared::effects::Kind;
use shared::fit::{Method, Settings};
use shared::wire;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Length of the verification of a commissioning, s.
const VERIFY_S: f64 = 4.0;

/// Excites the motor for so many seconds; the recording is fitted, or judges.
pub(super) fn record(bench: &Arc<Bench>, seconds: f64, role: Role) -> Result<(), Error> {
    let order = Order {
        excite_s: seconds,
        ..bench.device()?.next_order()
    };
    let effects = chosen_effects(bench);
    let (kept, folder) = run(bench, "record", &order, &[], None)?;
    let loaded = loaded(&folder, &kept, "recording.csv")?;
    place(bench, vec![(loaded, role)])?;
    unfailed(&kept)?;
    work::fit(bench, &effects, LEAST_SQUARES)
}

/// Plans the experiment that decides between effects which explain the recordings about equally.
pub(super) fn plan(bench: &Arc<Bench>, seconds: f64) -> Result<(), Error> {
    let device = bench.device()?;
    device.plan(None);
    let (recordings, rivals) = {
        let state = bench.state();
        (state.recordings()?, planned::rivals(&state)?)
    };
    let watched = Watched::new(bench, 0);
    let done = || servoid_identify::Progress::tried(&watched);
    let found = planned::plan(
        device,
        &recordings,
        rivals,
        seconds,
        bench.job.flag(),
        &done,
    )?;
    device.plan(Some(found));
    bench.tell(Telling::Changed);
    Ok(())
}

/// Records the experiment that was planned, beside what is fitted, and fits each rival to all of it.
pub(super) fn play(bench: &Arc<Bench>) -> Result<(), Error> {
    let device = bench.device()?;
    let planned = device.planned().ok_or_else(|| {
        Error::Usage("there is no experiment yet; let one be planned first".to_owned())
    })?;
    let order = Order {
        kind: wire::Kind::Play,
        ..device.order().clone()
    };
    let (scale, period_us) = (order.scale(device.about()), device.about().period_us);
    let plan = segments(&planned.commands, scale, period_us)?;
    let (kept, folder) = run(
        bench,
        "experiment",
        &order,
        &plan,
        Some(Arc::clone(&planned)),
    )?;
    device.plan(None);
    let loaded = loaded(&folder, &kept, "recording.csv")?;
    place(bench, vec![(loaded, Role::Beside)])?;
    unfailed(&kept)?;
    // In the order in which they ran along: each keeps its letter.
    let mut judged = Vec::new();
    for rival in &planned.rivals {
        let id = work::fit_alone(bench, &rival.effects, LEAST_SQUARES)?;
        let held_out = bench.state().model(id)?.held_out_rms_counts();
        judged.push((held_out.unwrap_or(f64::INFINITY), id));
        if bench.job.flag().load(Ordering::Relaxed) {
            return Ok(());
        }
    }
    let Some(&(_, best)) = judged.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Ok(());
    };
    bench.change(|state| state.choose(best));
    work::further(bench, best)
}

/// Lets the device identify its motor itself; what it recorded is fitted here, too, and its verification judges.
pub(super) fn commission(bench: &Arc<Bench>, seconds: f64) -> Result<(), Error> {
    let device = bench.device()?;
    let common = device.next_order();
    let order = Order {
        kind: wire::Kind::Commission,
        excite_s: seconds,
        record_s: None,
        verify_s: VERIFY_S,
        fit: Settings {
            method: Method::Pso,
            ..common.fit
        },
        ..common
    };
    let (kept, folder) = run(bench, "commission", &order, &[], None)?;
    device.commission(&kept.saved);
    let mut recordings = vec![(loaded(&folder, &kept, "recording.csv")?, Role::Fitted)];
    if kept.has_written("verify.csv") {
        recordings.push((loaded(&folder, &kept, "verify.csv")?, Role::HeldOut));
    }
    place(bench, recordings)?;
    // A fit that the verification does not bear out is what the bench is for.
    let unverified =
        matches!(&kept.run.outcome, Err(failure) if failure.fault == wire::Fault::NotVerified);
    if !unverified {
        unfailed(&kept)?;
    }
    work::fit(bench, &[], LEAST_SQUARES)
}

/// Runs an order; every page is told as the motor begins to turn and as it ends. Who stops the motor has what it recorded until then: the
/// work goes on with that.
fn run(
    bench: &Bench,
    what: &'static str,
    order: &Order,
    plan: &[wire::Segment],
    planned: Option<Arc<Planned>>,
) -> Result<(Kept, Folder), Error> {
    let told = || bench.tell(Telling::Changed);
    let device = bench.device()?;
    let done = device.run(what, order, plan, planned, bench.job.flag(), &told);
    bench.job.go_on();
    done
}

/// A recording of a run as a user's file would be.
fn loaded(folder: &Folder, kept: &Kept, name: &str) -> Result<Loaded, Error> {
    if !kept.has_written(name) {
        let why = kept.saved.failure.as_ref();
        return Err(Error::Failed(format!(
            "nothing was recorded: {}",
            why.map_or("no period arrived", |failure| failure.message.as_str())
        )));
    }
    let text = |name: &str| {
        let path = folder.path().join(name);
        std::fs::read_to_string(&path)
            .map_err(|error| Error::Failed(format!("{}: {error}", path.display())))
    };
    let run = folder.path().file_name().unwrap_or_default();
    let name_of_run = run.to_string_lossy();
    Loaded::read(vec![Source {
        name: match name {
            "recording.csv" => format!("{name_of_run}.csv"),
            other => format!("{name_of_run}-{other}"),
        },
        csv: text(name)?,
        motor: text("motor.toml")?,
        span_s: None,
    }])
}

/// Puts recordings on the bench; the first one that is fitted alone makes room.
fn place(bench: &Bench, recordings: Vec<(Loaded, Role)>) -> Result<(), Error> {
    let mut before = bench.state().recordings.clone();
    for (loaded, role) in recordings {
        before = Some(placed(loaded, role, before)?);
    }
    if let Some(recordings) = before {
        bench.change(|state| state.begin(recordings));
    }
    Ok(())
}

/// Why the device gave up, unless it was told to.
fn unfailed(kept: &Kept) -> Result<(), Error> {
    let told = matches!(&kept.run.outcome, Err(failure) if failure.fault == wire::Fault::Stopped);
    match &kept.saved.failure {
        Some(failure) if !told => Err(Error::Failed(format!(
            "{failure}; what it had recorded is on the bench"
        ))),
        _ => Ok(()),
    }
}

fn chosen_effects(bench: &Bench) -> Vec<Kind> {
    let state = bench.state();
    let chosen = state.chosen_model().ok();
    chosen.map_or(Vec::new(), |model| model.effects.clone())
}
