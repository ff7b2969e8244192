//! The laws that have been stated in this process. An effect is known by a reference that lives as long as the process, so a law
//! that was stated once stays.

use crate::amplitude::amplitudes;
use crate::compile::compile;
use crate::definition::Definition;
use crate::fault::Fault;
use shared::effects::formula::{Formula, Op, Output};
use shared::effects::{Description, Facts, Kind, Parameter, Place};
use shared::units::Quantity;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A law and what it was compiled to.
#[derive(Debug)]
pub struct Law {
    /// As it was stated.
    pub definition: Definition,
    /// As it runs.
    pub formula: Formula,
}

static LAWS: Mutex<Vec<&'static Law>> = Mutex::new(Vec::new());

/// Most laws of one process: each stays in memory.
const MOST: usize = 100_000;

fn laws() -> MutexGuard<'static, Vec<&'static Law>> {
    LAWS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Law {
    /// The law as a static of Rust, for a program that states it when it is built, such as firmware.
    pub fn rust(&self) -> String {
        let program = &self.formula.program;
        let description = &self.formula.description;
        let ops = |ops: &[Op]| {
            let ops: Vec<String> = ops.iter().map(op).collect();
            format!("&[{}]", ops.join(", "))
        };
        let constants: Vec<String> = program.constants.iter().map(|one| ops(one)).collect();
        let states: Vec<String> = (program.states.iter())
            .map(|state| {
                let (rate, range) = (ops(state.rate), state.range);
                format!("State {{ rate: {rate}, range: {range:?} }}")
            })
            .collect();
        let parameters: Vec<String> = (description.parameters.iter())
            .map(|parameter| {
                format!(
                    "Parameter {{ name: {:?}, quantity: Quantity::Stated({:?}), range: {:?}, widest: {:?}, typical: {:?}, amplitude: {}, neutral: {:?}, form: None }}",
                    parameter.name,
                    parameter.quantity.unit(),
                    parameter.range,
                    parameter.widest,
                    parameter.typical,
                    parameter.amplitude,
                    parameter.neutral,
                )
            })
            .collect();
        format!(
            "/// `{}`\npub static {}: Formula = Formula {{\n    description: Description {{\n        name: {:?},\n        place: Place::{:?},\n        \
             title: {:?},\n        parameters: &[{}],\n        equation: {:?},\n        signature: {:?},\n        exposed_by: {:?},\n        \
             look_alikes: &[],\n        source: {:?},\n        facts: Facts {{ series_parallel: {}, ..Facts::PLAIN }},\n    }},\n    \
             program: Program {{\n        output: Output::{:?},\n        constants: &[{}],\n        law: {},\n        \
             states: &[{}],\n    }},\n}};\n",
            self.definition.text,
            self.definition.name.to_uppercase(),
            description.name,
            description.place,
            description.title,
            parameters.join(", "),
            description.equation,
            description.signature,
            description.exposed_by,
            description.source,
            description.facts.series_parallel,
            program.output,
            constants.join(", "),
            ops(program.law),
            states.join(", "),
        )
    }
}

/// An operation in Rust.
fn op(op: &Op) -> String {
    match op {
        Op::Variable(variable) => format!("Op::Variable(Variable::{variable:?})"),
        other => format!("Op::{other:?}"),
    }
}

/// The effect that a text states. The same text gives the same effect.
///
/// # Errors
/// Text that is no law, wrong units, a law that cannot be computed: with the place in the text.
pub fn define(text: &str) -> Result<Kind, Fault> {
    let text = text.trim();
    let known = laws().iter().position(|law| law.definition.text == text);
    if let Some(place) = known {
        let mut laws = laws();
        // By its name the law is meant that was stated last.
        let law = laws.remove(place);
        laws.push(law);
        return Ok(Kind::Formula(&law.formula));
    }
    let definition = Definition::parse(text)?;
    if Kind::by_name(&definition.name).is_some() {
        let what = format!(
            "`{}` is an effect of the catalogue; take another name",
            definition.name
        );
        return Err(Fault::new(text, 0, what));
    }
    let program = compile(&definition).map_err(|(at, what)| Fault::new(text, at, what))?;
    if laws().len() >= MOST {
        return Err(Fault::new(
            text,
            0,
            format!("more than {MOST} laws in one process"),
        ));
    }
    let description = describe(&definition);
    let law: &'static Law = Box::leak(Box::new(Law {
        formula: Formula {
            description,
            program,
        },
        definition,
    }));
    laws().push(law);
    Ok(Kind::Formula(&law.formula))
}

/// The effect of this name: of the catalogue, or a law that was stated.
pub fn by_name(name: &str) -> Option<Kind> {
    let stated = || {
        let laws = laws();
        let law = laws.iter().rev().find(|law| law.definition.name == name);
        law.map(|law| Kind::Formula(&law.formula))
    };
    Kind::by_name(name).or_else(stated)
}

/// The law behind an effect, if it was stated.
pub fn law_of(kind: Kind) -> Option<&'static Law> {
    let Kind::Formula(formula) = kind else {
        return None;
    };
    let laws = laws();
    laws.iter().find(|law| law.formula == *formula).copied()
}

/// The text that states an effect, if it is none of the catalogue.
pub fn text_of(kind: Kind) -> Option<&'static str> {
    match kind {
        Kind::Formula(formula) => Some(formula.description.equation),
        _ => None,
    }
}

fn describe(definition: &Definition) -> Description {
    let leaked = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
    let amplitudes = amplitudes(definition);
    let parameters: Vec<Parameter> = (definition.parameters.iter().zip(amplitudes))
        .map(|(parameter, amplitude)| Parameter {
            name: leaked(&parameter.name),
            quantity: Quantity::Stated(leaked(&parameter.unit)),
            range: parameter.range,
            widest: parameter.range.1,
            typical: parameter.start,
            amplitude,
            neutral: amplitude.then_some(0.0),
            form: None,
        })
        .collect();
    Description {
        name: leaked(&definition.name),
        place: match definition.output {
            Output::Torque | Output::TorqueConstant | Output::Inertia => Place::Torque,
            Output::Friction => Place::Friction,
            Output::Voltage => Place::Drive,
            Output::Angle => Place::Sensed,
        },
        title: "law as stated",
        parameters: Box::leak(parameters.into_boxed_slice()),
        equation: leaked(&definition.text),
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: definition.states.is_empty(),
            ..Facts::PLAIN
        },
    }
}
