//! A parameter file of bam (Rhoban, `bam/model.py`; Duclusaud, Passault, *Extended friction models for servo actuators*, ICRA 2025).
//!
//! bam has one motor constant ([`OneConstant`]), and no inductance. Its models differ in their friction: `m1` is Coulomb and viscous, `m2`
//! adds Stribeck's hump `Ts·exp(−|ω/ωs|^α)`, `m3` friction that grows with the torque between motor and load, `m4` both. A key that
//! is not there takes a start value of bam's, so that every key of the model is written. Keys that bam does not know it passes over:
//! `servoid` holds what other formats say in comments.

use super::comment::head;
use super::digits::rounded;
use super::error::ExportError;
use super::friction::{self, Friction};
use super::one_constant::{Named, OneConstant};
use super::options::Options;
use super::subject::{Subject, Term};
use super::written::{Carried, Written};
use serde_json::{Map, Value};
use shared::effects::Kind;

const NAMED: Named = Named {
    format: "bam",
    program: "bam",
    constant: "kt",
};
/// One of bam's actuators that take a voltage; it decides on gains of the servo's firmware alone.
const ACTUATOR: &str = "mx106";

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let friction = Friction::of(subject, &mut written);
    let one = OneConstant::of(subject, &friction, NAMED, &mut written)?;
    let hump = subject.first(Kind::Stribeck).filter(is_hump);
    // The torque of the motor is right only with the back-EMF alone in it.
    let share = subject.first(Kind::LoadFriction);
    let share = share.filter(|_| subject.viscous_is_apart());
    let mut body = Map::new();
    let mut put = |key: &str, value: Value| body.insert(key.to_owned(), value);
    let mut number = |key: &str, from: &str, unit: &str, value: f64| {
        written.map(from, key, unit);
        put(key, value.into());
    };
    number("kt", "kb", "V*s/rad", one.constant);
    number("R", "resistance", "ohm", one.resistance);
    number("armature", "inertia", "kg*m^2", one.inertia);
    let (base, slides) = one.sliding.clone().unwrap_or_default();
    let slides = if slides.is_empty() {
        "no friction in the model"
    } else {
        &slides
    };
    number("friction_base", slides, "N*m", base);
    number("friction_viscous", "viscous", "N*m*s/rad", one.damping);
    if let Some(term) = hump {
        let excess = rounded(term.values[1] / one.ratio);
        number("friction_stribeck", "stribeck.excess_torque", "N*m", excess);
        let [speed, exponent] = [term.values[2], term.values[3]];
        number("dtheta_stribeck", "stribeck.speed", "rad/s", speed);
        number("alpha", "stribeck.exponent", "1", exponent);
    }
    if let Some(term) = share {
        number(
            "load_friction_base",
            "load_friction.share",
            "1",
            term.values[0],
        );
    }
    if hump.is_some() && share.is_some() {
        put("load_friction_stribeck", 0.0.into());
    }
    // A rig's offset and lateness, which are not the motor's.
    put("q_offset", 0.0.into());
    put("command_delay", 0.0.into());
    let model = match (hump, share) {
        (None, None) => "m1",
        (Some(_), None) => "m2",
        (None, Some(_)) => "m3",
        (Some(_), Some(_)) => "m4",
    };
    put("model", model.into());
    put("actuator", ACTUATOR.into());
    judge(subject, hump.is_some(), share.is_some(), &mut written);
    written.remarks.push(format!(
        "actuator: {ACTUATOR} stands for a servo that turns a position error into a voltage; put your servo's name there, or its class \
         into bam/actuators.py: its gain and supply voltage are not in this file"
    ));
    let lines = head(subject, &written);
    body.insert("servoid".to_owned(), lines.into());
    let text = serde_json::to_string_pretty(&body);
    written.text = text.map_err(|error| ExportError::Text(error.to_string()))? + "\n";
    Ok(written)
}

/// Whether the term has bam's form.
fn is_hump(term: &&Term) -> bool {
    let [_, excess, speed, exponent, form] = term.values[..] else {
        return false;
    };
    excess >= 0.0 && speed > 0.0 && exponent > 0.0 && form == 0.0
}

/// What bam does not carry.
fn judge(subject: &Subject, hump: bool, share: bool, written: &mut Written) {
    written.lacks("electrical_time_constant", "bam has no inductance");
    for kind in [Kind::Stribeck, Kind::LoadFriction] {
        let again = subject.terms.iter().filter(|term| term.kind == kind);
        if again.count() > 1 {
            written.lacks(kind.name(), "bam takes one of them");
        }
    }
    written.judge(subject, |kind| match kind {
        Kind::Stribeck if hump => Carried::Whole,
        Kind::Stribeck => Carried::Without(
            "what is larger near standstill is left out: it is not all determined, or of another form",
        ),
        Kind::LoadFriction if share => Carried::Whole,
        Kind::LoadFriction => Carried::Not(
            "its share, or viscous friction apart from back-EMF, is not determined by this recording",
        ),
        Kind::Delay => Carried::Not(
            "bam's command_delay is that of the target of its position loop, and not of the voltage",
        ),
        Kind::VoltageSat => Carried::Not("the actuator's class holds the supply voltage and the largest duty"),
        kind => friction::carried(kind),
    });
}
