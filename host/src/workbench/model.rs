//! A fitted model on the bench.

use super::loaded::Loaded;
use crate::error::Error;
use serde::Deserialize;
use serde_json::Value;
use servoid_engine::problem::Data;
use servoid_engine::problem::rms_counts;
use servoid_engine::solve::Found;
use servoid_identify::diagnose::residual_analysis::{Signature, signature, whiteness};
use servoid_identify::diagnose::{Budget, Criterion, Errors, HeldOut};
use servoid_identify::fit::scores::whole;
use servoid_identify::fit::{self, Fit, Options, validation_errors};
use servoid_results::export::{Side, Subject};
use servoid_results::schema::{self, Identified};
use shared::effects::Kind;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// The search method that is meant where none is named.
pub(super) const USUAL: &str = "lm";

/// A fitted model.
#[derive(Clone)]
pub(super) struct Model {
    /// Its number on the bench.
    pub(super) id: usize,
    /// Effects in the order in which they were added.
    pub(super) effects: Vec<Kind>,
    /// The fit, with parameters and their errors.
    pub(super) fit: Arc<Fit>,
    /// RMS error that was foreseen before the fit, counts.
    pub(super) predicted: Option<f64>,
    /// The errors by which it is judged: of whole runs, or in windows.
    pub(super) judged: Errors,
    /// The model from which it was made by adding or removing effects.
    pub(super) parent: Option<usize>,
    /// Whether nothing is left in the error of the free run but the encoder's steps; `None` where the motor moved too little to tell,
    /// and where models are judged in windows: there the readings' noise at the start of each carries on.
    pub(super) white: Option<bool>,
    /// What each of its effects takes of the drive, of those that a quantity tells.
    pub(super) signatures: Arc<Vec<(Kind, Signature)>>,
    /// Differs from that of every other fit.
    pub(super) stamp: u64,
}

/// Recordings of one piece of work.
#[derive(Clone)]
pub(super) struct Recordings {
    /// The fitted ones, whole.
    pub(super) fitted: Arc<Loaded>,
    /// Others, never fitted.
    pub(super) held_out: Option<Arc<Loaded>>,
    /// Others that are neither fitted nor judge.
    pub(super) ignored: Option<Arc<Loaded>>,
    /// By which errors models are judged, found when first asked for.
    criterion: Arc<OnceLock<Criterion>>,
    /// Differs from that of all other recordings.
    pub(super) stamp: u64,
}

/// What a recording on the bench is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(super) enum Role {
    /// Models learn from it.
    #[serde(rename = "fitted")]
    Fitted,
    /// It judges them.
    #[serde(rename = "held out")]
    HeldOut,
    /// Nothing.
    #[serde(rename = "ignored")]
    Ignored,
}

