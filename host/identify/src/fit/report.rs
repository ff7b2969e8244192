//! What a fit found, in the user's terms: parameters with errors, what stays undetermined and why.

use super::armature_current::current_evidence;
use super::bridge;
use super::interval::ReadingNoise;
use super::joint::Joint;
use super::margins::{Loop, Margins};
use super::options::Options;
use super::parameter::{Parameter, parameters};
use super::physical::{
    CONTRADICTION, Estimate, Evidence, NAMES, Reconciled, determined_by_data, reconcile,
};
use super::plausibility::contradictions;
use super::profile::Profile;
use super::recordings::RecordingError;
use super::remarks;
use super::scores::{self, Windowed};
use super::uncertainty::{Uncertainty, uncertainty};
use super::validate::validate;
use super::wave::Wave;
use crate::certificate::Certificate;
use crate::error::Error;
use crate::likelihood::Likelihood;
use crate::repeats::LackOfFit;
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::rms_counts;
use servoid_engine::problem::{Base, Candidate, Data, FitProblem, Unknown};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Found;
use servoid_io::channel::Measured;
use servoid_io::input::Known;
use servoid_io::recording::Drive;
use shared::effects::Kind;
use shared::motor::Response;

/// The error of a model with some of the effects.
#[derive(Clone, Debug, PartialEq)]
pub struct LadderEntry {
    /// The effect that was added last; `None` for the linear motor.
    pub added: Option<&'static str>,
    /// RMS error on the fitted recording, counts.
    pub rms_counts: f64,
    /// RMS error on the other recording, counts.
    pub validate_rms_counts: Option<f64>,
}

/// A fitted model and what is known of it.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Search method.
    pub algorithm: String,
    /// Its seed.
    pub seed: u64,
    /// Model evaluations.
    pub evaluations: usize,
    /// Least cost found.
    pub cost: f64,
    /// Name of the cost.
    pub cost_kind: &'static str,
    /// The model.
    pub candidate: Candidate,
    /// How it was run.
    pub method: Method,
    /// RMS of model minus measurement over the whole recording, open loop, counts.
    pub rms_counts: f64,
    /// The same on another recording.
    pub validate_rms_counts: Option<f64>,
    /// Scores of short free runs, for recordings on which the open loop drifts.
    pub windowed: Option<Windowed>,
    /// Whether the user asked for windows.
    pub window_asked: bool,
    /// Unexplained part of the drive along the measured motion, relative; see
    /// [`scores::equation_error`].
    pub equation_error: Option<f64>,
    /// Names of the effects.
    pub effects: Vec<&'static str>,
    /// Everything that was searched for, and the physical parameters that follow from it.
    pub parameters: Vec<Parameter>,
    /// What voltage and angle determine.
    pub response: Response<f64>,
    /// Margins of the position loop in radians, closed with unity feedback.
    pub margins: Option<Margins>,
    /// Whether the search ended near enough to a minimum for standard errors to mean anything.
    pub converged: bool,
    /// Samples that the recording is worth.
    pub effective_samples: f64,
    /// What a user should know about the result, in words.
    pub notes: Vec<String>,
    /// Those of the notes that are about search ranges.
    pub range_notes: Vec<String>,
    /// Best cost against evaluations.
    pub curve: Vec<(usize, f64)>,
    /// Whether the search was stopped by the user.
    pub interrupted: bool,
    /// Errors of the models that lead to this one, effect by effect; empty where nobody asked.
    pub error_ladder: Vec<LadderEntry>,
    /// The error on each recording, where there are several; only of the front door.
    pub recordings: Vec<RecordingError>,
    /// The fit with process noise, where the free run is not at the encoder's floor; only of the front door.
    pub likelihood: Option<Likelihood>,
    /// What repeats of a command say of the model, where one was recorded twice; only of the front door.
    pub lack_of_fit: Option<LackOfFit>,
    /// What is certain of the readings and this model, where it was asked for; only of the front door.
    pub certificate: Option<Certificate>,
    /// Noise before the counter, where the likelihood of the cells was maximised.
    pub reading_noise: Option<ReadingNoise>,
    /// How much worse the fit becomes as one parameter is held elsewhere; empty where nobody asked.
    pub profiles: Vec<Profile>,
    /// The unknowns with their covariance, where they have one.
    pub joint: Option<Joint>,
}

/// Where a search ended.
#[derive(Clone)]
pub(crate) struct Solved {
    /// Values of the unknowns.
    pub values: Vec<f64>,
    /// Their covariance; `None` where a model beside them cannot run.
    pub uncertainty: Option<Uncertainty>,
    /// RMS of model minus reading over the whole recording, counts.
    pub rms_counts: f64,
    /// Noise before the counter, where the likelihood of the cells was maximised.
    pub reading_noise: Option<ReadingNoise>,
}

