//! A motor as simulators have it: one motor constant for torque and back-EMF, torques in N·m, friction in two numbers.
//!
//! Theirs gives `τ = (K/R')·(v − K·ω)`, ours `τ = (v − Kb·ω)/ρ` with `ρ = R/Kt`. With `K = Kb` and `R' = ρ·Kb` the two are the
//! same, whatever `Kt` is; where `Kt = Kb`, `R'` is the resistance itself. If viscous friction is not told apart from back-EMF,
//! all of it stands as back-EMF, which moves the joint alike.

use super::digits::rounded;
use super::error::{ExportError, FIT_AGAIN};
use super::friction::Friction;
use super::subject::Subject;
use super::written::Written;
use shared::effects::Kind;

/// Motor constants that differ by less than this part are one.
const SAME: f64 = 1e-3;

/// What such a format is called, and what it calls its motor constant.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// On the command line.
    pub format: &'static str,
    /// The program, in sentences.
    pub program: &'static str,
    /// Its motor constant.
    pub constant: &'static str,
}

/// The largest voltage, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// V.
    pub volts: f64,
    /// Names in the result.
    pub from: &'static str,
}

/// The motor.
#[derive(Clone, Debug, PartialEq)]
pub struct OneConstant {
    /// Volts at the winding per newton metre, V/(N·m).
    pub ratio: f64,
    /// Motor constant, V·s/rad.
    pub constant: f64,
    /// Resistance that gives the torques with this constant, ohm.
    pub resistance: f64,
    /// Rotor inertia, kg·m².
    pub inertia: f64,
    /// Viscous friction, N·m·s/rad.
    pub damping: f64,
    /// Constant friction, N·m, and the effects that give it; none where the model has none.
    pub sliding: Option<(f64, String)>,
    /// Electrical time constant, s, if it is determined.
    pub electrical: Option<f64>,
    /// The largest voltage, if it is known.
    pub limit: Option<Limit>,
}

impl OneConstant {
    /// Of a motor with this friction. Notes in `written` what differs.
    ///
    /// # Errors
    /// The motor was not driven by a voltage, its response or its torques are not determined, or it has no back-EMF.
    pub fn of(
        subject: &Subject,
        friction: &Friction,
        named: Named,
        written: &mut Written,
    ) -> Result<Self, ExportError> {
        subject.needs_volts(named.format)?;
        subject.needs_response(named.format)?;
        let ratio = subject.needs_torques(named.format)?;
        let machine = &subject.machine;
        let (emf, viscous) = if subject.viscous_is_apart() {
            (machine.kb, machine.damping)
        } else {
            written.remarks.push(format!(
                "viscous friction and back-EMF are not told apart: all of it stands as back-EMF ({})",
                named.constant
            ));
            (machine.kb + machine.damping, 0.0)
        };
        // Both stand in denominators there.
        if emf <= 0.0 {
            return Err(ExportError::Undetermined {
                format: named.format,
                needs: "a back-EMF constant above zero".to_owned(),
                remedy: FIT_AGAIN,
            });
        }
        if let Some(kt) = subject.physical("kt", "N*m/A")
            && (kt / emf - 1.0).abs() > SAME
        {
            written.remarks.push(format!(
                "{} has one motor constant and Kt is {kt:?} N*m/A: resistance is Kb*R/Kt, so that torques are right and currents \
                 are not",
                named.program
            ));
        }
        let electrical = subject.determined("electrical_time_constant");
        let slides = friction.slides.join(", ");
        Ok(OneConstant {
            ratio,
            constant: rounded(emf),
            resistance: rounded(ratio * emf),
            inertia: rounded(machine.inertia / ratio),
            damping: rounded((viscous + friction.viscous) / ratio),
            sliding: (!slides.is_empty()).then(|| (rounded(friction.sliding / ratio), slides)),
            electrical: electrical.map(|_| machine.electrical),
            limit: limit(subject),
        })
    }
}

/// The largest voltage: what the stage clips at, else the supply.
fn limit(subject: &Subject) -> Option<Limit> {
    let clips = |kind: Kind| kind == Kind::VoltageSat;
    let clipped = (subject.terms.iter()).filter(|term| clips(term.kind) && term.determined[0]);
    let clipped = clipped.map(|term| term.values[0]);
    let volts = clipped.fold(subject.supply_v, |least, limit| {
        Some(least.map_or(limit, |least| least.min(limit)))
    });
    let clips = subject.terms.iter().any(|term| clips(term.kind));
    volts.map(|volts| Limit {
        volts,
        from: if clips {
            "supply, voltage_sat"
        } else {
            "supply"
        },
    })
}
