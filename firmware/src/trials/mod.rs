//! Trials of the guards: everything that can go wrong on a bench, in every phase in which it can, while the application
//! runs. They need neither a host nor a heap, so that they run on a PC and on a microcontroller alike.

pub mod bench;
pub mod host;

use core::cell::RefCell;
use core::fmt::{self, Write};

use shared::fit::{Arithmetic, Grade, Settings};
use shared::wire::{Job, Kind, Limits, ToDevice, ToHost};

use crate::app::{Memory, Recording};
use crate::board::Board;
use crate::guard::SHORTEST_WINDOW_MS;
use crate::phase::{Fault, Phase};
use crate::plant::{Motor, SMALL};
use bench::{Bench, OnBench};
use host::Host;

/// Periods that a trial records and fits: the length of its recording.
pub const RECORD: usize = 600;
/// Periods into a phase at which something goes wrong.
const INTO: u32 = 60;
/// A duty that moves the motor well.
const STRONG: u16 = 8_000;
/// Periods of strong drive one way within which a shaft that does not follow must be noticed: one and a half of the guard's windows,
/// which this motor's encoder lets be the shortest.
const REACTION: u32 = SHORTEST_WINDOW_MS * 1000 / <OnBench>::PERIOD_US * 3 / 2 + 1;
/// Periods after which a trial that has no outcome has failed.
const LONGEST: u32 = 60_000;

/// The injected fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mischief {
    /// Nothing.
    None,
    /// The encoder's lines are swapped.
    EncoderReversed,
    /// The encoder stands still.
    EncoderStuck,
    /// One of the encoder's lines is dead.
    EncoderLine,
    /// A disturbance makes the encoder's counter jump.
    EncoderJump,
    /// Something holds the shaft.
    ShaftLocked,
    /// A lead of the motor is cut.
    LeadCut,
    /// The current sensor shows nothing.
    SensorStuck,
    /// The supply breaks down.
    SupplySag,
    /// The motor brakes into a supply that takes no current back.
    SupplyRise,
    /// The current sensor shows a short circuit.
    ShortCircuit,
    /// The bridge's driver reports a fault.
    BridgeFault,
    /// A period was too long.
    Overrun,
    /// The host falls silent.
    Silence,
    /// The host stops the run.
    Stop,
    /// A limit of the job is too low for what it does.
    Limit(Fault),
    /// The supply breaks down: the microcontroller starts anew, and the host does not notice.
    BrownOut,
}

impl Mischief {
    /// Does it to a bench; what a host or a job does, it cannot.
    pub fn on(self, bench: &mut Bench) {
        // Parts of the motor's supply, mV.
        let supply = |part: f32| Some((bench.motor().supply * part * 1000.0) as u16);
        match self {
            Mischief::EncoderReversed => bench.encoder = -1,
            Mischief::EncoderStuck => bench.encoder = 0,
            Mischief::EncoderLine => bench.line_dead = true,
            Mischief::EncoderJump => bench.jump(60_000),
            Mischief::LeadCut => bench.lead_cut = true,
            Mischief::SensorStuck => bench.current_ma = Some(0),
            Mischief::SupplySag => bench.supply_mv = supply(0.5),
            Mischief::SupplyRise => bench.supply_mv = supply(1.5),
            Mischief::ShaftLocked => bench.locked = true,
            Mischief::ShortCircuit => bench.current_ma = Some(-30_000),
            Mischief::BridgeFault => bench.fails = Some(Fault::Bridge),
            Mischief::Overrun => bench.fails = Some(Fault::Overrun),
            _ => {}
        }
    }
}

/// A trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trial {
    /// The injected fault.
    pub mischief: Mischief,
    /// In which phase.
    pub phase: Phase,
    /// Fault that the device must report; none if the run must succeed, or the device must know of no run.
    pub fault: Option<Fault>,
    /// Periods within which the bridge must be open, where that does not depend on what is driven.
    pub within: Option<u32>,
}

const PHASES: [Phase; 5] = [
    Phase::Probe,
    Phase::Excite,
    Phase::Record,
    Phase::Verify,
    Phase::Tune,
];

