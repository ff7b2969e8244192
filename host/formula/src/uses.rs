//! What a law depends on, and where it acts.

use crate::definition::Definition;
use crate::syntax::{Expression, PLACES, Term};
use shared::effects::formula::{Output, Variable};

/// Something that a law depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Used {
    /// A variable of the motor.
    Variable(Variable),
    /// A state.
    State,
}

impl Definition {
    /// The law's place, by the name under which it is stated.
    pub fn place(&self) -> &'static str {
        let place = PLACES.iter().find(|(_, output)| *output == self.output);
        place.map_or("", |(name, _)| name)
    }

    /// Whether the law depends on the time.
    pub fn ages(&self) -> bool {
        self.uses().contains(&Used::Variable(Variable::Time))
    }

    /// Whether the law or a state of it depends on the temperature that a recording tells.
    pub fn is_of_temperature(&self) -> bool {
        let temperature = Used::Variable(Variable::Temperature);
        let mut found = self.uses();
        let rates = self.states.iter().map(|state| &state.rate);
        rates.for_each(|rate| collect(rate, &mut found));
        found.contains(&temperature)
    }

    /// What the law depends on, each once. A friction depends on the direction of the motion.
    pub fn uses(&self) -> Vec<Used> {
        let mut found = Vec::new();
        if self.output == Output::Friction {
            found.push(Used::Variable(Variable::Speed));
        }
        collect(&self.law, &mut found);
        found
    }
}

fn collect(expression: &Expression, found: &mut Vec<Used>) {
    let mut add = |used: Used| {
        if !found.contains(&used) {
            found.push(used);
        }
    };
    match &expression.term {
        Term::Variable(variable) => add(Used::Variable(*variable)),
        Term::State(_) => add(Used::State),
        Term::Negative(a) => collect(a, found),
        Term::Call(_, arguments) => arguments.iter().for_each(|a| collect(a, found)),
        Term::Binary(_, a, b) => {
            collect(a, found);
            collect(b, found);
        }
        Term::Number(_) | Term::Parameter(_) | Term::Fixed(_) | Term::Name(_) => {}
    }
}
