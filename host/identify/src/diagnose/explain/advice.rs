//! What to do next: which experiment splits what looks alike, and what no recording of voltage and angle tells.

use crate::diagnose::outcome::{Diagnosis, Verdict};
use crate::diagnose::recordings::HeldOut;
use servoid_engine::problem::Data;
use servoid_io::recording::Drive;
use shared::effects::{Kind, Place};

/// What to do next.
pub(crate) fn advise(diagnosis: &mut Diagnosis) {
    let mut advice = Vec::new();
    for step in &diagnosis.steps {
        if step.added == Kind::AsymCoulomb {
            advice.push(
                "unequal friction, and equal friction beside a constant load or an offset, do the same while the shaft \
                 turns: hold it at rest at several angles, where a load acts and friction only holds, and let it run down \
                 with the bridge open, where an offset vanishes"
                    .to_owned(),
            );
        }
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
    diagnosis.advice.append(&mut advice);
}

/// The experiment that tells two effects apart. `None` where the one is the other with some parameters at rest:
/// the simpler one is meant until a recording asks for more.
fn split(added: Kind, other: Kind) -> Option<String> {
    let how = match pair(added, other) {
        Pair::Refined => return None,
        Pair::How(how) => how.to_owned(),
        Pair::Other if added.description().exposed_by == other.description().exposed_by => {
            added.description().exposed_by.to_owned()
        }
        Pair::Other => format!(
            "{} (exposes {}), and {} (exposes {})",
            added.description().exposed_by,
            added.name(),
            other.description().exposed_by,
            other.name()
        ),
    };
    Some(format!(
        "{} and {} explain this recording alike; to separate them record {how}",
        added.name(),
        other.name()
    ))
}

enum Pair {
    Refined,
    How(&'static str),
    Other,
}

/// Splits that were found by simulation, for the pairs that look most alike.
fn pair(a: Kind, b: Kind) -> Pair {
    use Kind::{
        AsymCoulomb, Backlash, BrushDrop, Cogging, Compliance, Coulomb, DeadZone, Delay, EncEcc,
        LoadFriction, LoadTorque, Lugre, OffsetVoltage, Stribeck, SupplySag, TorqueSat, Unbalance,
        VoltageSat,
    };
    let is = |x: Kind, y: Kind| (a, b) == (x, y) || (a, b) == (y, x);
    let electrical = |kind: Kind| kind.description().place == Place::Drive;
    if [Stribeck, AsymCoulomb, Lugre]
        .iter()
        .any(|&k| is(Coulomb, k))
    {
        Pair::Refined
    } else if is(LoadTorque, OffsetVoltage) || is(OffsetVoltage, AsymCoulomb) {
        Pair::How(
            "a run-down with the bridge open, where a voltage offset vanishes and a torque does not",
        )
    } else if is(LoadTorque, AsymCoulomb) {
        Pair::How(
            "a hold at rest and slow creeping back: a load acts at rest, unequal friction only holds",
        )
    } else if [Coulomb, Stribeck].contains(&a) && electrical(b)
        || [Coulomb, Stribeck].contains(&b) && electrical(a)
    {
        Pair::How(
            "a run-down with the bridge open, where all that is electrical vanishes and friction stays, or log the \
             current",
        )
    } else if is(BrushDrop, DeadZone) {
        Pair::How(
            "the same commands on two supply voltages: a dead time scales with the supply, brushes do not",
        )
    } else if is(Backlash, Compliance) {
        Pair::How(
            "multisines of several amplitudes: the resonance moves with the amplitude for a gap, not for a spring",
        )
    } else if is(Compliance, Delay) {
        Pair::How(
            "a chirp: the phase of a delay falls evenly with the frequency, a resonance steps by half a turn",
        )
    } else if is(SupplySag, LoadFriction) || is(SupplySag, VoltageSat) {
        Pair::How("hard steps and a stall while the supply voltage is logged")
    } else if is(VoltageSat, TorqueSat) {
        Pair::How(
            "a stall with the current logged: a plateau of the current, or of the torque alone",
        )
    } else if is(Cogging, EncEcc) || is(Unbalance, EncEcc) {
        Pair::How(
            "constant runs at several speeds: an error of the angle stays the same, a torque shrinks as speed rises",
        )
    } else if is(Unbalance, Cogging) {
        Pair::How(
            "the same run with the bench tilted or the motor turned by 90 degrees: gravity stays where it was",
        )
    } else {
        Pair::Other
    }
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
            if data.current_a.is_none() {
                list.push(
                    "resistance and inertia are seen only as a product, and so are resistance and each torque: measure \
                     the resistance, or log the current"
                        .to_owned(),
                );
            }
        }
        Drive::Current => list.push(
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
