//! The fit, in the caller's memory.

use crate::recording::ServoidRecording;
use crate::status::{ServoidStatus, told};
use shared::fit::{Fit, Method, Outcome, Settings, Stop, Unknown};

/// The number format of the models: fixed point on cores without a floating-point unit.
#[cfg(all(target_arch = "arm", not(target_abi = "eabihf")))]
type Number = shared::scalar::Fixed;
#[cfg(not(all(target_arch = "arm", not(target_abi = "eabihf"))))]
type Number = f32;

/// What to search for, and how. `servoid_usual_settings` has what suits most motors.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ServoidSettings {
    /// Seed of the search.
    pub seed: u64,
    /// Models of a search; there may be three, and a polish comes on top of each.
    pub evaluations: u16,
    /// Waves of the bridge's carrier in a control period, to fit what its dead time takes; 0 takes a bridge that loses nothing.
    pub carriers: u16,
    /// What the dead time takes by the board's own figure, as a duty: twice the dead time by the carrier's period, times 32,768.
    pub dead_time: u16,
    /// Duty that is the whole supply; 0 for 32,768.
    pub full: u16,
    /// Particles or fireflies, at most 20.
    pub population: u8,
    /// Not 0: particle swarm; 0: fireflies.
    pub swarm: u8,
    /// Not 0: fit Coulomb friction.
    pub coulomb: u8,
    /// Not 0: fit a constant load.
    pub load: u8,
    /// Not 0: fit the resistance of a supply that is not measured.
    pub supply: u8,
}

impl ServoidSettings {
    fn settings(&self) -> Settings {
        Settings {
            method: match self.swarm {
                0 => Method::Firefly,
                _ => Method::Pso,
            },
            population: self.population,
            evaluations: self.evaluations,
            seed: self.seed,
            coulomb: self.coulomb != 0,
            load: self.load != 0,
            carriers: self.carriers,
            dead_time: self.dead_time,
            supply: self.supply != 0,
            full: self.full,
        }
    }
}

/// A value with its standard deviation, which is infinite where nothing determines it; both are 0 where it was not fitted.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoidEstimate {
    /// The value.
    pub value: f32,
    /// Its standard deviation.
    pub deviation: f32,
}

/// What a fit found. With `P` seconds a period, `N` counts a revolution and `V` volts of supply, a gain in rad/s/V is `value*2*pi/(N*P*V)`,
/// a time in seconds `value*P`, a voltage `value*V`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoidOutcome {
    /// Steady speed under the whole supply, counts a period.
    pub gain: ServoidEstimate,
    /// Coefficient a1 of the response to voltage, nearly the mechanical time constant, periods.
    pub first_order: ServoidEstimate,
    /// Electrical time constant, periods.
    pub electrical: ServoidEstimate,
    /// Coulomb friction, a part of the supply.
    pub coulomb: ServoidEstimate,
    /// Constant load against positive rotation, a part of the supply.
    pub load: ServoidEstimate,
    /// What the bridge's dead time takes, a part of the supply.
    pub dead_time: ServoidEstimate,
    /// Part of the damping that is viscous friction.
    pub viscous: ServoidEstimate,
    /// Resistance of the supply, a part of the winding's.
    pub supply: ServoidEstimate,
    /// Mean squared error, counts squared; an encoder that floors leaves 1/12.
    pub mean_square: f32,
    /// Models that were run.
    pub evaluations: u32,
}

impl ServoidOutcome {
    fn of(fit: &Fit<Number>, outcome: &Outcome) -> Self {
        let mut own = ServoidOutcome {
            mean_square: outcome.mean_square,
            evaluations: outcome.evaluations,
            ..ServoidOutcome::default()
        };
        for (unknown, estimate) in fit.unknowns().iter().zip(&outcome.estimates) {
            let place = match unknown {
                Unknown::Gain => &mut own.gain,
                Unknown::FirstOrder => &mut own.first_order,
                Unknown::Electrical => &mut own.electrical,
                Unknown::Coulomb => &mut own.coulomb,
                Unknown::Load => &mut own.load,
                Unknown::DeadTime => &mut own.dead_time,
                Unknown::Viscous => &mut own.viscous,
                Unknown::Supply => &mut own.supply,
            };
            *place = ServoidEstimate {
                value: estimate.value,
                deviation: estimate.std,
            };
        }
        own
    }
}

/// Memory for a fit, its prediction and its verdict; at most one of each at a time. A static of it needs no image. What is in it is not for
/// the caller.
#[repr(C)]
pub struct ServoidFit {
    memory: [u64; 1000],
}

/// What the fit has found.
// The first is a zero at the front: an empty memory is all zeros.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Found {
    /// It is not over.
    NotYet,
    /// It is over, and there is no motor.
    NoModel,
    Motor(ServoidOutcome),
}

/// What the memory holds, once a fit has begun.
pub(crate) struct Memory {
    begun: u32,
    found: Found,
    pub(crate) predicts: bool,
    pub(crate) fit: Fit<Number>,
}

