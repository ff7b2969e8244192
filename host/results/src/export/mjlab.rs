//! A motor of mjlab: its `DcMotorActuatorCfg` (mujocolab/mjlab, `actuator/dc_actuator.py`), as Python.
//!
//! mjlab clips the torque that is asked for to `saturation_effort·(±1 − ω/velocity_limit)` and to `±effort_limit`. A motor of one motor
//! constant `K` ([`OneConstant`]) at the largest voltage `V` gives `(K/R)·(±V − K·ω)`: the stall torque is `V·K/R`, and the speed without
//! torque `V/K`. A voltage `u` is the torque `(K/R)·(u − K·ω)`: at full speed and full voltage against it twice the stall torque, which is
//! what `effort_limit` lets pass.

use super::comment::{head, marked};
use super::digits::rounded;
use super::error::ExportError;
use super::friction::{self, Friction};
use super::one_constant::{Named, OneConstant};
use super::options::Options;
use super::subject::Subject;
use super::written::{Carried, Written};
use shared::effects::Kind;

const NAMED: Named = Named {
    format: "mjlab",
    program: "mjlab",
    constant: "velocity_limit",
};

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let friction = Friction::of(subject, &mut written);
    let one = OneConstant::of(subject, &friction, NAMED, &mut written)?;
    let limit = one.limit.ok_or_else(|| ExportError::Undetermined {
        format: NAMED.format,
        needs: "the largest voltage".to_owned(),
        remedy: "fit again with supply_v = … in motor.toml, or --supply-v",
    })?;
    let stall = rounded(limit.volts / one.ratio);
    let mut fields = vec![
        ("effort_limit", limit.from, "N*m", rounded(2.0 * stall)),
        ("saturation_effort", limit.from, "N*m", stall),
        (
            "velocity_limit",
            "kb",
            "rad/s",
            rounded(limit.volts / one.constant),
        ),
        ("armature", "inertia", "kg*m^2", one.inertia),
        ("viscous_damping", "viscous", "N*m*s/rad", one.damping),
    ];
    if let Some((torque, slides)) = &one.sliding {
        fields.push(("frictionloss", slides.as_str(), "N*m", *torque));
    }
    let mut body = String::new();
    for (to, from, unit, value) in fields {
        written.map(from, to, unit);
        body += &format!("    {to}={value:?},  # {unit}\n");
    }
    let clips = |kind: Kind| kind == Kind::VoltageSat;
    let rounds = subject
        .terms
        .iter()
        .any(|term| clips(term.kind) && term.values.last() != Some(&0.0));
    let unsaid = subject
        .terms
        .iter()
        .any(|term| clips(term.kind) && !term.determined[0]);
    written.lacks(
        "electrical_time_constant",
        "mjlab's motor has no inductance",
    );
    written.judge(subject, |kind| match kind {
        Kind::VoltageSat if unsaid => Carried::Not("its size is not determined by the recording"),
        Kind::VoltageSat if rounds => Carried::Without("the limit is sharp"),
        Kind::VoltageSat => Carried::Whole,
        Kind::Delay => {
            Carried::Not("delay_min_lag and delay_max_lag are for it, in steps of your simulation")
        }
        kind => friction::carried(kind),
    });
    written.remarks.extend([
        "effort_limit is what the motor gives where it is braked by the full voltage, twice the stall torque, of which mjlab warns: put the torque \
         there that your motor and drive stand for long"
            .to_owned(),
        "stiffness and damping are gains of a position controller, which is not the motor's: put yours there; with both zero the \
         motor takes the torque that is asked for"
            .to_owned(),
        format!(
            "a voltage u is the torque (u - {:?}*w)/{:?}, in V, rad/s and N*m",
            one.constant,
            rounded(one.ratio)
        ),
        "viscous_damping is a joint's: where your mjlab does not know it, put it into the model's XML".to_owned(),
    ]);
    let mut text = marked(&head(subject, &written), "# ");
    text += "\nfrom mjlab.actuator import DcMotorActuatorCfg\n\nMOTOR = DcMotorActuatorCfg(\n    target_names_expr=(\"shaft\",),\n";
    text += "    stiffness=0.0,\n    damping=0.0,\n";
    text += &body;
    text += ")\n";
    written.text = text;
    Ok(written)
}
