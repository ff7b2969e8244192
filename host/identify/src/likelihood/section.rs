//! What `fit` says of the likelihood beside its free run.

use super::maximum::{Maximum, Settings, fit_from};
use super::observed::{Observed, parts};
use super::parameters::{Coordinate, Parameters};
use super::terms::{Delays, Terms};
use super::whiteness::Whiteness;
use crate::fit::{EXPLAINED_COUNTS, Fit};
use servoid_engine::problem::Data;
use servoid_io::recording::Drive;
use shared::effects::Kind;
use std::sync::atomic::{AtomicBool, Ordering};

/// Least time between the readings of the check, s.
const CHECK_S: f64 = 0.05;
/// Most steps; of a longer recording the first ones count. A fit of so many takes some seconds.
const MOST_STEPS: usize = 100_000;
/// Least change of the command from one sample to the next, part of its range, that is an edge.
const EDGE: f64 = 0.1;
/// Correlation of delay and inertia beyond which they are one number.
const CORRELATED: f64 = 0.9;
/// Part of delay and time constant together that a delay may be which no edge shows.
const SMALL: f64 = 0.1;
/// Change of the delay with the time between readings, part of delay and time constant together, beyond which it is no delay.
const UNSTEADY: f64 = 0.25;
/// Standard error of the delay, part of delay and time constant together, beyond which it is not known.
const UNKNOWN: f64 = 0.5;

/// A number with its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// The number, SI.
    pub value: f64,
    /// Its standard error; `None` where the recording does not determine it.
    pub std: Option<f64>,
    /// The 95 % interval.
    pub interval: Option<[f64; 2]>,
    /// Its unit.
    pub unit: &'static str,
}

/// The numbers with readings used at another distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// Least time between readings, s.
    pub update_s: f64,
    /// Inertia, V·s²/rad.
    pub inertia: f64,
    /// Back-EMF and viscous friction, V·s/rad.
    pub damping: f64,
    /// Coulomb friction, V.
    pub coulomb: f64,
    /// Offset, V.
    pub offset: f64,
    /// Delay, s.
    pub delay: f64,
    /// Bayesian information criterion; comparable only at the same distance.
    pub bic: f64,
}

/// A number on which likelihood and free run differ by more than their 95 % intervals: an error of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disagreement {
    /// The number: `inertia`, `back_emf_viscous`, `coulomb`, `offset` or `delay`.
    pub name: &'static str,
    /// By the likelihood, SI.
    pub likelihood: f64,
    /// By the free run, SI.
    pub free_run: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// The fit by the likelihood with process noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Likelihood {
    /// Inertia referred to the winding; without the electrical time constant.
    pub inertia: Value,
    /// Back-EMF and viscous friction.
    pub damping: Value,
    /// Coulomb friction.
    pub coulomb: Value,
    /// Offset of the drive.
    pub offset: Value,
    /// Delay from command to drive.
    pub delay: Value,
    /// Delay and time constant added up.
    pub total_lag: Value,
    /// Whether the recording tells delay and inertia apart.
    pub delay_separable: bool,
    /// Correlation of delay and inertia.
    pub delay_inertia_correlation: Option<f64>,
    /// Intensity of the process noise.
    pub process_noise: Value,
    /// Standard deviation of readings beyond quantisation.
    pub reading_noise: Value,
    /// Whether the innovations are white.
    pub whiteness: Option<Whiteness>,
    /// The numbers at each distance of readings.
    pub checks: Vec<Check>,
    /// Where the free run differs.
    pub disagreements: Vec<Disagreement>,
    /// Bayesian information criterion.
    pub bic: f64,
    /// Readings that were used.
    pub readings: usize,
    /// Time that was used, s.
    pub duration_s: f64,
    /// Whether the search converged.
    pub converged: bool,
}

/// The section of a fit. `None` where the free run already explains the recording down to the encoder (process noise is then
/// nothing, and the likelihood is that of the free run), where the bridge opens, or where too little moves.
pub fn section(data: &Data, free: &Fit, effects: &[Kind], stop: &AtomicBool) -> Option<Likelihood> {
    if data.quantised && free.rms_counts <= EXPLAINED_COUNTS {
        return None;
    }
    let most = MOST_STEPS / parts(data.units.interval);
    let short = (data.len() > most).then(|| data.first(most));
    let alone = short.as_ref().unwrap_or(data).parts();
    let observed: Vec<Observed> = alone.filter_map(|part| Observed::new(&part)).collect();
    if observed.is_empty() {
        return None;
    }
    let recordings: Vec<&Observed> = observed.iter().collect();
    let terms = Terms {
        asymmetric_viscous: effects.contains(&Kind::AsymViscous),
        gravity: effects.contains(&Kind::Unbalance),
        ..Terms::USUAL
    };
    let fitted = |update_s: f64, known: &[Parameters]| {
        let settings = Settings {
            update_s,
            delays: Delays::Common,
            ..Settings::default()
        };
        fit_from(&recordings, terms, &settings, known, stop).map(|m| (update_s, m))
    };
    let usual = fitted(Settings::default().update_s, &[])?;
    let checked = fitted(CHECK_S, std::slice::from_ref(&usual.1.parameters));
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    let delay_separable = is_separable(&observed, &usual.1, checked.as_ref().map(|c| &c.1));
    let checks = [&usual].into_iter().chain(&checked);
    let checks = checks.map(|(update_s, m)| check(*update_s, m)).collect();
    let m = usual.1;
    let value = |c: Coordinate| Value {
        value: c.get(&m.parameters),
        std: m.std(c),
        interval: m.interval(c),
        unit: unit(c, data.drive),
    };
    let separable = |c: Coordinate| {
        let value = value(c);
        Value {
            std: value.std.filter(|_| delay_separable),
            interval: value.interval.filter(|_| delay_separable),
            ..value
        }
    };
    let (lag, lag_std) = m
        .total_lag(0)
        .map_or((m.parameters.time_constant(), None), |(l, s)| (l, Some(s)));
    let mut found = Likelihood {
        inertia: separable(Coordinate::Inertia),
        damping: value(Coordinate::Damping),
        coulomb: value(Coordinate::Coulomb),
        offset: value(Coordinate::Offset),
        delay: separable(Coordinate::CommonDelay),
        total_lag: Value {
            value: lag,
            std: lag_std,
            interval: lag_std.map(|std| [(lag - 1.96 * std).max(0.0), lag + 1.96 * std]),
            unit: "s",
        },
        delay_separable,
        delay_inertia_correlation: m.correlation(Coordinate::Inertia, Coordinate::CommonDelay),
        process_noise: value(Coordinate::ProcessNoise),
        reading_noise: value(Coordinate::ReadingNoise),
        whiteness: m.whiteness,
        checks,
        disagreements: Vec::new(),
        bic: m.bic,
        readings: m.readings,
        duration_s: observed.iter().map(Observed::duration_s).sum(),
        converged: m.converged,
    };
    found.disagreements = disagreements(&found, free);
    Some(found)
}

