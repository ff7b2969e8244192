//! A speed controller of ROS 2: `pid_controller/PidController` (ros-controls/ros2_controllers, `pid_controller.yaml`), whose command is
//! `p·e + i·∫e dt + feedforward_gain·reference`. The gains are those of `gains/`, for a loop that gives volts (behind a current loop units of
//! the command).

use super::comment::{head, marked};
use super::digits::yaml;
use super::error::ExportError;
use super::gains::feed_forward::FeedForward;
use super::gains::{Loops, design};
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use servoid_io::recording::Drive;

const FORMAT: &str = "ros2-control";
/// The controller, and the joint.
const CONTROLLER: &str = "motor_speed_controller";
const JOINT: &str = "shaft";

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
    let mut options = *options;
    options.gains.loops = Some(Loops::Voltage);
    let controllers = design(subject, &options)?;
    let mut written = Written::new(subject);
    written.remarks.extend(controllers.remarks.iter().cloned());
    let speed = controllers.section("speed_loop");
    let pi = speed.map(|section| section.closed.pi);
    let pi = pi.ok_or_else(|| ExportError::Undetermined {
        format: FORMAT,
        needs: "a speed loop".to_owned(),
        remedy: super::error::FIT_AGAIN,
    })?;
    let feed = FeedForward::of(subject, &mut written);
    let volt = subject.unit_shown("V");
    let mut gains = vec![
        ("p", "the linear machine", format!("{volt}/(rad/s)"), pi.kp),
        ("i", "the linear machine", format!("{volt}/rad"), pi.ki),
        (
            "feedforward_gain",
            "gain",
            format!("{volt}/(rad/s)"),
            feed.k_v,
        ),
    ];
    let limit = subject.supply_v.filter(|_| subject.drive == Drive::Voltage);
    match limit {
        Some(volts) => {
            gains.push(("i_clamp_max", "supply", volt.clone(), volts));
            gains.push(("i_clamp_min", "supply", volt.clone(), -volts));
        }
        None => written.remarks.push(
            "the largest command is not known: give i_clamp_max and i_clamp_min, which are zero else".to_owned(),
        ),
    }
    // The manager counts whole updates a second.
    let rate = (1.0 / controllers.period).round().max(1.0);
    written.map("sample", "update_rate", "Hz");
    for (to, from, unit, _) in &gains {
        written.map(from, &format!("gains.{JOINT}.{to}"), unit);
    }
    for (name, value, unit) in [
        ("k_s", feed.k_s, "against friction"),
        ("k_g", feed.k_g, "against what pulls constantly"),
        ("k_a", Some(feed.k_a), "by the acceleration"),
    ] {
        if let Some(value) = value {
            written.lacks(
                name,
                &format!("pid_controller has no feed-forward {unit}; it is {value:?}, in {volt} and rad/s"),
            );
        }
    }
    // Friction stands in k_s, which has no place.
    for term in &subject.terms {
        let name = term.kind.name();
        if !written.cannot_carry.iter().any(|lack| lack.what == name) {
            written.lacks(name, "pid_controller has a feed-forward by the speed alone");
        }
    }
    written.remarks.push(format!(
        "command_interface: the name of an interface of your hardware that takes {volt}; velocity is in rad/s"
    ));
    let mut text = marked(&head(subject, &written), "# ");
    text += &format!(
        "controller_manager:\n  ros__parameters:\n    update_rate: {rate:.0}\n    {CONTROLLER}:\n      type: pid_controller/PidController\n\n"
    );
    let interface = match subject.drive {
        Drive::Voltage => "voltage",
        Drive::Current | Drive::Torque => "effort",
    };
    text += &format!(
        "{CONTROLLER}:\n  ros__parameters:\n    dof_names: [{JOINT}]\n    command_interface: {interface}\n    \
         reference_and_state_interfaces: [velocity]\n    enable_feedforward: true\n    gains:\n      {JOINT}:\n        d: 0.0\n"
    );
    for (to, _, unit, value) in &gains {
        text += &format!("        {to}: {} # {unit}\n", yaml(*value));
    }
    written.text = text;
    Ok(written)
}
