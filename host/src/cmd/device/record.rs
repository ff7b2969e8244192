//! Verbs that drive the motor: commission, record, stream, run.

use super::emulate;
use crate::cli::{
    CommissionArgs, DeviceMethod, FollowArgs, LimitArgs, PortArgs, RecordArgs, RunArgs, StreamArgs,
    Switch,
};
use crate::device::{
    Aim, Conversation, Course, Kept, Order, Progress, Reached, Run, drive, keep, segments,
};
use crate::error::Error;
use crate::session::{Session, print};
use indicatif::ProgressBar;
use servoid_io::output::CommandSequence;
use servoid_results::device_run::{COLUMNS, Folder, Lines};
use servoid_results::schema::DeviceRun;
use servoid_results::schema::device::{Answer, Followed, FollowedWhat, Predicted, Tuned};
use shared::fit::{Grade, Method, Settings};
use shared::wire::{About, Fault, Kind, Segment, Stage};
use std::path::Path;

/// A motor whose servo was kept over a power cut is verified for so long before it follows, s.
const TRIED_S: f64 = 1.0;

/// The common part of an order, without the settings of a commissioning.
pub(super) fn order(
    session: &Session,
    reached: &Reached,
    limits: &LimitArgs,
    kind: Kind,
) -> Result<Order, Error> {
    let (supply, counts) = reached.bench.unzip();
    let missing = |flag: &str| Error::Usage(format!("{flag}: say it, a device does not know"));
    let supply_v = limits
        .supply
        .or(supply)
        .ok_or_else(|| missing("--supply-v"))?;
    let counts_per_rev = limits
        .counts_per_rev
        .or(counts)
        .ok_or_else(|| missing("--counts-per-rev"))?;
    if !(supply_v > 0.0 && supply_v.is_finite()) {
        return Err(Error::Usage(format!(
            "--supply-v {supply_v}: must be above zero"
        )));
    }
    if counts_per_rev == 0 {
        return Err(Error::Usage(
            "--counts-per-rev 0: must be above zero".to_owned(),
        ));
    }
    Ok(Order {
        kind,
        amplitude: limits.amplitude,
        excite_s: 0.0,
        coast: true,
        record_s: Some(0.0),
        verify_s: 0.0,
        verify_within: None,
        accept: Grade::Control,
        seed: session.seed,
        fit: Settings {
            seed: session.seed,
            ..Settings::default()
        },
        supply_v,
        counts_per_rev: counts_per_rev.into(),
        max_voltage: limits.max_voltage,
        max_current: limits.max_current,
        max_travel: limits.max_travel,
        max_speed: limits.max_speed,
        continuous: limits.continuous_current.zip(limits.thermal_time),
        resistance_ohm: limits.resistance,
        course: None,
    })
}

/// An open device with its identification.
pub(super) struct Bench {
    pub(super) reached: Reached,
    conversation: Conversation,
    pub(super) about: About,
}

impl Bench {
    /// `fit` with what is between the supply and the winding: a resistance where the supply is not measured; and the dead time of the board's
    /// bridge, if the board knows how often that switches and the user does not want otherwise.
    ///
    /// # Errors
    /// A device that does not say what it is made of, or one that does not know it though the user wants it fitted.
    fn behind_its_bridge(
        &mut self,
        fit: Settings,
        asked: Option<Switch>,
    ) -> Result<Settings, Error> {
        let details = self.conversation.details()?;
        let fit = Settings {
            supply: !details.senses_supply,
            full: self.about.full,
            ..fit
        };
        if asked == Some(Switch::Off) {
            return Ok(fit);
        }
        if details.carriers == 0 && asked.is_some() {
            return Err(Error::Usage(
                "--dead-time: this board does not say how often its bridge switches; leave it out"
                    .to_owned(),
            ));
        }
        Ok(Settings {
            carriers: details.carriers,
            dead_time: details.dead_time,
            ..fit
        })
    }
}

pub(super) fn open(session: &Session, port: &PortArgs, limits: &LimitArgs) -> Result<Bench, Error> {
    let reached = emulate::reach(port, Some(limits), session.seed)?;
    let mut conversation = Conversation::open(&reached.port)?;
    let about = conversation.about()?;
    session.remark(&format!("{}, firmware {}", about.board, about.firmware));
    Ok(Bench {
        reached,
        conversation,
        about,
    })
}

