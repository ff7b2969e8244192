//! The report of a device's run.

use super::{Aim, Course, Order, Run};
use servoid_results::device_run::Recorded;
use servoid_results::schema::DeviceRun;
use servoid_results::schema::device;
use shared::fit::{self, Outcome, Reason, Settings, Stop, Verdict};
use shared::servo::Response;
use shared::wire::{About, Fault, Format, Stage, Tuned};
use std::f64::consts::TAU;

/// Report of a finished run.
pub fn report(run: &Run, order: &Order) -> DeviceRun {
    let failure = run.outcome.as_ref().err();
    let report = run
        .outcome
        .as_ref()
        .ok()
        .or(failure.and_then(|failure| failure.report.as_ref()));
    let mut saved = broken(&run.about, order, &run.recorded);
    saved.partial =
        saved.missing > 0 || failure.is_some_and(|failure| failure.fault != Fault::NotVerified);
    saved.failure = failure.map(|failure| device::Failure {
        fault: format!("{:?}", failure.fault),
        message: failure.fault.to_string(),
        stage: format!("{:?}", failure.stage).to_lowercase(),
        at_s: f64::from(failure.at) * f64::from(run.about.period_us) * 1e-6,
        seen: failure.seen,
        limit: failure.limit,
        unit: Some(failure.fault.unit().to_owned()).filter(|unit| !unit.is_empty()),
    });
    if let Some(report) = report {
        let period_s = f64::from(run.about.period_us) * 1e-6;
        let scale = saved.scale();
        saved.breakaway_v = scale.volts(report.breakaway);
        saved.limited_periods = Some(report.limited);
        saved.amplitude_v = scale.volts(report.amplitude);
        saved.outcome = report
            .outcome
            .as_ref()
            .map(|outcome| self::outcome(outcome, period_s, order, scale.unit_v()));
        saved.verified_rms_counts = report
            .verified
            .map(|verified| f64::from(verified.mean_square).sqrt());
        saved.predicted = report.verified.as_ref().map(predicted);
        let unit_v = scale.unit_v();
        saved.tuned = (report.tuned.as_ref()).map(|own| tuned(own, period_s, order, unit_v));
        if let Some(verdict) = &report.verdict {
            saved.grade = Some(grade(verdict.grade));
            saved.reason = reason(verdict).map(str::to_owned);
            saved.within = Some(within(verdict));
        }
    }
    saved
}

/// Report of a run that broke off.
pub fn broken(about: &About, order: &Order, recorded: &[Recorded]) -> DeviceRun {
    DeviceRun {
        schema: "servoid.device/1".to_owned(),
        board: about.board.to_string(),
        firmware: about.firmware.to_string(),
        period_us: about.period_us,
        format: match about.format {
            Format::F32 => "f32".to_owned(),
            Format::Fixed => "fixed".to_owned(),
        },
        supply_v: order.supply_v,
        full_duty: about.full,
        counts_per_rev: order.counts_per_rev,
        fit: order.fit,
        breakaway_v: 0.0,
        amplitude_v: 0.0,
        outcome: None,
        verified_rms_counts: None,
        grade: None,
        reason: None,
        within: None,
        predicted: None,
        tuned: None,
        followed: order
            .course
            .as_ref()
            .and_then(|course| followed(course, about, order, recorded)),
        failure: None,
        limited_periods: None,
        missing: recorded.iter().map(Recorded::missing).sum(),
        partial: true,
    }
}

/// How the last set-point of a course was kept to.
fn followed(
    course: &Course,
    about: &About,
    order: &Order,
    recorded: &[Recorded],
) -> Option<device::Followed> {
    let (from_s, aim) = course.last()?;
    let period_s = f64::from(about.period_us) * 1e-6;
    let part = recorded.iter().find(|part| part.stage == Stage::Follow);
    let rows: Vec<_> = part.map(|part| part.whole().collect()).unwrap_or_default();
    // A motor that was tried first has gone some way by then.
    let gone = match (recorded.first(), part) {
        (Some(first), Some(part)) => part.count.wrapping_sub(first.count),
        _ => 0,
    };
    let period = |seconds: f64| (seconds / period_s).round() as usize;
    let end = period(course.seconds());
    let travel = |from: usize| -> Option<f64> {
        let rows = rows.get(from..end)?;
        let counts: i64 = rows.iter().map(|row| i64::from(row.step)).sum();
        Some(counts as f64 * TAU / order.counts_per_rev)
    };
    let (what, set_point, reached) = match aim {
        Aim::Angle(rad) => {
            let gone = f64::from(gone) * TAU / order.counts_per_rev;
            let reached = travel(0).map(|rad| rad + gone);
            (device::FollowedWhat::Angle, rad, reached)
        }
        Aim::Speed(speed) => {
            let quarter = (course.seconds() - from_s) / 4.0;
            let from = end.saturating_sub(period(quarter).max(1));
            let seconds = (end - from) as f64 * period_s;
            let mean = travel(from).map(|rad| rad / seconds);
            (device::FollowedWhat::Speed, speed, mean)
        }
    };
    Some(device::Followed {
        what,
        set_point,
        reached,
    })
}

