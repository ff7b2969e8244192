//! A law in other programs' languages.

use crate::definition::Definition;
use crate::syntax::{Binary, Expression, Function, Term, VARIABLES};

/// A language in which a law can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99, with `math.h`.
    C,
    /// Rust, with the crate `libm`, so that it needs no standard library.
    Rust,
    /// Modelica.
    Modelica,
    /// Python, with numpy as `np`.
    Python,
}

/// A line that says what stands below it.
fn remark(language: Language, says: &str) -> String {
    match language {
        Language::C => format!("/* {says} */\n"),
        Language::Rust => format!("/// {says}\n"),
        Language::Modelica => format!("  // {says}\n"),
        Language::Python => format!("# {says}\n"),
    }
}

/// What is behind the name of a state or its rate.
fn numbered(place: usize) -> &'static str {
    if place == 0 { "" } else { "2" }
}

impl Definition {
    /// The law as a function of speed `w` (rad/s), angle within the revolution `theta` (rad), current `i` and torque passed on `tau`
    /// (both in V referred to the winding), voltage of the drive `u` (V), the state `z`, of a law with two states `z2`, and, of a law that
    /// depends on them, the time `t` (s) and the temperature `temperature` (°C); and one of each state's rate.
    pub fn functions_in(&self, language: Language, values: &[f64]) -> String {
        let law = self.function(language, &self.name, &self.law, values);
        let rates = self.states.iter().enumerate().map(|(place, state)| {
            let number = numbered(place);
            let name = format!("{}_rate{number}", self.name);
            let says = format!(
                "How fast the state z{number} of {} changes, by the second.",
                self.name
            );
            remark(language, &says) + &self.function(language, &name, &state.rate, values)
        });
        law + &rates.collect::<String>()
    }

    fn function(
        &self,
        language: Language,
        name: &str,
        expression: &Expression,
        values: &[f64],
    ) -> String {
        let arguments = ["w", "theta", "i", "tau", "u", "z"];
        let arguments: Vec<&str> = arguments
            .into_iter()
            .chain((self.states.len() > 1).then_some("z2"))
            .chain(self.ages().then_some("t"))
            .chain(self.is_of_temperature().then_some("temperature"))
            .collect();
        let each = |text: &dyn Fn(&str) -> String, between: &str| {
            let texts: Vec<String> = arguments.iter().map(|name| text(name)).collect();
            texts.join(between)
        };
        let typed =
            |before: &str, behind: &str| each(&|name| format!("{before}{name}{behind}"), ", ");
        let value = self.written(expression, language, values);
        match language {
            Language::C => format!(
                "static inline double servoid_{name}({})\n{{\n    {}\n    return {value};\n}}\n",
                typed("double ", ""),
                each(&|name| format!("(void){name};"), " ")
            ),
            Language::Rust => format!(
                "#[allow(unused_variables, unused_parens, clippy::all)]\npub fn {name}({}) -> f64 {{\n    {value}\n}}\n",
                typed("", ": f64")
            ),
            Language::Modelica => format!(
                "  function {name}\n{}    output Real value;\n  algorithm\n    value := {value};\n  end {name};\n",
                each(&|name| format!("    input Real {name};\n"), "")
            ),
            Language::Python => {
                format!(
                    "def {name}({}):\n    return {value}\n",
                    arguments.join(", ")
                )
            }
        }
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
            Term::State(place) => format!("z{}", numbered(*place)),
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
                            Language::Rust => format!("libm::pow({a}, {b})"),
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
        Function::Abs => ("fabs", "libm::fabs", "abs", "np.abs"),
        Function::Sign => {
            let x = &arguments[0];
            return match language {
                Language::C => format!("(double)(({x} > 0.0) - ({x} < 0.0))"),
                Language::Rust => format!("(f64::from({x} > 0.0) - f64::from({x} < 0.0))"),
                Language::Modelica => format!("sign({x})"),
                Language::Python => format!("np.sign({x})"),
            };
        }
        Function::Min => ("fmin", "libm::fmin", "min", "np.minimum"),
        Function::Max => ("fmax", "libm::fmax", "max", "np.maximum"),
        Function::Exp => ("exp", "libm::exp", "exp", "np.exp"),
        Function::Sqrt => ("sqrt", "libm::sqrt", "sqrt", "np.sqrt"),
        Function::Sin => ("sin", "libm::sin", "sin", "np.sin"),
        Function::Cos => ("cos", "libm::cos", "cos", "np.cos"),
        Function::Tanh => ("tanh", "libm::tanh", "tanh", "np.tanh"),
    };
    let name = match language {
        Language::C => c,
        Language::Rust => rust,
        Language::Modelica => modelica,
        Language::Python => python,
    };
    format!("{name}({})", arguments.join(", "))
}
