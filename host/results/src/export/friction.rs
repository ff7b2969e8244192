//! Friction in the two numbers that most programs have for it: a constant one against motion, and one that grows with
//! the speed. Effects with more are reduced to what they are at speed.

use super::subject::{Subject, Term};
use super::written::{Carried, Written};
use shared::effects::{AtSpeed, Kind, Place};

/// Friction at speed, referred to the winding; behind a current loop in units of the command.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Friction {
    /// Constant, against motion, V.
    pub sliding: f64,
    /// Beside the machine's own viscous friction, V·s/rad: mean of the directions.
    pub viscous: f64,
    /// The effects that give a constant one.
    pub slides: Vec<&'static str>,
}

/// How much of an effect the two numbers carry.
pub fn carried(kind: Kind) -> Carried {
    match kind.facts().at_speed {
        AtSpeed::Sliding { without, .. } | AtSpeed::Viscous { without, .. } => {
            without.map_or(Carried::Whole, Carried::Without)
        }
        AtSpeed::OtherForm(why) => Carried::Not(why),
        AtSpeed::Nothing => Carried::Not(match kind.description().place {
            Place::Torque | Place::Friction => "a torque of another form has no place here",
            Place::Load => "a second inertia has no place here; all of it stands as one",
            Place::Sensed => "it is the encoder's, and touches no motion",
            Place::Drive => "it is the power stage's or the brushes', and has no place here",
            Place::Winding => "constants of the winding that change have no place here",
        }),
    }
}

impl Friction {
    /// Of all effects. What is not determined is left out, and said so in `written`.
    pub fn of(subject: &Subject, written: &mut Written) -> Self {
        let mut sum = Friction::default();
        for term in &subject.terms {
            let (own, slides) = match term.kind.facts().at_speed {
                AtSpeed::Sliding { mean_of, .. } => (mean_of, true),
                AtSpeed::Viscous { mean_of, .. } => (mean_of, false),
                AtSpeed::Nothing | AtSpeed::OtherForm(_) => continue,
            };
            let Some(mean) = mean(term, own) else {
                written.lacks(
                    term.kind.name(),
                    "its size is not determined by the recording",
                );
                continue;
            };
            if slides {
                sum.sliding += mean;
                sum.slides.push(term.kind.name());
            } else {
                sum.viscous += mean;
            }
        }
        sum
    }
}

/// Mean of these parameters of a term, if all are determined. Zero is determined by its error, not by its size.
pub(super) fn mean(term: &Term, own: &[usize]) -> Option<f64> {
    let sum = own.iter().try_fold(0.0, |sum, &k| {
        term.determined[k].then(|| sum + term.values[k])
    });
    sum.map(|sum| sum / own.len() as f64)
}
