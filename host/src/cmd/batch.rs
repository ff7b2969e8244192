//! `servoid batch`: many recordings, one row each.

use crate::cli::{BatchArgs, BatchVerb, Retry};
use crate::error::Error;
use crate::session::Session;
use indicatif::ProgressBar;
use serde::Serialize;
use servoid_batch::{
    Batch, Input, Store, Task, Verb, Watch, counted, run as run_batch, write_table,
};
use servoid_identify::fit::cost_name;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;

/// The output of `--json`.
#[derive(Serialize)]
struct BatchJson {
    schema: &'static str,
    input: String,
    out: String,
    shard: String,
    recordings: usize,
    there: usize,
    made: usize,
    errors: usize,
    interrupted: bool,
    /// Rows of the whole folder by their status, cause or verdict.
    rows: BTreeMap<String, usize>,
    table: Option<String>,
}

pub(super) fn run(session: &Session, args: &BatchArgs) -> Result<(), Error> {
    let outputs: Vec<_> = args
        .table
        .as_deref()
        .map(|path| ("--table", path))
        .into_iter()
        .collect();
    session.check_outputs(&outputs, &[("the recordings", &args.input)])?;
    let task = Task {
        verb: match args.verb {
            BatchVerb::Fit => Verb::Fit,
            BatchVerb::Diagnose => Verb::Diagnose,
        },
        effects: args.with.clone(),
        algorithm: args.algorithm.clone(),
        cost: cost_name(args.cost.cost()).to_owned(),
        evaluations: usize::try_from(args.evaluations).unwrap_or(usize::MAX),
        steps: args.budget.saturating_mul(1_000_000),
        seed: session.seed,
        force: args.force,
    };
    task.check()?;
    let input = Input::open(&args.input)?;
    let mut store = Store::open(&args.out, args.shard)?;
    for remark in &store.remarks {
        session.remark(remark);
    }
    let workers = args.workers.map_or_else(
        || available_parallelism().map_or(1, usize::from),
        usize::from,
    );
    let batch = Batch {
        task: &task,
        shard: args.shard,
        retry_errors: args.retry == Some(Retry::Error),
        workers,
    };
    let own = input.count(args.shard);
    let watched = Watched {
        bar: session.progress(own as u64, "batch"),
        session,
    };
    let done = run_batch(&input, &batch, &mut store, &watched)?;
    watched.bar.finish_and_clear();
    let counted = counted(&args.out)?;
    if let Some(path) = &args.table {
        write_table(&args.out, path)?;
    }
    let mut text = format!(
        "{own} recordings: {} made now ({} errors), {} there before\n",
        done.made, done.errors, done.there
    );
    if done.interrupted {
        text += "stopped before the end; the same command goes on\n";
    }
    text += &format!(
        "{}: {} rows\n",
        args.out.display(),
        counted.values().sum::<usize>()
    );
    for (said, count) in &counted {
        text += &format!("  {:<18} {count}\n", said.replace('_', " "));
    }
    let json = BatchJson {
        schema: "servoid.batch/1",
        input: args.input.display().to_string(),
        out: args.out.display().to_string(),
        shard: args.shard.to_string(),
        recordings: own,
        there: done.there,
        made: done.made,
        errors: done.errors,
        interrupted: done.interrupted,
        rows: counted,
        table: args.table.as_ref().map(|path| path.display().to_string()),
    };
    session.deliver(&text, &json)
}

/// A bar over the recordings; stopped by Ctrl-C.
struct Watched<'a> {
    bar: ProgressBar,
    session: &'a Session,
}

impl Watch for Watched<'_> {
    fn ended(&self) {
        self.bar.inc(1);
    }

    fn stop(&self) -> &AtomicBool {
        self.session.stop()
    }
}
