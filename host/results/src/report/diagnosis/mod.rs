//! A diagnosis as text and as a document.

pub mod bars;
mod document;
mod evidence;
mod residual;
mod steady;
mod text;
mod verdict;

pub use steady::SteadyReport;
pub(super) use text::nothing_else;

use servoid_engine::problem::Data;
use servoid_identify::Diagnosed;
use servoid_identify::Findings;
use servoid_identify::diagnose::advice::cannot_tell;
use servoid_identify::diagnose::{Diagnosis, FittedModel, HeldOut, Remark, Step, Verdict};
use servoid_identify::discovery::Proposed;
use servoid_identify::fit::{Fit, RecordingError};
use servoid_identify::plan::Hypothesis;
use servoid_io::recording::Drive;
use servoid_plant::Machine;
use shared::effects::Kind;
use std::path::Path;

/// A diagnosis with everything that its report states.
pub struct DiagnosisReport<'a> {
    /// The fitted recording.
    pub data: &'a Data,
    /// What was held out.
    pub held_out: &'a HeldOut,
    /// The diagnosis.
    pub diagnosis: &'a Diagnosis,
    /// Its last model, fitted to its end.
    pub last: &'a Fit,
    /// Where the models fail.
    pub findings: &'a Findings,
    /// What a user should know about the two recordings.
    pub remarks: Vec<Remark>,
    /// The error of the last model on each recording, where there are several.
    pub recordings: &'a [RecordingError],
    /// Laws that were proposed for what the catalogue leaves, if they were looked for.
    pub proposed: Option<&'a [Proposed]>,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether the user stopped the work.
    pub interrupted: bool,
    /// Where the JSON goes, if it goes to a file: what a plan is made from.
    pub json: Option<&'a Path>,
}

/// A model that explains the recording: the chosen one, or one with a look-alike in some place.
struct Role<'a> {
    name: &'static str,
    model: &'a FittedModel,
}

impl<'a> DiagnosisReport<'a> {
    /// What was found in the `data` that were fitted. `json` is the file that the result goes to, if any.
    pub fn new(
        found: &'a Diagnosed,
        data: &'a Data,
        held_out: &'a HeldOut,
        seed: u64,
        json: Option<&'a Path>,
    ) -> Self {
        DiagnosisReport {
            data,
            held_out,
            diagnosis: &found.diagnosis,
            last: &found.last,
            findings: &found.findings,
            remarks: found.remarks.clone(),
            recordings: &found.recordings,
            proposed: found.proposed.as_deref(),
            seed,
            interrupted: found.interrupted,
            json,
        }
    }
}

impl DiagnosisReport<'_> {
    /// The chosen model and one for each look-alike, except those that only refine it: they can do whatever it
    /// does, so that no recording could speak against them.
    fn models(&self) -> Vec<Role<'_>> {
        let last = &self.diagnosis.last;
        let mut models = vec![Role {
            name: "chosen",
            model: last,
        }];
        for step in &self.diagnosis.steps {
            for kind in self.look_alikes(step) {
                models.extend(self.alternative(step.added, kind).map(|model| Role {
                    name: "alternative",
                    model,
                }));
            }
        }
        models
    }

    /// Effects that explain these data as well as the one that was added, and are no refinements of it.
    fn look_alikes(&self, step: &Step) -> Vec<Kind> {
        let alike = step.indistinguishable_from.iter().copied();
        alike.filter(|&kind| !refines(kind, step.added)).collect()
    }

    /// Effects that can become the one that was added, by some parameters at rest, and bring nothing more.
    fn refinements(&self, step: &Step) -> Vec<Kind> {
        let alike = step.indistinguishable_from.iter().copied();
        alike.filter(|&kind| refines(kind, step.added)).collect()
    }

    /// The best model with `instead` in the place of `added`: beside all the other effects if there is one, else
    /// of the step.
    fn alternative(&self, added: Kind, instead: Kind) -> Option<&FittedModel> {
        let last = &self.diagnosis.last.effects;
        let swapped = |model: &&FittedModel| {
            model.effects.len() == last.len()
                && model.effects.contains(&instead)
                && last
                    .iter()
                    .all(|&kind| kind == added || model.effects.contains(&kind))
        };
        let step = self.diagnosis.steps.iter().find(|s| s.added == added)?;
        let in_step = |model: &&FittedModel| model.effects.last() == Some(&instead);
        let score = |model: &&FittedModel| model.judged().score();
        (self.diagnosis.rivals.iter().filter(swapped))
            .min_by(|a, b| score(a).total_cmp(&score(b)))
            .or_else(|| step.candidates.iter().find(in_step))
    }

    /// Whether a further recording can separate what this one cannot.
    fn can_plan(&self) -> bool {
        self.data.drive == Drive::Voltage && self.models().len() > 1
    }

    /// The command that plans the next recording.
    fn next_command(&self) -> Option<String> {
        let file = self.json.map(|path| path.display().to_string());
        let file = file.unwrap_or_else(|| "diagnosis.json".to_owned());
        self.can_plan()
            .then(|| format!("servoid simulate --plan --after {file} --out next.csv"))
    }

    /// What to do next.
    fn advice(&self) -> Vec<String> {
        let mut advice = self.diagnosis.advice.clone();
        if self.diagnosis.ran_out {
            advice.push(format!(
                "the work ran out after {} million steps of a model, before all was tried that speaks for or against \
                 these effects: run it again with a larger --budget",
                self.diagnosis.steps_taken / 1_000_000
            ));
        }
        if let Some(command) = self.next_command() {
            advice.push(match self.json {
                Some(_) => format!("to plan the recording that separates them: {command}"),
                None => format!(
                    "to plan the recording that separates them, write this diagnosis with --json diagnosis.json, \
                     then: {command}"
                ),
            });
        }
        advice
    }

    /// What these recordings cannot tell, whatever the verdict.
    fn cannot_tell(&self) -> Vec<String> {
        let knows_torque = self.last.parameters.iter().any(|p| p.name == "kt");
        cannot_tell(self.data, self.held_out, knows_torque)
    }

    /// Titles of the effects that were added; `None` for none.
    pub fn names(&self) -> Option<String> {
        (!self.diagnosis.steps.is_empty()).then(|| self.titles())
    }

    /// The fault of the recordings by which any model must fail, where they are not explained; the one that was found
    /// last, with models at hand, says most.
    fn cause(&self) -> Option<&Remark> {
        let unexplained = self.verdict() == Verdict::Unexplained;
        self.remarks
            .iter()
            .rfind(|remark| unexplained && remark.spoils())
    }

    /// The verdict: what was stopped has not said its last word.
    fn verdict(&self) -> Verdict {
        match self.diagnosis.verdict {
            Verdict::Unexplained if self.interrupted || self.diagnosis.ran_out => {
                Verdict::Inconclusive
            }
            verdict => verdict,
        }
    }
}

/// Whether `general` can become `special` by its parameters alone.
fn refines(general: Kind, special: Kind) -> bool {
    let alone = |kind: Kind| Hypothesis::typical(kind, &Machine::gearmotor());
    alone(general).contains(&alone(special))
}

/// Names, as in a sentence.
fn names(kinds: &[Kind]) -> Vec<&'static str> {
    kinds.iter().map(|kind| kind.name()).collect()
}
