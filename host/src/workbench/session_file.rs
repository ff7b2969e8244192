//! The bench as a file that can be opened again, or sent to somebody: recordings, models, and what is looked at.

use super::loaded::{Loaded, Source};
use super::model::Model;
use super::recordings::Recordings;
use super::state::{Secret, State};
use crate::error::Error;
use crate::prove::surprise;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use servoid_io::output::write_private;
use servoid_io::showcase;
use servoid_plant::Hidden;
use servoid_results::schema::{self, Document};
use std::path::Path;
use std::sync::Arc;

/// What the file calls itself.
pub const SCHEMA: &str = "servoid.session/1";
/// What a session of any version calls itself at the beginning.
pub const FAMILY: &str = "servoid.session/";

/// The bench as a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SessionFile {
    schema: String,
    #[serde(default)]
    version: String,
    fitted: Option<Source>,
    /// Others that are fitted with it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    fitted_with: Vec<Source>,
    #[serde(default)]
    held_out: Option<Source>,
    /// Others that are held out with it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    held_out_with: Vec<Source>,
    /// Others that are neither.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    ignored: Vec<Source>,
    #[serde(default)]
    models: Vec<SavedModel>,
    #[serde(default)]
    chosen: Option<usize>,
    #[serde(default)]
    against: Option<usize>,
    /// Effects that are not proposed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    locked: Vec<String>,
    #[serde(default)]
    race: Option<Value>,
    #[serde(default)]
    diagnosis: Option<Value>,
    /// Seed of a blind demonstration, and whether its secret is out.
    #[serde(default)]
    blind: Option<(u64, bool)>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct SavedModel {
    algorithm: String,
    evaluations: usize,
    foreseen_rms_counts: Option<f64>,
    /// Place of the model from which it was made.
    #[serde(default)]
    parent: Option<usize>,
    model: schema::Model,
}

impl SessionFile {
    /// The bench as it is.
    pub(super) fn of(state: &State) -> Self {
        let place = |id: Option<usize>| {
            id.and_then(|id| state.models.iter().position(|model| model.id == id))
        };
        let first = |loaded: &Arc<Loaded>| loaded.sources.first().cloned();
        let others = |loaded: &Arc<Loaded>| loaded.sources.iter().skip(1).cloned().collect();
        let recordings = state.recordings.as_ref();
        let held_out = recordings.and_then(|r| r.held_out.as_ref());
        SessionFile {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            fitted: recordings.and_then(|r| first(&r.fitted)),
            fitted_with: recordings.map_or(Vec::new(), |r| others(&r.fitted)),
            held_out: held_out.and_then(first),
            held_out_with: held_out.map_or(Vec::new(), others),
            ignored: (recordings.and_then(|r| r.ignored.as_ref()))
                .map_or(Vec::new(), |ignored| ignored.sources.clone()),
            models: state
                .models
                .iter()
                .map(|model| SavedModel {
                    algorithm: model.fit.algorithm.clone(),
                    evaluations: model.fit.evaluations,
                    foreseen_rms_counts: model.predicted,
                    parent: place(model.parent),
                    model: schema::Model::of(&model.fit.candidate, model.fit.method),
                })
                .collect(),
            chosen: place(state.chosen),
            against: place(state.against),
            locked: state
                .locked
                .iter()
                .map(|kind| kind.name().to_owned())
                .collect(),
            race: state.race.clone(),
            diagnosis: state.diagnosis.clone(),
            blind: (state.secret.as_ref()).map(|secret| (secret.seed, secret.revealed)),
        }
    }

    /// As text.
    pub(super) fn text(&self) -> Result<String, Error> {
        serde_json::to_string_pretty(self)
            .map(|text| text + "\n")
            .map_err(|error| Error::Failed(format!("the session cannot be written: {error}")))
    }

    /// Reads one.
    ///
    /// # Errors
    /// What is no session, with the reason.
    pub fn parse(text: &str, source: &str) -> Result<Self, Error> {
        let failed = |what: String| {
            Error::Failed(format!(
                "{source}: {what}; a session is what the workbench saved, a recording is a CSV file"
            ))
        };
        // First what it is, so that a file of another kind or version is refused by its name and not by a key.
        #[derive(Deserialize)]
        struct Named {
            #[serde(default)]
            schema: Option<String>,
        }
        let named: Named = serde_json::from_str(text).map_err(|error| failed(error.to_string()))?;
        let schema = named.schema.unwrap_or_default();
        if schema != SCHEMA {
            let what = if schema.starts_with(FAMILY) {
                format!(
                    "is a session of another servoid: schema is `{schema}`, needed is `{SCHEMA}`"
                )
            } else if schema.is_empty() {
                format!("has no schema, needed is `{SCHEMA}`")
            } else {
                format!("schema is `{schema}`, needed is `{SCHEMA}`")
            };
            return Err(failed(what));
        }
        serde_json::from_str(text).map_err(|error| failed(error.to_string()))
    }

