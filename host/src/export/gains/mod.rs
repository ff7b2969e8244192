//! Controllers for the motor, as TOML.
//!
//! | file | holds |
//! |---|---|
//! | `loops` | a sampled loop at its frequencies: margins and bandwidth, exactly |
//! | `design` | where the zeros stand and how fast the loops may be |
//! | `feed_forward` | the command that a wanted motion needs |
//!
//! Where the resistance is known a current loop is closed, and a speed loop around it (cascade). Otherwise, or if asked, the
//! speed loop gives volts. Behind an amplifier with a current loop its output is in units of the command.

pub mod design;
pub mod feed_forward;
pub mod loops;

use super::comment::{head, marked};
use super::error::{ExportError, NAME_RESISTANCE};
use super::format::Options;
use super::subject::Subject;
use super::written::{Lack, Written};
use crate::recording::Drive;
use clap::ValueEnum;
use design::{Method, Task, Zero};
use feed_forward::FeedForward;
use loops::{C, Closed, Open, Pi, Plant, hz};
use shared::effects::Kind;
use std::f64::consts::TAU;

const FORMAT: &str = "gains";

/// What a user asks of the controllers; everything has a usual value.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// Crossover of the current loop, Hz.
    pub current_hz: Option<f64>,
    /// Crossover of the speed loop, Hz.
    pub speed_hz: Option<f64>,
    /// How the speed loop's zero is placed.
    pub method: Option<Method>,
    /// Which loops.
    pub loops: Option<Loops>,
}

/// Which loops are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Loops {
    /// A current loop, and a speed loop around it
    Cascade,
    /// One speed loop that gives volts
    Voltage,
}

/// A closed loop with its units.
#[derive(Clone, Debug)]
pub struct Section {
    /// `current_loop` or `speed_loop`.
    pub name: &'static str,
    /// How its zero was placed.
    pub method: Method,
    /// The loop.
    pub closed: Closed,
    /// Unit of its output.
    pub output: String,
    /// Unit of its error.
    pub input: &'static str,
}

/// All controllers of a motor.
#[derive(Clone, Debug)]
pub struct Controllers {
    /// The loops, inner first.
    pub sections: Vec<Section>,
    /// Control period, s.
    pub period: f64,
    /// What to know.
    pub remarks: Vec<String>,
}

/// Designs the loops.
///
/// # Errors
/// Something that is not determined, or a bandwidth that cannot be had.
pub fn design(subject: &Subject, options: &Options) -> Result<Controllers, ExportError> {
    subject.needs_response(FORMAT)?;
    let period = options.period(subject, FORMAT)?;
    let asked = &options.gains;
    let plant = Plant::new(subject, period)?;
    let mut controllers = Controllers {
        sections: Vec::new(),
        period,
        remarks: Vec::new(),
    };
    let resistance = subject.physical("resistance", "ohm");
    let electrical = subject.determined("electrical_time_constant");
    let can_cascade = subject.drive == Drive::Voltage && electrical.is_some();
    match (asked.loops, resistance.filter(|_| can_cascade)) {
        (None | Some(Loops::Cascade), Some(ohm)) => {
            cascade(subject, asked, &plant, ohm, &mut controllers)?;
        }
        (Some(Loops::Cascade), None) => {
            return Err(ExportError::Undetermined {
                format: "a current loop",
                needs: "resistance and electrical time constant".to_owned(),
                remedy: NAME_RESISTANCE,
            });
        }
        _ => {
            if asked.current_hz.is_some() {
                return Err(ExportError::Loop(
                    "--current-bandwidth: there is no current loop here: it needs the resistance (fit again with --known \
                     resistance_ohm=…) and the electrical time constant, and no --loops voltage"
                        .to_owned(),
                ));
            }
            alone(subject, asked, &plant, &mut controllers)?;
        }
    }
    controllers.judge_speed(subject);
    Ok(controllers)
}

