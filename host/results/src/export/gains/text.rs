//! The controllers as TOML.

use super::super::comment::{head, marked};
use super::super::digits::rounded;
use super::super::error::ExportError;
use super::super::options::Options;
use super::super::subject::Subject;
use super::super::written::{Lack, Written};
use super::design::Method;
use super::feed_forward::FeedForward;
use super::loops::{Pi, hz};
use super::{Section, design};
use shared::effects::Kind;
use std::f64::consts::TAU;

pub(in crate::export) fn write(
    subject: &Subject,
    options: &Options,
) -> Result<Written, ExportError> {
    let controllers = design(subject, options)?;
    let mut written = Written::new(subject);
    written.remarks.extend(controllers.remarks.iter().cloned());
    let feed = FeedForward::of(subject, &mut written);
    let is_delay = |lack: &&mut Lack| lack.what == Kind::Delay.name();
    for lack in written.cannot_carry.iter_mut().filter(is_delay) {
        lack.why = "it is in the margins, and not in the feed-forward".to_owned();
    }
    let mut body = format!("sample_s = {:?}\n", controllers.period);
    for section in &controllers.sections {
        body += &text(section, subject, &mut written);
    }
    let volt = subject.unit_shown("V");
    body += "\n# the command that a motion needs: u = k_s*sign(w) + k_g + k_v*w + k_a*dw/dt, without a current loop added to the\n\
             # speed loop's output\n[feed_forward]\n";
    let per = |unit: &str| {
        [
            unit.to_owned(),
            format!("{unit} per rad/s"),
            format!("{unit} per rad/s^2"),
        ]
    };
    let [constant, rate, second] = per(&volt);
    for (key, from, number, unit) in [
        ("k_s", feed.k_s_from.as_str(), feed.k_s, &constant),
        ("k_g", &feed.k_g_from, feed.k_g, &constant),
        ("k_v", "gain", Some(feed.k_v), &rate),
        ("k_a", "a1, gain", Some(feed.k_a), &second),
    ] {
        if let Some(number) = number {
            written.map(from, &format!("feed_forward.{key}"), unit);
            body += &format!("{key} = {number:?} # {unit}\n");
        }
    }
    let ohm = subject.physical("resistance", "ohm");
    if let Some(ohm) = ohm.filter(|_| controllers.section("current_loop").is_some()) {
        // Behind the current loop back-EMF, offsets and dead zone are its own affair.
        body += "\n# the current that a motion needs, added to the speed loop's output\n[feed_forward_current]\n";
        let [constant, rate, second] = per("A");
        for (key, from, number, unit) in [
            ("k_s", "friction", feed.sliding, &constant),
            ("k_v", "viscous", feed.viscous, &rate),
            ("k_a", "inertia", Some(subject.machine.inertia), &second),
        ] {
            if let Some(number) = number {
                written.map(from, &format!("feed_forward_current.{key}"), unit);
                body += &format!("{key} = {:?} # {unit}\n", number / ohm);
            }
        }
    }
    let mut text = marked(&head(subject, &written), "# ");
    text += "#\n# PI: u[k] = kp*e[k] + x[k], x[k+1] = x[k] + ki*sample_s*e[k]; hold x while u is clipped.\n";
    text += "# u[k] acts one period after e[k] was read. Speed is the difference of counts over a period.\n";
    text += "# Margins and bandwidth are those of the sampled loop with this dead time.\n";
    text += &body;
    written.text = text;
    Ok(written)
}

/// One loop's section.
fn text(section: &Section, subject: &Subject, written: &mut Written) -> String {
    let Section {
        name,
        closed,
        output,
        input,
        ..
    } = section;
    let Pi { kp, ki } = closed.pi;
    let method = match section.method {
        Method::Cancel => "cancel",
        Method::Symmetrical => "symmetrical",
    };
    let mut out =
        format!("\n[{name}] # error in {input}, output in {output}\nmethod = \"{method}\"\n");
    let mut gain = |key: &str, value: f64, unit: String| {
        written.map("the linear machine", &format!("{name}.{key}"), &unit);
        out += &format!("{key} = {value:?} # {unit}\n");
    };
    gain("kp", kp, format!("{output} per {input}"));
    gain("ki", ki, format!("{output} per {input} and second"));
    if let Some(counts) = subject.counts_per_rev.filter(|_| *input == "rad/s") {
        let speed = TAU / counts;
        gain("kp_counts", kp * speed, format!("{output} per count/s"));
        gain(
            "ki_counts",
            ki * speed,
            format!("{output} per count/s and second"),
        );
    }
    out += &format!("crossover_hz = {:?}\n", rounded(hz(closed.crossover)));
    out += &format!("phase_margin_deg = {:?}\n", rounded(closed.phase_margin));
    out += &match closed.bandwidth {
        Some(bandwidth) => format!(
            "bandwidth_hz = {:?} # -3 dB of the closed loop\n",
            rounded(hz(bandwidth))
        ),
        None => "# bandwidth: beyond half the sampling rate\n".to_owned(),
    };
    out
}