    /// Lays it on a bench. Models that cannot be run along the recording are left out, and said.
    pub(super) fn lay(self, state: &mut State) -> Result<(), Error> {
        let Some(fitted) = self.fitted else {
            state.clear();
            return Ok(());
        };
        let read = |first: Source, others: Vec<Source>| {
            Loaded::read(std::iter::once(first).chain(others).collect())
        };
        let others = self.held_out_with;
        let held_out = self.held_out.map(|first| read(first, others)).transpose()?;
        let fitted = Arc::new(read(fitted, self.fitted_with)?);
        let ignored = (!self.ignored.is_empty()).then(|| Loaded::read(self.ignored));
        let recordings = Recordings::new(fitted, held_out.map(Arc::new))
            .ignoring(ignored.transpose()?.map(Arc::new));
        state.begin(recordings.clone());
        state.locked = self
            .locked
            .iter()
            .filter_map(|name| servoid_formula::by_name(name))
            .collect();
        let parents: Vec<Option<usize>> = self.models.iter().map(|saved| saved.parent).collect();
        let mut ids = Vec::new();
        let mut faults = Vec::new();
        for (place, saved) in self.models.into_iter().enumerate() {
            let id = state.number();
            match saved.again(place, id, &recordings) {
                Ok(mut model) => {
                    model.predicted = saved.foreseen_rms_counts;
                    let mut fit = (*model.fit).clone();
                    fit.evaluations = saved.evaluations;
                    model.fit = Arc::new(fit);
                    state.models.push(model);
                    ids.push(Some(id));
                }
                Err(error) => {
                    faults.push(error.to_string());
                    ids.push(None);
                }
            }
        }
        // A model is made from one that was there before; anything else would be no tree.
        let made_from = |place: usize| {
            let parent = parents[place].filter(|parent| *parent < place)?;
            ids[parent]
        };
        for (place, id) in ids.iter().enumerate() {
            if let Some(model) = state.models.iter_mut().find(|model| Some(model.id) == *id) {
                model.parent = made_from(place);
            }
        }
        let mut id = |key: &str, place: Option<usize>| {
            let place = place?;
            if place >= ids.len() {
                faults.push(format!("{key}: there is no model {place}"));
            }
            ids.get(place).copied().flatten()
        };
        state.chosen = id("chosen", self.chosen);
        state.against = id("against", self.against).filter(|other| state.chosen != Some(*other));
        // A bench with models always looks at one.
        state.chosen = (state.chosen).or_else(|| state.models.last().map(|model| model.id));
        let race = |document: &Document| matches!(document, Document::Contest(_));
        state.race = result("race", self.race, race, &mut faults);
        let diagnosis = |document: &Document| matches!(document, Document::Diagnosis(_));
        state.diagnosis = result("diagnosis", self.diagnosis, diagnosis, &mut faults);
        state.secret = self.blind.and_then(|(seed, revealed)| {
            let hidden: Hidden = surprise(&showcase::machine(), seed).ok()?;
            Some(Secret {
                hidden,
                seed,
                revealed,
            })
        });
        if !faults.is_empty() {
            state.fault = Some(format!("left out of the session: {}", faults.join("; ")));
        }
        Ok(())
    }
}

impl SavedModel {
    /// The model as number `id` of the bench; `place` is where it stands in the file.
    fn again(&self, place: usize, id: usize, recordings: &Recordings) -> Result<Model, Error> {
        if servoid_engine::solve::by_name(&self.algorithm).is_none() {
            return Err(Error::Failed(format!(
                "models[{place}]: there is no search method `{}`",
                self.algorithm
            )));
        }
        Model::again(id, &self.model, &self.algorithm, recordings)
            .map_err(|error| Error::Failed(format!("models[{place}]: {error}")))
    }
}

/// The result of another verb within the session, if it is one of that kind; else a fault.
fn result(
    key: &str,
    value: Option<Value>,
    is_kind: impl Fn(&Document) -> bool,
    faults: &mut Vec<String>,
) -> Option<Value> {
    let value = value?;
    match Document::from_json(value.clone()) {
        Ok(document) if is_kind(&document) => return Some(value),
        Ok(_) => faults.push(format!("{key}: is a result of another kind")),
        Err(fault) => faults.push(format!("{key}{fault}")),
    }
    None
}

/// Writes the bench to a file, whole or not at all. It holds recordings: it is the user's alone.
pub(super) fn write(path: &Path, state: &State) -> Result<(), Error> {
    let text = SessionFile::of(state).text()?;
    Ok(write_private(path, |out| out.write_all(text.as_bytes()))?)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn a_session_is_for_the_users_eyes_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("bench.json");
        write(&path, &State::default()).expect("written");
        let mode = std::fs::metadata(&path)
            .expect("a file")
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o600);
        let text = std::fs::read_to_string(&path).expect("text");
        SessionFile::parse(&text, "bench.json").expect("a session");
    }
}