impl Memory {
    /// All zeros, so that writing it copies no image and takes no stack.
    const EMPTY: Self = Memory {
        begun: 0,
        found: Found::NotYet,
        predicts: false,
        fit: Fit::idle(),
    };

    /// What the fit has found.
    ///
    /// # Errors
    /// It is not over, or there is no motor.
    pub(crate) fn found(&self) -> Result<&ServoidOutcome, ServoidStatus> {
        match &self.found {
            Found::NotYet => Err(ServoidStatus::TooEarly),
            Found::NoModel => Err(ServoidStatus::NoModel),
            Found::Motor(outcome) => Ok(outcome),
        }
    }
}

/// Marks memory in which a fit has begun.
const BEGUN: u32 = 0x5e70_01d1;
const _: () = assert!(size_of::<Memory>() <= size_of::<ServoidFit>());
const _: () = assert!(align_of::<Memory>() <= align_of::<ServoidFit>());

/// The memory, if a fit has begun in it.
///
/// # Safety
/// `fit` is null or a `ServoidFit` that nothing else uses meanwhile; the caller keeps it all zeros before its first fit.
pub(crate) unsafe fn begun<'a>(fit: *mut ServoidFit) -> Result<&'a mut Memory, ServoidStatus> {
    let memory = fit.cast::<Memory>();
    if memory.is_null() {
        return Err(ServoidStatus::Null);
    }
    // SAFETY: it is as large and as well aligned as `Memory` (asserted above), and has the mark only if it holds one.
    unsafe {
        if (&raw const (*memory).begun).read() != BEGUN {
            return Err(ServoidStatus::TooEarly);
        }
        Ok(&mut *memory)
    }
}

/// Settings that suit most motors: fireflies, 4,000 models, Coulomb friction, seed 1.
#[unsafe(no_mangle)]
pub extern "C" fn servoid_usual_settings() -> ServoidSettings {
    let usual = Settings::USUAL;
    ServoidSettings {
        seed: usual.seed,
        evaluations: usual.evaluations,
        carriers: usual.carriers,
        dead_time: usual.dead_time,
        full: usual.full,
        population: usual.population,
        swarm: u8::from(usual.method == Method::Pso),
        coulomb: usual.coulomb.into(),
        load: usual.load.into(),
        supply: usual.supply.into(),
    }
}

/// Begins a fit of a recording. The memory must be all zeros before its first fit, as a static is.
///
/// # Safety
/// The addresses are null or of what they are declared as; the recording's arrays have as many elements as there are periods.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_fit_begin(
    fit: *mut ServoidFit,
    recording: *const ServoidRecording,
    settings: *const ServoidSettings,
) -> ServoidStatus {
    let memory = fit.cast::<Memory>();
    // SAFETY: the caller answers for all three, and for the arrays.
    let (recording, settings) = unsafe { (recording.as_ref(), settings.as_ref()) };
    let (Some(recording), Some(settings), false) = (recording, settings, memory.is_null()) else {
        return ServoidStatus::Null;
    };
    // SAFETY: as above.
    let Some(trace) = (unsafe { recording.trace() }) else {
        return ServoidStatus::Null;
    };
    // SAFETY: it is not null, as large and as well aligned as `Memory`, and nothing in a `Memory` has to be dropped.
    let memory = unsafe {
        memory.write(const { Memory::EMPTY });
        &mut *memory
    };
    if memory.fit.begin(&trace, settings.settings()) {
        memory.begun = BEGUN;
        return ServoidStatus::Done;
    }
    ServoidStatus::NothingToFit
}

/// Runs models along at most about so many periods of the recording with which the fit has begun. `SERVOID_STATUS_RUNNING` until the fit is
/// over.
///
/// # Safety
/// As of `servoid_fit_begin`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_fit_work(
    fit: *mut ServoidFit,
    recording: *const ServoidRecording,
    samples: u32,
) -> ServoidStatus {
    // SAFETY: the caller answers for both, and for the arrays.
    let (memory, trace) = unsafe {
        let recording = recording.as_ref();
        (
            begun(fit),
            recording.and_then(|recording| recording.trace()),
        )
    };
    told(memory.and_then(|memory| {
        let trace = trace.ok_or(ServoidStatus::Null)?;
        if let Found::NotYet = memory.found {
            let outcome = memory.fit.work(&trace, samples);
            let outcome = outcome.ok_or(ServoidStatus::Running)?;
            memory.found = match outcome.stop {
                Stop::Converged => Found::Motor(ServoidOutcome::of(&memory.fit, &outcome)),
                Stop::NoModel => Found::NoModel,
            };
        }
        memory.found().map(|_| ())
    }))
}

/// What a fit found that is over.
///
/// # Safety
/// The addresses are null or of what they are declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_fit_outcome(
    fit: *mut ServoidFit,
    outcome: *mut ServoidOutcome,
) -> ServoidStatus {
    // SAFETY: the caller answers for both.
    let (memory, to) = unsafe { (begun(fit), outcome.as_mut()) };
    told(memory.and_then(|memory| {
        let to = to.ok_or(ServoidStatus::Null)?;
        *to = *memory.found()?;
        Ok(())
    }))
}
