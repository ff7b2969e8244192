//! The bench's state, and its change notifications to the page.

use super::device::Device;
use super::drawings::Drawings;
use super::dropped::Dropped;
use super::history::History;
use super::job::Job;
use super::model::Model;
use super::recordings::Recordings;
use crate::error::Error;
use crate::twins::Found;
use serde_json::Value;
use servoid_identify::diagnose::{Floor, Suggestion};
use servoid_plant::Hidden;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::broadcast;

/// Tellings that a slow page may miss; it asks for the state anyhow.
const TELLINGS: usize = 256;

/// The bench, shared by the pages that show it and the work that is done on it.
pub(super) struct Bench {
    state: Mutex<State>,
    /// Tells every page that the bench has changed, and how work goes on.
    pub(super) tellings: broadcast::Sender<Telling>,
    /// What is being done.
    pub(super) job: Job,
    /// Where the bench is kept after every change.
    file: Option<PathBuf>,
    history: Mutex<History>,
    /// Drawings of what is looked at.
    pub(super) drawings: Drawings,
    device: Option<Device>,
    /// Files that wait until it is said what their columns are.
    pub(super) dropped: Dropped,
}

/// Which way through the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Back.
    Undo,
    /// Forward.
    Redo,
}

/// What pages are told without asking.
#[derive(Clone, Debug)]
pub(super) enum Telling {
    /// The bench has changed.
    Changed,
    /// Work goes on: what there is to show of it.
    Progress(Value),
}

/// What lies on the bench.
#[derive(Clone, Default)]
pub(super) struct State {
    /// Counts changes.
    pub(super) revision: u64,
    /// Recordings, if there are any.
    pub(super) recordings: Option<Recordings>,
    /// Fitted models, in the order in which they were made.
    pub(super) models: Vec<Model>,
    /// The one that is looked at.
    pub(super) chosen: Option<usize>,
    /// The one that it is compared with.
    pub(super) against: Option<usize>,
    /// What would explain more than a model, of each for which that was looked for.
    pub(super) proposed: BTreeMap<usize, Arc<Proposed>>,
    /// Effects that are not proposed.
    pub(super) locked: Vec<Kind>,
    /// The last race of search methods, `servoid.compare/1`.
    pub(super) race: Option<Value>,
    /// The last diagnosis, `servoid.diagnosis/1`.
    pub(super) diagnosis: Option<Value>,
    /// What was named in twins of a model, as far as they were tried.
    pub(super) twins: BTreeMap<usize, Found>,
    /// What is hidden in the motor of a blind demonstration.
    pub(super) secret: Option<Secret>,
    /// What went wrong last, in words.
    pub(super) fault: Option<String>,
    next: usize,
}

/// What would explain more than a model.
pub(super) struct Proposed {
    /// Best first.
    pub(super) list: Vec<Suggestion>,
    /// What stands below the model's error, where models run in windows.
    pub(super) floor: Option<Floor>,
    /// Models that were tried for it.
    pub(super) tried: usize,
    /// Time that this took, s.
    pub(super) seconds: f64,
}

/// What is hidden in a blind demonstration.
#[derive(Clone)]
pub(super) struct Secret {
    pub(super) hidden: Hidden,
    pub(super) seed: u64,
    pub(super) revealed: bool,
}

impl State {
    /// An empty bench.
    pub(super) fn clear(&mut self) {
        *self = State {
            revision: self.revision,
            next: self.next,
            ..State::default()
        };
    }

    /// Other recordings: nothing that was found in the old ones holds.
    pub(super) fn begin(&mut self, recordings: Recordings) {
        self.clear();
        self.recordings = Some(recordings);
    }

    /// Takes over what counts on whatever lies on the bench.
    pub(super) fn carry_on(&mut self, before: &State) {
        self.revision = before.revision;
        self.next = self.next.max(before.next);
        self.fault = None;
    }

    /// RMS error of a right model of what lies on the bench, counts.
    pub(super) fn floor_counts(&self) -> f64 {
        let criterion = (self.recordings.as_ref()).and_then(Recordings::criterion_if_known);
        criterion.map_or(FLOOR_RMS_COUNTS, |criterion| criterion.floor)
    }

    /// A number for the next model.
    pub(super) fn number(&mut self) -> usize {
        self.next += 1;
        self.next
    }

    /// Puts a model on the bench; one with the same effects and method is replaced. It is looked at next, beside the
    /// one that was.
    pub(super) fn put(&mut self, mut model: Model) -> usize {
        let same = |other: &Model| {
            other.effects == model.effects && other.fit.algorithm == model.fit.algorithm
        };
        if let Some(place) = self.models.iter().position(same) {
            let old = &self.models[place];
            (model.id, model.parent) = (old.id, old.parent);
            let id = model.id;
            self.proposed.remove(&id);
            self.twins.remove(&id);
            self.models[place] = model;
            self.choose(id);
            return id;
        }
        model.id = self.number();
        let id = model.id;
        self.models.push(model);
        self.choose(id);
        id
    }

