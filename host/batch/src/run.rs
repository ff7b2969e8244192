//! The work of a batch, on all cores: what is wanted less what is there.

use crate::error::Error;
use crate::input::{Input, Unit};
use crate::shard::Shard;
use crate::store::Store;
use crate::task::Task;
use serde::{Deserialize, Serialize};
use servoid_identify::Progress;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

/// A batch.
pub struct Batch<'a> {
    /// What is done to each recording.
    pub task: &'a Task,
    /// Which of them this run does.
    pub shard: Shard,
    /// Whether recordings that gave an error are done again.
    pub retry_errors: bool,
    /// How many are done at a time.
    pub workers: usize,
}

/// Who watches a batch.
pub trait Watch: Sync {
    /// One more recording of the shard has a result: made now, or there before.
    fn ended(&self) {}

    /// Set it to stop: what is under way is given up, and everything else is kept.
    fn stop(&self) -> &AtomicBool;
}

/// What a run did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Done {
    /// Results that were there before.
    pub there: usize,
    /// Results that were made.
    pub made: usize,
    /// Those of them that are errors.
    pub errors: usize,
    /// Whether it was stopped before its end.
    pub interrupted: bool,
}

/// Does what is wanted and not there.
///
/// # Errors
/// An input that cannot be read further; results that cannot be written. What was made until then is kept.
pub fn run(
    input: &Input,
    batch: &Batch<'_>,
    store: &mut Store,
    watch: &dyn Watch,
) -> Result<Done, Error> {
    store.begin(input, batch.task, batch.shard)?;
    let (give, take) = sync_channel::<Unit>(batch.workers.max(1));
    let take = Mutex::new(take);
    let collected = Mutex::new(Collected {
        store,
        done: Done::default(),
        failed: None,
    });
    let given = thread::scope(|scope| {
        for _ in 0..batch.workers.max(1) {
            scope.spawn(|| work(batch, &take, &collected, watch));
        }
        let given = input.each(batch.shard, |unit| {
            let goes_on = !watch.stop().load(Ordering::Relaxed)
                && !collected.lock().is_ok_and(|c| c.failed.is_some());
            goes_on && give.send(unit).is_ok()
        });
        drop(give);
        given
    });
    let collected = collected
        .into_inner()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    let Collected {
        store,
        mut done,
        failed,
    } = collected;
    done.interrupted = watch.stop().load(Ordering::Relaxed);
    let ended = store.end(done);
    match failed {
        Some(error) => Err(error),
        None => given.and(ended).map(|()| done),
    }
}

/// What the workers put together.
struct Collected<'s> {
    store: &'s mut Store,
    done: Done,
    failed: Option<Error>,
}

/// A worker: takes units until there are no more.
fn work(
    batch: &Batch<'_>,
    take: &Mutex<Receiver<Unit>>,
    collected: &Mutex<Collected<'_>>,
    watch: &dyn Watch,
) {
    let stopped = Stopped(watch.stop());
    loop {
        let next = take.lock().map(|take| take.recv());
        let Ok(Ok(unit)) = next else { return };
        // What is still given is taken and left, or whoever gives would wait for ever.
        let failed = collected.lock().is_ok_and(|c| c.failed.is_some());
        if failed || watch.stop().load(Ordering::Relaxed) {
            continue;
        }
        let key = batch.task.key(&unit);
        let has = collected
            .lock()
            .is_ok_and(|c| c.store.has(&key, batch.retry_errors));
        if has {
            if let Ok(mut collected) = collected.lock() {
                collected.done.there += 1;
            }
            watch.ended();
            continue;
        }
        let Some(row) = batch.task.row(&unit, key, &stopped) else {
            continue;
        };
        let Ok(mut collected) = collected.lock() else {
            return;
        };
        if collected.failed.is_some() {
            continue;
        }
        let ok = row.is_ok();
        match collected.store.add(row) {
            Ok(()) => {
                collected.done.made += 1;
                collected.done.errors += usize::from(!ok);
            }
            Err(error) => collected.failed = Some(error),
        }
        drop(collected);
        watch.ended();
    }
}

/// Stops with the batch.
struct Stopped<'a>(&'a AtomicBool);

impl Progress for Stopped<'_> {
    fn stop(&self) -> &AtomicBool {
        self.0
    }
}