fn finite(x: f32) -> Option<f64> {
    Some(f64::from(x)).filter(|x| x.is_finite())
}

fn predicted(verified: &fit::Predicted) -> device::Predicted {
    device::Predicted {
        by_persistence: finite(verified.by_persistence),
        gain_moved: finite(verified.gain),
        a1_moved: finite(verified.time_constant),
    }
}

fn grade(grade: fit::Grade) -> device::Grade {
    match grade {
        fit::Grade::No => device::Grade::No,
        fit::Grade::Control => device::Grade::Control,
        fit::Grade::Floor => device::Grade::Floor,
    }
}

fn within(verdict: &Verdict) -> device::Within {
    device::Within {
        gain: finite(verdict.gain),
        a1: finite(verdict.time_constant),
        acceleration: finite(verdict.acceleration),
    }
}

/// Why a grade is no better, and what to do.
fn reason(verdict: &Verdict) -> Option<&'static str> {
    match verdict.reason {
        Reason::None => None,
        Reason::Left => Some(
            "the model leaves more than the encoder does: good for gains; `servoid device verify` looks for the physics that is missing",
        ),
        Reason::Undetermined => Some(
            "the recording does not determine gain and time constant well enough: use a finer encoder, a longer --record or a larger \
             --amplitude",
        ),
        Reason::Disagrees => Some(
            "the verification has another gain or time constant than the recording: the load, the supply or the friction changed between \
             them, or the encoder is too coarse; commission again with a longer --record and --verify",
        ),
        Reason::Predicts => Some(
            "the model predicts 50 ms ahead hardly better than a constant speed does: the motion is too small for the encoder, or the physics \
             that matters is missing; use a larger --amplitude",
        ),
    }
}

fn tuned(tuned: &Tuned, period_s: f64, order: &Order, unit_v: f64) -> device::Tuned {
    let gains = &tuned.gains;
    // Part of the unit by counts a period, as V·s/rad.
    let by_speed = unit_v * order.counts_per_rev / std::f64::consts::TAU * period_s;
    let answer = |own: &Response| device::Answer {
        overshoot: own.overshoot.into(),
        settling_s: f64::from(own.settling) * period_s,
        left_counts: own.left.into(),
    };
    device::Tuned {
        position_1_s: f64::from(gains.position) / period_s,
        speed_v_s_rad: f64::from(gains.speed) * by_speed,
        back_emf_v_s_rad: f64::from(gains.back_emf) * by_speed,
        friction_v: f64::from(gains.friction) * unit_v,
        observer: gains.observer.map(f64::from),
        step_counts: tuned.step,
        predicted: answer(&tuned.predicted),
        measured: tuned.measured.as_ref().map(answer),
        kept: tuned.kept,
    }
}

/// Dead time of a leg by the part of the supply that two take, s.
fn dead_time_s(fit: &Settings, period_s: f64) -> f64 {
    0.5 * period_s / f64::from(fit.carriers)
}

fn outcome(outcome: &Outcome, period_s: f64, order: &Order, unit_v: f64) -> device::Outcome {
    let per_count = std::f64::consts::TAU / order.counts_per_rev;
    let gain = per_count / period_s / unit_v;
    let mut measures = vec![
        ("gain", gain, "rad/s/V"),
        ("a1", period_s, "s"),
        ("electrical", period_s, "s"),
    ];
    if order.fit.coulomb {
        measures.push(("coulomb", unit_v, "V"));
    }
    if order.fit.load {
        measures.push(("load", unit_v, "V"));
    }
    if order.fit.carriers > 0 {
        let of_supply = unit_v / order.supply_v;
        measures.push((
            "dead_time",
            of_supply * dead_time_s(&order.fit, period_s),
            "s",
        ));
        measures.push(("viscous_part", 1.0, "1"));
    }
    if order.fit.supply {
        measures.push(("supply_part", 1.0, "1"));
    }
    let parameters =
        outcome
            .estimates
            .iter()
            .zip(measures)
            .map(|(estimate, (name, scale, unit))| device::Parameter {
                name: name.to_owned(),
                value: f64::from(estimate.value) * scale,
                unit: unit.to_owned(),
                std: finite(estimate.std).map(|std| std * scale),
            });
    device::Outcome {
        parameters: parameters.collect(),
        bits: outcome
            .estimates
            .iter()
            .map(|e| [e.value.to_bits(), e.std.to_bits()])
            .collect(),
        rms_counts: f64::from(outcome.mean_square).sqrt(),
        mean_square_bits: outcome.mean_square.to_bits(),
        evaluations: outcome.evaluations,
        converged: outcome.stop == Stop::Converged,
    }
}
