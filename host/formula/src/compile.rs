//! An expression as a stack program. What depends on parameters and numbers alone is computed once, when a model is made.

use crate::definition::Definition;
use crate::syntax::{Binary, Expression, Function, Term};
use shared::effects::formula::{
    MAX_CONSTANTS, MAX_DEPTH, MAX_NUMBERS, Op, Program, State, Variable,
};

/// Code of an expression.
enum Code {
    /// Of parameters and numbers alone.
    Constant(Vec<Op>),
    /// What depends on the motion.
    Varying(Vec<Op>),
}

struct Compiler<'a> {
    definition: &'a Definition,
    constants: Vec<Vec<Op>>,
}

/// What cannot be compiled: where, and why.
type Refused = (usize, String);

/// Compiles a law.
pub(crate) fn compile(definition: &Definition) -> Result<Program, Refused> {
    let mut compiler = Compiler {
        definition,
        constants: Vec::new(),
    };
    let law = compiler.program(&definition.law)?;
    let rates: Result<Vec<Vec<Op>>, Refused> = definition
        .states
        .iter()
        .map(|state| compiler.program(&state.rate))
        .collect();
    let rates = rates?;
    let refused = |what: String| (0, what);
    if compiler.constants.len() > MAX_CONSTANTS {
        let what =
            format!("the law has more than {MAX_CONSTANTS} constants; a simpler one is needed");
        return Err(refused(what));
    }
    let all = || rates.iter().chain([&law]);
    let numbers: usize = all().flatten().map(numbers).sum();
    if numbers > MAX_NUMBERS {
        let what = format!("the law has more than {MAX_NUMBERS} numbers; a simpler one is needed");
        return Err(refused(what));
    }
    let deepest = compiler.constants.iter().chain(all()).map(|ops| depth(ops));
    if deepest.max().unwrap_or(0) > MAX_DEPTH {
        let what = format!(
            "the law needs more than {MAX_DEPTH} results at once; put brackets to the left"
        );
        return Err(refused(what));
    }
    // Laws live as long as the process: every effect is known by a reference of that life.
    let leaked = |ops: Vec<Op>| -> &'static [Op] { Box::leak(ops.into_boxed_slice()) };
    let ranges = definition.states.iter().map(|state| state.range);
    let states: Vec<State> = (rates.into_iter().zip(ranges))
        .map(|(rate, range)| State {
            rate: leaked(rate),
            range,
        })
        .collect();
    let constants: Vec<&'static [Op]> = compiler.constants.into_iter().map(leaked).collect();
    Ok(Program {
        output: definition.output,
        constants: Box::leak(constants.into_boxed_slice()),
        law: leaked(law),
        states: Box::leak(states.into_boxed_slice()),
    })
}

/// How many numbers an operation takes when it runs.
fn numbers(op: &Op) -> usize {
    match op {
        Op::Variable(_) => 1,
        Op::Add | Op::Sub | Op::Min | Op::Max | Op::Div | Op::Sin | Op::Cos | Op::Tanh => 2,
        Op::Exp => 5,
        Op::Raise(_) => 17,
        _ => 0,
    }
}

/// Most results that wait on the stack.
fn depth(ops: &[Op]) -> usize {
    let (mut now, mut most) = (0usize, 0usize);
    for op in ops {
        match op {
            Op::Number(_) | Op::Parameter(_) | Op::Variable(_) | Op::State(_) | Op::Constant(_) => {
                now += 1;
            }
            Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Min | Op::Max | Op::Power => {
                now = now.saturating_sub(1);
            }
            _ => {}
        }
        most = most.max(now);
    }
    most
}

