//! `servoid device verify`: checks the device's result.
//!
//! First its arithmetic: the same recording, seed and number format on the host must give the same bits. Then its search:
//! least squares in double precision on the same recording. Then its physics: the diagnosis of the long recording, judged by
//! the verification, neither of which the device fitted.

use super::super::progress::Watched;
use crate::cli::VerifyArgs;
use crate::device::{Replayed, replay};
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_engine::simulation::Candidate;
use servoid_identify::diagnose::{self, Budget};
use servoid_identify::fit::Options;
use servoid_identify::fit::bridge::dead_time_s;
use servoid_identify::{Datasets, diagnose_datasets, identify_data};
use servoid_io::input::{MotorFile, read_recording};
use servoid_results::device_run::{Folder, FolderError};
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::schema::device::Outcome;
use servoid_results::schema::verification::{self, DeadTime, Stronger};
use servoid_results::schema::{DeviceRun, Diagnosis, Verification};
use shared::effects::Kind;
use shared::wire::Stage;
use std::path::Path;

/// Values that differ by less than this part are the same answer.
const SAME: f64 = 0.01;

/// True if the stronger search agrees with the device.
fn agrees(stronger: &Stronger) -> bool {
    [stronger.gain_off, stronger.a1_off]
        .iter()
        .all(|off| off.is_some_and(|off| off.abs() < SAME))
}

pub(super) fn run(session: &Session, args: &VerifyArgs) -> Result<(), Error> {
    let folder = Folder::at(&args.folder);
    let saved = folder.saved()?;
    let Some(outcome) = &saved.outcome else {
        let why = match &saved.failure {
            Some(failure) => format!(
                "the device gave up before it had fitted: {}",
                failure.message
            ),
            None => "the device did not fit; commission the motor first".to_owned(),
        };
        return Err(FolderError::Unusable {
            path: args.folder.clone(),
            why,
        }
        .into());
    };
    let (duties, steps) = folder.fitted(&saved)?;
    let replayed = replay(&saved, &duties, &steps);
    let mut text = bits(&saved, outcome, &replayed, duties.len());
    session.remark("the device's fit, repeated");

    let motor = MotorFile::read(&args.folder.join("motor.toml"))?;
    let stronger = stronger(session, &folder, &motor, outcome, &saved)?;
    text += &search(outcome, &stronger);

    let diagnosed = match (
        folder.recording_of(Stage::Excite),
        folder.recording_of(Stage::Verify),
    ) {
        (Some(recording), Some(held_out)) => {
            Some(diagnose(session, &recording, &held_out, &motor)?)
        }
        _ => None,
    };
    let fitted = fitted_effects(&saved);
    let same = replayed.differ.is_empty();
    let (stands, verdict) = verdict(same, &stronger, diagnosed.as_ref(), &fitted);
    if let Some(diagnosed) = &diagnosed {
        text += &format!("\n{}\n", diagnosed.text);
    }
    text += &format!("{verdict}\n");
    let json = Verification {
        schema: verification::SCHEMA.to_owned(),
        same_bits: same,
        differ: replayed.differ,
        stronger: Some(stronger),
        stands,
        verdict: verdict.clone(),
        diagnosis: diagnosed.map(|diagnosed| Box::new(diagnosed.json)),
    };
    session.deliver(&text, &json)?;
    if same {
        Ok(())
    } else {
        Err(Error::Failed(
            "the host does not find the device's bits: is the firmware of another version, or fitted.csv changed?".to_owned(),
        ))
    }
}

fn fitted_effects(saved: &DeviceRun) -> Vec<Kind> {
    let flags = [
        (saved.fit.coulomb, Kind::Coulomb),
        (saved.fit.load, Kind::LoadTorque),
        (saved.fit.carriers > 0, Kind::DeadTime),
        (saved.fit.supply, Kind::SupplySag),
    ];
    flags
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, kind)| kind)
        .collect()
}

/// Whether an effect is what a fitted dead time takes: at one supply voltage brushes drop the same.
fn is_lost_by_the_bridge(kind: Kind, fitted: &[Kind]) -> bool {
    kind == Kind::BrushDrop && fitted.contains(&Kind::DeadTime)
}

fn bits(saved: &DeviceRun, outcome: &Outcome, replayed: &Replayed, periods: usize) -> String {
    let what = format!(
        "{periods} periods, {} models, {}, seed {}",
        outcome.evaluations, saved.format, saved.fit.seed
    );
    if replayed.differ.is_empty() {
        format!("arithmetic: the host finds the same bits ({what})\n")
    } else {
        format!(
            "arithmetic: the host finds OTHER BITS for {} ({what})\n",
            replayed.differ.join(", ")
        )
    }
}

fn stronger(
    session: &Session,
    folder: &Folder,
    motor: &MotorFile,
    outcome: &Outcome,
    saved: &DeviceRun,
) -> Result<Stronger, Error> {
    let path = folder.recording_of(Stage::Record).ok_or_else(|| {
        Error::Failed(
            "fitted.csv is not there: the folder is not as `servoid device commission` wrote it"
                .to_owned(),
        )
    })?;
    let data = Data::new(&read_recording(&path, motor)?)?;
    let options = Options {
        effects: fitted_effects(saved),
        seed: session.seed,
        known: motor.known.clone(),
        ..Options::default()
    };
    let watched = Watched::search(session, options.budget);
    let fit = identify_data(&data, None, &options, &watched)?;
    drop(watched);
    let response = fit.candidate.machine.response();
    let off = |name: &str, truth: f64| {
        outcome
            .value(name)
            .and_then(|value| finite(value / truth - 1.0))
    };
    Ok(Stronger {
        rms_counts: finite(fit.rms_counts),
        device_rms_counts: finite(outcome.rms_counts),
        gain_rad_s_v: finite(response.gain),
        a1_s: finite(response.a1),
        gain_off: off("gain", response.gain),
        a1_off: off("a1", response.a1),
        dead_time: (saved.fit.carriers > 0).then(|| dead_time(saved, outcome, &fit.candidate)),
    })
}