/// A current loop, and a speed loop around it that is computed from the same readings.
fn cascade(
    subject: &Subject,
    asked: &Asked,
    plant: &Plant,
    ohm: f64,
    controllers: &mut Controllers,
) -> Result<(), ExportError> {
    let period = plant.period;
    let current = |omega: f64| plant.at(omega)[0] / ohm;
    let inner = Task {
        name: "current loop",
        flag: "--current-bandwidth",
        asked_hz: asked.current_hz,
        // The winding's own pole; back-EMF changes slowly and is left to the integral.
        zero: Zero::Pole((-period / subject.machine.electrical).exp()),
        open: Open {
            plant: &current,
            period,
        },
        inner: true,
    };
    let (inner, warning) = inner.close()?;
    controllers.remarks.extend(warning);
    controllers.sections.push(Section {
        name: "current_loop",
        method: Method::Cancel,
        closed: inner,
        output: "V".to_owned(),
        input: "A",
    });

    // Speed by the current that is asked for, with the inner loop closed.
    let speed = |omega: f64| -> C {
        let [current, speed] = plant.at(omega);
        let pi = inner.pi.at(omega, period);
        pi * speed / (pi * current / ohm + 1.0)
    };
    let method = asked.method.unwrap_or(Method::Symmetrical);
    let zero = match method {
        // A type-one loop follows a ramp 1/ωc late; the difference of counts is half a period late.
        Method::Symmetrical => Zero::Lags(1.0 / inner.crossover + 0.5 * period),
        Method::Cancel => {
            let machine = &subject.machine;
            if !(subject.viscous_is_apart() && machine.damping > 0.0) {
                return Err(ExportError::Undetermined {
                    format: "--method cancel of a speed loop around a current loop",
                    needs: "viscous friction apart from back-EMF".to_owned(),
                    remedy: "record a stretch of coasting with the bridge open, or use --method symmetrical or --loops voltage",
                });
            }
            Zero::Pole((-period * machine.damping / machine.inertia).exp())
        }
    };
    let outer = Task {
        name: "speed loop",
        flag: "--speed-bandwidth",
        asked_hz: asked.speed_hz,
        zero,
        open: Open {
            plant: &speed,
            period,
        },
        inner: false,
    };
    let (outer, warning) = outer.close()?;
    controllers.remarks.extend(warning);
    if outer.crossover > 0.5 * inner.crossover {
        controllers.remarks.push(format!(
            "speed loop: {:.1} Hz is more than half of the current loop's {:.1} Hz",
            hz(outer.crossover),
            hz(inner.crossover)
        ));
    }
    controllers.sections.push(Section {
        name: "speed_loop",
        method,
        closed: outer,
        output: "A".to_owned(),
        input: "rad/s",
    });
    Ok(())
}

/// One speed loop whose output is the motor's command.
fn alone(
    subject: &Subject,
    asked: &Asked,
    plant: &Plant,
    controllers: &mut Controllers,
) -> Result<(), ExportError> {
    let period = plant.period;
    let Some([slow, _]) = plant.poles() else {
        return Err(ExportError::Loop(
            "the motor's two poles are complex (L/R is more than a quarter of its mechanical time constant): a PI from speed to \
             volts has no pole to cancel; fit again with --known resistance_ohm=…, so that a current loop can be closed"
                .to_owned(),
        ));
    };
    let method = asked.method.unwrap_or(match subject.drive {
        Drive::Voltage => Method::Cancel,
        Drive::Current => Method::Symmetrical,
    });
    let zero = match method {
        Method::Cancel if slow < 1.0 => Zero::Pole(slow),
        Method::Cancel => {
            return Err(ExportError::Loop(
                "--method cancel: the motor has no viscous friction, so that its pole is an integrator and nothing of the integral \
                 would be left; use --method symmetrical"
                    .to_owned(),
            ));
        }
        // Dead time 1.5 periods, half of one for the difference of counts, and the winding.
        Method::Symmetrical => Zero::Lags(2.0 * period + subject.machine.electrical),
    };
    let speed = |omega: f64| plant.at(omega)[1];
    let task = Task {
        name: "speed loop",
        flag: "--speed-bandwidth",
        asked_hz: asked.speed_hz,
        zero,
        open: Open {
            plant: &speed,
            period,
        },
        inner: false,
    };
    let (closed, warning) = task.close()?;
    controllers.remarks.extend(warning);
    controllers.sections.push(Section {
        name: "speed_loop",
        method,
        closed,
        output: subject.unit_shown("V"),
        input: "rad/s",
    });
    Ok(())
}

impl Controllers {
    /// The loop of this name.
    pub fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.name == name)
    }

    /// What the numbers of the speed loop leave out.
    fn judge_speed(&mut self, subject: &Subject) {
        let Some(speed) = self.section("speed_loop").cloned() else {
            return;
        };
        if let Some(counts) = subject.counts_per_rev {
            let step = TAU / counts / self.period;
            self.remarks.push(format!(
                "one count over one period is {step:.3} rad/s, which the speed loop answers with {:.3} {}",
                step * speed.closed.pi.kp,
                speed.output
            ));
        }
        for term in &subject.terms {
            if matches!(term.kind, Kind::Compliance | Kind::Backlash) {
                self.remarks.push(format!(
                    "{}: the margins are of motor and load as one body; stay well below their resonance",
                    term.kind.name()
                ));
            }
        }
        if subject.drive == Drive::Voltage
            && subject.determined("electrical_time_constant").is_none()
        {
            self.remarks.push(
                "the electrical time constant is not determined: the margins take it as small as it was fitted"
                    .to_owned(),
            );
        }
    }
}

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
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
    out += &format!("crossover_hz = {:?}\n", hz(closed.crossover));
    out += &format!("phase_margin_deg = {:?}\n", closed.phase_margin);
    out += &match closed.bandwidth {
        Some(bandwidth) => format!(
            "bandwidth_hz = {:?} # -3 dB of the closed loop\n",
            hz(bandwidth)
        ),
        None => "# bandwidth: beyond half the sampling rate\n".to_owned(),
    };
    out
}

#[cfg(test)]
mod tests;
