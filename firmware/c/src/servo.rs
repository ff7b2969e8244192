//! A servo out of a fitted motor.

use crate::fit::{ServoidFit, begun};
use crate::status::{ServoidStatus, told};
use shared::servo::{Gains, Servo, Target};

/// Memory for a servo. What is in it is not for the caller, but for the gains.
#[repr(C)]
pub struct ServoidServo {
    /// Speed asked for by a count off, a period.
    pub position: f32,
    /// Part of the supply asked for by a count a period too slow.
    pub speed: f32,
    /// Part of the supply that a speed of a count a period takes.
    pub back_emf: f32,
    /// Part of the supply that friction takes.
    pub friction: f32,
    memory: [u64; 16],
}

/// What the memory holds, once a servo has begun.
struct Begun {
    mark: u32,
    gains: Gains,
    servo: Servo,
}

const MARK: u32 = 0x5e70_5e70;
const _: () = assert!(size_of::<Begun>() <= size_of::<[u64; 16]>());
const _: () = assert!(align_of::<Begun>() <= align_of::<u64>());

/// What the memory holds, if a servo has begun in it.
///
/// # Safety
/// `servo` is null or a `ServoidServo` that nothing else uses meanwhile; the caller keeps it all zeros before its first use.
unsafe fn servo_of<'a>(servo: *mut ServoidServo) -> Option<&'a mut Begun> {
    if servo.is_null() {
        return None;
    }
    // SAFETY: it is as large and as well aligned as `Begun` (asserted above), and has the mark only if it holds one.
    unsafe {
        let memory = (&raw mut (*servo).memory).cast::<Begun>();
        ((&raw const (*memory).mark).read() == MARK).then(|| &mut *memory)
    }
}

/// Begins a servo of the fitted motor where its shaft rests, whose gain over time constant may be off by the part `off` (of its verdict), with
/// duties up to `limit`, a part of the supply from 0 to 1. The memory must be all zeros before its first use, as a static is.
///
/// # Safety
/// The addresses are null or of what they are declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_servo_begin(
    servo: *mut ServoidServo,
    fit: *mut ServoidFit,
    off: f32,
    limit: f32,
) -> ServoidStatus {
    if servo.is_null() {
        return ServoidStatus::Null;
    }
    // SAFETY: the caller answers for it.
    let memory = unsafe { begun(fit) };
    told(memory.and_then(|memory| {
        memory.found()?;
        let gains = memory.fit.gains(off);
        let numbers = [gains.position, gains.speed, gains.back_emf, gains.friction];
        let more = [off, gains.decay, gains.time_constant];
        let mut all = numbers.iter().chain(&more).chain(&gains.observer);
        if !(0.0..=1.0).contains(&limit) || off < 0.0 || !all.all(|number| number.is_finite()) {
            return Err(ServoidStatus::OutOfRange);
        }
        let mut began = Begun {
            mark: MARK,
            gains,
            servo: Servo::IDLE,
        };
        began.servo.begin(gains, limit);
        // SAFETY: it is not null, and there is room for it, as asserted above; nothing in it has to be dropped.
        unsafe {
            (&raw mut (*servo).position).write(gains.position);
            (&raw mut (*servo).speed).write(gains.speed);
            (&raw mut (*servo).back_emf).write(gains.back_emf);
            (&raw mut (*servo).friction).write(gains.friction);
            (&raw mut (*servo).memory).cast::<Begun>().write(began);
        }
        Ok(())
    }))
}

/// The count went on by `step` in the period that has ended, and the duty that was given last acts now. Gives the duty of the period after
/// this one, a part of the supply, on the way to `target`, counts from where the servo began; 0 before it has begun.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_servo_next(
    servo: *mut ServoidServo,
    step: i32,
    target: i32,
) -> f32 {
    // SAFETY: the caller answers for it.
    unsafe { servo_of(servo) }.map_or(0.0, |began| {
        began.servo.next(step, Target::Position(target))
    })
}

/// The same on the way to a speed, counts a period; 0 before it has begun, or if the speed is not finite.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_servo_turn(
    servo: *mut ServoidServo,
    step: i32,
    speed: f32,
) -> f32 {
    // SAFETY: the caller answers for it.
    match unsafe { servo_of(servo) } {
        Some(began) if speed.is_finite() => began.servo.next(step, Target::Speed(speed)),
        _ => 0.0,
    }
}

/// The next duty will be another than was given, as behind a limit of the current.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_servo_acts(servo: *mut ServoidServo, duty: f32) {
    // SAFETY: the caller answers for it.
    if let Some(began) = unsafe { servo_of(servo) } {
        began.servo.acts(duty);
    }
}

/// Periods in which a step is over; 0 before the servo has begun.
///
/// # Safety
/// The address is null or of what it is declared as.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn servoid_servo_settling(servo: *mut ServoidServo) -> f32 {
    // SAFETY: the caller answers for it.
    unsafe { servo_of(servo) }.map_or(0.0, |began| began.gains.settling())
}