/// The bridge's dead time by both fits and by the board.
fn dead_time(saved: &DeviceRun, outcome: &Outcome, found: &Candidate) -> DeadTime {
    let own = found
        .effects
        .iter()
        .find(|(kind, _)| *kind == Kind::DeadTime);
    let lost = own.and_then(|(_, values)| values.first().copied());
    DeadTime {
        device_s: outcome.value("dead_time").and_then(finite),
        host_s: lost
            .zip(saved.carrier_hz())
            .and_then(|(volts, carrier)| finite(dead_time_s(volts, saved.supply_v, carrier))),
        told_s: saved.told_dead_time_s(),
    }
}

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

fn search(outcome: &Outcome, stronger: &Stronger) -> String {
    let number = |x: Option<f64>| x.unwrap_or(f64::NAN);
    let mut text = format!(
        "search: least squares in double precision leaves {:.4} counts RMS, the device {:.4}; its gain is off by {:+.3} %, its \
         time constant by {:+.3} %\n",
        number(stronger.rms_counts),
        outcome.rms_counts,
        number(stronger.gain_off) * 100.0,
        number(stronger.a1_off) * 100.0
    );
    if let Some(dead_time) = &stronger.dead_time {
        let ns = |x: Option<f64>| format!("{:.0} ns", number(x) * 1e9);
        let told = match dead_time.told_s {
            Some(_) => format!("the timer was told {}", ns(dead_time.told_s)),
            None => "the board does not say what its bridge has".to_owned(),
        };
        text += &format!(
            "dead time: {} by the device, {} by least squares; {told}\n",
            ns(dead_time.device_s),
            ns(dead_time.host_s)
        );
    }
    text
}

/// The diagnosis, rendered.
struct Account {
    text: String,
    json: Diagnosis,
    names: Vec<Kind>,
    explained: bool,
    base: f64,
    last: f64,
}

fn diagnose(
    session: &Session,
    recording: &Path,
    held_out: &Path,
    motor: &MotorFile,
) -> Result<Account, Error> {
    let first = read_recording(recording, motor)?;
    let other = read_recording(held_out, motor)?;
    let options = Options {
        known: motor.known.clone(),
        seed: session.seed,
        ..Options::default()
    };
    let datasets = Datasets::new(first, Some(other), &options)?;
    let watched = Watched::diagnosis(session);
    let budget = Budget::usual(session.stop());
    let found = diagnose_datasets(&datasets, &options, &budget, &watched)?;
    drop(watched);
    let Datasets { fitted, kind, .. } = &datasets;
    let report = DiagnosisReport::new(&found, fitted, kind, session.seed, session.json_file());
    let diagnosis = &found.diagnosis;
    Ok(Account {
        text: report.text(),
        json: Diagnosis::from(&report),
        names: diagnosis.steps.iter().map(|step| step.added).collect(),
        explained: matches!(
            diagnosis.verdict,
            diagnose::Verdict::Complete | diagnose::Verdict::MissingEffects
        ),
        base: diagnosis.base.judged().held_out,
        last: diagnosis.last.judged().held_out,
    })
}

fn verdict(
    same: bool,
    stronger: &Stronger,
    diagnosed: Option<&Account>,
    fitted: &[Kind],
) -> (bool, String) {
    if !same {
        return (
            false,
            "The device's answer does not stand: its arithmetic cannot be repeated.".to_owned(),
        );
    }
    let other_motor = || {
        "The device's answer does not stand: on its own recording a stronger search finds another motor. Commission \
         again with another --seed or a larger --budget."
            .to_owned()
    };
    let Some(diagnosed) = diagnosed else {
        if !agrees(stronger) {
            return (false, other_motor());
        }
        return (
            true,
            "The device's answer stands as far as its own recording tells; there is no long recording to diagnose (--excite 0)."
                .to_owned(),
        );
    };
    let missing: Vec<&str> = diagnosed
        .names
        .iter()
        .filter(|kind| !fitted.contains(kind) && !is_lost_by_the_bridge(**kind, fitted))
        .map(|kind| kind.name())
        .collect();
    if !diagnosed.explained {
        return (
            false,
            "The device's answer does not stand alone: something in the recording is not explained by its model, nor by any \
             in the catalogue."
                .to_owned(),
        );
    }
    // Where physics is missing, no seed finds the motor.
    if missing.is_empty() {
        if !agrees(stronger) {
            return (false, other_motor());
        }
        return (
            true,
            "The device's answer stands: same bits, same motor, and no physics missing.".to_owned(),
        );
    }
    (
        false,
        format!(
            "The device's answer does not stand alone: {} missing. With {} the held-out error falls from {:.2} to {:.2} counts RMS.",
            if let [only] = missing.as_slice() {
                format!("{only} is")
            } else {
                format!("{} are", missing.join(" and "))
            },
            if missing.len() == 1 { "it" } else { "them" },
            diagnosed.base,
            diagnosed.last
        ),
    )
}
