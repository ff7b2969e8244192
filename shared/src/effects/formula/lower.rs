//! A program with the values of its parameters: what every operation needs to compute with numbers near one.
//!
//! Each intermediate result is a number times a base. The bases come from the [`Interval`] in which the result can lie, so that
//! the number is at most one in magnitude while the motor stays within twice its base speed and voltage. A factor changes the base
//! and costs nothing when the program runs.

use super::power;
use super::{Formula, Interval, MAX_CONSTANTS, MAX_DEPTH, MAX_STATES, Op, Variable};
use crate::error::ModelError;
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};
use core::f64::consts::TAU;

/// Most numbers of a lowered program.
pub const MAX_NUMBERS: usize = 40;

/// Speeds and voltages that a motor reaches, in bases: braking from full speed takes twice the supply.
const REACHED: f64 = 2.0;
/// Largest result of an exponential, as its exponent.
const LARGEST_EXPONENT: f64 = 80.0;

/// A program lowered: numbers in the order in which its operations take them.
pub(super) struct Numbers {
    numbers: [f64; MAX_NUMBERS],
    used: usize,
    /// Base of the law by the output's base.
    pub(super) law: f64,
    /// Of each state's rate.
    pub(super) rates: [RateNumbers; MAX_STATES],
}

/// What a state's rate takes.
#[derive(Clone, Copy, Default)]
pub(super) struct RateNumbers {
    /// Base of the rate by the state's range, for one interval.
    pub(super) by_interval: f64,
    /// Where its numbers begin.
    pub(super) from: usize,
}

/// An intermediate result: a number times `base`, which lies in `range`.
#[derive(Clone, Copy, Default)]
struct Result {
    base: f64,
    range: Interval,
}

impl Numbers {
    /// Of a formula with these values in SI.
    pub(super) fn new<R: Real>(formula: &Formula, values: &[R], units: &PerUnit<R>) -> Self {
        let program = &formula.program;
        let mut constants = [0.0; MAX_CONSTANTS];
        for (constant, ops) in constants.iter_mut().zip(program.constants) {
            *constant = constant_of(ops, values);
        }
        let mut numbers = Numbers {
            numbers: [0.0; MAX_NUMBERS],
            used: 0,
            law: 0.0,
            rates: [RateNumbers::default(); MAX_STATES],
        };
        let mut states = [Interval::default(); MAX_STATES];
        for (range, state) in states.iter_mut().zip(program.states) {
            *range = Interval::new(state.range.0, state.range.1);
        }
        let law = numbers.walk(program.law, &constants, &states, units);
        numbers.law = law.base / units.base(program.output.quantity()).to_f64();
        for (place, state) in program.states.iter().enumerate().take(MAX_STATES) {
            let from = numbers.used;
            let rate = numbers.walk(state.rate, &constants, &states, units);
            let by_interval = rate.base * units.interval.to_f64() / states[place].most();
            numbers.rates[place] = RateNumbers { by_interval, from };
        }
        numbers
    }

    /// As multipliers of a number format.
    pub(super) fn lowered<S: Scalar>(&self) -> [S::Coefficient; MAX_NUMBERS] {
        self.numbers.map(S::coefficient)
    }

    fn push(&mut self, number: f64) {
        if let Some(place) = self.numbers.get_mut(self.used) {
            *place = number;
            self.used += 1;
        }
    }

    fn walk<R: Real>(
        &mut self,
        ops: &[Op],
        constants: &[f64],
        states: &[Interval; MAX_STATES],
        units: &PerUnit<R>,
    ) -> Result {
        let mut stack = [Result::default(); MAX_DEPTH];
        let mut depth = 0;
        for op in ops {
            let operands = operands(op);
            let at = depth - operands.min(depth);
            let (a, b) = (stack[at], stack[(at + 1).min(MAX_DEPTH - 1)]);
            stack[at.min(MAX_DEPTH - 1)] = self.step(op, a, b, constants, states, units);
            depth = (at + 1).min(MAX_DEPTH);
        }
        stack[0]
    }

