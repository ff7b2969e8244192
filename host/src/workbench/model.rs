//! A fitted model on the bench.

use super::recordings::{Recordings, stamp};
use crate::error::Error;
use serde_json::Value;
use servoid_engine::problem::rms_counts;
use servoid_engine::solve::Found;
use servoid_identify::diagnose::Errors;
use servoid_identify::fit::scores::whole;
use servoid_identify::fit::{self, Fit, Options, validation_errors};
use servoid_identify::residual_analysis::{Signature, signature, whiteness};
use servoid_results::export::{Side, Subject};
use servoid_results::schema::{self, Identified};
use shared::effects::Kind;
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
            fit::base_for(data, &effects, options.window_s.is_some()),
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
