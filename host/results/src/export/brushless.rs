//! A motor as drives of three phases have it: values of one phase to the star's centre, back-EMF as the peak of a phase.
//!
//! servoid knows a motor of two terminals. Of a star of which two phases are driven at a time it sees two in series: twice a phase's
//! resistance and inductance, and the peak between two lines, `√3` that of a phase ([`Winding::Line`]). In a rotor's frame whose currents
//! are peaks of a phase, the voltage and current of the q axis are a phase's own ([`Winding::Phase`]). The torque per ampere of the q
//! axis is 1.5 times the peak back-EMF of a phase per speed, by power. So `Kv` in rpm/V (between lines) and the torque constant
//! have the product `1.5/√3·60/2π = 8.27`, as the makers have it.

use super::comment::{head, marked};
use super::digits::rounded;
use super::error::{ExportError, NAME_RESISTANCE};
use super::options::Options;
use super::side::Side;
use super::subject::Subject;
use super::written::{Carried, Written};
use clap::ValueEnum;
use std::f64::consts::TAU;

/// Crossover of a current loop if nothing is asked for, rad/s: what ODrive and VESC begin with.
const USUAL_BANDWIDTH: f64 = 1000.0;
/// Torque of the q axis by back-EMF of a phase.
const TORQUE_BY_EMF: f64 = 1.5;
/// A torque constant further from what the back-EMF says is named.
const SAME: f64 = 0.02;

/// What the voltage and current of a recording were those of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Winding {
    /// Two terminals: a brushed motor, or two phases of a star in series
    #[default]
    Line,
    /// The q axis of a brushless motor, in peaks of a phase
    Phase,
}

/// One phase of the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Ohm.
    pub resistance: f64,
    /// H, if the electrical time constant is determined.
    pub inductance: Option<f64>,
    /// Peak back-EMF by the speed of the shaft, V·s/rad.
    pub emf: f64,
    /// Torque per ampere of the q axis, N·m/A.
    pub torque: f64,
    /// Rotor inertia, kg·m².
    pub inertia: Option<f64>,
    /// Crossover of the current loop, rad/s.
    pub bandwidth: f64,
    /// Pairs of poles, if they were given.
    pub pole_pairs: Option<u32>,
}

impl Phase {
    /// Of a motor. Says in `written` what was assumed.
    ///
    /// # Errors
    /// The numbers are of another shaft, the motor was not driven by a voltage, or resistance or back-EMF is not determined.
    pub fn of(
        subject: &Subject,
        options: &Options,
        format: &'static str,
        written: &mut Written,
    ) -> Result<Self, ExportError> {
        if subject.side != Side::Motor {
            return Err(ExportError::MotorSide { format });
        }
        subject.needs_volts(format)?;
        let needs = |name: &str, unit: &str| {
            let value = subject.physical(name, unit).filter(|value| *value > 0.0);
            value.ok_or_else(|| ExportError::Undetermined {
                format,
                needs: format!("the motor's {name} in {unit}"),
                remedy: NAME_RESISTANCE,
            })
        };
        let ohm = needs("resistance", "ohm")?;
        let kb = needs("kb", "V*s/rad")?;
        let (in_series, peaks, assumed) = match options.winding {
            Winding::Line => (
                2.0,
                3.0_f64.sqrt(),
                "voltage and current of the recording are taken as those between two terminals (--winding line): resistance and \
                 inductance of a phase are half of them, as in a star, and its back-EMF is less by the root of three",
            ),
            Winding::Phase => (
                1.0,
                1.0,
                "voltage and current of the recording are taken as those of the q axis, in peaks of a phase (--winding phase)",
            ),
        };
        written.remarks.push(assumed.to_owned());
        let emf = kb / peaks;
        let torque = rounded(TORQUE_BY_EMF * emf);
        if let Some(kt) = subject.physical("kt", "N*m/A")
            && options.winding == Winding::Phase
            && (kt / torque - 1.0).abs() > SAME
        {
            written.remarks.push(format!(
                "Kt was found as {kt:?} N*m/A, and 1.5 times the back-EMF is {torque:?} N*m/A, which stands here; inertia and friction \
                 go with the one that was found: fit again with --known kt_n_m_a={torque:?} and without --kt-equals-kb"
            ));
        }
        let seconds = subject.determined("electrical_time_constant");
        let asked = options.gains.current_hz.map(|hertz| hertz * TAU);
        Ok(Phase {
            resistance: rounded(ohm / in_series),
            inductance: seconds.map(|_| rounded(subject.machine.electrical * ohm / in_series)),
            emf,
            torque,
            inertia: subject.physical("inertia", "kg*m^2"),
            bandwidth: rounded(asked.unwrap_or(USUAL_BANDWIDTH)),
            pole_pairs: options.pole_pairs,
        })
    }

    /// Speed without load by the voltage between lines, rpm/V.
    pub fn kv(&self) -> f64 {
        rounded(60.0 / TAU / (3.0_f64.sqrt() * self.emf))
    }

    /// Flux linkage of a phase, Wb, if the pairs of poles are known.
    pub fn flux(&self) -> Option<f64> {
        self.pole_pairs
            .map(|pairs| rounded(self.emf / f64::from(pairs)))
    }

    /// The current loop's gains `L·ωc` (V/A) and `R·ωc` (V/(A·s)), its zero on the winding's pole.
    pub fn current_loop(&self) -> Option<[f64; 2]> {
        let gains = |henry: f64| [henry, self.resistance].map(|x| rounded(x * self.bandwidth));
        self.inductance.map(gains)
    }
}

/// A setting of a drive: its name there, where it comes from, its unit, and the number.
pub struct Setting {
    /// Its name in the drive.
    pub to: &'static str,
    /// Its name in the result.
    pub from: &'static str,
    /// Its unit in the drive.
    pub unit: &'static str,
    /// The number, in that unit.
    pub value: f64,
}

/// The lines of a drive's settings behind its comments. `line` is one of its commands.
pub fn lines(
    subject: &Subject,
    settings: &[Setting],
    mark: &str,
    line: impl Fn(&Setting) -> String,
    mut written: Written,
) -> Written {
    let mut body = String::new();
    for setting in settings {
        written.map(setting.from, setting.to, setting.unit);
        body += &format!("{}\n", line(setting));
    }
    let mapped = |name: &str| settings.iter().any(|setting| setting.from == name);
    for (name, why) in [
        (
            "electrical_time_constant",
            "not determined by this recording",
        ),
        ("inertia", "no setting of this drive is certain to hold it"),
        ("viscous", "the drive knows no friction"),
    ] {
        if !mapped(name) {
            written.lacks(name, why);
        }
    }
    written.judge(subject, |_| {
        Carried::Not("a drive's settings have no place for it")
    });
    written.text = marked(&head(subject, &written), mark) + "\n" + &body;
    written
}