fn show(bar: &ProgressBar, progress: Progress<'_>) {
    match progress {
        Progress::Stage(stage, length) => {
            bar.set_message(format!("{stage:?}").to_lowercase());
            bar.set_length(length.unwrap_or(0).into());
            bar.set_position(0);
            bar.reset_eta();
        }
        Progress::Rows(rows) => bar.set_position(u64::from(rows.first) + rows.rows.len() as u64),
        Progress::Models(done, of) => {
            bar.set_length(of.into());
            bar.set_position(done.into());
        }
    }
}

/// Runs an order into a folder and says what came.
fn into_folder(
    session: &Session,
    bench: &mut Bench,
    order: &Order,
    plan: &[Segment],
    folder: &Folder,
    path: &Path,
) -> Result<(), Error> {
    let bar = session.progress(0, "device");
    let (about, stop) = (&bench.about, session.stop());
    let kept = keep(
        &mut bench.conversation,
        about,
        order,
        plan,
        folder,
        stop,
        |told| show(&bar, told),
    );
    bar.finish_and_clear();
    let Kept {
        saved,
        run,
        written,
    } = kept?;
    let text = summary(&saved, &run, path, &written);
    let unverified = matches!(&run.outcome, Err(failure) if failure.fault == Fault::NotVerified);
    match &saved.failure {
        None => {
            session.deliver(&text, &saved)?;
            match saved.missing {
                0 => Ok(()),
                missing => Err(Error::Failed(format!(
                    "{missing} periods never arrived: each recording in {} ends at its first gap, and what lies behind one is in files of its own; \
                     see to the link and run it again",
                    path.display()
                ))),
            }
        }
        Some(failure) if unverified => {
            session.deliver(&text, &saved)?;
            let why = saved.reason.clone().unwrap_or_default();
            Err(Error::Failed(format!(
                "the fit is not verified: {:.2} counts RMS on what it had not seen, of which an encoder leaves {:.2}; {why}. `servoid device \
                 verify {}` looks for what its model lacks",
                f64::from(failure.seen) * 0.01,
                f64::from(failure.limit) * 0.01,
                path.display()
            )))
        }
        Some(failure) => {
            session.deliver(&text, &saved)?;
            Err(Error::Failed(format!(
                "{failure}{}",
                if failure.limit != 0 {
                    let unit = failure.unit.as_deref().unwrap_or_default();
                    let number = |x: i32| format!("{x} {unit}").trim_end().to_owned();
                    format!(
                        " (seen {}, limit {})",
                        number(failure.seen),
                        number(failure.limit)
                    )
                } else {
                    String::new()
                }
            )))
        }
    }
}

/// A number with six places, or the digits that tell of one that is small.
fn shown(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 {
        format!("{value:.2e}")
    } else {
        format!("{value:.6}")
    }
}

fn summary(saved: &DeviceRun, run: &Run, path: &Path, written: &[String]) -> String {
    let period_s = f64::from(saved.period_us) * 1e-6;
    let mut text = String::new();
    for part in &run.recorded {
        if part.stage != Stage::Probe {
            let stage = format!("{:?}", part.stage).to_lowercase();
            text += &format!("  {stage:<8} {:>8.3} s", part.rows.len() as f64 * period_s);
            text += &match part.missing() {
                0 => "\n".to_owned(),
                missing => format!(", {missing} periods missing: partial\n"),
            };
        }
    }
    if saved.breakaway_v > 0.0 {
        text += &format!(
            "the shaft first moved at {:.3} V; excited with up to {:.2} V\n",
            saved.breakaway_v, saved.amplitude_v
        );
    }
    if let Some(limited @ 1..) = saved.limited_periods {
        text += &format!(
            "the limit of the current held the drive back in {limited} periods; what was driven is recorded\n"
        );
    }
    if let Some(outcome) = &saved.outcome {
        text += &format!(
            "the device fitted ({}, {} models, {}): {:.4} counts RMS",
            match saved.fit.method {
                Method::Pso => "particle swarm",
                Method::Firefly => "fireflies",
            },
            outcome.evaluations,
            saved.format,
            outcome.rms_counts
        );
        if let Some(rms) = saved.verified_rms_counts {
            text += &format!("; {rms:.4} on what it had not seen");
        }
        text.push('\n');
        for parameter in &outcome.parameters {
            let std = parameter
                .std
                .map_or_else(|| "not determined".to_owned(), |std| format!("± {std:.2e}"));
            text += &format!(
                "  {:<12}{:>14} {:<8} {std}\n",
                parameter.name,
                shown(parameter.value),
                parameter.unit
            );
        }
        text += &verdict(saved);
        text += &saved.tuned.as_ref().map_or(String::new(), tuned);
        if let Some(told) = saved.told_dead_time_s() {
            text += &format!("  the board's timer was told a dead time of {told:.2e} s\n");
        }
    }
    text += &saved.followed.as_ref().map_or(String::new(), followed);
    if let (None, Some(predicted)) = (&saved.outcome, &saved.predicted) {
        text += &tried(predicted);
    }
    text += &format!(
        "{}: {}, motor.toml, device.json\n",
        path.display(),
        written.join(", ")
    );
    if saved.outcome.is_some() {
        text += &format!("next: servoid device verify {}\n", path.display());
    } else if written.iter().any(|name| name == "recording.csv") {
        text += &format!(
            "next: servoid diagnose {}\n",
            path.join("recording.csv").display()
        );
    }
    text
}

