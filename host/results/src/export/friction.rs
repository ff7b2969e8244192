//! Friction in the two numbers that most programs have for it: a constant one against motion, and one that grows with
//! the speed. Effects with more are reduced to what they are at speed.

use super::subject::{Subject, Term};
use super::written::{Carried, Written};
use shared::effects::Kind;

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
    match kind {
        Kind::Coulomb => Carried::Whole,
        Kind::AsymCoulomb => Carried::Without("the mean of both directions stands for each"),
        Kind::Stribeck => Carried::Without("what is larger near standstill is left out"),
        Kind::Lugre => {
            Carried::Without("what is elastic and what is larger near standstill is left out")
        }
        Kind::AsymViscous => Carried::Without("the mean of both directions stands for each"),
        Kind::LoadFriction => Carried::Not("friction that grows with the load has no place here"),
        Kind::LoadTorque => Carried::Not("a constant torque has no place here"),
        Kind::Windage => Carried::Not("drag on the square of the speed has no place here"),
        Kind::Cogging | Kind::Unbalance => {
            Carried::Not("a torque that depends on the angle has no place here")
        }
        Kind::Backlash | Kind::Compliance => {
            Carried::Not("a second inertia has no place here; all of it stands as one")
        }
        Kind::EncEcc | Kind::MissedCounts => {
            Carried::Not("it is the encoder's, and touches no motion")
        }
        Kind::DeadZone
        | Kind::OffsetVoltage
        | Kind::BrushDrop
        | Kind::SupplySag
        | Kind::VoltageSat
        | Kind::Delay => {
            Carried::Not("it is the power stage's or the brushes', and has no place here")
        }
        Kind::TorqueSat | Kind::LSat | Kind::Heating => {
            Carried::Not("constants of the winding that change have no place here")
        }
    }
}

impl Friction {
    /// Of all effects. What is not determined is left out, and said so in `written`.
    pub fn of(subject: &Subject, written: &mut Written) -> Self {
        let mut sum = Friction::default();
        for term in &subject.terms {
            let own = match term.kind {
                Kind::Coulomb | Kind::Stribeck | Kind::Lugre => &[0][..],
                Kind::AsymCoulomb | Kind::AsymViscous => &[0, 1],
                _ => continue,
            };
            let Some(mean) = mean(term, own) else {
                written.lacks(
                    term.kind.name(),
                    "its size is not determined by the recording",
                );
                continue;
            };
            if term.kind == Kind::AsymViscous {
                sum.viscous += mean;
            } else {
                sum.sliding += mean;
                sum.slides.push(term.kind.name());
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
