//! A law that is none of the catalogue: what is hidden, and what was found of it.

use super::case::Case;
use super::draws::{Draws, rounded};
use serde::{Deserialize, Serialize};
use servoid_formula::{law_of, text_of};
use servoid_identify::diagnose::FittedModel;
use servoid_identify::discovery::{Given, Proposed, departure};
use servoid_identify::truth;
use servoid_plant::{Machine, Outside, OutsideLaw, Variable};
use servoid_results::schema::ProposedLaw;
use shared::effects::formula;

/// A law from outside the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DrawnLaw {
    /// Name of its form on the bench.
    pub form: String,
    /// Its parameters, SI, as the form states them.
    pub values: Vec<f64>,
}

/// What a diagnosis found of a law, or where none is hidden, what it took for one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundLaw {
    /// Laws that it names, as their texts.
    pub named: Vec<String>,
    /// Whether these depend on what the hidden law depends on, and on nothing else.
    pub right_variables: bool,
    /// RMS of the difference of all effects that it names from the hidden law along the held-out recording, as a part of the law, beside
    /// what a linear motor gives.
    pub departure: Option<f64>,
    /// Every law that was proposed for what the catalogue leaves, and whether it was named.
    #[serde(default)]
    pub proposed: Vec<ProposedLaw>,
}

impl DrawnLaw {
    /// The form of case `number`, all equally often, with parameters that are typical on a machine.
    pub fn draw(number: u64, machine: &Machine, draws: &mut Draws) -> Option<DrawnLaw> {
        let form = Outside::ALL.get((number % Outside::ALL.len() as u64) as usize)?;
        let law = form.draw(machine, draws.seed());
        Some(DrawnLaw {
            form: law.name().to_owned(),
            values: law.values().iter().map(|&value| rounded(value)).collect(),
        })
    }

    /// The law on the bench; `None` where this program has no such form.
    pub fn hidden(&self, machine: &Machine) -> Option<OutsideLaw> {
        Outside::find(&self.form)?.with(machine, self.values.clone())
    }
}

impl FoundLaw {
    /// Of a case, the last model of its diagnosis and the laws that were proposed.
    pub fn of(case: &Case, model: &FittedModel, proposed: &[Proposed]) -> FoundLaw {
        let laws = model
            .effects
            .iter()
            .filter(|kind| text_of(**kind).is_some());
        let laws: Vec<_> = laws.copied().collect();
        let machine = case.drawn.motor.machine;
        let hidden = case.drawn.law.as_ref();
        let hidden = hidden.and_then(|law| law.hidden(&machine));
        let mut depends_on: Vec<Variable> = laws
            .iter()
            .filter_map(|kind| law_of(*kind))
            .flat_map(|law| law.definition.uses())
            .map(variable)
            .collect();
        depends_on.sort_unstable();
        depends_on.dedup();
        let off = hidden.as_ref().and_then(|hidden| {
            let (bench, drive) = case.drawn.bench(1).ok()?;
            let run = bench.run(&drive).ok()?;
            let given = hidden.along(&machine, &run).into_iter();
            let known: Given = given.map(|given| (given.torque, given.voltage)).collect();
            let beside = truth::model(&machine, &bench.effects, bench.counts_per_rev).ok()?;
            departure(&case.held_out, &model.candidate, &known, &beside)
        });
        FoundLaw {
            named: laws
                .iter()
                .filter_map(|kind| text_of(*kind))
                .map(str::to_owned)
                .collect(),
            right_variables: hidden.is_some_and(|hidden| hidden.depends_on() == depends_on),
            departure: off.map(rounded),
            proposed: proposed.iter().map(Into::into).collect(),
        }
    }
}

/// What the bench calls what a law uses.
fn variable(used: servoid_formula::Used) -> Variable {
    use servoid_formula::Used;
    match used {
        Used::Variable(formula::Variable::Speed) => Variable::Speed,
        Used::Variable(formula::Variable::Angle) => Variable::Angle,
        Used::Variable(_) => Variable::Load,
        Used::State => Variable::Memory,
    }
}