/// What a verification found of a motor whose servo was kept.
fn tried(predicted: &Predicted) -> String {
    let part = |x: Option<f64>| match x {
        Some(x) => format!("{:+.1} %", 100.0 * x),
        None => "by an unknown amount".to_owned(),
    };
    format!(
        "since it was tuned, the motor's gain has changed by {}, its time constant by {}\n",
        part(predicted.gain_moved),
        part(predicted.a1_moved)
    )
}

/// How the last set-point was kept to.
fn followed(followed: &Followed) -> String {
    let (unit, when) = match followed.what {
        FollowedWhat::Angle => ("rad", "at its end"),
        FollowedWhat::Speed => ("rad/s", "in the mean of its last quarter"),
    };
    let Some(reached) = followed.reached else {
        return format!(
            "the last set-point, {} {unit}, was not held to its end\n",
            followed.set_point
        );
    };
    format!(
        "the last set-point: {} {unit}; {when} {reached:.4} {unit}\n",
        followed.set_point
    )
}

/// The servo, and how its step went.
fn tuned(tuned: &Tuned) -> String {
    let answer = |of: &Answer| {
        format!(
            "overshoot {:.1} %, settled after {:.3} s, {:+.1} counts left",
            100.0 * of.overshoot,
            of.settling_s,
            of.left_counts
        )
    };
    format!(
        "servo: position loop {:.4} 1/s, speed loop {} V*s/rad with {} V*s/rad of back-EMF and {} V of friction fed forward\n\
         a step of {} counts\n  predicted {}\n  measured  {}\n{}\n",
        tuned.position_1_s,
        shown(tuned.speed_v_s_rad),
        shown(tuned.back_emf_v_s_rad),
        shown(tuned.friction_v),
        tuned.step_counts,
        answer(&tuned.predicted),
        tuned
            .measured
            .as_ref()
            .map_or_else(|| "nothing: the step was given up".to_owned(), answer),
        if tuned.kept {
            "the servo is kept in the device's flash"
        } else {
            "the servo is kept until the power is cut"
        }
    )
}

/// What the numbers are good for, and why for no more.
fn verdict(saved: &DeviceRun) -> String {
    let (Some(grade), Some(within)) = (saved.grade, &saved.within) else {
        return String::new();
    };
    let part = |x: Option<f64>| match x {
        Some(x) => format!("{:.2} %", x * 100.0),
        None => "nothing".to_owned(),
    };
    let text = format!(
        "verdict: {grade}: gain known to {}, time constant to {}, acceleration from standstill to {} (95 %)\n",
        part(within.gain),
        part(within.a1),
        part(within.acceleration),
    );
    match &saved.reason {
        None => text,
        Some(reason) => text + &format!("  {reason}\n"),
    }
}

