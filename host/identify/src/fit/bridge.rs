//! What a fitted dead time is in seconds, by the bridge's carrier.

use servoid_engine::simulation::Candidate;
use servoid_io::input::Known;
use shared::effects::Kind;

/// Seconds of dead time in both legs by the voltage that they lose in each carrier wave: `t_d = Vd/(2·Vs·f)` (Holmes, Lipo, *Pulse Width
/// Modulation for Power Converters*, 2003, section 12.2).
pub fn dead_time_s(lost_v: f64, supply_v: f64, carrier_hz: f64) -> f64 {
    lost_v / (2.0 * supply_v * carrier_hz)
}

/// The fitted dead time in words, where the model has one.
pub(super) fn remark(candidate: &Candidate, supply_v: f64, known: &Known) -> Option<String> {
    let mut effects = candidate.effects.iter();
    let (_, values) = effects.find(|(kind, _)| *kind == Kind::DeadTime)?;
    let lost_v = *values.first()?;
    let ns = |seconds: f64| format!("{:.0} ns", seconds * 1e9);
    let told = known
        .dead_time_s
        .map(|told| format!(": the timer was told {}", ns(told.value)));
    Some(match known.carrier_hz {
        Some(carrier) => format!(
            "dead time of {} at a carrier of {} kHz{}",
            ns(dead_time_s(lost_v, supply_v, carrier.value)),
            carrier.value * 1e-3,
            told.unwrap_or_default()
        ),
        None => format!(
            "dead time of {:.2} % of the carrier's period in each leg, as {} at 20 kHz; [known] carrier_hz gives it in seconds",
            50.0 * lost_v / supply_v,
            ns(dead_time_s(lost_v, supply_v, 20e3)),
        ),
    })
}
