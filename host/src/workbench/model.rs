//! A fitted model on the bench.

use super::loaded::Loaded;
use crate::error::Error;
use serde_json::Value;
use servoid_engine::problem::Data;
use servoid_engine::problem::rms_counts;
use servoid_engine::solve::Found;
use servoid_identify::diagnose::HeldOut;
use servoid_identify::fit::scores::whole;
use servoid_identify::fit::{self, Fit, Options, validation_errors};
use servoid_results::schema;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::sync::Arc;

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
}

/// Recordings of one piece of work.
#[derive(Clone)]
pub(super) struct Recordings {
    /// The fitted ones, whole.
    pub(super) fitted: Arc<Loaded>,
    /// Others, never fitted.
    pub(super) held_out: Option<Arc<Loaded>>,
}

impl Recordings {
    /// Whether they are the same ones.
    pub(super) fn are(&self, other: &Recordings) -> bool {
        let held_out = match (&self.held_out, &other.held_out) {
            (None, None) => true,
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        };
        held_out && Arc::ptr_eq(&self.fitted, &other.fitted)
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

    /// What is drawn: all that is fitted, and the end of the only recording, which may be held out.
    pub(super) fn shown(&self) -> &Data {
        match self.kind() {
            HeldOut::Recording(_) => self.parts().0,
            HeldOut::End { .. } | HeldOut::Nothing => &self.fitted.data,
        }
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
            ..options(&recordings.fitted, &effects, 1)
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
            effects,
            fit: Arc::new(fit),
            predicted: None,
        })
    }

    /// As `servoid.fit/1`.
    pub(super) fn json(&self, recordings: &Recordings) -> Result<Value, Error> {
        let kind = recordings.kind();
        let json = schema::Fit::new(&self.fit, recordings.shown(), kind.source());
        serde_json::to_value(json).map_err(|error| Error::Failed(error.to_string()))
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

    /// Whether it leaves more than the encoder's own error.
    pub(super) fn leaves_something(&self) -> bool {
        self.fit.rms_counts > 1.15 * FLOOR_RMS_COUNTS
    }
}

/// Options of a fit on the bench.
pub(super) fn options(loaded: &Loaded, effects: &[Kind], seed: u64) -> Options {
    Options {
        effects: effects.to_vec(),
        known: loaded.known.clone(),
        seed,
        ..Options::default()
    }
}
