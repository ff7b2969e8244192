//! Errors that no standard error knows: what a parameter changes by if the recording is not what it says it is.
//!
//! A standard error is about readings that scatter. A latency that was not logged, a voltage scale that is off and an encoder whose
//! edges are displaced shift every repetition alike. Each makes a change of the residuals, `dr`, and the parameters follow it by one
//! Gauss-Newton step, `dp = −(JᵀJ)⁻¹·Jᵀ·dr`. (Evaluation of type B in the words of the GUM, JCGM 100:2008, §4.3.)

use super::options::Options;
use super::parameter::{Parameter, parameters};
use super::report::{Solved, reconciled};
use super::sensitivity::{Redraw, Sensitivity, sensitivities};
use super::uncertainty::{Uncertainty, step};
use servoid_engine::problem::{Candidate, Data, FitProblem};
use shared::effects::{EffectSet, Kind};
use shared::error::ModelError;
use shared::motor::Machine;
use shared::units::{PerUnit, Quantity};
use std::f64::consts::TAU;

/// Edges of one period of a quadrature encoder.
const QUADRATURE: f64 = 4.0;

/// Changes below this part of the value are rounding errors.
const ROUNDING: f64 = 1e-12;

/// What may be wrong with a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// The command acts later than the log says, s.
    Latency,
    /// Edges of the encoder are displaced: each of the four of a quadrature period by itself, and all along a turn as by a disc that
    /// is off its centre; RMS of each of the two, counts.
    EncoderEdges,
    /// The command is larger than the log says, relative.
    CommandScale,
}

impl Cause {
    /// All of them.
    pub const ALL: [Cause; 3] = [Cause::Latency, Cause::EncoderEdges, Cause::CommandScale];

    /// The size for which the changes are stated: what an ordinary bench has without anybody's notice.
    pub fn size(self) -> f64 {
        match self {
            Cause::Latency => 10e-6,
            Cause::EncoderEdges => 0.1,
            Cause::CommandScale => 0.01,
        }
    }

    /// Unit of the size.
    pub fn unit(self) -> &'static str {
        match self {
            Cause::Latency => "s",
            Cause::EncoderEdges => "count",
            Cause::CommandScale => "1",
        }
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Cause::Latency => "latency",
            Cause::EncoderEdges => "encoder_edges",
            Cause::CommandScale => "command_scale",
        }
    }
}

/// By how much a parameter changes if something is wrong with the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Systematic {
    /// What is wrong.
    pub cause: Cause,
    /// Change of the parameter for the cause's [size](Cause::size), in the parameter's unit; without a sign where the cause has
    /// several parts that depend on their squares.
    pub change: f64,
}

/// Says of each parameter of a fit by how much it would change.
pub(crate) fn add_systematic(
    found: &mut [Parameter],
    problem: &FitProblem<'_>,
    solved: &Solved,
    options: &Options,
) {
    let Some(spread) = solved.uncertainty.as_ref().filter(|s| s.converged) else {
        return;
    };
    for cause in Cause::ALL {
        let changed = match cause {
            Cause::CommandScale => rescaled(problem, solved).into_iter().collect(),
            _ => followed(
                problem,
                solved,
                spread,
                &residual_changes(cause, problem, solved),
            ),
        };
        if changed.is_empty() {
            continue;
        }
        let data = match cause {
            Cause::CommandScale => &larger(problem.data),
            _ => problem.data,
        };
        let changed: Vec<Vec<Parameter>> = (changed.iter())
            .map(|values| stated(cause, problem, data, values, spread, options))
            .collect();
        let determined = |p: &&mut Parameter| p.std.is_some_and(|std| std > 0.0);
        for parameter in found.iter_mut().filter(determined) {
            let same = |p: &&Parameter| p.name == parameter.name && p.unit == parameter.unit;
            let changes: Option<Vec<f64>> = (changed.iter())
                .map(|there| Some(there.iter().find(same)?.value - parameter.value))
                .collect();
            let change = match changes.as_deref() {
                Some([one]) => *one,
                Some(parts) => parts.iter().map(|part| part * part).sum::<f64>().sqrt(),
                None => continue,
            };
            // Nothing but rounding is nothing.
            let change = if change.abs() < ROUNDING * parameter.value.abs() {
                0.0
            } else {
                change
            };
            if change.is_finite() {
                parameter.systematic.push(Systematic { cause, change });
            }
        }
    }
}