    fn step<R: Real>(
        &mut self,
        op: &Op,
        a: Result,
        b: Result,
        constants: &[f64],
        states: &[Interval; MAX_STATES],
        units: &PerUnit<R>,
    ) -> Result {
        let constant = |place: u8| constants.get(usize::from(place)).copied().unwrap_or(0.0);
        let of_base = |range: Interval| Result {
            base: range.most(),
            range,
        };
        match *op {
            Op::Variable(variable) => {
                let (quantity, range) = variable_range(variable, units);
                let result = of_base(range);
                self.push(units.base(quantity).to_f64() / result.base);
                result
            }
            Op::State(place) => {
                of_base(states.get(usize::from(place)).copied().unwrap_or_default())
            }
            Op::Constant(place) => Result {
                base: constant(place),
                range: Interval::point(constant(place)),
            },
            Op::Scale(place) => Result {
                base: a.base * constant(place),
                range: a.range.times(Interval::point(constant(place))),
            },
            Op::Neg => Result {
                base: -a.base,
                range: a.range.negated(),
            },
            Op::Add => self.common(a, b, a.range.plus(b.range), 1.0),
            Op::Sub => self.common(a, b, a.range.plus(b.range.negated()), -1.0),
            Op::Min => self.common(a, b, a.range.min(b.range), 1.0),
            Op::Max => self.common(a, b, a.range.max(b.range), 1.0),
            Op::Mul => Result {
                base: a.base * b.base,
                range: a.range.times(b.range),
            },
            Op::Square => Result {
                base: a.base * a.base,
                range: a.range.square(),
            },
            Op::Div => {
                // Least magnitude of the divisor's number.
                let least = part(b.range.least(), b.base.abs());
                self.push(least);
                self.push(part(1.0, least));
                let sign = if b.range.low < 0.0 { -1.0 } else { 1.0 };
                Result {
                    base: sign * part(a.base, b.base.abs() * least),
                    range: a.range.times(b.range.inverse()),
                }
            }
            Op::Abs => Result {
                base: a.base.abs(),
                range: a.range.magnitude(),
            },
            Op::Sign => Result {
                base: Interval::point(a.base).sign().low,
                range: a.range.sign(),
            },
            Op::Exp => {
                let most = a.range.most().max(f64::MIN_POSITIVE);
                let high = a.range.high.min(LARGEST_EXPONENT);
                for number in [a.base / most, high / most, FIXED_DEPTH / most, most, a.base] {
                    self.push(number);
                }
                Result {
                    base: libm::exp(high),
                    range: a.range.rising(libm::exp),
                }
            }
            Op::Raise(place) => {
                let exponent = constant(place).max(0.0);
                self.push(exponent);
                for number in power::numbers(exponent) {
                    self.push(number);
                }
                Result {
                    base: libm::pow(a.base.abs(), exponent),
                    range: a.range.raised(exponent),
                }
            }
            Op::Sin | Op::Cos => {
                self.push(a.base / TAU);
                self.push(a.base);
                Result {
                    base: 1.0,
                    range: Interval::within(1.0),
                }
            }
            Op::Tanh => {
                let end = TANH_ENDS / a.base.abs().max(TANH_ENDS);
                self.push(end);
                self.push(a.base.abs());
                Result {
                    base: if a.base < 0.0 { -1.0 } else { 1.0 },
                    range: a.range.rising(libm::tanh),
                }
            }
            // Of constants only.
            Op::Number(_) | Op::Parameter(_) | Op::Power => Result::default(),
        }
    }

    /// Two results brought to one base, with the sign of the second.
    fn common(&mut self, a: Result, b: Result, range: Interval, sign: f64) -> Result {
        let base = a.range.most() + b.range.most();
        self.push(part(a.base, base));
        self.push(sign * part(b.base, base));
        Result { base, range }
    }
}

/// From here on the hyperbolic tangent is one to 2e-6.
pub(super) const TANH_ENDS: f64 = 7.0;