/// Injected faults of each phase, the report that each must cause, and its deadline.
const MISCHIEFS: [(Mischief, Option<Fault>, Option<u32>); 15] = [
    (Mischief::EncoderReversed, Some(Fault::Runaway), None),
    (Mischief::EncoderStuck, Some(Fault::Stall), None),
    (Mischief::EncoderLine, Some(Fault::EncoderLine), None),
    (Mischief::EncoderJump, Some(Fault::EncoderJump), Some(1)),
    (Mischief::LeadCut, Some(Fault::MotorLead), None),
    (Mischief::SensorStuck, Some(Fault::CurrentSensor), None),
    (Mischief::SupplySag, Some(Fault::Undervoltage), Some(1)),
    (Mischief::SupplyRise, Some(Fault::Overvoltage), Some(1)),
    (Mischief::ShaftLocked, Some(Fault::Stall), None),
    (Mischief::ShortCircuit, Some(Fault::Overcurrent), Some(1)),
    (Mischief::BridgeFault, Some(Fault::Bridge), Some(1)),
    (Mischief::Overrun, Some(Fault::Overrun), Some(1)),
    (Mischief::Silence, Some(Fault::LinkLost), Some(501)),
    (Mischief::Stop, Some(Fault::Stopped), Some(1)),
    (Mischief::BrownOut, None, Some(1)),
];

// A limit of the current is no fault: it bounds the drive.
const LIMITS: [Fault; 4] = [
    Fault::Overtravel,
    Fault::Overspeed,
    Fault::Overheated,
    Fault::TimeUp,
];

/// Whether a mischief shows in its phase. A step of the servo is over before a link is too silent, and hardly draws the current that a dead
/// sensor would be missed in; and a shaft without a motor that still turns when the loop brakes runs against the drive.
fn shows(trial: &Trial) -> bool {
    let hidden = [Mischief::Silence, Mischief::SensorStuck, Mischief::LeadCut];
    trial.phase != Phase::Tune || !hidden.contains(&trial.mischief)
}

/// All trials.
pub fn all() -> impl Iterator<Item = Trial> {
    let undisturbed = Trial {
        mischief: Mischief::None,
        phase: Phase::Idle,
        fault: None,
        within: None,
    };
    let disturbed = MISCHIEFS.into_iter().flat_map(|(mischief, fault, within)| {
        PHASES.into_iter().map(move |phase| Trial {
            mischief,
            phase,
            fault,
            within,
        })
    });
    // The next phase would drive, for nobody.
    let alone = Trial {
        mischief: Mischief::Silence,
        phase: Phase::Fit,
        fault: Some(Fault::LinkLost),
        within: Some(1),
    };
    let limited = LIMITS.into_iter().map(|fault| Trial {
        mischief: Mischief::Limit(fault),
        phase: Phase::Excite,
        fault: Some(fault),
        within: None,
    });
    [undisturbed, alone]
        .into_iter()
        .chain(disturbed.filter(shows))
        .chain(limited)
}

/// Result of a trial.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Outcome {
    /// The fault that the device reported.
    pub fault: Option<Fault>,
    /// True if it reported success.
    pub succeeded: bool,
    /// Periods from the mischief to the open bridge.
    pub open_after: Option<u32>,
    /// Longest time of those for which it drove strongly one way, periods.
    pub strongly: u32,
    /// True if the bridge stayed open from then on.
    pub stayed_open: bool,
    /// A phase in which the bridge drove though it must not.
    pub drove_in: Option<Phase>,
    /// True if it drove after the host had died while nothing moved.
    pub drove_alone: bool,
}

impl Trial {
    /// True if an outcome is as required.
    pub fn passes(&self, outcome: &Outcome) -> bool {
        let reported = outcome.fault == self.fault;
        let succeeded = outcome.succeeded == (self.mischief == Mischief::None);
        let soon = match (self.within, outcome.open_after) {
            (None, _) => true,
            (Some(within), Some(after)) => after <= within,
            (Some(_), None) => false,
        };
        // A shaft that does not follow can only be told from one that need not while it is driven; the probe drives for
        // longer, but only as strongly as it must.
        let follows = !matches!(self.fault, Some(Fault::Stall | Fault::Runaway));
        let noticed = follows || self.phase == Phase::Probe || outcome.strongly <= REACTION;
        let stayed_open = outcome.stayed_open && outcome.drove_in.is_none() && !outcome.drove_alone;
        reported && succeeded && soon && noticed && stayed_open
    }

    fn job(&self) -> Job {
        let mut limits = Limits {
            duty: 32_000,
            current_ma: 20_000,
            time: 60_000,
            ..Limits::NONE
        };
        if let Mischief::Limit(fault) = self.mischief {
            match fault {
                Fault::Overtravel => limits.travel = 900,
                Fault::Overspeed => limits.speed = 60,
                Fault::Overheated => (limits.continuous_ma, limits.thermal) = (900, 300),
                _ => limits.time = 700,
            }
        }
        Job {
            kind: Kind::Tune,
            amplitude: 30_000,
            excite: 800,
            coast: false,
            record: RECORD as u16,
            verify: 700,
            verify_within: 100,
            accept: Grade::No,
            seed: 3,
            fit: Settings {
                evaluations: 200,
                ..Settings::USUAL
            },
            limits,
            counts_per_rev: SMALL.counts_per_rev as u32,
            supply_mv: (SMALL.supply * 1000.0) as u32,
        }
    }

