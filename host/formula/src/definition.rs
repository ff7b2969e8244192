//! A law as it was stated, and what its names mean.

use crate::dimension::{self, Dimension};
use crate::fault::Fault;
use crate::syntax::{
    Expression, FUNCTIONS, MAY_BE_NAMED, PLACES, Statement, Term, VARIABLES, found, statements,
};
use shared::effects::MAX_PARAMETERS;
use shared::effects::formula::{MAX_STATES, Output, Variable};

/// A parameter of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Value from which a search starts, and with which a simulation runs.
    pub start: f64,
    /// Range of the search.
    pub range: (f64, f64),
    /// Its unit, as it was written.
    pub unit: String,
    /// The same.
    pub dimension: Dimension,
}

/// A number with a unit and a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fixed {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: String,
    pub(crate) dimension: Dimension,
}

/// A law as it was stated.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// What it gives.
    pub output: Output,
    /// How that depends on the motion.
    pub law: Expression,
    /// What it remembers: at most two numbers.
    pub states: Vec<State>,
    /// Parameters in the order in which they were stated.
    pub parameters: Vec<Parameter>,
    pub(crate) fixed: Vec<Fixed>,
    pub(crate) text: String,
}

/// A number that a law remembers, and that is zero at first.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its name.
    pub name: String,
    /// How fast it changes, by the second.
    pub rate: Expression,
    /// Range in which it lies.
    pub range: (f64, f64),
    /// Its unit.
    pub dimension: Dimension,
}