/// The parameters that these values of the unknowns give, with the cause.
fn stated(
    cause: Cause,
    problem: &FitProblem<'_>,
    data: &Data,
    values: &[f64],
    spread: &Uncertainty,
    options: &Options,
) -> Vec<Parameter> {
    let start = problem.structure.coordinates(values);
    let problem = FitProblem {
        data,
        ..problem.with_structure(problem.structure.clone(), start)
    };
    let mut candidate = problem.structure.candidate(values);
    // The current is late as well.
    if let (Cause::Latency, Some(late)) = (cause, behind_latency(&candidate)) {
        candidate = late;
    }
    let physical = reconciled(&problem, &candidate, Some(spread), options);
    let spread = Some(spread);
    parameters(&problem, values, spread, physical.as_ref(), &mut Vec::new())
}

/// The unknowns' values with a command that is larger: torques and voltages grow with it. `None` behind a position loop, whose
/// target has no scale that could be wrong.
fn rescaled(problem: &FitProblem<'_>, solved: &Solved) -> Option<Vec<f64>> {
    let (data, structure) = (problem.data, &problem.structure);
    if data.recordings.loops().next().is_some() {
        return None;
    }
    let units = larger_units(data).ok()?;
    let mut model = structure.candidate(&solved.values);
    let scale =
        |value: f64, quantity: Quantity| value / data.units.base(quantity) * units.base(quantity);
    let Machine {
        kb,
        damping,
        inertia,
        electrical,
    } = model.machine;
    model.machine = Machine {
        kb: scale(kb, Quantity::Damping),
        damping: scale(damping, Quantity::Damping),
        inertia: scale(inertia, Quantity::Inertia),
        electrical,
    };
    let mut effects = EffectSet::default();
    for (kind, values) in model.effects.iter() {
        let parameters = values.iter().zip(kind.parameters());
        let values: Vec<f64> = parameters.map(|(v, p)| scale(*v, p.quantity)).collect();
        effects.push(kind, &values).ok()?;
    }
    model.effects = effects;
    Some(structure.values_in(&model))
}

fn larger_units(data: &Data) -> Result<PerUnit<f64>, ModelError> {
    let PerUnit {
        volts,
        speed,
        interval,
        counts_per_rev,
        ..
    } = data.units;
    let factor = 1.0 + Cause::CommandScale.size();
    PerUnit::new(volts * factor, speed, interval, counts_per_rev)
}

/// The recording with a command that is larger.
fn larger(data: &Data) -> Data {
    let mut larger = data.clone();
    for command in &mut larger.command {
        *command *= 1.0 + Cause::CommandScale.size();
    }
    larger
}

/// The unknowns' values after each of these changes of the residuals. What the data do not determine stays as it is, and so does what
/// would leave its search range: a nearly flat direction leads far beyond where anything is straight.
fn followed(
    problem: &FitProblem<'_>,
    solved: &Solved,
    spread: &Uncertainty,
    changes: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let values = &solved.values;
    let unknowns = &problem.structure.unknowns;
    let undetermined: Vec<bool> = (unknowns.iter().zip(values).enumerate())
        .map(|(k, (unknown, value))| spread.std(k).is_none() || unknown.ends_at(*value))
        .collect();
    let x = problem.structure.coordinates(values);
    let series: Vec<&[f64]> = changes.iter().map(Vec::as_slice).collect();
    let sums = sensitivities(problem, values, &series, Redraw::default()).unwrap_or_default();
    let moved = |sums: &Sensitivity| {
        let mut held = undetermined.clone();
        loop {
            let step = step(sums, &x, &held);
            let moved: Vec<f64> = values.iter().zip(step.iter()).map(|(v, s)| v + s).collect();
            let leaves = |k: &usize| {
                let (low, high) = unknowns[*k].range;
                !held[*k] && !(low..=high).contains(&moved[*k])
            };
            match (0..moved.len()).find(leaves) {
                Some(k) => held[k] = true,
                None => return moved,
            }
        }
    };
    sums.iter().map(moved).collect()
}

/// What the residuals of the true recording have more than those of the one that was fitted, counts, one series for each part of
/// the cause; none where it does not apply.
fn residual_changes(cause: Cause, problem: &FitProblem<'_>, solved: &Solved) -> Vec<Vec<f64>> {
    match cause {
        Cause::Latency => late(problem, &solved.values).into_iter().collect(),
        Cause::EncoderEdges if problem.data.quantised => edges(problem.data),
        Cause::EncoderEdges | Cause::CommandScale => Vec::new(),
    }
}

/// Of a model behind a latency.
fn late(problem: &FitProblem<'_>, values: &[f64]) -> Option<Vec<f64>> {
    let here = problem.structure.candidate(values);
    let late = problem.errors(&behind_latency(&here)?).ok()?;
    let here = problem.errors(&here).ok()?;
    Some(
        late.iter()
            .zip(&here)
            .map(|(late, here)| late - here)
            .collect(),
    )
}