/// A number that was not given before.
fn stamp() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl Recordings {
    pub(super) fn new(fitted: Arc<Loaded>, held_out: Option<Arc<Loaded>>) -> Self {
        Recordings {
            fitted,
            held_out,
            ignored: None,
            criterion: Arc::default(),
            stamp: stamp(),
        }
    }

    /// With others that are neither fitted nor judge.
    pub(super) fn ignoring(self, ignored: Option<Arc<Loaded>>) -> Self {
        Recordings { ignored, ..self }
    }

    /// The same recordings in other roles, in the order fitted, held out, ignored in which they stand now.
    ///
    /// # Errors
    /// As many roles as there are recordings, and one at least that is fitted.
    pub(super) fn in_roles(&self, roles: &[Role]) -> Result<Self, Error> {
        let all = [
            Some(&self.fitted),
            self.held_out.as_ref(),
            self.ignored.as_ref(),
        ];
        let all: Vec<_> = all
            .into_iter()
            .flatten()
            .flat_map(|one| one.singles())
            .collect();
        if all.len() != roles.len() {
            return Err(Error::Usage(format!(
                "{} recordings have {} roles",
                all.len(),
                roles.len()
            )));
        }
        let of = |role: Role| {
            let own = all.iter().zip(roles).filter(|(_, own)| **own == role);
            Loaded::of(
                own.map(|(single, _)| single.clone()).collect(),
                &self.fitted.known,
            )
        };
        let fitted = of(Role::Fitted)?.ok_or_else(|| {
            Error::Usage(
                "one recording at least must be fitted; give another that role first".to_owned(),
            )
        })?;
        Ok(Recordings::new(fitted, of(Role::HeldOut)?).ignoring(of(Role::Ignored)?))
    }

    /// The same with another span of recording `k`, s after its own first sample, in the order fitted, held out, ignored; the whole of it
    /// for none.
    ///
    /// # Errors
    /// No such recording; a span that leaves nothing to fit, in words.
    pub(super) fn spanned(&self, k: usize, span_s: Option<[f64; 2]>) -> Result<Self, Error> {
        let mut first = 0;
        let mut changed = |loaded: &Arc<Loaded>| -> Result<Arc<Loaded>, Error> {
            let range = first..first + loaded.sources.len();
            first = range.end;
            if !range.contains(&k) {
                return Ok(Arc::clone(loaded));
            }
            let mut sources = loaded.sources.clone();
            sources[k - range.start].span_s = span_s;
            Ok(Arc::new(Loaded::read(sources)?))
        };
        let fitted = changed(&self.fitted)?;
        let held_out = self.held_out.as_ref().map(&mut changed).transpose()?;
        let ignored = self.ignored.as_ref().map(&mut changed).transpose()?;
        if k >= first {
            return Err(Error::Usage(format!("there is no recording {k}")));
        }
        Ok(Recordings::new(fitted, held_out).ignoring(ignored))
    }

    /// The recording in which samples of what is drawn lie, as [`spanned`](Self::spanned) counts, and the span that they are of it; they end
    /// with that recording.
    pub(super) fn span_of(
        &self,
        samples: &Range<usize>,
        held_out: bool,
    ) -> Option<(usize, [f64; 2])> {
        let last = self.fitted.sources.len() - 1;
        let (loaded, data, first, before) = match (held_out, &self.held_out) {
            (true, Some(other)) => (other, &*other.data, 0, last + 1),
            // Of several the last judges, where no other one does.
            (true, None) => (&self.fitted, self.judge()?, last, 0),
            (false, _) => (&self.fitted, self.shown(), 0, 0),
        };
        let mut ranges = data.recordings.ranges().enumerate();
        let (place, range) = ranges.find(|(_, range)| range.contains(&samples.start))?;
        let place = first + place;
        // What is drawn may be a span already.
        let begin = loaded
            .sources
            .get(place)?
            .span_s
            .map_or(0.0, |span| span[0]);
        let since = |k: usize| begin + data.time_s[k] - data.time_s[range.start];
        let end = samples.end.clamp(samples.start + 1, range.end) - 1;
        Some((before + place, [since(samples.start), since(end)]))
    }

    /// Whether they are the same ones, in the same roles.
    pub(super) fn are(&self, other: &Recordings) -> bool {
        self.stamp == other.stamp
    }

    /// What is fitted and what is held out: the other recordings, or a part of the fitted ones where they are long enough.
    pub(super) fn parts(&self) -> (&Data, &Data) {
        if let Some(other) = &self.held_out {
            return (&self.fitted.data, &other.data);
        }
        match self.fitted.cut() {
            Some(cut) => (&cut.fitted, &cut.held_out),
            None => (&self.fitted.data, &self.fitted.data),
        }
    }

    /// By which errors models are judged. Finding it takes about as long as a fit of the linear motor.
    pub(super) fn criterion(&self) -> &Criterion {
        self.criterion.get_or_init(|| {
            let (data, held_out) = self.parts();
            let never = AtomicBool::new(false);
            let options = options(&self.fitted, &[]);
            Criterion::of(data, held_out, &options, &Budget::usual(&never))
        })
    }

    /// The same, if it is known already.
    pub(super) fn criterion_if_known(&self) -> Option<&Criterion> {
        self.criterion.get()
    }

    /// Options of a fit of a model with these effects, over the span in which it will be judged.
    pub(super) fn options(&self, effects: &[Kind]) -> Options {
        Options {
            window_s: self.criterion().span.window_s,
            ..options(&self.fitted, effects)
        }
    }

    /// What is drawn: all that is fitted, and the end of the only recording, which may be held out.
    pub(super) fn shown(&self) -> &Data {
        match self.kind() {
            HeldOut::Recording(_) => self.parts().0,
            HeldOut::End { .. } | HeldOut::Nothing => &self.fitted.data,
        }
    }

    /// The recordings that are never fitted, where these are recordings of their own.
    pub(super) fn judge(&self) -> Option<&Data> {
        self.kind().source().map(|_| self.parts().1)
    }

    /// What is held out, in the words of a diagnosis.
    pub(super) fn kind(&self) -> HeldOut {
        if let Some(other) = &self.held_out {
            return HeldOut::Recording(other.data.source.clone());
        }
        self.fitted
            .cut()
            .map_or(HeldOut::Nothing, |cut| cut.kind.clone())
    }

    /// Where the held-out end of the only recording begins, s.
    pub(super) fn held_out_from(&self) -> Option<f64> {
        if self.held_out.is_some() {
            return None;
        }
        match self.fitted.cut()?.kind {
            HeldOut::End { from_s, .. } => Some(from_s),
            _ => None,
        }
    }
}

