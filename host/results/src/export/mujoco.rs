//! A joint and a `dcmotor` actuator of MuJoCo (XML reference, `joint`, `actuator/dcmotor`; its technical note `dcmotor.pdf`).
//!
//! MuJoCo's motor has one constant ([`OneConstant`]). The inductance is given by the electrical time constant. For a MuJoCo without
//! `dcmotor` the same motor stands beside it as `general`, with `gain = 1/ρ` and `bias = −Kb/ρ`; that one has no inductance.
//! (MuJoCo 4.0.0 was seen to reach the speeds, and to give the cogging and LuGre torques, of these equations.)

use super::comment::{head, xml};
use super::digits::rounded;
use super::error::ExportError;
use super::friction::{self, Friction};
use super::one_constant::{Named, OneConstant};
use super::options::Options;
use super::subject::{Subject, Term};
use super::written::{Carried, Written};
use shared::effects::Kind;

const NAMED: Named = Named {
    format: "mujoco",
    program: "MuJoCo",
    constant: "motorconst",
};
/// Orders nearer to a whole number than this are one.
const WHOLE: f64 = 1e-3;
/// Inertia of the body that carries the joint, as a part of the armature.
const LITTLE: f64 = 1e-6;
/// How soon frictionloss has its whole torque. With MuJoCo's own 0.02 s a gearmotor creeps below 16 rad/s, and a run of 4 s was seen to
/// end 180 counts off, with this one 2; MuJoCo itself takes no less than two of its steps.
const AT_ONCE: &str = "0.0001 1";
/// The least that MuJoCo takes is 1e-15 kg·m².
const LEAST_INERTIA: f64 = 1e-14;

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    subject.needs_volts(NAMED.format)?;
    subject.needs_response(NAMED.format)?;
    let ratio = subject.needs_torques(NAMED.format)?;
    let mut written = Written::new(subject);
    let bristles = bristles(subject, ratio);
    let mut friction = Friction::of(subject, &mut written);
    if let Some((torque, _)) = &bristles {
        // It stands as bristles, and not once more as a constant.
        friction.sliding -= torque;
        let lugre = |name: &&str| *name == Kind::Lugre.name();
        if let Some(place) = friction.slides.iter().position(lugre) {
            friction.slides.remove(place);
        }
    }
    let one = OneConstant::of(subject, &friction, NAMED, &mut written)?;
    let (resistance, emf) = (one.resistance, one.constant);
    let mut joint = vec![
        ("damping", "N*m*s/rad", "viscous", one.damping),
        ("armature", "kg*m^2", "inertia", one.inertia),
    ];
    if let Some((torque, slides)) = &one.sliding {
        joint.push(("frictionloss", "N*m", slides.as_str(), *torque));
    }
    let mut motor = vec![
        ("resistance", "ohm", "resistance", format!("{resistance:?}")),
        ("motorconst", "V*s/rad", "kb", format!("{emf:?} {emf:?}")),
    ];
    if let Some(seconds) = one.electrical {
        motor.push((
            "inductance",
            "H s",
            "electrical_time_constant",
            format!("0 {seconds:?}"),
        ));
    } else {
        written.lacks(
            "electrical_time_constant",
            "not determined by this recording",
        );
    }
    if let Some(limit) = one.limit {
        let volts = limit.volts;
        motor.push((
            "ctrlrange",
            "V",
            limit.from,
            format!("-{volts:?} {volts:?}"),
        ));
    } else {
        written.remarks.push(
            "the supply is not known, so ctrlrange is left out: give it, or the actuator takes any voltage".to_owned(),
        );
    }
    let cogging = cogging(subject, ratio);
    if let Some((_, text)) = &cogging {
        motor.push(("cogging", "N*m 1 rad", "cogging", text.clone()));
        let place = "cogging: the joint's angle is zero where the encoder counts from";
        written.remarks.push(place.to_owned());
    }
    if let Some((_, text)) = &bristles {
        motor.push((
            "lugre",
            "N*m/rad N*m*s/rad N*m N*m rad/s",
            "lugre",
            text.clone(),
        ));
    }
    let (mut coggings, mut lugres, mut limits) = (0, 0, 0);
    for term in &subject.terms {
        let (count, carried) = match term.kind {
            Kind::Cogging => (&mut coggings, cogging.is_some()),
            Kind::Lugre => (&mut lugres, bristles.is_some()),
            Kind::VoltageSat => (&mut limits, term.determined[0]),
            _ => continue,
        };
        *count += 1;
        let name = term.kind.name();
        if *count > 1 || !carried {
            written.lacks(
                name,
                "MuJoCo takes one of them, of whole order and all determined",
            );
        }
    }
    let is_round =
        |t: &Term| t.kind == Kind::VoltageSat && t.values.last().is_some_and(|form| *form != 0.0);
    let rounds = subject.terms.iter().any(is_round);
    written.judge(subject, |kind| match kind {
        Kind::VoltageSat if rounds => Carried::Without("the limit is sharp"),
        Kind::Cogging | Kind::VoltageSat => Carried::Whole,
        Kind::Lugre if bristles.is_some() => Carried::Whole,
        Kind::Delay => Carried::Not("MuJoCo 4 has `delay` for it, in its own steps"),
        Kind::Heating => Carried::Not(
            "`thermal` needs what the winding's temperature is, and servoid knows only its effect",
        ),
        Kind::Unbalance => Carried::Not("give the body a mass off its axis"),
        kind => friction::carried(kind),
    });
    if subject.machine.electrical > 0.0 {
        written.remarks.push(
            "inductance is fast: use integrator=\"implicitfast\" and a small timestep".to_owned(),
        );
    }
    for (name, unit, from, _) in &joint {
        written.map(from, &format!("joint/{name}"), unit);
    }
    for (name, unit, from, _) in &motor {
        written.map(from, &format!("dcmotor/{name}"), unit);
    }

    let mut text = xml(&head(subject, &written));
    text += "<mujoco model=\"servoid motor\">\n  <compiler angle=\"radian\"/>\n  <worldbody>\n    <body name=\"rotor\">\n";
    text += "      <!-- all of the inertia is the armature; give the bodies of the load their own only if it is not in it -->\n";
    text += "      <joint name=\"shaft\" type=\"hinge\" axis=\"0 0 1\"";
    for (name, _, _, value) in &joint {
        text += &format!(" {name}=\"{value:?}\"");
    }
    if one.sliding.is_some() {
        text += &format!(" solreffriction=\"{AT_ONCE}\"");
    }
    // MuJoCo wants some inertia in every body that moves.
    let least = (LITTLE * one.inertia).max(LEAST_INERTIA);
    text += &format!(
        "/>\n      <inertial pos=\"0 0 0\" mass=\"1e-6\" diaginertia=\"{least:?} {least:?} {least:?}\"/>\n    </body>\n  </worldbody>\n"
    );
    text += "  <actuator>\n    <dcmotor name=\"motor\" joint=\"shaft\"";
    for (name, _, _, value) in &motor {
        text += &format!(" {name}=\"{value}\"");
    }
    text += "/>\n    <!-- without dcmotor, and without inductance, cogging and lugre:\n";
    let volts = one.limit.map(|limit| limit.volts);
    let range = volts.map_or_else(String::new, |v| format!(" ctrlrange=\"-{v:?} {v:?}\""));
    text += &format!(
        "    <general name=\"motor\" joint=\"shaft\"{range} gaintype=\"fixed\" gainprm=\"{:?}\" biastype=\"affine\" biasprm=\"0 0 {:?}\"/>\n    -->\n",
        rounded(1.0 / ratio),
        rounded(-emf / ratio)
    );
    text += "  </actuator>\n</mujoco>\n";
    written.text = text;
    Ok(written)
}

