//! Units of a law: powers of volt, radian and second.

use crate::definition::Definition;
use crate::syntax::{Binary, Expression, Function, Term};
use shared::effects::formula::{Output, Variable};
use std::fmt;

/// Powers of V, rad, s and °C.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dimension {
    powers: [f64; 4],
}

const NAMES: [&str; 4] = ["V", "rad", "s", "degC"];
const ONE: Dimension = Dimension { powers: [0.0; 4] };
const VOLT: Dimension = Dimension {
    powers: [1.0, 0.0, 0.0, 0.0],
};
const RADIAN: Dimension = Dimension {
    powers: [0.0, 1.0, 0.0, 0.0],
};
const SPEED: Dimension = Dimension {
    powers: [0.0, 1.0, -1.0, 0.0],
};
/// Powers that differ by less are equal.
const SAME: f64 = 1e-6;

impl Dimension {
    /// From a unit such as `V*s^2/rad^2`; nothing is one.
    ///
    /// # Errors
    /// A unit that is none of these.
    pub fn parse(unit: &str) -> Result<Self, String> {
        let mut sum = ONE;
        let mut sign = 1.0;
        let unit = unit.trim();
        if unit.is_empty() {
            return Ok(ONE);
        }
        for (k, divided) in unit.split('/').enumerate() {
            sign = if k == 0 { sign } else { -1.0 };
            for factor in divided.split('*') {
                let factor = factor.trim();
                if factor == "1" {
                    continue;
                }
                let (name, power) = factor.split_once('^').unwrap_or((factor, "1"));
                let place = NAMES.iter().position(|known| *known == name.trim());
                let power: Option<f64> = power.trim().parse().ok();
                let power = power.filter(|power| power.is_finite() && power.abs() <= 9.0);
                let (Some(place), Some(power)) = (place, power) else {
                    return Err(format!(
                        "`{unit}` is no unit; expected products of V, rad, s and degC, such as V*s/rad"
                    ));
                };
                sum.powers[place] += sign * power;
            }
        }
        Ok(sum)
    }

    /// The power of rad in it.
    pub fn of_angle(self) -> f64 {
        self.powers[1]
    }

    fn times(self, other: Self, power: f64) -> Self {
        let mut product = self;
        for (own, other) in product.powers.iter_mut().zip(other.powers) {
            *own += power * other;
        }
        product
    }

    fn is(self, other: Self) -> bool {
        let mut pairs = self.powers.iter().zip(other.powers);
        pairs.all(|(a, b)| (a - b).abs() < SAME)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = |powers: &[f64; 4], sign: f64| {
            let factors = NAMES
                .iter()
                .zip(powers)
                .filter(|(_, power)| sign * **power > SAME);
            let factors = factors.map(|(name, power)| match power.abs() {
                one if (one - 1.0).abs() < SAME => (*name).to_owned(),
                power => format!("{name}^{power}"),
            });
            factors.collect::<Vec<_>>()
        };
        let above = written(&self.powers, 1.0);
        let below = written(&self.powers, -1.0);
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join("*")
        };
        match below.is_empty() {
            true => f.write_str(&above),
            false => write!(f, "{above}/{}", below.join("/")),
        }
    }
}

/// Of what an expression is; none of zero, which is of every dimension.
type Found = Result<Option<Dimension>, (usize, String)>;

/// Checks the units of a law.
pub(crate) fn check(definition: &Definition) -> Result<(), (usize, String)> {
    let expected = match definition.output {
        Output::Torque | Output::Friction => (VOLT, "a torque is in V, referred to the winding"),
        Output::Voltage => (VOLT, "a voltage is in V"),
        Output::TorqueConstant => (
            ONE,
            "torque_constant is a part of the motor's, without a unit",
        ),
        Output::Angle => (RADIAN, "an angle is in rad"),
        Output::Inertia => (ONE, "inertia is a part of the motor's, without a unit"),
    };
    same(definition, &definition.law, expected.0, expected.1)?;
    for state in &definition.states {
        let by_second = state.dimension.times(SECOND, -1.0);
        let what = format!(
            "the rate of {}, which is in {}, by the second; its range states its unit",
            state.name, state.dimension
        );
        same(definition, &state.rate, by_second, &what)?;
    }
    Ok(())
}

