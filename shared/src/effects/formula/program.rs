//! The operations of a formula, and what it says of itself.

use crate::effects::MEMORIES;
use crate::units::Quantity;

/// Most constants of a program: what depends on the parameters alone.
pub const MAX_CONSTANTS: usize = 16;
/// Most numbers that wait on the stack.
pub const MAX_DEPTH: usize = 8;
/// Most states of a law.
pub const MAX_STATES: usize = MEMORIES;

/// What a formula may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Speed of the shaft, rad/s.
    Speed,
    /// Its position within the revolution, rad.
    Angle,
    /// Current, as the voltage across the resistance, V: the torque of the motor.
    Current,
    /// Torque that motor and load pass to each other, V; of a friction budget only.
    Transmitted,
    /// Voltage that the drive gives, V; of a voltage what is left of it behind the effects before it.
    Command,
    /// Time since the recording began, s; of a torque, a torque constant or a voltage without a state.
    Time,
    /// Temperature that the recording tells, °C.
    Temperature,
}

/// What a formula gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// A torque in the direction of positive rotation, V referred to the winding.
    Torque,
    /// A friction budget, V referred to the winding; what is below zero is none.
    Friction,
    /// A voltage added to the command, V.
    Voltage,
    /// The torque constant, as a part of the motor's.
    TorqueConstant,
    /// An angle added to what the encoder sees, rad.
    Angle,
    /// Moment of inertia added to the motor's, as a part of it; what is below zero is none.
    Inertia,
}

impl Output {
    /// What its numbers are.
    pub(super) fn quantity(self) -> Quantity {
        match self {
            Output::Torque | Output::Friction | Output::Voltage => Quantity::Voltage,
            Output::TorqueConstant | Output::Inertia => Quantity::Ratio,
            Output::Angle => Quantity::Angle,
        }
    }
}

/// One operation. It takes its operands from the stack and puts its result there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    /// A number; of constants only.
    Number(f64),
    /// The parameter at this place, SI; of constants only.
    Parameter(u8),
    /// A variable.
    Variable(Variable),
    /// The state at this place.
    State(u8),
    /// The constant at this place.
    Constant(u8),
    /// Times the constant at this place.
    Scale(u8),
    /// To the power of the constant at this place, of a magnitude.
    Raise(u8),
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient. The divisor is never zero.
    Div,
    /// With the other sign.
    Neg,
    /// Magnitude.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// Square.
    Square,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// Natural exponential.
    Exp,
    /// Power; of constants only.
    Power,
    /// Sine, of rad.
    Sin,
    /// Cosine, of rad.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
}

/// A number that a law remembers, zero at first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Program of its rate, by the second.
    pub rate: &'static [Op],
    /// Range in which it lies.
    pub range: (f64, f64),
}

/// A formula compiled: programs on a stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Program {
    /// What it gives.
    pub output: Output,
    /// Programs of the constants, at most [`MAX_CONSTANTS`].
    pub constants: &'static [&'static [Op]],
    /// Program of the law.
    pub law: &'static [Op],
    /// Its states, at most [`MAX_STATES`].
    pub states: &'static [State],
}

impl Program {
    /// Whether the law or its states look at a variable.
    pub fn looks_at(&self, variable: Variable) -> bool {
        let rates = self.states.iter().flat_map(|state| state.rate);
        let mut ops = self.law.iter().chain(rates);
        ops.any(|op| *op == Op::Variable(variable))
    }

    /// Whether it has a state.
    pub fn has_state(&self) -> bool {
        !self.states.is_empty()
    }

    /// Whether it is a voltage that changes within an interval: by a state, the motion, the current or the time, and not by the command
    /// alone.
    pub fn acts_within_a_part(&self) -> bool {
        let within = self.has_state() || self.goes_with_the_run() || self.is_a_resistance();
        self.output == Output::Voltage && within
    }

    /// Whether it is a voltage that depends on the current.
    pub(super) fn is_a_resistance(&self) -> bool {
        self.output == Output::Voltage && self.looks_at(Variable::Current)
    }

    /// Whether it looks at what neither the command nor the current tells: the motion, the time or the temperature.
    pub(super) fn goes_with_the_run(&self) -> bool {
        let seen = [
            Variable::Speed,
            Variable::Angle,
            Variable::Time,
            Variable::Temperature,
        ];
        seen.iter().any(|variable| self.looks_at(*variable))
    }

    /// Whether it remembers a number: a state, or how long it has run.
    pub fn remembers(&self) -> bool {
        self.has_state() || self.looks_at(Variable::Time)
    }
}