/// `None` where the model has a delay of its own, which is then fitted.
fn behind_latency(model: &Candidate) -> Option<Candidate> {
    if model.effects.iter().any(|(kind, _)| kind == Kind::Delay) {
        return None;
    }
    let mut late = *model;
    let size = Cause::Latency.size();
    (late.effects.push(Kind::Delay, &[size]).ok()).map(|()| late)
}

/// Displacements of the encoder's edges, counts: waves along the angle, orthogonal, each so large that those of a quadrature period
/// and those of a turn have the cause's RMS.
fn edges(data: &Data) -> Vec<Vec<f64>> {
    let size = Cause::EncoderEdges.size();
    let wave = |period: f64, rms: f64, phase: f64| -> Vec<f64> {
        // The wave of two edges takes but two values.
        let peak = if period > 2.0 { 2f64.sqrt() * rms } else { rms };
        let at = |count: &f64| peak * libm::cos(TAU * count / period + phase);
        data.counts.iter().map(at).collect()
    };
    let turn = data.units.counts_per_rev;
    let (third, half) = (size / 3f64.sqrt(), size / 2f64.sqrt());
    let quarter = -0.25 * TAU;
    vec![
        wave(QUADRATURE, third, 0.0),
        wave(QUADRATURE, third, quarter),
        wave(0.5 * QUADRATURE, third, 0.0),
        wave(turn, half, 0.0),
        wave(turn, half, quarter),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Silent, identify};
    use servoid_io::record::Record;
    use servoid_io::recording::Recording;
    use servoid_io::{excitation, showcase};
    use servoid_plant::{Bench, Hidden};

    fn fitted(recording: &Recording) -> Vec<Parameter> {
        let options = Options {
            effects: vec![Kind::Coulomb],
            ..Options::default()
        };
        let fit = identify(recording, &options, &Silent::default()).unwrap();
        fit.parameters
    }

    /// Of a gearmotor with friction.
    fn recorded(latency: Option<f64>, with_current: bool) -> Recording {
        let mut bench = Bench::new(showcase::machine());
        bench.effects = vec![Hidden::typical("coulomb", &bench.machine).unwrap()];
        let delay = |time| Hidden::parse(&format!("delay:time={time}"), &bench.machine).unwrap();
        bench.effects.extend(latency.map(delay));
        let usual = excitation::named("commissioning").unwrap();
        let plan = excitation::stretched(&usual, 20.0, 1.0);
        let drive = excitation::drive(&plan, 1e-3, 1, bench.machine.supply_v);
        bench.record(&drive, "bench", with_current).unwrap()
    }

    /// What a fit of the recording with the error moves by is what is stated of it; also where viscous friction is not determined.
    #[test]
    fn fits_of_recordings_with_these_errors_move_as_stated() {
        for with_current in [true, false] {
            let right = recorded(None, with_current);
            let late = recorded(Some(Cause::Latency.size()), with_current);
            let mut weaker = right.clone();
            for command in &mut weaker.command {
                *command /= 1.0 + Cause::CommandScale.size();
            }
            let right = fitted(&right);
            for (cause, wrong) in [(Cause::Latency, late), (Cause::CommandScale, weaker)] {
                let compared = compare(cause, &right, &fitted(&wrong));
                assert!(compared >= 4, "{cause:?}, {with_current}: {compared}");
            }
        }
    }

    /// How many parameters were compared.
    fn compare(cause: Cause, right: &[Parameter], wrong: &[Parameter]) -> usize {
        let mut compared = 0;
        for wrong in wrong {
            let right = right.iter().find(|p| p.name == wrong.name).unwrap();
            let own = wrong.systematic.iter().find(|s| s.cause == cause);
            let (Some(own), Some(std)) = (own, wrong.std) else {
                continue;
            };
            let back = right.value - wrong.value;
            compared += 1;
            assert!(
                (back - own.change).abs() < 0.05 * own.change.abs() + std,
                "{cause:?} {}: {back:e}, stated {:e}, std {std:e}",
                wrong.name,
                own.change
            );
            let small = own.change.abs() < wrong.value.abs();
            assert!(small || !wrong.identifiable, "{cause:?}: {wrong:?}");
        }
        compared
    }

    #[test]
    fn displaced_edges_have_the_stated_size() {
        let data = Data::new(&recorded(None, false)).unwrap();
        let all = Data {
            counts: (0..2000).map(f64::from).collect(),
            ..data
        };
        let square = |wave: &Vec<f64>| wave.iter().map(|x| x * x).sum::<f64>() / 2000.0;
        let squares: Vec<f64> = edges(&all).iter().map(square).collect();
        for part in [&squares[..3], &squares[3..]] {
            let rms = part.iter().sum::<f64>().sqrt();
            assert!((rms - Cause::EncoderEdges.size()).abs() < 1e-9, "{rms}");
        }
    }
}
