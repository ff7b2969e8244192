//! A device that is connected to the bench: what it is, the limits that its motor is held to, and its run that is under way.

use super::planned::Planned;
use crate::device::{Conversation, Kept, Order, Progress, Reached, keep};
use crate::error::Error;
use serde_json::{Value, json};
use servoid_results::device_run::{Folder, Recorded, recording};
use servoid_results::schema::DeviceRun;
use shared::wire::{About, Segment, Stage};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long the motor may be started after it was armed.
const ARMED: Duration = Duration::from_secs(10);

/// A device, the order with the limits that every run keeps, and a place for the runs' files.
pub struct Device {
    reached: Reached,
    about: About,
    order: Order,
    runs: Runs,
    /// Runs that were ordered.
    started: AtomicU64,
    armed: Mutex<Option<Instant>>,
    run: Mutex<Option<UnderWay>>,
    planned: Mutex<Option<Arc<Planned>>>,
    commissioned: Mutex<Option<Arc<DeviceRun>>>,
}

/// Where runs are kept: a folder of the user's, or one that ends with the program.
enum Runs {
    Kept(PathBuf),
    Passing(tempfile::TempDir),
}

impl Runs {
    fn path(&self) -> &Path {
        match self {
            Runs::Kept(path) => path,
            Runs::Passing(folder) => folder.path(),
        }
    }
}