impl Definition {
    /// Reads a law.
    ///
    /// # Errors
    /// Text that is no law, with the place and what was expected there.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let (name, statements) = statements(text)?;
        let mut definition = Definition {
            name,
            output: Output::Torque,
            law: Expression {
                term: Term::Number(0.0),
                at: 0,
            },
            states: Vec::new(),
            parameters: Vec::new(),
            fixed: Vec::new(),
            text: text.trim().to_owned(),
        };
        definition.take(text, statements)?;
        definition.resolve(text)?;
        dimension::check(&definition).map_err(|(at, what)| Fault::new(text, at, what))?;
        Ok(definition)
    }

    fn take(&mut self, text: &str, statements: Vec<Statement>) -> Result<(), Fault> {
        let mut output = None;
        let mut ranges = Vec::new();
        for statement in statements {
            match statement {
                Statement::Place(at, place, law) => {
                    if output.is_some() {
                        let what = "a law has one place; state the other one as a law of its own";
                        return Err(Fault::new(text, at, what));
                    }
                    output = Some(place);
                    self.law = law;
                }
                Statement::Rate(at, name, rate) => {
                    if self.states.len() == MAX_STATES {
                        let what = format!(
                            "a law has at most {MAX_STATES} states; what has a state of its own is a law of its own"
                        );
                        return Err(Fault::new(text, at, what));
                    }
                    self.new_name(text, at, &name)?;
                    self.states.push(State {
                        name,
                        rate,
                        range: (-1.0, 1.0),
                        dimension: Dimension::default(),
                    });
                }
                Statement::Fixed(at, name, value, (unit_at, unit)) => {
                    self.new_name(text, at, &name)?;
                    let dimension =
                        Dimension::parse(&unit).map_err(|what| Fault::new(text, unit_at, what))?;
                    self.fixed.push(Fixed {
                        name,
                        value,
                        unit,
                        dimension,
                    });
                }
                Statement::Range {
                    names,
                    start,
                    range,
                    unit,
                } => ranges.push((names, start, range, unit)),
            }
        }
        self.output = output.ok_or_else(|| {
            let places: Vec<&str> = PLACES.iter().map(|(name, _)| *name).collect();
            let what = format!(
                "the law has no place; add one of {} = ...",
                places.join(", ")
            );
            Fault::new(text, text.len(), what)
        })?;
        for (names, start, range, (unit_at, unit)) in ranges {
            for (at, name) in names {
                let (low, high) = range;
                if low >= high {
                    let what = format!("the range of {name} is empty: [{low}, {high}]");
                    return Err(Fault::new(text, at, what));
                }
                if let Some(start) = start.filter(|x| !(low..=high).contains(x)) {
                    let what = format!("{name} = {start} is outside of its range [{low}, {high}]");
                    return Err(Fault::new(text, at, what));
                }
                let dimension =
                    Dimension::parse(&unit).map_err(|what| Fault::new(text, unit_at, what))?;
                let state = self.states.iter_mut().find(|state| state.name == name);
                if let Some(state) = state {
                    (state.range, state.dimension) = ((low, high), dimension);
                    continue;
                }
                self.new_name(text, at, &name)?;
                self.parameters.push(Parameter {
                    name,
                    start: start.unwrap_or_else(|| middle(low, high)),
                    range,
                    unit: if unit.is_empty() {
                        "1".to_owned()
                    } else {
                        unit.clone()
                    },
                    dimension,
                });
            }
        }
        if self.parameters.len() > MAX_PARAMETERS {
            let what = format!("a law has at most {MAX_PARAMETERS} parameters");
            return Err(Fault::new(text, text.len(), what));
        }
        if let Some(State { rate, .. }) = self.states.first()
            && !matches!(self.output, Output::Torque | Output::Voltage)
        {
            let what = "a state belongs to a torque or a voltage; friction, torque_constant, angle and inertia have none";
            return Err(Fault::new(text, rate.at, what));
        }
        Ok(())
    }

    fn state(&self, name: &str) -> Option<usize> {
        self.states.iter().position(|state| state.name == name)
    }

    fn new_name(&self, text: &str, at: usize, name: &str) -> Result<(), Fault> {
        let variable = found(&VARIABLES, name).is_some() && !MAY_BE_NAMED.contains(&name);
        let taken = variable
            || found(&FUNCTIONS, name).is_some()
            || found(&PLACES, name).is_some()
            || self.state(name).is_some()
            || self.parameters.iter().any(|p| p.name == name)
            || self.fixed.iter().any(|p| p.name == name);
        if taken {
            return Err(Fault::new(text, at, format!("`{name}` is a name already")));
        }
        Ok(())
    }

    /// Says what the names mean.
    fn resolve(&mut self, text: &str) -> Result<(), Fault> {
        let mut law = self.law.clone();
        self.meant(text, &mut law)?;
        self.law = law;
        let mut states = self.states.clone();
        for state in &mut states {
            self.meant(text, &mut state.rate)?;
        }
        self.states = states;
        Ok(())
    }

    fn meant(&self, text: &str, expression: &mut Expression) -> Result<(), Fault> {
        let at = expression.at;
        match &mut expression.term {
            Term::Name(name) => {
                let term = self.term(name).ok_or_else(|| {
                    let variables: Vec<&str> = VARIABLES.iter().map(|(name, _)| *name).collect();
                    let what = format!(
                        "`{name}` is neither a variable ({}) nor a parameter; state its range: {name} in [low, high] unit",
                        variables.join(", ")
                    );
                    Fault::new(text, at, what)
                })?;
                if let Term::Variable(variable) = term {
                    self.is_at_hand(variable)
                        .map_err(|what| Fault::new(text, at, what))?;
                }
                expression.term = term;
            }
            Term::Negative(inner) => self.meant(text, inner)?,
            Term::Call(_, arguments) => {
                for argument in arguments {
                    self.meant(text, argument)?;
                }
            }
            Term::Binary(_, a, b) => {
                self.meant(text, a)?;
                self.meant(text, b)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn term(&self, name: &str) -> Option<Term> {
        let state = self.state(name).map(Term::State);
        let parameter = || self.parameters.iter().position(|p| p.name == name);
        let fixed = || self.fixed.iter().position(|p| p.name == name);
        state
            .or_else(|| parameter().map(Term::Parameter))
            .or_else(|| fixed().map(Term::Fixed))
            .or_else(|| found(&VARIABLES, name).map(Term::Variable))
    }

    /// Whether the law may depend on the time, which it remembers in its state's place.
    fn may_age(&self) -> Result<(), String> {
        if !self.states.is_empty() {
            return Err("a law with a state has no t".to_owned());
        }
        match self.output {
            Output::Torque | Output::TorqueConstant | Output::Voltage => Ok(()),
            _ => Err("t, the time, belongs to a torque, a torque constant or a voltage".to_owned()),
        }
    }

    /// Whether the place sees a variable.
    fn is_at_hand(&self, variable: Variable) -> Result<(), String> {
        if variable == Variable::Time {
            return self.may_age();
        }
        let seen = match self.output {
            Output::Angle | Output::Inertia => variable == Variable::Angle,
            Output::Voltage => variable != Variable::Transmitted,
            Output::Torque | Output::Friction | Output::TorqueConstant => true,
        };
        if seen {
            return Ok(());
        }
        Err(match self.output {
            Output::Voltage => {
                "a voltage depends on u, the command, and on i, w, theta, t and temperature"
            }
            Output::Angle => "an error of the angle depends on theta alone",
            _ => "an inertia depends on theta alone",
        }
        .to_owned())
    }
}

/// A start for a search where none is stated.
fn middle(low: f64, high: f64) -> f64 {
    if low > 0.0 {
        (low * high).sqrt()
    } else {
        low.max(0.0).max(0.1 * high).min(high)
    }
}
