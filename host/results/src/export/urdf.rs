//! The `<dynamics>` of a joint in URDF (ROS, `urdf/XML/joint`): viscous friction in N·m·s/rad and Coulomb friction in N·m.
//! URDF has no rotor inertia, no winding and no Stribeck effect.

use super::comment::{head, xml};
use super::error::ExportError;
use super::friction::{Friction, carried};
use super::options::Options;
use super::subject::Subject;
use super::written::Written;

const FORMAT: &str = "urdf";

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    subject.needs_volts(FORMAT)?;
    subject.needs_response(FORMAT)?;
    let ratio = subject.needs_torques(FORMAT)?;
    let mut written = Written::new(subject);
    let friction = Friction::of(subject, &mut written);
    let mut attributes = Vec::new();
    if subject.viscous_is_apart() {
        let damping = (subject.machine.damping + friction.viscous) / ratio;
        attributes.push(("damping", "viscous".to_owned(), "N*m*s/rad", damping));
    } else {
        written.lacks(
            "viscous",
            "not told apart from back-EMF; record a stretch of coasting with the bridge open",
        );
    }
    if !friction.slides.is_empty() {
        let from = friction.slides.join(", ");
        attributes.push(("friction", from, "N*m", friction.sliding / ratio));
    }
    if attributes.is_empty() {
        return Err(ExportError::Undetermined {
            format: FORMAT,
            needs: "some friction".to_owned(),
            remedy: "fit again with --with coulomb, or record a stretch of coasting with the bridge open",
        });
    }
    for (name, from, unit, _) in &attributes {
        written.map(from, &format!("dynamics/{name}"), unit);
    }
    written.judge(subject, carried);
    let inertia = subject.machine.inertia / ratio;
    for (what, why) in [
        (
            "inertia",
            format!(
                "URDF has no rotor inertia: {inertia:?} kg*m^2 on this side belong to the actuator or the link"
            ),
        ),
        ("back-EMF", "URDF has no motor".to_owned()),
        ("electrical_time_constant", "URDF has no motor".to_owned()),
    ] {
        written.lacks(what, &why);
    }
    let mut text = xml(&head(subject, &written));
    text += "<dynamics";
    for (name, _, _, value) in &attributes {
        text += &format!(" {name}=\"{value:?}\"");
    }
    text += "/>\n";
    written.text = text;
    Ok(written)
}