/// A run that is under way.
#[derive(Clone)]
pub(super) struct UnderWay {
    /// What the page calls it.
    pub(super) what: &'static str,
    /// The periods of the present stage that arrived.
    pub(super) recorded: Recorded,
    /// Periods of the stage, if known.
    pub(super) length: Option<u32>,
    /// Models that the device has run, of about so many.
    pub(super) models: Option<(u32, u32)>,
    /// The experiment that is played.
    pub(super) planned: Option<Arc<Planned>>,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Device {
    /// A device that answered; every run keeps the limits of `order` and goes into a folder of its own in `runs`.
    ///
    /// # Errors
    /// A system without a place for files.
    pub fn new(
        reached: Reached,
        about: About,
        order: Order,
        runs: Option<PathBuf>,
    ) -> Result<Self, Error> {
        let failed = |error: std::io::Error| Error::Failed(format!("no folder for runs: {error}"));
        let runs = match runs {
            Some(path) => {
                std::fs::create_dir_all(&path).map_err(failed)?;
                Runs::Kept(path)
            }
            None => Runs::Passing(tempfile::tempdir().map_err(failed)?),
        };
        Ok(Device {
            reached,
            about,
            order,
            runs,
            started: AtomicU64::new(0),
            armed: Mutex::default(),
            run: Mutex::default(),
            planned: Mutex::default(),
            commissioned: Mutex::default(),
        })
    }

    /// The order that every run begins with.
    pub(super) fn order(&self) -> &Order {
        &self.order
    }

    /// The same with another seed than the run before: the same drive once more would judge nothing.
    pub(super) fn next_order(&self) -> Order {
        let runs = self.started.fetch_add(1, Ordering::Relaxed);
        let seed = self.order.seed.wrapping_add(runs);
        Order {
            seed,
            fit: shared::fit::Settings {
                seed,
                ..self.order.fit
            },
            ..self.order.clone()
        }
    }

    /// What the device is.
    pub(super) fn about(&self) -> &About {
        &self.about
    }

    /// Its control period, s.
    pub(super) fn period_s(&self) -> f64 {
        f64::from(self.about.period_us) * 1e-6
    }

    /// Lets the motor be started within the next seconds.
    pub(super) fn arm(&self) {
        *locked(&self.armed) = Some(Instant::now());
    }

    /// Takes the arming, which is for one start.
    ///
    /// # Errors
    /// A device that was not armed, or too long ago.
    pub(super) fn disarm(&self) -> Result<(), Error> {
        match locked(&self.armed).take() {
            Some(at) if at.elapsed() < ARMED => Ok(()),
            _ => Err(Error::Usage(format!(
                "the motor would turn: arm the device first, and start within {} s",
                ARMED.as_secs()
            ))),
        }
    }

    /// Seconds for which it is still armed.
    fn armed_s(&self) -> f64 {
        let left = locked(&self.armed).map(|at| ARMED.saturating_sub(at.elapsed()));
        left.map_or(0.0, |left| left.as_secs_f64())
    }

    /// The run that is under way.
    pub(super) fn under_way(&self) -> Option<UnderWay> {
        locked(&self.run).clone()
    }

    /// The experiment that was planned last.
    pub(super) fn planned(&self) -> Option<Arc<Planned>> {
        locked(&self.planned).clone()
    }

    /// Keeps an experiment to be recorded.
    pub(super) fn plan(&self, planned: Option<Planned>) {
        *locked(&self.planned) = planned.map(Arc::new);
    }

    /// Keeps what the device found of its motor.
    pub(super) fn commission(&self, saved: &DeviceRun) {
        *locked(&self.commissioned) = Some(Arc::new(saved.clone()));
    }

    /// Runs an order, with the limits of this device, into a folder of its own; `told` is called as the run begins and as it ends.
    ///
    /// # Errors
    /// As [`keep`].
    pub(super) fn run(
        &self,
        what: &'static str,
        order: &Order,
        plan: &[Segment],
        planned: Option<Arc<Planned>>,
        stop: &AtomicBool,
        told: &dyn Fn(),
    ) -> Result<(Kept, Folder), Error> {
        let folder = self.free_folder(what)?;
        let mut conversation = Conversation::open(&self.reached.port)?;
        let about = conversation.about()?;
        *locked(&self.run) = Some(UnderWay {
            what,
            recorded: Recorded::new(Stage::Idle, 0),
            length: None,
            models: None,
            planned,
        });
        told();
        let kept = keep(
            &mut conversation,
            &about,
            order,
            plan,
            &folder,
            stop,
            |progress| {
                if let Some(run) = locked(&self.run).as_mut() {
                    run.hear(progress);
                }
            },
        );
        *locked(&self.run) = None;
        told();
        Ok((kept?, folder))
    }

    /// The next folder that holds no run.
    fn free_folder(&self, what: &str) -> Result<Folder, Error> {
        let mut number = 1;
        loop {
            let path = self.runs.path().join(format!("{number:03}-{what}"));
            if !path.exists() {
                return Ok(Folder::new(&path)?);
            }
            number += 1;
        }
    }

    /// The periods that arrived of a run that is under way, as a recording.
    pub(super) fn so_far(&self, run: &UnderWay) -> servoid_io::recording::Recording {
        recording(
            &run.recorded.start(),
            self.about.period_us,
            self.order.scale(&self.about),
            self.order.counts_per_rev,
            self.about.senses_current,
        )
    }

    /// What the page shows of it.
    pub(super) fn view(&self) -> Value {
        let order = &self.order;
        let commissioned = locked(&self.commissioned).clone();
        json!({
            "board": self.about.board.as_str(),
            "firmware": self.about.firmware.as_str(),
            "port": self.reached.port.to_string(),
            "emulated": self.reached.bench.is_some(),
            "period_s": self.period_s(),
            "senses_current": self.about.senses_current,
            "supply_v": order.supply_v,
            "counts_per_rev": order.counts_per_rev,
            "limits": {
                "voltage_v": order.largest_voltage(), "current_a": order.max_current,
                "travel_rev": order.max_travel, "speed_rad_s": order.max_speed,
            },
            "armed_s": self.armed_s(),
            "running": locked(&self.run).is_some(),
            "runs": matches!(self.runs, Runs::Kept(_)).then(|| self.runs.path().display().to_string()),
            "planned": self.planned().map(|planned| planned.view()),
            "found": commissioned.as_deref().map(found),
        })
    }
}

/// What the device found of its motor.
fn found(saved: &DeviceRun) -> Value {
    json!({
        "parameters": saved.outcome.as_ref().map(|outcome| &outcome.parameters),
        "rms_counts": saved.outcome.as_ref().map(|outcome| outcome.rms_counts),
        "verified_rms_counts": saved.verified_rms_counts,
        "grade": saved.grade,
        "reason": saved.reason,
        "failure": saved.failure.as_ref().map(|failure| &failure.message),
    })
}

impl UnderWay {
    fn hear(&mut self, told: Progress<'_>) {
        match told {
            Progress::Stage(stage, length) => {
                self.length = length;
                self.recorded = Recorded::new(stage, 0);
            }
            // Rows of an earlier stage that come late are in the file, and are no longer looked at.
            Progress::Rows(rows) if rows.stage == self.recorded.stage => self.recorded.take(rows),
            Progress::Rows(_) => {}
            Progress::Models(done, of) => self.models = Some((done, of)),
        }
    }
}
