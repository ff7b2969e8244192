//! The constants that firmware takes, in single precision: what the C header and the Rust module share.

use super::discrete;
use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use servoid_io::recording::Drive;
use std::collections::HashSet;

/// One constant.
pub(super) struct Constant {
    /// Upper case, digits and underscores.
    pub name: String,
    /// Finite, and zero only if the number is.
    pub value: f32,
    /// Unit, error and side.
    pub about: String,
}

/// The constants, and the lines that say how the step is computed from them.
pub(super) struct Constants {
    /// All of them.
    pub list: Vec<Constant>,
    /// What the step is.
    pub step: Vec<String>,
}

pub(super) fn constants(
    subject: &Subject,
    options: &Options,
    format: &'static str,
    written: &mut Written,
) -> Result<Constants, ExportError> {
    subject.needs_response(format)?;
    let period = options.period(subject, format)?;
    let mut list = List {
        all: Vec::new(),
        names: HashSet::new(),
        written,
    };
    let side = subject.side.name();
    for value in &subject.values {
        if !value.determined {
            list.written
                .lacks(&value.name, "not determined by this recording");
            continue;
        }
        let unit = subject.unit_shown(&value.unit);
        let std = value.std.filter(|std| *std > 0.0);
        let std = std.map_or_else(String::new, |std| format!(", standard deviation {std:.2e}"));
        list.push(
            &value.name,
            value.value,
            &unit,
            &format!("{unit}{std}, {side} side"),
        );
    }
    for (name, number, unit) in [
        ("supply", subject.supply_v, "V"),
        ("counts_per_rev", subject.counts_per_rev, "count/rev"),
        ("sample", Some(period), "s"),
    ] {
        if let Some(number) = number {
            list.push(name, number, unit, &format!("{unit}, {side} side"));
        }
    }
    let by = discrete::step(subject, period)?;
    let [[cc, cw], [wc, ww]] = by.state;
    let [cv, wv] = by.state_by_command;
    let [tc, tw] = by.angle;
    let tv = by.angle_by_command;
    let [ct, wt, tt] = by.by_torque;
    let volt = subject.unit_shown("V");
    let speed = "rad/s";
    for (name, number, of, per) in [
        ("step_c_by_c", cc, volt.as_str(), volt.as_str()),
        ("step_c_by_w", cw, &volt, speed),
        ("step_c_by_v", cv, &volt, &volt),
        ("step_w_by_c", wc, speed, &volt),
        ("step_w_by_w", ww, speed, speed),
        ("step_w_by_v", wv, speed, &volt),
        ("step_theta_by_c", tc, "rad", &volt),
        ("step_theta_by_w", tw, "rad", speed),
        ("step_theta_by_v", tv, "rad", &volt),
        ("step_c_by_t", ct, &volt, &volt),
        ("step_w_by_t", wt, speed, &volt),
        ("step_theta_by_t", tt, "rad", &volt),
    ] {
        let unit = format!("({of})/({per})");
        list.push(name, number, &unit, &format!("{of} per {per}, {side} side"));
    }
    for term in &subject.terms {
        let kind = term.kind.description();
        if term.determined.contains(&true) {
            list.written.remarks.push(format!(
                "{}: {}; torques and friction in {volt} are T*R/Kt",
                kind.name, kind.equation
            ));
        } else {
            list.written
                .lacks(kind.name, "none of its parameters is determined");
        }
    }
    let mut step = vec![
        format!("Exact step of the linear machine over {period:?} s from the old c, w and theta, with v and t held:"),
        "  c'     = c     + STEP_C_BY_C*c     + STEP_C_BY_W*w     + STEP_C_BY_V*v     + STEP_C_BY_T*t".to_owned(),
        "  w'     = w     + STEP_W_BY_C*c     + STEP_W_BY_W*w     + STEP_W_BY_V*v     + STEP_W_BY_T*t".to_owned(),
        "  theta' = theta + STEP_THETA_BY_C*c + STEP_THETA_BY_W*w + STEP_THETA_BY_V*v + STEP_THETA_BY_T*t".to_owned(),
        format!("c = R*i is the current in {volt}, w the speed in rad/s, theta the angle in rad, v the command in {volt}, and t a torque"),
        format!("against positive rotation as T*R/Kt in {volt}: with Coulomb friction Tc it is t = Tc*sign(w), a Tc in N*m times R/Kt."),
    ];
    if subject.drive == Drive::Voltage && subject.determined("electrical_time_constant").is_none() {
        step.push(
            "The electrical time constant is not determined: the step takes it as small as it was fitted.".to_owned(),
        );
    }
    if subject.drive == Drive::Voltage && !subject.viscous_is_apart() {
        step.push(
            "Viscous friction and back-EMF are not told apart: the step takes all as back-EMF, which moves the shaft alike."
                .to_owned(),
        );
    }
    Ok(Constants {
        list: list.all,
        step,
    })
}

struct List<'a> {
    all: Vec<Constant>,
    names: HashSet<String>,
    written: &'a mut Written,
}

impl List<'_> {
    /// Adds a constant, unless single precision has no number for it.
    fn push(&mut self, from: &str, value: f64, unit: &str, about: &str) {
        let single = value as f32;
        let kept = single.is_normal() || (value == 0.0 && single == 0.0);
        if !kept {
            self.written
                .lacks(from, "is beyond what single precision can hold");
            return;
        }
        let plain = |c: char| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_uppercase()
            } else {
                '_'
            }
        };
        let stem: String = from.chars().map(plain).collect();
        let mut name = stem.clone();
        let mut again = 2;
        // An effect may stand in a model twice.
        while !self.names.insert(name.clone()) {
            name = format!("{stem}_{again}");
            again += 1;
        }
        self.written.map(from, &name, unit);
        self.all.push(Constant {
            name,
            value: single,
            about: about.to_owned(),
        });
    }
}