impl Model {
    /// A fitted model, not yet numbered.
    pub(super) fn new(
        effects: Vec<Kind>,
        fit: Fit,
        predicted: Option<f64>,
        parent: Option<usize>,
        recordings: &Recordings,
    ) -> Result<Self, Error> {
        let (data, held_out) = recordings.parts();
        let criterion = recordings.criterion();
        let judged = criterion.errors(data, held_out, &fit)?;
        let white = match criterion.span.window_s {
            Some(_) => None,
            None => whiteness(data, &whole(data, &fit.candidate, fit.method)?),
        };
        let drawn = |&kind: &Kind| Some((kind, signature(data, &fit.candidate, kind, fit.method)?));
        let signatures = Arc::new(effects.iter().filter_map(drawn).collect());
        Ok(Model {
            id: 0,
            effects,
            fit: Arc::new(fit),
            predicted,
            judged,
            parent,
            white: white.map(|found| found.is_white()),
            signatures,
            stamp: stamp(),
        })
    }

    /// A model that was kept, with its errors and intervals found again.
    pub(super) fn again(
        id: usize,
        saved: &schema::Model,
        algorithm: &str,
        recordings: &Recordings,
    ) -> Result<Self, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Failed(error.to_string());
        let candidate = saved
            .candidate("models[].model")
            .map_err(|fault| failed(&fault))?;
        let effects: Vec<Kind> = candidate.effects.iter().map(|(kind, _)| kind).collect();
        let options = Options {
            method: saved.method(),
            ..recordings.options(&effects)
        };
        let (data, held_out) = recordings.parts();
        let mut problem = fit::problem(data, &options)?;
        problem.structure = servoid_engine::problem::Structure::around(
            data,
            fit::base_for(data, &effects),
            &effects,
            &candidate.machine,
            candidate.start_speed != 0.0,
        );
        let x = problem.structure.point(&candidate);
        let found = Found {
            cost: servoid_engine::solve::Objective::cost(&problem, &x),
            x,
            evaluations: 0,
            curve: Vec::new(),
            interrupted: false,
        };
        let mut fit = Fit::conclude(&problem, algorithm, "squared", &found, &options, None)?;
        // Through coordinates and back, a number keeps all but its last bits, which a chaotic run does not forgive.
        fit.candidate = candidate;
        let own = whole(data, &candidate, options.method)?;
        let other = validation_errors(held_out, &candidate, options.method)?;
        fit.rms_counts = rms_counts(data, &own);
        fit.validate_rms_counts = Some(rms_counts(held_out, &other));
        Ok(Model {
            id,
            ..Model::new(effects, fit, None, None, recordings)?
        })
    }

    /// As `servoid.fit/1`.
    pub(super) fn json(&self, recordings: &Recordings) -> Result<Value, Error> {
        let kind = recordings.kind();
        let json = schema::Fit::new(&self.fit, recordings.shown(), kind.source());
        serde_json::to_value(json).map_err(|error| Error::Failed(error.to_string()))
    }

    /// What is exported of it.
    pub(super) fn subject(&self, recordings: &Recordings) -> Result<Subject, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Failed(error.to_string());
        let text = self.json(recordings)?.to_string();
        let result = Identified::parse(&text).map_err(|error| failed(&error))?;
        Subject::new(&result, "the workbench", Side::Motor).map_err(|error| failed(&error))
    }

    /// What it is called: its effects, and its method unless that is the usual one.
    pub(super) fn name(&self) -> String {
        let names: Vec<&str> = self.effects.iter().map(|kind| kind.name()).collect();
        let name = if names.is_empty() {
            "linear motor".to_owned()
        } else {
            format!("motor with {}", names.join(", "))
        };
        match self.fit.algorithm.as_str() {
            USUAL => name,
            other => format!("{name} (by {other})"),
        }
    }

    /// Whether it leaves more than the readings' own error.
    pub(super) fn leaves_something(&self) -> bool {
        !self.judged.at_floor()
    }

    /// The error on what was not fitted, if anything was not, counts.
    pub(super) fn held_out_rms_counts(&self) -> Option<f64> {
        self.fit.validate_rms_counts.map(|_| self.judged.held_out)
    }

    /// Whether it explains the recordings: at the floor of the readings, and with an error that is noise.
    pub(super) fn explains(&self) -> bool {
        !self.leaves_something() && self.white != Some(false)
    }
}

/// Options of work on the bench, of which nothing but the effects and what is known of the motor is said.
pub(super) fn options(loaded: &Loaded, effects: &[Kind]) -> Options {
    Options {
        effects: effects.to_vec(),
        known: loaded.known.clone(),
        ..Options::default()
    }
}
