//! Settings of a VESC, as a script of its LispBM (vedderb/bldc, `lispBM/README.md`: `conf-set` takes mΩ, µH and mWb). VESC Tool shows the
//! resistance in mΩ or Ω, and takes the same numbers. The current loop's gains are VESC's own: `L·ωc` and `R·ωc`.

use super::brushless::{Phase, Setting, lines};
use super::digits::rounded;
use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let phase = Phase::of(subject, options, "vesc", &mut written)?;
    let mut settings = Vec::new();
    let mut set = |to, from, unit, value| {
        settings.push(Setting {
            to,
            from,
            unit,
            value,
        });
    };
    set(
        "foc-motor-r",
        "resistance",
        "mOhm",
        rounded(phase.resistance * 1e3),
    );
    if let Some(henry) = phase.inductance {
        set(
            "foc-motor-l",
            "electrical_time_constant",
            "uH",
            rounded(henry * 1e6),
        );
    }
    if let Some(weber) = phase.flux() {
        set("foc-motor-flux-linkage", "kb", "mWb", rounded(weber * 1e3));
    } else {
        written.lacks(
            "kb",
            &format!(
                "the flux linkage is the back-EMF of a phase, {:?} V*s/rad, by the pairs of poles: give them with --pole-pairs N",
                rounded(phase.emf)
            ),
        );
    }
    if let Some([kp, ki]) = phase.current_loop() {
        set(
            "foc-current-kp",
            "electrical_time_constant, --current-bandwidth",
            "V/A",
            kp,
        );
        set(
            "foc-current-ki",
            "resistance, --current-bandwidth",
            "V/(A*s)",
            ki,
        );
    }
    if let Some(pairs) = phase.pole_pairs {
        set("si-motor-poles", "--pole-pairs", "1", f64::from(2 * pairs));
    }
    written.remarks.push(format!(
        "the torque is 1.5*pole_pairs*flux*iq: {:?} N*m/A; the script changes what runs, (conf-store) keeps it",
        phase.torque
    ));
    let line = |setting: &Setting| {
        let Setting {
            to, value, unit, ..
        } = setting;
        let number = if *to == "si-motor-poles" {
            format!("{value:.0}")
        } else {
            format!("{value:?}")
        };
        format!("(conf-set '{to} {number}) ; {unit}")
    };
    Ok(lines(subject, &settings, "; ", line, written))
}
