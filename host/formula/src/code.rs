//! A law in other programs' languages.

use crate::syntax::{Binary, Definition, Expression, Function, Term, VARIABLES};

/// A language in which a law can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99, with `math.h`.
    C,
    /// Rust, with methods of f64.
    Rust,
    /// Modelica.
    Modelica,
    /// Python, with numpy as `np`.
    Python,
}

impl Definition {
    /// The law as an expression, with the parameters by value.
    pub fn law_in(&self, language: Language, values: &[f64]) -> String {
        self.written(&self.law, language, values)
    }

    /// The state's rate as an expression.
    pub fn rate_in(&self, language: Language, values: &[f64]) -> Option<String> {
        let rate = self.state.as_ref().map(|(_, rate, _)| rate)?;
        Some(self.written(rate, language, values))
    }

    fn written(&self, expression: &Expression, language: Language, values: &[f64]) -> String {
        let inner = |expression: &Expression| self.written(expression, language, values);
        let number = |x: f64| match language {
            _ if x < 0.0 => format!("({x:?})"),
            _ => format!("{x:?}"),
        };
        match &expression.term {
            Term::Number(x) => number(*x),
            Term::Fixed(place) => number(self.fixed[*place].value),
            Term::Parameter(place) => number(values.get(*place).copied().unwrap_or(0.0)),
            Term::Variable(variable) => {
                let name = VARIABLES.iter().find(|(_, own)| own == variable);
                name.map_or("w", |(name, _)| name).to_owned()
            }
            Term::State => "z".to_owned(),
            Term::Name(name) => name.clone(),
            Term::Negative(a) => format!("(-{})", inner(a)),
            Term::Call(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(inner).collect();
                called(*function, language, &arguments)
            }
            Term::Binary(binary, a, b) => {
                let (a, b) = (inner(a), inner(b));
                let sign = match binary {
                    Binary::Add => "+",
                    Binary::Sub => "-",
                    Binary::Mul => "*",
                    Binary::Div => "/",
                    Binary::Power => {
                        return match language {
                            Language::C => format!("pow({a}, {b})"),
                            Language::Rust => format!("f64::powf({a}, {b})"),
                            Language::Modelica => format!("({a})^({b})"),
                            Language::Python => format!("({a})**({b})"),
                        };
                    }
                };
                format!("({a} {sign} {b})")
            }
        }
    }
}

fn called(function: Function, language: Language, arguments: &[String]) -> String {
    let (c, rust, modelica, python) = match function {
        Function::Abs => ("fabs", "f64::abs", "abs", "np.abs"),
        Function::Sign => {
            let x = &arguments[0];
            return match language {
                Language::C => format!("(double)(({x} > 0.0) - ({x} < 0.0))"),
                Language::Rust => format!("(f64::from({x} > 0.0) - f64::from({x} < 0.0))"),
                Language::Modelica => format!("sign({x})"),
                Language::Python => format!("np.sign({x})"),
            };
        }
        Function::Min => ("fmin", "f64::min", "min", "np.minimum"),
        Function::Max => ("fmax", "f64::max", "max", "np.maximum"),
        Function::Exp => ("exp", "f64::exp", "exp", "np.exp"),
        Function::Sqrt => ("sqrt", "f64::sqrt", "sqrt", "np.sqrt"),
        Function::Sin => ("sin", "f64::sin", "sin", "np.sin"),
        Function::Cos => ("cos", "f64::cos", "cos", "np.cos"),
        Function::Tanh => ("tanh", "f64::tanh", "tanh", "np.tanh"),
    };
    let name = match language {
        Language::C => c,
        Language::Rust => rust,
        Language::Modelica => modelica,
        Language::Python => python,
    };
    format!("{name}({})", arguments.join(", "))
}
