//! Controllers for the motor, as TOML.
//!
//! | file | holds |
//! |---|---|
//! | `asked` | what a user asks of them |
//! | `loops` | a sampled loop at its frequencies: margins and bandwidth, exactly |
//! | `cascade`, `alone` | a speed loop around a current loop; one without |
//! | `text` | the TOML |
//! | `design` | where the zeros stand and how fast the loops may be |
//! | `feed_forward` | the command that a wanted motion needs |
//!
//! Where the resistance is known a current loop is closed, and a speed loop around it (cascade). Otherwise, or if asked, the
//! speed loop gives volts. Behind an amplifier with a current loop its output is in units of the command.

mod alone;
pub(super) mod asked;
mod cascade;
pub mod design;
pub mod feed_forward;
pub mod loops;
mod text;

pub use asked::{Asked, Loops};
pub(super) use text::write;

use super::error::{ExportError, NAME_RESISTANCE};
use super::options::Options;
use super::subject::Subject;
use design::Method;
use loops::{Closed, Plant};
use servoid_io::recording::Drive;
use shared::effects::Place;
use std::f64::consts::TAU;

const FORMAT: &str = "gains";

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
            cascade::close(subject, asked, &plant, ohm, &mut controllers)?;
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
            alone::close(subject, asked, &plant, &mut controllers)?;
            if subject.drive == Drive::Voltage && asked.loops.is_none() {
                let why = "no current loop: it needs resistance and electrical time constant; fit again with --known resistance_ohm=…";
                controllers.remarks.push(why.to_owned());
            }
        }
    }
    controllers.judge_speed(subject);
    Ok(controllers)
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
            if term.kind.description().place == Place::Load {
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

#[cfg(test)]
mod tests;
