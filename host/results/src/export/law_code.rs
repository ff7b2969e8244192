//! Laws that the user stated, as functions in another program's language.

use super::comment::plain;
use super::subject::Subject;
use super::written::Written;
use servoid_formula::{Language, law_of};

/// What the arguments and the value of a function are.
const ABOUT: &str = "w is the motor's speed in rad/s, theta its angle within the revolution in rad, i and tau current and torque as volts at the \
                     winding (R*i, T*R/Kt), u the command in V, z the state, t the time in s, temperature in °C; the value is in V at the winding, or what the law's place says";

/// The functions, each with lines that say what it is. A law of which a number is not determined is left out, and said to be.
pub(super) fn functions(
    subject: &Subject,
    language: Language,
    mark: &str,
    written: &mut Written,
) -> String {
    let mut text = String::new();
    for term in &subject.terms {
        let Some(law) = law_of(term.kind) else {
            continue;
        };
        let name = &law.definition.name;
        if !term.determined.iter().all(|determined| *determined) {
            written.lacks(
                name,
                "not all of its numbers are determined: there is no function of it",
            );
            continue;
        }
        let (open, close) = if language == Language::C {
            ("/* ", " */")
        } else {
            (mark, "")
        };
        for line in [term.kind.description().equation, ABOUT] {
            text += &format!("{open}{}{close}\n", plain(line));
        }
        // The function is of the motor's shaft, as its fixed numbers are.
        let parameters = term.kind.parameters().iter().zip(&term.values);
        let own: Vec<f64> = parameters
            .map(|(p, value)| value / subject.side.factor(p.quantity.unit()).unwrap_or(1.0))
            .collect();
        text += &law.definition.functions_in(language, &own);
        text += "\n";
    }
    text
}