fn check(update_s: f64, m: &Maximum) -> Check {
    let p = &m.parameters;
    Check {
        update_s,
        inertia: p.inertia,
        damping: p.damping,
        coulomb: p.coulomb,
        offset: p.offset,
        delay: p.delays.first().copied().unwrap_or(0.0),
        bic: m.bic,
    }
}

/// Edges of the command show a delay by itself; without any it must be small and apart from inertia at both distances. In
/// either case it must stay what it is at another distance, as far as its errors tell.
fn is_separable(observed: &[Observed], usual: &Maximum, checked: Option<&Maximum>) -> bool {
    let delay = |m: &Maximum| (m.parameters.delays[0], m.std(Coordinate::CommonDelay));
    let (own, Some(error)) = delay(usual) else {
        return false;
    };
    let lag = own + usual.parameters.time_constant();
    let correlated = |m: &Maximum| {
        let correlation = m.correlation(Coordinate::Inertia, Coordinate::CommonDelay);
        correlation.is_none_or(|r| r.abs() > CORRELATED)
    };
    let edges = observed.iter().any(|one| one.steepest_edge() >= EDGE);
    let small = own <= SMALL * lag;
    let apart = edges || small && !(correlated(usual) || checked.is_some_and(correlated));
    let steady = checked.map(delay).is_none_or(|(other, other_error)| {
        let both = libm::hypot(error, other_error.unwrap_or(lag));
        (own - other).abs() <= (UNSTEADY * lag).max(2.0 * both)
    });
    apart && steady && error < UNKNOWN * lag
}

fn unit(c: Coordinate, drive: Drive) -> &'static str {
    let volts = match c {
        Coordinate::Inertia => "V*s^2/rad",
        Coordinate::Damping | Coordinate::Asymmetry => "V*s/rad",
        Coordinate::Coulomb | Coordinate::Offset | Coordinate::Gravity(_) => "V",
        Coordinate::CommonDelay | Coordinate::Delay(_) => "s",
        Coordinate::ProcessNoise => "V*sqrt(s)",
        Coordinate::ReadingNoise => "rad",
    };
    drive.unit(volts)
}

/// What the free run's model has too, and where both errors are known.
fn disagreements(found: &Likelihood, free: &Fit) -> Vec<Disagreement> {
    let std = |name: &str| {
        let parameter = free.parameters.iter().find(|p| p.name == name)?;
        Some((parameter.value, parameter.std?))
    };
    let of_effect = |kind: Kind, name: &str| {
        let (_, values) = free
            .candidate
            .effects
            .iter()
            .find(|(own, _)| *own == kind)?;
        let value = values.first().copied()?;
        // The parameter may be in N·m: its error is taken as a part of it.
        let (stated, error) = std(name)?;
        Some((value, (value / stated * error).abs()))
    };
    let machine = &free.candidate.machine;
    let total = machine.kb + machine.damping;
    let relative = |name: &str| std(name).map(|(value, error)| (error / value).abs());
    let gain = relative("gain");
    let inertia = gain
        .zip(relative("a1"))
        .map(|(g, a1)| (machine.inertia, machine.inertia * libm::hypot(g, a1)));
    [
        ("inertia", found.inertia, inertia),
        (
            "back_emf_viscous",
            found.damping,
            gain.map(|g| (total, total * g)),
        ),
        (
            "coulomb",
            found.coulomb,
            of_effect(Kind::Coulomb, "coulomb.torque"),
        ),
        (
            "offset",
            found.offset,
            of_effect(Kind::OffsetVoltage, "offset_voltage.voltage"),
        ),
        ("delay", found.delay, of_effect(Kind::Delay, "delay.time")),
    ]
    .into_iter()
    .filter_map(|(name, own, free)| {
        let (free_run, error) = free?;
        let gap = (own.value - free_run).abs();
        (gap > 1.96 * (own.std? + error)).then_some(Disagreement {
            name,
            likelihood: own.value,
            free_run,
            unit: own.unit,
        })
    })
    .collect()
}