/// `amplitude poles phase`: MuJoCo pushes with `A·sin(n·θ + φ)` where ours brakes with `a·cos(kθ) + b·sin(kθ)`.
fn cogging(subject: &Subject, ratio: f64) -> Option<(Kind, String)> {
    let term = subject.first(Kind::Cogging)?;
    let (a, b, order) = (term.values[0], term.values[1], term.values[2]);
    let whole = order.round();
    let fits = (order - whole).abs() < WHOLE && whole >= 1.0;
    let phase = (-a).atan2(-b);
    fits.then(|| {
        (
            term.kind,
            format!("{:?} {whole:.0} {phase:?}", a.hypot(b) / ratio),
        )
    })
}

/// The sliding friction (V), and `stiffness damping coulomb static stribeck`, with `σ0 = Tc·(1 + r)/z(0)` and `σ1 = σ0·t1`.
fn bristles(subject: &Subject, ratio: f64) -> Option<(f64, String)> {
    let term = subject.first(Kind::Lugre)?;
    let [torque, excess, speed, presliding, time, form] = term.values[..] else {
        return None;
    };
    let sliding = torque / ratio;
    let holding = sliding * (1.0 + excess);
    let stiffness = holding / presliding;
    // MuJoCo's damping does not fall with the speed.
    let fits = presliding > 0.0 && speed > 0.0 && stiffness.is_finite() && form == 0.0;
    fits.then(|| {
        let damping = stiffness * time;
        let text = format!("{stiffness:?} {damping:?} {sliding:?} {holding:?} {speed:?}");
        (torque, text)
    })
}
