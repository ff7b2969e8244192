//! An expression's value, and the range in which it lies.

use crate::definition::Definition;
use crate::syntax::{Binary, Expression, Function, Term};
use shared::effects::formula::{Interval, MAX_STATES, Output, Variable};
use std::f64::consts::TAU;

/// Where a law is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Speed, rad/s.
    pub speed: f64,
    /// Position within the revolution, rad.
    pub angle: f64,
    /// Current as the voltage across the resistance, V.
    pub current: f64,
    /// Torque passed on, V.
    pub transmitted: f64,
    /// Command, V.
    pub command: f64,
    /// Time since the recording began, s.
    pub time: f64,
    /// Temperature that the recording tells, °C.
    pub temperature: f64,
    /// The states.
    pub states: [f64; MAX_STATES],
}

impl Expression {
    /// Its value if it is a number that depends on nothing.
    pub(crate) fn constant(&self) -> Option<f64> {
        match &self.term {
            Term::Number(x) => Some(*x),
            Term::Negative(a) => a.constant().map(|x| -x),
            Term::Call(function, arguments) => {
                let arguments: Option<Vec<f64>> =
                    arguments.iter().map(Expression::constant).collect();
                arguments.map(|arguments| called(*function, &arguments))
            }
            Term::Binary(binary, a, b) => Some(joined(*binary, a.constant()?, b.constant()?)),
            _ => None,
        }
    }
}

impl Definition {
    /// The law at a point, with these values of the parameters.
    pub fn value(&self, values: &[f64], point: &Point) -> f64 {
        self.value_of(&self.law, values, point)
    }

    /// The rates of the states there, by the second; zero where there is none.
    pub fn rates(&self, values: &[f64], point: &Point) -> [f64; MAX_STATES] {
        let mut rates = [0.0; MAX_STATES];
        for (rate, state) in rates.iter_mut().zip(&self.states) {
            *rate = self.value_of(&state.rate, values, point);
        }
        rates
    }

    pub(crate) fn value_of(&self, expression: &Expression, values: &[f64], point: &Point) -> f64 {
        let inner = |expression: &Expression| self.value_of(expression, values, point);
        match &expression.term {
            Term::Number(x) => *x,
            Term::Variable(variable) => match variable {
                Variable::Speed => point.speed,
                Variable::Angle => point.angle,
                Variable::Current => point.current,
                Variable::Transmitted if self.output == Output::Friction => point.transmitted,
                Variable::Transmitted => point.current,
                Variable::Command => point.command,
                Variable::Time => point.time,
                Variable::Temperature => point.temperature,
            },
            Term::State(place) => point.states[*place],
            Term::Parameter(place) => values.get(*place).copied().unwrap_or(0.0),
            Term::Fixed(place) => self.fixed[*place].value,
            Term::Name(_) => 0.0,
            Term::Negative(a) => -inner(a),
            Term::Call(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(inner).collect();
                called(*function, &arguments)
            }
            Term::Binary(binary, a, b) => joined(*binary, inner(a), inner(b)),
        }
    }

    /// The range in which an expression lies, for every motor and every parameter within its range.
    pub(crate) fn range_of(&self, expression: &Expression) -> Interval {
        let inner = |expression: &Expression| self.range_of(expression);
        let everything = Interval::within(f64::INFINITY);
        match &expression.term {
            Term::Number(x) => Interval::point(*x),
            Term::Variable(Variable::Angle) => Interval::new(0.0, TAU),
            Term::Variable(Variable::Time) => Interval::new(0.0, f64::INFINITY),
            Term::Variable(_) | Term::Name(_) => everything,
            Term::State(place) => {
                let (low, high) = self.states[*place].range;
                Interval::new(low, high)
            }
            Term::Parameter(place) => {
                let (low, high) = self.parameters[*place].range;
                Interval::new(low, high)
            }
            Term::Fixed(place) => Interval::point(self.fixed[*place].value),
            Term::Negative(a) => inner(a).negated(),
            Term::Call(function, arguments) => {
                let first = inner(&arguments[0]);
                match function {
                    Function::Abs => first.magnitude(),
                    Function::Sign => first.sign(),
                    Function::Min => first.min(inner(&arguments[1])),
                    Function::Max => first.max(inner(&arguments[1])),
                    Function::Exp => first.rising(libm::exp),
                    Function::Sqrt => first.raised(0.5),
                    Function::Sin | Function::Cos => Interval::within(1.0),
                    Function::Tanh => first.rising(libm::tanh),
                }
            }
            Term::Binary(binary, a, b) => {
                let (one, other) = (inner(a), inner(b));
                match binary {
                    Binary::Add => one.plus(other),
                    Binary::Sub => one.plus(other.negated()),
                    Binary::Mul if a.term == b.term => one.square(),
                    Binary::Mul => one.times(other),
                    Binary::Div => one.times(other.inverse()),
                    Binary::Power => match b.constant() {
                        Some(2.0) => one.square(),
                        Some(power) if power < 0.0 => one.raised(-power).inverse(),
                        Some(3.0) => one.times(one.square()),
                        _ if one.low >= 0.0 => Interval::new(0.0, f64::INFINITY),
                        _ => everything,
                    },
                }
            }
        }
    }
}

fn called(function: Function, arguments: &[f64]) -> f64 {
    let x = arguments[0];
    match function {
        Function::Abs => x.abs(),
        Function::Sign => Interval::point(x).sign().low,
        Function::Min => x.min(arguments[1]),
        Function::Max => x.max(arguments[1]),
        Function::Exp => libm::exp(x),
        Function::Sqrt => x.max(0.0).sqrt(),
        Function::Sin => libm::sin(x),
        Function::Cos => libm::cos(x),
        Function::Tanh => libm::tanh(x),
    }
}

fn joined(binary: Binary, a: f64, b: f64) -> f64 {
    match binary {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Power => libm::pow(a, b),
    }
}