    /// Looks at a model, beside the one that was looked at.
    pub(super) fn choose(&mut self, id: usize) {
        if self.chosen != Some(id) {
            self.against = self.chosen;
            self.chosen = Some(id);
        }
    }

    /// The model of that number.
    pub(super) fn model(&self, id: usize) -> Result<&Model, Error> {
        self.models
            .iter()
            .find(|model| model.id == id)
            .ok_or_else(|| Error::Usage(format!("there is no model {id} on the bench")))
    }

    /// The model that is looked at.
    ///
    /// # Errors
    /// A bench without one.
    pub(super) fn chosen_model(&self) -> Result<&Model, Error> {
        let chosen = self
            .chosen
            .ok_or_else(|| Error::Usage("nothing is fitted yet; fit first".to_owned()))?;
        self.model(chosen)
    }

    /// The model that is looked at, and the one that it is compared with, as far as there are any.
    pub(super) fn both(&self) -> Vec<Model> {
        let ids = [self.chosen, self.against];
        let models = ids
            .into_iter()
            .flatten()
            .filter_map(|id| self.model(id).ok());
        models.cloned().collect()
    }

    /// Takes a model away; what was made from it hangs on what it was made from.
    ///
    /// # Errors
    /// A number that no model has.
    pub(super) fn remove(&mut self, id: usize) -> Result<(), Error> {
        let parent = self.model(id)?.parent;
        self.models.retain(|model| model.id != id);
        for model in &mut self.models {
            if model.parent == Some(id) {
                model.parent = parent;
            }
        }
        self.proposed.remove(&id);
        self.twins.remove(&id);
        if self.against == Some(id) {
            self.against = None;
        }
        if self.chosen == Some(id) {
            let known = parent.filter(|parent| self.model(*parent).is_ok());
            self.chosen = known.or(self.models.last().map(|model| model.id));
            self.against = None;
        }
        Ok(())
    }

    /// The number that the next model gets.
    pub(super) fn next_number(&self) -> usize {
        self.next + 1
    }

    /// A key for a drawing of that name: the same as long as the models that are looked at, and the recordings, are.
    pub(super) fn looked_at(&self, what: &str) -> String {
        let stamp = |id: Option<usize>| {
            let model = id.and_then(|id| self.model(id).ok());
            model.map(|model| (model.id, model.stamp))
        };
        let recordings = self.recordings.as_ref().map(|recordings| recordings.stamp);
        let race = self.race.as_ref().filter(|_| what == "race");
        let race = race.map(ToString::to_string);
        format!(
            "{what} {recordings:?} {:?} {:?} {race:?}",
            stamp(self.chosen),
            stamp(self.against)
        )
    }

    /// The recordings.
    pub(super) fn recordings(&self) -> Result<Recordings, Error> {
        self.recordings.clone().ok_or_else(|| {
            Error::Usage("there is no recording on the bench; load one first".to_owned())
        })
    }
}

impl Bench {
    pub(super) fn new(file: Option<PathBuf>, device: Option<Device>) -> Arc<Self> {
        Arc::new(Bench {
            device,
            dropped: Dropped::default(),
            state: Mutex::default(),
            tellings: broadcast::channel(TELLINGS).0,
            job: Job::default(),
            file,
            history: Mutex::default(),
            drawings: Drawings::default(),
        })
    }

    /// The device that is connected.
    ///
    /// # Errors
    /// A bench without one.
    pub(super) fn device(&self) -> Result<&Device, Error> {
        self.device.as_ref().ok_or_else(|| {
            Error::Usage(
                "no device is connected; open the bench with one: servoid device bench --port ADDRESS"
                    .to_owned(),
            )
        })
    }

    /// What lies on the bench; whoever held it before cannot have left it half done.
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes what lies on the bench, keeps it, and tells every page. It can be undone.
    pub(super) fn change<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        self.kept(|state| {
            let before = state.clone();
            let result = change(state);
            if !state.has_same_work(&before) {
                self.history().changed(before);
            }
            result
        })
    }

    /// Undoes the last change, or does again what was undone last.
    ///
    /// # Errors
    /// Where there is nothing to undo or to do again.
    pub(super) fn go(&self, way: Way) -> Result<(), Error> {
        self.kept(|state| match way {
            Way::Undo => self.history().undo(state),
            Way::Redo => self.history().redo(state),
        })
    }

    /// What was done and undone; always after the state, so that nobody waits for the other.
    pub(super) fn history(&self) -> MutexGuard<'_, History> {
        self.history.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state, writes the file, and tells every page.
    fn kept<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        let mut state = self.state();
        let result = change(&mut state);
        state.revision += 1;
        if let Some(path) = &self.file
            && let Err(error) = super::session_file::write(path, &state)
        {
            state.fault = Some(error.to_string());
        }
        drop(state);
        self.tell(Telling::Changed);
        result
    }

    /// Does what a user asked for: what went wrong before is no longer of interest.
    pub(super) fn act<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        self.change(|state| {
            state.fault = None;
            change(state)
        })
    }

    /// Tells every page; that nobody listens is no fault.
    pub(super) fn tell(&self, telling: Telling) {
        let _ = self.tellings.send(telling);
    }
}