/// Fixed point can tell exponentials of so much below the largest from nothing.
const FIXED_DEPTH: f64 = 7.9;

/// A quotient, zero of nothing.
fn part(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

/// How many operands an operation takes.
fn operands(op: &Op) -> usize {
    match op {
        Op::Number(_) | Op::Parameter(_) | Op::Variable(_) | Op::State(_) | Op::Constant(_) => 0,
        Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Min | Op::Max | Op::Power => 2,
        _ => 1,
    }
}

/// What a variable measures, and how far it reaches.
fn variable_range<R: Real>(variable: Variable, units: &PerUnit<R>) -> (Quantity, Interval) {
    let reached = |quantity| {
        let most = REACHED * units.base(quantity).to_f64();
        (quantity, Interval::within(most))
    };
    match variable {
        Variable::Speed => reached(Quantity::Speed),
        Variable::Angle => (Quantity::Angle, Interval::new(0.0, TAU)),
        Variable::Current | Variable::Transmitted | Variable::Command => reached(Quantity::Voltage),
        Variable::Time => (Quantity::Time, Interval::new(0.0, LONGEST)),
        Variable::Temperature => reached(Quantity::Temperature),
    }
}

/// A constant, from the values of the parameters.
fn constant_of<R: Real>(ops: &[Op], values: &[R]) -> f64 {
    let mut stack = [0.0; MAX_DEPTH];
    let mut depth = 0;
    for op in ops {
        let at = depth - operands(op).min(depth);
        let (a, b) = (
            stack[at.min(MAX_DEPTH - 1)],
            stack[(at + 1).min(MAX_DEPTH - 1)],
        );
        stack[at.min(MAX_DEPTH - 1)] = match *op {
            Op::Number(x) => x,
            Op::Parameter(place) => values.get(usize::from(place)).map_or(0.0, |x| x.to_f64()),
            Op::Add => a + b,
            Op::Sub => a - b,
            Op::Mul => a * b,
            Op::Div => part(a, b),
            Op::Neg => -a,
            Op::Abs => libm::fabs(a),
            Op::Sign => Interval::point(a).sign().low,
            Op::Square => a * a,
            Op::Min => libm::fmin(a, b),
            Op::Max => libm::fmax(a, b),
            Op::Exp => libm::exp(a.min(LARGEST_EXPONENT)),
            Op::Power => libm::pow(a, b),
            Op::Sin => libm::sin(a),
            Op::Cos => libm::cos(a),
            Op::Tanh => libm::tanh(a),
            Op::Variable(_) | Op::State(_) | Op::Constant(_) | Op::Scale(_) | Op::Raise(_) => 0.0,
        };
        depth = (at + 1).min(MAX_DEPTH);
    }
    stack[0]
}

/// Whether a number format can hold the formula with these values.
pub(super) fn check<S: Scalar, R: Real>(
    formula: &Formula,
    values: &[R],
    units: &PerUnit<R>,
) -> core::result::Result<(), ModelError> {
    let numbers = Numbers::new(formula, values, units);
    let all = numbers.numbers[..numbers.used].iter();
    let finite = all.clone().chain([&numbers.law]).all(|x| x.is_finite());
    if !finite {
        return Err(ModelError::Parameter {
            name: formula.description.name,
            value: numbers.law,
        });
    }
    if S::LIMIT.is_infinite() {
        return Ok(());
    }
    // Rates of a state are far beyond one where it follows within a sample; so is a count of intervals.
    let limit = if formula.program.remembers() {
        0.0
    } else {
        LARGEST_MULTIPLIER
    };
    let most = all
        .chain([&numbers.law])
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    if most < limit {
        return Ok(());
    }
    Err(ModelError::Range {
        name: formula.description.name,
        value: most,
        limit,
    })
}

/// Longest run that a law of the time is asked for, s.
const LONGEST: f64 = 1e5;
/// Multipliers of fixed point are below this.
const LARGEST_MULTIPLIER: f64 = 1_073_741_824.0;