impl Solved {
    /// The end of a search as it stands.
    ///
    /// # Errors
    /// [`Error::Failed`] where the search found no model, and where the model cannot run.
    pub fn of(problem: &FitProblem<'_>, algorithm: &str, found: &Found) -> Result<Self, Error> {
        if !found.cost.is_finite() {
            return Err(Error::Failed(format!(
                "{algorithm} found no model with a finite cost in {} evaluations",
                found.evaluations
            )));
        }
        let values = problem.structure.values(&found.x);
        let candidate = problem.structure.candidate(&values);
        let errors = scores::whole(problem.data, &candidate, problem.method)?;
        Ok(Solved {
            rms_counts: rms_counts(problem.data, &errors),
            uncertainty: uncertainty(problem, &values)?,
            reading_noise: None,
            values,
        })
    }

    /// The same with an error of each unknown besides, in its unit.
    #[must_use]
    pub fn with_error(mut self, error: &[f64]) -> Self {
        let error = DVector::from_column_slice(error);
        if let Some(uncertainty) = &mut self.uncertainty {
            uncertainty.covariance += &error * error.transpose();
        }
        self
    }
}

impl Fit {
    /// Draws conclusions from a finished search.
    pub fn conclude(
        problem: &FitProblem<'_>,
        algorithm: &str,
        cost_kind: &'static str,
        found: &Found,
        options: &Options,
        validation: Option<&Data>,
    ) -> Result<Self, Error> {
        let solved = Solved::of(problem, algorithm, found)?;
        Self::of_solved(
            problem, algorithm, cost_kind, found, options, validation, &solved,
        )
    }

    /// As [`conclude`](Self::conclude), where the unknowns' values, their covariance and the error are known.
    pub(crate) fn of_solved(
        problem: &FitProblem<'_>,
        algorithm: &str,
        cost_kind: &'static str,
        found: &Found,
        options: &Options,
        validation: Option<&Data>,
        solved: &Solved,
    ) -> Result<Self, Error> {
        let Solved {
            values,
            uncertainty: spread,
            rms_counts,
            reading_noise,
        } = solved;
        let (spread, rms_counts) = (spread.as_ref(), *rms_counts);
        let data = problem.data;
        let candidate = problem.structure.candidate(values);
        let mut notes = Vec::new();
        let reconciled = reconciled(problem, &candidate, spread, options);
        let mut parameters = parameters(problem, values, spread, reconciled.as_ref(), &mut notes);
        for contradiction in contradictions(data, &candidate) {
            for parameter in &mut parameters {
                if contradiction.parameters.contains(&parameter.name) {
                    (parameter.std, parameter.identifiable) = (None, false);
                }
            }
            notes.push(contradiction.text);
        }
        if let Some(reconciled) = &reconciled {
            describe(problem, reconciled, &options.known, &mut notes);
        }
        notes.extend(bridge::remark(&candidate, data.supply, &options.known));
        let windowed = scores::windowed(data, &candidate, options);
        let range_notes = remarks::range_notes(problem, found);
        remarks::remarks(
            problem,
            found,
            options,
            spread,
            rms_counts,
            &range_notes,
            &mut notes,
        );
        let response = candidate.machine.response();
        Ok(Fit {
            algorithm: algorithm.to_owned(),
            seed: options.seed,
            evaluations: found.evaluations,
            cost: found.cost,
            cost_kind,
            candidate,
            method: options.method,
            rms_counts,
            validate_rms_counts: validation
                .map(|data| validate(data, &candidate, options.method))
                .transpose()?,
            windowed,
            window_asked: options.window_s.is_some(),
            equation_error: scores::equation_error(data, &candidate),
            effects: problem
                .structure
                .effects
                .iter()
                .map(|kind| kind.name())
                .collect(),
            parameters,
            response,
            margins: Loop::from(&candidate.machine).margins(),
            converged: spread.is_some_and(|s| s.converged),
            effective_samples: spread.map_or(data.len() as f64, |s| s.effective_samples),
            notes,
            range_notes,
            curve: found.curve.clone(),
            interrupted: found.interrupted,
            error_ladder: Vec::new(),
            recordings: Vec::new(),
            likelihood: None,
            certificate: None,
            lack_of_fit: None,
            reading_noise: *reading_noise,
            profiles: Vec::new(),
            joint: Joint::of(problem, values, spread),
        })
    }
}

/// The physical parameters that data and known facts give together. `None` where the command is no voltage, and without errors.
pub(super) fn reconciled(
    problem: &FitProblem<'_>,
    candidate: &Candidate,
    spread: Option<&Uncertainty>,
    options: &Options,
) -> Option<Reconciled> {
    spread
        .filter(|spread| problem.data.drive == Drive::Voltage && spread.converged)
        .map(|spread| reconcile(&evidence(problem, candidate, spread), &options.known))
}

