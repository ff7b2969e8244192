//! `servoid prove`: random cases from the virtual bench, diagnosed blind.

use crate::cli::{CostName, ProveArgs};
use crate::coverage::{self, Condition};
use crate::error::Error;
use crate::prove::report::text;
use crate::prove::{
    self, Content, Fault, Header, HowMany, Outcome, SetUp, Shard, Store, StoreError,
};
use crate::session::Session;
use servoid_results::plot::reliability;
use servoid_results::schema::coverage::Coverage;
use shared::effects::Kind;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::Ordering;

pub(super) fn run(session: &Session, args: &ProveArgs) -> Result<(), Error> {
    if args.coverage {
        return coverage(session, args);
    }
    if !args.merge.is_empty() {
        return merge(session, args);
    }
    let files = [
        ("--out", &args.out),
        ("--resume", &args.resume),
        ("--plot", &args.plot),
    ];
    let outputs: Vec<(&str, &Path)> = files
        .into_iter()
        .filter_map(|(flag, path)| Some((flag, path.as_deref()?)))
        .collect();
    session.check_outputs(&outputs, &[])?;
    let header = Header::new(&set_up(session, args));
    let (mut store, mut outcomes) = opened(args, &header)?;
    let numbers = missing(args, &outcomes);
    if !outcomes.is_empty() {
        let done = outcomes.len();
        session.remark(&format!(
            "{done} cases done before, {} to do",
            numbers.len()
        ));
    }
    let bar = session.progress(numbers.len() as u64, "prove");
    prove::run(&header.set_up, &numbers, session.stop(), &mut |outcome| {
        if let Some(store) = &mut store {
            store.append(&outcome)?;
        }
        outcomes.push(outcome);
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    outcomes.sort_by_key(|outcome| outcome.case);
    deliver(session, args, &header, &outcomes)
}

/// How often standard errors hold the truth.
fn coverage(session: &Session, args: &ProveArgs) -> Result<(), Error> {
    check_plot(session, args)?;
    let found = if args.merge.is_empty() {
        covered(session, args)?
    } else {
        coverage::join(&args.merge)?
    };
    if let Some(path) = &args.plot {
        let lines = coverage::report::lines(&found);
        session.write_plot(path, &reliability(&lines, coverage::report::AXES)?)?;
    }
    session.deliver(&coverage::report::text(&found), &found)
}

fn covered(session: &Session, args: &ProveArgs) -> Result<Coverage, Error> {
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let effects = args.effect.iter().filter_map(|name| Kind::by_name(name));
    let conditions = match (args.effect.is_empty(), args.cost) {
        (true, CostName::Squared) => Condition::linear(),
        (true, cost) => Condition::noisy(cost.cost()),
        (false, cost) => {
            let with = |kind| Condition {
                cost: cost.cost(),
                ..Condition::with_effect(kind)
            };
            effects.map(with).collect()
        }
    };
    let plan = coverage::Plan {
        seed: session.seed,
        cases: args.cases,
        shard,
        conditions,
    };
    let bar = session.progress(plan.recordings(), "coverage");
    let found = plan.run(session.stop(), &|| bar.inc(1))?;
    bar.finish_and_clear();
    Ok(found)
}

/// The joint table of several files.
fn merge(session: &Session, args: &ProveArgs) -> Result<(), Error> {
    check_plot(session, args)?;
    let merged = prove::merge(&args.merge);
    match merged.map_err(|error| wrong_flag("--merge", error))? {
        Some(Content { header, outcomes }) => deliver(session, args, &header, &outcomes),
        None => Err(Error::Usage("--merge: name the files".to_owned())),
    }
}

fn set_up(session: &Session, args: &ProveArgs) -> SetUp {
    let effects: BTreeSet<String> = args.effect.iter().cloned().collect();
    SetUp {
        seed: session.seed,
        hidden: args.hidden,
        excite: args.excite,
        effects: effects.into_iter().collect(),
        laws: args.law,
        discover: args.discover || args.hidden == HowMany::Formula,
    }
}

/// Where finished cases go, and those that are there.
fn opened(args: &ProveArgs, header: &Header) -> Result<(Option<Store>, Vec<Outcome>), Error> {
    if let Some(path) = &args.resume {
        let resumed = Store::resume(path, header);
        let (store, outcomes) = resumed.map_err(|error| wrong_flag("--resume", error))?;
        return Ok((Some(store), outcomes));
    }
    let store = match &args.out {
        Some(path) => {
            let created = Store::create(path, header);
            Some(created.map_err(|error| wrong_flag("--out", error))?)
        }
        None => None,
    };
    Ok((store, Vec::new()))
}

/// What is wrong with the use of a file, under the flag's name; what is wrong with the file itself as it is.
fn wrong_flag(flag: &str, error: StoreError) -> Error {
    match error.fault {
        Fault::Exists | Fault::Missing | Fault::Other(_) => Error::Usage(format!("{flag} {error}")),
        _ => error.into(),
    }
}

/// The cases that are asked for and not done.
fn missing(args: &ProveArgs, done: &[Outcome]) -> Vec<u64> {
    let done: BTreeSet<u64> = done.iter().map(|outcome| outcome.case).collect();
    let asked: Vec<u64> = match &args.only[..] {
        [] => args
            .shard
            .unwrap_or(Shard::WHOLE)
            .numbers(args.cases)
            .collect(),
        only => only
            .iter()
            .copied()
            .collect::<BTreeSet<u64>>()
            .into_iter()
            .collect(),
    };
    asked
        .into_iter()
        .filter(|case| !done.contains(case))
        .collect()
}

/// Nothing that is written may be a file of --merge.
fn check_plot(session: &Session, args: &ProveArgs) -> Result<(), Error> {
    let merged = args.merge.iter();
    let inputs: Vec<_> = merged.map(|path| ("a file of --merge", &**path)).collect();
    let plot: Vec<_> = args.plot.iter().map(|path| ("--plot", &**path)).collect();
    session.check_outputs(&plot, &inputs)
}

fn deliver(
    session: &Session,
    args: &ProveArgs,
    header: &Header,
    outcomes: &[Outcome],
) -> Result<(), Error> {
    let interrupted = session.stop().load(Ordering::Relaxed);
    let proof = prove::tally(header, outcomes, interrupted);
    if let Some(path) = &args.plot {
        let lines = prove::report::lines(&proof);
        session.write_plot(path, &reliability(&lines, prove::report::AXES)?)?;
    }
    session.deliver(&text(&proof), &proof)
}