/// `servoid device commission` and, with [`Kind::Tune`], `tune`.
pub(super) fn commission(
    session: &Session,
    args: &CommissionArgs,
    kind: Kind,
) -> Result<(), Error> {
    let folder = Folder::new(&args.out)?;
    let mut bench = open(session, &args.port, &args.limits)?;
    let common = order(session, &bench.reached, &args.limits, kind)?;
    let fit = bench.behind_its_bridge(common.fit, args.dead_time)?;
    // A limit that the user names is kept to the count.
    let (verify_within, accept) = match args.verify_within {
        None => (None, Grade::Control),
        Some(0.0) => (None, Grade::No),
        within => (within, Grade::Floor),
    };
    let order = Order {
        excite_s: args.excite,
        coast: !args.no_coast,
        record_s: args.record,
        verify_s: args.verify,
        verify_within,
        accept,
        fit: Settings {
            method: match args.algorithm {
                DeviceMethod::Pso => Method::Pso,
                DeviceMethod::Firefly => Method::Firefly,
            },
            population: args.population,
            evaluations: args.budget,
            seed: session.seed,
            coulomb: args.with.iter().any(|name| name == "coulomb"),
            load: args.with.iter().any(|name| name == "load_torque"),
            ..fit
        },
        ..common
    };
    into_folder(session, &mut bench, &order, &[], &folder, &args.out)
}

/// `servoid device follow`.
pub(super) fn follow(session: &Session, args: &FollowArgs) -> Result<(), Error> {
    let numbers = [args.angle, args.speed, Some(args.seconds)];
    if numbers.iter().flatten().any(|number| !number.is_finite()) || args.seconds <= 0.0 {
        return Err(Error::Usage(
            "--angle and --speed must be finite, --for above zero".to_owned(),
        ));
    }
    let course = match (&args.course, args.angle, args.speed) {
        (Some(path), _, _) => Course::read(path, args.seconds)?,
        (None, Some(angle), _) => Course::of(Aim::Angle(angle), args.seconds),
        (None, None, speed) => Course::of(Aim::Speed(speed.unwrap_or(0.0)), args.seconds),
    };
    let folder = Folder::new(&args.out)?;
    let mut bench = open(session, &args.port, &args.limits)?;
    let order = Order {
        course: Some(course),
        verify_s: TRIED_S,
        ..order(session, &bench.reached, &args.limits, Kind::Follow)?
    };
    into_folder(session, &mut bench, &order, &[], &folder, &args.out)
}

/// A device, and the order to excite it.
fn excited(session: &Session, args: &StreamArgs) -> Result<(Bench, Order), Error> {
    let bench = open(session, &args.port, &args.limits)?;
    let order = Order {
        excite_s: args.seconds,
        coast: !args.no_coast,
        ..order(session, &bench.reached, &args.limits, Kind::Record)?
    };
    Ok((bench, order))
}

/// `servoid device record`.
pub(super) fn record(session: &Session, args: &RecordArgs) -> Result<(), Error> {
    let folder = Folder::new(&args.out)?;
    let (mut bench, order) = excited(session, &args.stream)?;
    into_folder(session, &mut bench, &order, &[], &folder, &args.out)
}

/// `servoid device run`.
pub(super) fn play(session: &Session, args: &RunArgs) -> Result<(), Error> {
    let commands = CommandSequence::read(&args.plan)?;
    let folder = Folder::new(&args.out)?;
    let mut bench = open(session, &args.port, &args.limits)?;
    let order = order(session, &bench.reached, &args.limits, Kind::Play)?;
    let plan = segments(&commands, order.scale(&bench.about), bench.about.period_us)?;
    into_folder(session, &mut bench, &order, &plan, &folder, &args.out)
}

/// `servoid device stream`.
pub(super) fn stream(session: &Session, args: &StreamArgs) -> Result<(), Error> {
    let (mut bench, order) = excited(session, args)?;
    let mut lines = Lines::new(bench.about.period_us, order.scale(&bench.about));
    // Set once stdout is closed.
    let mut closed = false;
    print(COLUMNS.as_bytes())?;
    let bar = session.progress(0, "device");
    let (about, stop) = (&bench.about, session.stop());
    let each = |progress: Progress<'_>| {
        show(&bar, progress);
        if let Progress::Rows(rows) = progress
            && rows.stage == Stage::Excite
            && !closed
        {
            closed = print(lines.of(rows).as_bytes()).is_err();
        }
        Ok(())
    };
    let mut recorded = Vec::new();
    let run = drive(
        &mut bench.conversation,
        about,
        &order,
        &[],
        stop,
        &mut recorded,
        each,
    );
    bar.finish_and_clear();
    match run?.outcome {
        Ok(_) => Ok(()),
        Err(failure) => Err(Error::Failed(format!(
            "the device gave up: {}",
            failure.fault
        ))),
    }
}
