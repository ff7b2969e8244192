//! Feed-forward with compensation of friction: the command that a wanted motion needs.
//!
//! `u = kS·sign(ω) + kG + kV·ω + kA·dω/dt`: the inverse of the motor's response without its second-order term (Ellis, *Control
//! System Design Guide*, 2012, ch. 8). A dead zone of the stage is missing at every command, as friction is at every
//! speed, and adds to `kS`.

use super::super::friction::{self, Friction, mean};
use super::super::subject::Subject;
use super::super::written::{Carried, Written};
use shared::effects::Kind;

/// Commands in V (behind a current loop in units of the command), speeds in rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedForward {
    /// Against friction and dead zone, V; none where the model has neither.
    pub k_s: Option<f64>,
    /// The effects that make it.
    pub k_s_from: String,
    /// Against what pulls constantly, V; none where nothing does.
    pub k_g: Option<f64>,
    /// The effects that make it.
    pub k_g_from: String,
    /// The part of `k_s` that is friction, without the dead zone, V.
    pub sliding: Option<f64>,
    /// Of friction alone, without back-EMF, V per rad/s; none where they are not told apart.
    pub viscous: Option<f64>,
    /// V per rad/s.
    pub k_v: f64,
    /// V per rad/s².
    pub k_a: f64,
}

impl FeedForward {
    /// Of a motor whose response is determined. Notes in `written` what has no place in it.
    pub fn of(subject: &Subject, written: &mut Written) -> Self {
        let friction = Friction::of(subject, written);
        let machine = &subject.machine;
        let (mut constant, mut constant_from) = (None, Vec::new());
        let (mut dead, mut dead_from) = (None, friction.slides.clone());
        for term in &subject.terms {
            // A load brakes and is added; an offset helps and is taken off.
            let (sum, from, sign): (&mut Option<f64>, _, _) = match term.kind {
                Kind::LoadTorque => (&mut constant, &mut constant_from, 1.0),
                Kind::OffsetVoltage => (&mut constant, &mut constant_from, -1.0),
                Kind::DeadZone => (&mut dead, &mut dead_from, 1.0),
                _ => continue,
            };
            match mean(term, &[0]) {
                Some(volts) => {
                    *sum = Some(sum.unwrap_or(0.0) + sign * volts);
                    from.push(term.kind.name());
                }
                None => written.lacks(
                    term.kind.name(),
                    "its size is not determined by the recording",
                ),
            }
        }
        written.judge(subject, |kind| match kind {
            Kind::LoadTorque | Kind::OffsetVoltage => Carried::Whole,
            Kind::DeadZone => Carried::Without(
                "right where the command has the sign of the speed, wrong while braking hard",
            ),
            Kind::BrushDrop | Kind::DeadTime => Carried::Not(
                "it changes its sign with the current, not with the speed: while driving, add its voltage to kS",
            ),
            Kind::VoltageSat => Carried::Not("limit the output to it"),
            kind => friction::carried(kind),
        });
        let slides = (!friction.slides.is_empty()).then_some(friction.sliding);
        FeedForward {
            k_s: match (slides, dead) {
                (None, None) => None,
                (sliding, dead) => Some(sliding.unwrap_or(0.0) + dead.unwrap_or(0.0)),
            },
            k_s_from: dead_from.join(", "),
            sliding: slides,
            viscous: (subject.viscous_is_apart()).then_some(machine.damping + friction.viscous),
            k_g: constant,
            k_g_from: constant_from.join(", "),
            k_v: machine.kb + machine.damping + friction.viscous,
            k_a: machine.inertia + machine.electrical * machine.damping,
        }
    }
}