impl Compiler<'_> {
    fn program(&mut self, expression: &Expression) -> Result<Vec<Op>, Refused> {
        Ok(match self.code(expression)? {
            Code::Constant(ops) => vec![Op::Constant(self.constant(ops))],
            Code::Varying(ops) => ops,
        })
    }

    /// The place of a constant.
    fn constant(&mut self, ops: Vec<Op>) -> u8 {
        let place = self.constants.iter().position(|own| *own == ops);
        let place = place.unwrap_or_else(|| {
            self.constants.push(ops);
            self.constants.len() - 1
        });
        place.min(usize::from(u8::MAX)) as u8
    }

    /// As code that varies.
    fn varying(&mut self, code: Code) -> Vec<Op> {
        match code {
            Code::Constant(ops) => vec![Op::Constant(self.constant(ops))],
            Code::Varying(ops) => ops,
        }
    }

    fn code(&mut self, expression: &Expression) -> Result<Code, Refused> {
        let one = |op: Op, code: Code| match code {
            Code::Constant(mut ops) => {
                ops.push(op);
                Code::Constant(ops)
            }
            Code::Varying(mut ops) => {
                ops.push(op);
                Code::Varying(ops)
            }
        };
        Ok(match &expression.term {
            Term::Number(x) => Code::Constant(vec![Op::Number(*x)]),
            Term::Fixed(place) => {
                Code::Constant(vec![Op::Number(self.definition.fixed[*place].value)])
            }
            Term::Parameter(place) => Code::Constant(vec![Op::Parameter(*place as u8)]),
            Term::Variable(variable) => {
                let torque = self.definition.output != shared::effects::formula::Output::Friction;
                let variable = match variable {
                    // Of what is no friction budget both are one.
                    Variable::Transmitted if torque => Variable::Current,
                    other => *other,
                };
                Code::Varying(vec![Op::Variable(variable)])
            }
            Term::State(place) => Code::Varying(vec![Op::State(*place as u8)]),
            Term::Name(_) => Code::Constant(vec![Op::Number(0.0)]),
            Term::Negative(a) => one(Op::Neg, self.code(a)?),
            Term::Call(function, arguments) => {
                let first = self.code(&arguments[0])?;
                match function {
                    Function::Abs => one(Op::Abs, first),
                    Function::Sign => one(Op::Sign, first),
                    Function::Exp => one(Op::Exp, first),
                    Function::Sin => one(Op::Sin, first),
                    Function::Cos => one(Op::Cos, first),
                    Function::Tanh => one(Op::Tanh, first),
                    Function::Sqrt => {
                        let half = Code::Constant(vec![Op::Number(0.5)]);
                        self.raised(&arguments[0], first, half)?
                    }
                    Function::Min | Function::Max => {
                        let second = self.code(&arguments[1])?;
                        let op = if *function == Function::Min {
                            Op::Min
                        } else {
                            Op::Max
                        };
                        self.both(op, first, second)
                    }
                }
            }
            Term::Binary(binary, a, b) => self.binary(*binary, a, b)?,
        })
    }

    fn both(&mut self, op: Op, a: Code, b: Code) -> Code {
        if let (Code::Constant(_), Code::Constant(_)) = (&a, &b) {
            let (Code::Constant(mut ops), Code::Constant(others)) = (a, b) else {
                return Code::Constant(Vec::new());
            };
            ops.extend(others);
            ops.push(op);
            return Code::Constant(ops);
        }
        let mut ops = self.varying(a);
        ops.extend(self.varying(b));
        ops.push(op);
        Code::Varying(ops)
    }

    fn binary(&mut self, binary: Binary, a: &Expression, b: &Expression) -> Result<Code, Refused> {
        let (one, other) = (self.code(a)?, self.code(b)?);
        Ok(match (binary, one, other) {
            (Binary::Add, one, other) => self.both(Op::Add, one, other),
            (Binary::Sub, one, other) => self.both(Op::Sub, one, other),
            (Binary::Mul, Code::Varying(mut ops), Code::Constant(factor))
            | (Binary::Mul, Code::Constant(factor), Code::Varying(mut ops)) => {
                ops.push(Op::Scale(self.constant(factor)));
                Code::Varying(ops)
            }
            (Binary::Mul, Code::Varying(mut ops), Code::Varying(_)) if a.term == b.term => {
                ops.push(Op::Square);
                Code::Varying(ops)
            }
            (Binary::Mul, one, other) => self.both(Op::Mul, one, other),
            (Binary::Div, one, other) => {
                if self.definition.range_of(b).least() == 0.0 {
                    let what = "the divisor can be zero; add something to it, or take the larger of it and something small";
                    return Err((b.at, what.to_owned()));
                }
                match (one, other) {
                    (Code::Varying(mut ops), Code::Constant(divisor)) => {
                        let mut inverse = vec![Op::Number(1.0)];
                        inverse.extend(divisor);
                        inverse.push(Op::Div);
                        ops.push(Op::Scale(self.constant(inverse)));
                        Code::Varying(ops)
                    }
                    (one, other) => self.both(Op::Div, one, other),
                }
            }
            (Binary::Power, Code::Constant(mut ops), Code::Constant(others)) => {
                ops.extend(others);
                ops.push(Op::Power);
                Code::Constant(ops)
            }
            (Binary::Power, one, other) => self.power(a, b, one, other)?,
        })
    }

    fn power(
        &mut self,
        a: &Expression,
        b: &Expression,
        one: Code,
        other: Code,
    ) -> Result<Code, Refused> {
        let Code::Constant(exponent) = other else {
            return Err((b.at, "an exponent is a number or a parameter".to_owned()));
        };
        let inverse = |compiler: &mut Self, code: Code| {
            if compiler.definition.range_of(a).least() == 0.0 {
                let what = "what is raised to a negative power can be zero; add something to it";
                return Err((a.at, what.to_owned()));
            }
            let one = Code::Constant(vec![Op::Number(1.0)]);
            Ok(compiler.both(Op::Div, one, code))
        };
        match b.constant() {
            Some(1.0) => Ok(one),
            Some(2.0) => {
                let mut ops = self.varying(one);
                ops.push(Op::Square);
                Ok(Code::Varying(ops))
            }
            Some(3.0) => {
                let mut ops = self.varying(one);
                let again = ops.clone();
                ops.extend(again);
                ops.extend([Op::Square, Op::Mul]);
                Ok(Code::Varying(ops))
            }
            Some(4.0) => {
                let mut ops = self.varying(one);
                ops.extend([Op::Square, Op::Square]);
                Ok(Code::Varying(ops))
            }
            Some(power) if power < 0.0 => {
                let mut ops = self.varying(one);
                match power {
                    -1.0 => {}
                    -2.0 => ops.push(Op::Square),
                    _ => {
                        let positive = Code::Constant(vec![Op::Number(-power)]);
                        let raised = self.raised(a, Code::Varying(ops), positive)?;
                        return inverse(self, raised);
                    }
                }
                inverse(self, Code::Varying(ops))
            }
            _ => {
                if self.definition.range_of(b).low < 0.0 {
                    let what = "an exponent that can be negative; divide by the power instead";
                    return Err((b.at, what.to_owned()));
                }
                self.raised(a, one, Code::Constant(exponent))
            }
        }
    }

    /// To a power that is not negative, of what is not negative.
    fn raised(&mut self, a: &Expression, one: Code, exponent: Code) -> Result<Code, Refused> {
        let Code::Constant(exponent) = exponent else {
            return Err((a.at, "an exponent is a number or a parameter".to_owned()));
        };
        match one {
            Code::Constant(mut ops) => {
                ops.extend(exponent);
                ops.push(Op::Power);
                Ok(Code::Constant(ops))
            }
            Code::Varying(mut ops) => {
                if self.definition.range_of(a).low < 0.0 {
                    let what = "what is raised to this power can be negative; take its magnitude with abs()";
                    return Err((a.at, what.to_owned()));
                }
                ops.push(Op::Raise(self.constant(exponent)));
                Ok(Code::Varying(ops))
            }
        }
    }
}
