//! Variables of a workspace of MATLAB for the blocks DC Motor (Simscape Electrical) and Rotational Friction (Simscape).
//!
//! DC Motor has one motor constant ([`OneConstant`]). Rotational Friction is
//! `√(2e)·(Tbrk − TC)·exp(−(ω/ωSt)²)·ω/ωSt + TC·tanh(ω/ωCoul) + f·ω` with `ωCoul` a tenth of the breakaway velocity: Coulomb
//! friction is `Tbrk = TC` with a small breakaway velocity.

use super::comment::{head, marked};
use super::digits::rounded;
use super::error::ExportError;
use super::friction::{Friction, carried};
use super::one_constant::{Named, OneConstant};
use super::options::Options;
use super::subject::Subject;
use super::written::{Carried, Written};
use shared::effects::Kind;

const NAMED: Named = Named {
    format: "simscape",
    program: "DC Motor of Simscape",
    constant: "K",
};
/// Breakaway velocity where friction is sliding friction alone, rad/s.
const BREAKAWAY: f64 = 0.1;

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let friction = Friction::of(subject, &mut written);
    let one = OneConstant::of(subject, &friction, NAMED, &mut written)?;
    let mut motor = vec![
        (
            "motor.Ra",
            "resistance",
            "Ohm",
            one.resistance,
            "Armature resistance",
        ),
        (
            "motor.K",
            "kb",
            "V/(rad/s)",
            one.constant,
            "Back-emf constant",
        ),
        (
            "motor.Jm",
            "inertia",
            "kg*m^2",
            one.inertia,
            "Rotor inertia",
        ),
        (
            "motor.Dm",
            "viscous",
            "N*m/(rad/s)",
            one.damping,
            "Rotor damping",
        ),
    ];
    let inductance = one
        .electrical
        .map(|seconds| rounded(seconds * one.resistance));
    if let Some(henry) = inductance {
        let asks = "Armature inductance";
        motor.push(("motor.La", "electrical_time_constant", "H", henry, asks));
    }
    let title = "DC Motor, Model parameterization: By equivalent circuit parameters";
    let mut body = block(title, &motor, &mut written);
    if let Some((torque, slides)) = &one.sliding {
        let lines = [
            (
                "motor.TC",
                slides.as_str(),
                "N*m",
                *torque,
                "Coulomb friction torque",
            ),
            (
                "motor.Tbrk",
                slides.as_str(),
                "N*m",
                *torque,
                "Breakaway friction torque",
            ),
        ];
        let title = "Rotational Friction, between the motor's shaft and its case";
        body += &block(title, &lines, &mut written);
        body += &format!(
            "motor.wbrk = {BREAKAWAY:?}; % rad/s: Breakaway friction velocity, assumed\n\
             motor.f = 0.0; % N*m/(rad/s): Viscous friction coefficient; all of it is the motor's Rotor damping\n"
        );
    }
    if let Some(limit) = one.limit {
        let asks = "largest voltage of the source";
        let source = ("motor.Vmax", limit.from, "V", limit.volts, asks);
        body += &block("The source", &[source], &mut written);
    }
    if inductance.is_none() {
        written.lacks(
            "electrical_time_constant",
            "not determined by this recording",
        );
    }
    written.judge(subject, |kind| match kind {
        Kind::VoltageSat if one.limit.is_some() => {
            Carried::Without("limit the source to motor.Vmax")
        }
        kind => carried(kind),
    });
    written.remarks.push(
        "the blocks' own units are others (V/rpm, g*cm^2): choose those that stand beside each number".to_owned(),
    );
    let mut text = marked(&head(subject, &written), "% ");
    text += &body;
    written.text = text;
    Ok(written)
}

/// The variables of a block: name here, name in the result, unit, number, and the block's own name for it.
fn block(title: &str, lines: &[(&str, &str, &str, f64, &str)], written: &mut Written) -> String {
    let mut text = format!("\n% {title}\n");
    for (to, from, unit, value, asks) in lines {
        written.map(from, to, unit);
        text += &format!("{to} = {value:?}; % {unit}: {asks}\n");
    }
    text
}