const SECOND: Dimension = Dimension {
    powers: [0.0, 0.0, 1.0, 0.0],
};
const CELSIUS: Dimension = Dimension {
    powers: [0.0, 0.0, 0.0, 1.0],
};

fn same(
    definition: &Definition,
    expression: &Expression,
    expected: Dimension,
    what: &str,
) -> Result<(), (usize, String)> {
    match of(definition, expression)? {
        Some(found) if !found.is(expected) => Err((
            expression.at,
            format!("expected {expected}, found {found}: {what}"),
        )),
        _ => Ok(()),
    }
}

fn of(definition: &Definition, expression: &Expression) -> Found {
    let at = expression.at;
    let inner = |expression: &Expression| of(definition, expression);
    match &expression.term {
        Term::Number(x) => Ok((*x != 0.0).then_some(ONE)),
        Term::Variable(variable) => Ok(Some(match variable {
            Variable::Speed => SPEED,
            Variable::Angle => RADIAN,
            Variable::Current | Variable::Transmitted | Variable::Command => VOLT,
            Variable::Time => SECOND,
            Variable::Temperature => CELSIUS,
        })),
        Term::State(place) => Ok(Some(definition.states[*place].dimension)),
        Term::Parameter(place) => Ok(Some(definition.parameters[*place].dimension)),
        Term::Fixed(place) => Ok(Some(definition.fixed[*place].dimension)),
        Term::Name(_) => Ok(None),
        Term::Negative(a) => inner(a),
        Term::Call(function, arguments) => match function {
            Function::Abs => inner(&arguments[0]),
            Function::Sign => inner(&arguments[0]).map(|_| Some(ONE)),
            Function::Sqrt => Ok(inner(&arguments[0])?.map(|of| ONE.times(of, 0.5))),
            Function::Min | Function::Max => {
                alike(definition, &arguments[0], &arguments[1], "are compared")
            }
            Function::Exp | Function::Tanh | Function::Sin | Function::Cos => {
                let wave = matches!(function, Function::Sin | Function::Cos);
                match inner(&arguments[0])? {
                    Some(found) if !(found.is(ONE) || wave && found.is(RADIAN)) => {
                        let needed = if wave { "rad or no unit" } else { "no unit" };
                        Err((arguments[0].at, format!("expected {needed}, found {found}")))
                    }
                    _ => Ok(Some(ONE)),
                }
            }
        },
        Term::Binary(binary, a, b) => match binary {
            Binary::Add => alike(definition, a, b, "are added"),
            Binary::Sub => alike(definition, a, b, "are subtracted"),
            Binary::Mul | Binary::Div => {
                let power = if *binary == Binary::Mul { 1.0 } else { -1.0 };
                let (a, b) = (inner(a)?, inner(b)?);
                Ok(a.map(|a| b.map_or(a, |b| a.times(b, power))))
            }
            Binary::Power => {
                if let Some(found) = inner(b)?
                    && !found.is(ONE)
                {
                    return Err((b.at, format!("an exponent has no unit, found {found}")));
                }
                let Some(of_base) = inner(a)? else {
                    return Ok(None);
                };
                match b.constant() {
                    Some(power) => Ok(Some(ONE.times(of_base, power))),
                    None if of_base.is(ONE) => Ok(Some(ONE)),
                    None => Err((
                        at,
                        format!(
                            "what is raised to an unknown power has no unit, found {of_base}; divide it by a fixed number, \
                             such as w0 = 100 rad/s"
                        ),
                    )),
                }
            }
        },
    }
}

fn alike(definition: &Definition, a: &Expression, b: &Expression, what: &str) -> Found {
    match (of(definition, a)?, of(definition, b)?) {
        (Some(one), Some(other)) if !one.is(other) => {
            Err((b.at, format!("{one} and {other} {what}")))
        }
        (one, other) => Ok(one.or(other)),
    }
}
