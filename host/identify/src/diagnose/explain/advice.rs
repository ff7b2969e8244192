//! What to do next: which experiment splits what looks alike, and what no recording of voltage and angle tells.

use crate::diagnose::outcome::{Diagnosis, Floor, FloorKind, Verdict};
use crate::diagnose::recordings::HeldOut;
use servoid_engine::problem::Data;
use servoid_io::channel::Measured;
use servoid_io::recording::Drive;
use shared::effects::Kind;

/// What to do next.
pub(crate) fn advise(diagnosis: &mut Diagnosis) {
    let mut advice = Vec::new();
    for step in &diagnosis.steps {
        advice.extend(step.added.facts().caution.map(str::to_owned));
        for &other in &step.indistinguishable_from {
            advice.extend(split(step.added, other));
        }
    }
    if diagnosis.verdict == Verdict::Unexplained && diagnosis.fits_only_its_own() {
        advice.push(
            "the model explains the recording that it was fitted to and not the other one: fit them the other way \
             round, to see what the other one asks for, and record both anew if they are not of one motor in one state"
                .to_owned(),
        );
    } else if diagnosis.verdict == Verdict::Unexplained {
        advice.push(match diagnosis.not_named {
            Some(kind) => format!(
                "{} ({}) reduces the error most, but not beyond doubt, and is not named; to expose it record {}",
                kind.name(),
                kind.description().title,
                kind.description().exposed_by
            ),
            None => "no effect of the catalogue reduces the error on what was held out".to_owned(),
        });
    }
    let is_unknown = |floor: &Floor| floor.kind == FloorKind::Unknown;
    if diagnosis.floor.as_ref().is_some_and(is_unknown) {
        advice.push(
            "record the same command three times and give all of them: what the runs differ by no model can explain, and what they have in \
             common it can"
                .to_owned(),
        );
    }
    diagnosis.advice.append(&mut advice);
}

/// The experiment that tells two effects apart. `None` where the one is the other with some parameters at rest:
/// the simpler one is meant until a recording asks for more.
fn split(added: Kind, other: Kind) -> Option<String> {
    if added.refines(other) || other.refines(added) {
        return None;
    }
    let [own, others] = [added, other].map(|kind| kind.description().exposed_by);
    let how = match added.told_from(other) {
        Some(told) => told.record.to_owned(),
        None if own == others => own.to_owned(),
        None => format!(
            "{own} (exposes {}), and {others} (exposes {})",
            added.name(),
            other.name()
        ),
    };
    Some(format!(
        "{} and {} explain this recording alike; to separate them record {how}",
        added.name(),
        other.name()
    ))
}

/// What the recordings cannot tell, whatever the verdict (the exact scalings of the equations).
pub fn cannot_tell(data: &Data, held_out: &HeldOut, knows_torque: bool) -> Vec<String> {
    let mut list = vec![
        "a wrong counts_per_rev leaves no trace: all speeds and constants scale with it; compare index pulse to index \
         pulse, or turn the shaft once by hand"
            .to_owned(),
    ];
    match data.drive {
        Drive::Voltage => {
            list.push(
                "a wrong scale of the voltage leaves no trace: all constants scale with it; use a voltmeter"
                    .to_owned(),
            );
            if data.measured.get(Measured::Current).is_none() {
                list.push(
                    "resistance and inertia are seen only as a product, and so are resistance and each torque: measure \
                     the resistance, or log the current"
                        .to_owned(),
                );
            }
        }
        Drive::Current | Drive::Torque => list.push(
            "a wrong scale of the command leaves no trace: inertia and torques are per unit of it"
                .to_owned(),
        ),
    }
    if !knows_torque {
        list.push(
            "whether the torque constant equals the back-EMF constant: a known added inertia or weight would tell"
                .to_owned(),
        );
    }
    if let HeldOut::End { .. } = held_out {
        list.push(
            "what changes from one run to the next: both parts are of one run; give another with --validate"
                .to_owned(),
        );
    }
    list
}
