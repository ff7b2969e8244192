//! What a fitted motor predicts of a recording that it has not seen, and what it is good for.

use crate::fit::{Memory, ServoidFit, begun};
use crate::status::{ServoidStatus, told};
use shared::fit::{Grade, Reason};

/// What a motor is good for, best last.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoidGrade {
    /// For nothing that its numbers are needed for.
    No = 0,
    /// For gains.
    Control = 1,
    /// For all: what it leaves is the encoder's.
    Floor = 2,
}

/// Why a grade is no better.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoidReason {
    /// There is no better.
    None = 0,
    /// What is left is more than the encoder's.
    Left = 1,
    /// The recording does not determine gain or time constant well enough.
    Undetermined = 2,
    /// What was predicted has another gain or time constant.
    Disagrees = 3,
    /// It predicts hardly better than one who takes it that the speed stays.
    Predicts = 4,
}

/// A verdict.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ServoidVerdict {
    /// What the motor is good for.
    pub grade: ServoidGrade,
    /// Why it is for no more.
    pub reason: ServoidReason,
    /// Part by which the gain may be off, with a probability of 95 %.
    pub gain: f32,
    /// The same of the time constant.
    pub time_constant: f32,
    /// The same of gain over time constant, from which a servo is made.
    pub acceleration: f32,
    /// Mean squared error of the prediction, counts squared.
    pub mean_square: f32,
}

/// The memory, if a prediction has begun in it.
///
/// # Safety
/// As of [`begun`].
unsafe fn predicting<'a>(fit: *mut ServoidFit) -> Result<&'a mut Memory, ServoidStatus> {
    // SAFETY: the caller answers for it.
    let memory = unsafe { begun(fit) }?;
    memory
        .predicts
        .then_some(memory)
        .ok_or(ServoidStatus::TooEarly)
}

/// Gets the fitted motor ready to predict about so many periods from standstill, none of the `fitted` ones, judged over windows of so many
/// periods: as many as 50 ms have.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_predict_begin(
    fit: *mut ServoidFit,
    fitted: u32,
    periods: u32,
    window: u32,
) -> ServoidStatus {
    // SAFETY: the caller answers for it.
    let memory = unsafe { begun(fit) };
    told(memory.and_then(|memory| {
        memory.found()?;
        memory.predicts = memory.fit.predict(fitted as usize, periods, window);
        memory.predicts.then_some(()).ok_or(ServoidStatus::NoModel)
    }))
}

/// One period of what the motor predicts: the duty acted, and the reading is so many counts further. It takes no time: `servoid_predict_catch_up`
/// does the work.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_predict_observe(
    fit: *mut ServoidFit,
    duty: i16,
    step: i16,
) -> ServoidStatus {
    // SAFETY: the caller answers for it.
    let memory = unsafe { predicting(fit) };
    told(memory.map(|memory| memory.fit.observe(duty, step)))
}

/// Runs models along at most about so many of the periods that were observed; call it in every period, and after the last one until it is
/// done. At most 256 periods may wait: what comes later is not predicted.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_predict_catch_up(
    fit: *mut ServoidFit,
    samples: u32,
) -> ServoidStatus {
    // SAFETY: the caller answers for it.
    let memory = unsafe { predicting(fit) };
    told(memory.and_then(|memory| {
        let done = memory.fit.catch_up(samples);
        done.then_some(()).ok_or(ServoidStatus::Running)
    }))
}

/// What the motor is good for, by what it predicted; errors within so many counts RMS are the encoder's (0.5 for one that floors).
///
/// # Safety
/// The addresses are null or of what they are declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_verdict(
    fit: *mut ServoidFit,
    within: f32,
    verdict: *mut ServoidVerdict,
) -> ServoidStatus {
    // SAFETY: the caller answers for both.
    let (memory, to) = unsafe { (begun(fit), verdict.as_mut()) };
    told(memory.and_then(|memory| {
        let to = to.ok_or(ServoidStatus::Null)?;
        let predicted = memory.predicts.then(|| memory.fit.predicted()).flatten();
        let predicted = predicted.ok_or(ServoidStatus::TooEarly)?;
        let found = memory.fit.verdict(&predicted, within);
        *to = ServoidVerdict {
            grade: match found.grade {
                Grade::No => ServoidGrade::No,
                Grade::Control => ServoidGrade::Control,
                Grade::Floor => ServoidGrade::Floor,
            },
            reason: match found.reason {
                Reason::None => ServoidReason::None,
                Reason::Left => ServoidReason::Left,
                Reason::Undetermined => ServoidReason::Undetermined,
                Reason::Disagrees => ServoidReason::Disagrees,
                Reason::Predicts => ServoidReason::Predicts,
            },
            gain: found.gain,
            time_constant: found.time_constant,
            acceleration: found.acceleration,
            mean_square: predicted.mean_square,
        };
        Ok(())
    }))
}