    /// Runs it; `memory` and `recording` are the device's.
    #[inline(never)]
    pub fn run<S: Arithmetic>(
        &self,
        memory: &mut Memory<S>,
        recording: &mut Recording<RECORD>,
    ) -> Outcome {
        let bench = RefCell::new(Bench::new(Motor { ..SMALL }));
        let mut outcome = self.until_the_end(&bench, memory, recording);
        if self.mischief == Mischief::BrownOut {
            // The microcontroller starts anew; the host goes on talking, but has not armed it.
            let mut host = Host::<S, RECORD>::new(&bench, memory, recording);
            outcome.open_after = bench.borrow().driven.is_none().then_some(0);
            outcome.stayed_open = true;
            for _ in 0..1000 {
                host.period(|_| {});
                outcome.stayed_open &= host.bench.borrow().driven.is_none();
            }
        }
        outcome
    }

    fn until_the_end<S: Arithmetic>(
        &self,
        bench: &RefCell<Bench>,
        memory: &mut Memory<S>,
        recording: &mut Recording<RECORD>,
    ) -> Outcome {
        let mut outcome = Outcome::default();
        let mut host = Host::<S, RECORD>::new(bench, memory, recording);
        if !host.start(self.job()) {
            return outcome;
        }
        let (mut phase, mut into, mut since) = (Phase::Idle, 0, None);
        let (mut strongly, mut forward) = (0, false);
        for _ in 0..LONGEST {
            into = if host.app.phase() == phase {
                into + 1
            } else {
                0
            };
            phase = host.app.phase();
            if since.is_none() && phase == self.phase && into == self.into() {
                since = Some(0);
                if self.mischief == Mischief::BrownOut {
                    return outcome;
                }
                self.disturb(&mut host);
            }
            let mut ended = false;
            host.period(|message| match message {
                ToHost::Report(_) => (outcome.succeeded, ended) = (true, true),
                ToHost::Failed(failure) => (outcome.fault, ended) = (Some(failure.fault), true),
                _ => {}
            });
            since = since.map(|periods| periods + 1);
            let duty = host.bench.borrow().driven.unwrap_or(0);
            let lasts = duty.unsigned_abs() >= STRONG && (duty > 0) == forward;
            strongly = if lasts { strongly + 1 } else { 0 };
            forward = duty > 0;
            if since.is_some() && outcome.open_after.is_none() {
                outcome.strongly = outcome.strongly.max(strongly);
            }
            let open = host.bench.borrow().driven.is_none();
            if open && outcome.open_after.is_none() {
                outcome.open_after = since;
            }
            outcome.drove_alone |= !open && self.phase == Phase::Fit && since.is_some();
            if ended {
                break;
            }
        }
        outcome.stayed_open = true;
        for _ in 0..300 {
            host.period(|_| {});
            outcome.stayed_open &= host.bench.borrow().driven.is_none();
        }
        outcome.drove_in = host.drove_in;
        outcome
    }

    /// The probe moves the shaft within its first steps, and the fit is short: what goes wrong in them goes wrong from the start.
    fn into(&self) -> u32 {
        match self.phase {
            Phase::Probe | Phase::Fit => 1,
            _ => INTO,
        }
    }

    fn disturb<S: Arithmetic>(&self, host: &mut Host<'_, S, RECORD>) {
        match self.mischief {
            Mischief::Silence => host.alive = false,
            Mischief::Stop => host.send(&ToDevice::Stop),
            _ => {}
        }
        self.mischief.on(&mut host.bench.borrow_mut());
    }
}

/// Runs all trials and writes a line for each; returns how many failed.
///
/// # Errors
/// Errors of the writer.
pub fn run<S: Arithmetic>(
    out: &mut impl Write,
    memory: &mut Memory<S>,
    recording: &mut Recording<RECORD>,
) -> Result<u32, fmt::Error> {
    let mut failed = 0;
    for trial in all() {
        let outcome = trial.run(memory, recording);
        let passes = trial.passes(&outcome);
        failed += u32::from(!passes);
        let Trial {
            mischief, phase, ..
        } = trial;
        let verdict = if passes { "ok" } else { "FAILED" };
        write!(out, "{verdict} {mischief:?} in {phase:?}: ")?;
        match outcome.fault {
            Some(fault) => write!(out, "{fault:?}")?,
            None => write!(out, "no fault")?,
        }
        match outcome.open_after {
            Some(periods) => writeln!(
                out,
                ", bridge open after {periods} periods, {} of strong drive",
                outcome.strongly
            )?,
            None => writeln!(out)?,
        }
    }
    Ok(failed)
}