/// What the data say about the machine, by the delta method from the unknowns.
fn evidence(problem: &FitProblem<'_>, candidate: &Candidate, spread: &Uncertainty) -> Evidence {
    let values = problem.structure.values_of(&candidate.machine, &[], 0.0);
    let count = values.len().min(spread.covariance.nrows());
    let free = |(unknown, &value): (&Unknown, &f64)| !unknown.ends_at(value);
    let with_part = matches!(problem.structure.base, Base::Response { damping: true })
        && problem.structure.unknowns.iter().zip(&values).all(free)
        && !spread.flat[..count].iter().any(|&flat| flat);
    let wanted = |candidate: &Candidate| determined_by_data(&candidate.machine);
    let rows = if with_part { 4 } else { 3 };
    let mut full = values.clone();
    full.resize(problem.structure.dim(), 0.0);
    let mut slope = DMatrix::zeros(rows, count);
    for k in 0..count {
        let (low, high) = problem.structure.unknowns[k].range;
        let step = 1e-6 * values[k].abs().max(1e-3 * (high - low));
        let at = |sign: f64| {
            let mut moved = full.clone();
            moved[k] += sign * step;
            wanted(&problem.structure.candidate(&moved))
        };
        let (up, down) = (at(1.0), at(-1.0));
        for row in 0..rows {
            slope[(row, k)] = (up[row] - down[row]) / (2.0 * step);
        }
    }
    let finite = spread.finite_covariance();
    let own = finite.view((0, 0), (count, count));
    Evidence {
        machine: candidate.machine,
        covariance: &slope * own * slope.transpose(),
        current: current_evidence(problem, candidate, spread),
        unbalance_v: unbalance(problem, candidate, spread),
    }
}

/// Largest torque of an unbalance, as the voltage that holds it.
fn unbalance(
    problem: &FitProblem<'_>,
    candidate: &Candidate,
    spread: &Uncertainty,
) -> Option<Estimate> {
    let mut effects = candidate.effects.iter();
    let (_, values) = effects.find(|(kind, _)| *kind == Kind::Unbalance)?;
    let name = format!(
        "{}.{}",
        Kind::Unbalance.name(),
        Kind::Unbalance.parameters()[0].name
    );
    let mut unknowns = problem.structure.unknowns.iter();
    let cosine = unknowns.position(|unknown| unknown.name == name)?;
    Wave::new([values[0], values[1]], [cosine, cosine + 1], Some(spread))?.estimate()
}

/// Says in words what stays open and what would settle it.
fn describe(
    problem: &FitProblem<'_>,
    reconciled: &Reconciled,
    known: &Known,
    notes: &mut Vec<String>,
) {
    let missing: Vec<&str> = NAMES
        .iter()
        .zip(&reconciled.physical)
        .filter(|(_, estimate)| estimate.is_none())
        .map(|((name, _), _)| *name)
        .collect();
    if reconciled.strain > CONTRADICTION {
        notes.push(
            "the facts under [known] contradict the recording (by more than five standard errors), so \
             no physical parameter is given: check them, counts_per_rev and the voltage scale"
                .to_owned(),
        );
        return;
    }
    if known.unbalance_n_m.is_some() && !problem.structure.effects.contains(&Kind::Unbalance) {
        notes.push(
            "unbalance_n_m is known, and this model has no unbalance to which it belongs: fit --with unbalance".to_owned(),
        );
    }
    if missing.is_empty() {
        return;
    }
    let mut remedy = Vec::new();
    if known.resistance_ohm.is_none() && problem.data.measured.get(Measured::Current).is_none() {
        remedy.push("the resistance from an ohmmeter (resistance_ohm) or a current column");
    }
    if !known.kt_equals_kb && known.kt_n_m_a.is_none() {
        remedy.push("kt_equals_kb = true (in SI units, without iron losses)");
    }
    if !matches!(problem.structure.base, Base::Response { damping: true })
        && known.viscous_n_m_s.is_none()
    {
        remedy.push("a stretch of coasting with the bridge open (or viscous_n_m_s), since viscous friction and back-EMF act alike");
    }
    if known.unbalance_n_m.is_none() && problem.structure.effects.contains(&Kind::Unbalance) {
        remedy.push("the torque of the weight on the shaft (unbalance_n_m)");
    }
    if remedy.is_empty() {
        remedy.push("a known inertia or torque constant");
    }
    notes.push(format!(
        "not separable from voltage and angle: {}. What would settle it: {}",
        missing.join(", "),
        remedy.join("; ")
    ));
}
