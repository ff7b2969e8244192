//! Feed-forward of WPILib: `V = kS·sign(v) + kV·v + kA·a` (`SimpleMotorFeedforward`), with `kG` of `ElevatorFeedforward` where
//! something constant pulls. From `θ/V = gain/(s·(a2·s² + a1·s + 1))`: `kV = 1/gain`, `kA = a1/gain`; what a2 adds with the
//! jerk has no place. Nothing but volts is needed.

use super::comment::{head, marked};
use super::error::ExportError;
use super::gains::feed_forward::FeedForward;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use std::f64::consts::TAU;

const FORMAT: &str = "wpilib";

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    subject.needs_volts(FORMAT)?;
    subject.needs_response(FORMAT)?;
    let mut written = Written::new(subject);
    let feed = FeedForward::of(subject, &mut written);
    written.lacks(
        "a2 (electrical time constant)",
        "WPILib has no term in the jerk",
    );
    let side = subject.side.words();
    let mut body = String::new();
    if feed.k_s.is_none() {
        body += "  // kS: no friction in the model, or not determined; see above.\n";
    }
    for (name, from, value, unit) in [
        ("kS", feed.k_s_from.as_str(), feed.k_s, "V"),
        ("kG", &feed.k_g_from, feed.k_g, "V"),
        ("kV", "gain", Some(feed.k_v), "V per rad/s"),
        ("kA", "a1, gain", Some(feed.k_a), "V per rad/s^2"),
        ("kVRotations", "gain", Some(feed.k_v * TAU), "V per rev/s"),
        (
            "kARotations",
            "a1, gain",
            Some(feed.k_a * TAU),
            "V per rev/s^2",
        ),
    ] {
        let Some(value) = value else { continue };
        written.map(from, name, unit);
        body += &format!(
            "  /** {unit}, {side}. */\n  public static final double {name} = {value:?};\n"
        );
    }
    let mut text = marked(&head(subject, &written), "// ");
    text += "public final class MotorConstants {\n  private MotorConstants() {}\n\n";
    text += &body;
    text += "}\n";
    written.text = text;
    Ok(written)
}
