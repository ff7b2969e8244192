//! Instruction counts of the device's arithmetic: per sample, and of a whole commissioning search.
//!
//! Counted, not timed: an emulator that gives each instruction the same length of virtual time makes a timer an exact and
//! repeatable counter. Wait states of the flash and latencies of the floating-point unit come on top on a real chip.

use core::fmt::{self, Write};

use crate::app::{Script, Which};
use crate::plant::{Motor, SMALL};
use shared::fit::{Arithmetic, Evaluation, Fit, Method, Settings};
use shared::model::{Rigid, RigidPlan};
use shared::motor::Machine;
use shared::trace::Trace;
use shared::units::PerUnit;

/// Periods of the recording.
const PERIODS: usize = 1000;
/// Samples in a slice of a search.
const SLICE: u32 = 20_000;
/// Twenty particles, two hundred iterations.
const EVALUATIONS: u16 = 4000;

/// Writes a line for each quantity; `count` says how many instructions what it is given takes.
///
/// # Errors
/// Errors of the writer.
pub fn count<S: Arithmetic>(
    out: &mut impl Write,
    mut count: impl FnMut(&mut dyn FnMut()) -> u32,
    searches: bool,
) -> fmt::Result {
    for (name, coulomb) in [("linear", 0.0), ("coulomb", 0.0149)] {
        let (duties, steps) = recording(coulomb > 0.0);
        let trace = Trace::new(&duties, &steps);
        let evaluation = motor::<S>(coulomb).and_then(Evaluation::new);
        let Some(mut evaluation) = evaluation else {
            return writeln!(out, "the motor does not fit the format");
        };
        let instructions = count(&mut || {
            evaluation.run(&trace, PERIODS as u32);
        });
        writeln!(out, "sample {name} {}", per_sample(instructions))?;
    }
    for (name, coulomb) in [("linear", 0.0), ("coulomb", 0.0149)] {
        let mut model = Rigid::of(S::zero(), S::Coefficient::default());
        let plan = plan(coulomb);
        let mut built = false;
        let instructions = count(&mut || built = S::set(&mut model, &plan));
        writeln!(out, "build {name} {instructions}")?;
    }
    for (name, coulomb) in [("linear", false), ("coulomb", true)] {
        let (duties, steps) = recording(coulomb);
        let trace = Trace::new(&duties, &steps);
        for (method, called) in [(Method::Pso, "pso"), (Method::Firefly, "firefly")] {
            if !searches {
                continue;
            }
            let settings = Settings {
                method,
                evaluations: EVALUATIONS,
                coulomb,
                ..Settings::USUAL
            };
            let instructions = search::<S>(&trace, settings, &mut count);
            writeln!(out, "search-{called} {name} {instructions}")?;
        }
    }
    Ok(())
}

/// To a tenth.
fn per_sample(instructions: u32) -> f32 {
    let tenths = (instructions * 10 + PERIODS as u32 / 2) / PERIODS as u32;
    tenths as f32 / 10.0
}

/// A whole fit; its size is kept off the caller's stack.
#[inline(never)]
fn search<S: Arithmetic>(
    trace: &Trace<'_>,
    settings: Settings,
    count: &mut impl FnMut(&mut dyn FnMut()) -> u32,
) -> u64 {
    let mut fit = Fit::<S>::idle();
    let (mut instructions, mut done) = (0, !fit.begin(trace, settings));
    while !done {
        // As on a board, in slices: one fits into the counter.
        let mut slice = || done = fit.work(trace, SLICE).is_some();
        instructions += u64::from(count(&mut slice));
    }
    instructions
}

/// A commissioning recording of a small motor, with or without dry friction.
#[inline(never)]
fn recording(coulomb: bool) -> ([i16; PERIODS], [i16; PERIODS]) {
    let (mut duties, mut steps) = ([0; PERIODS], [0; PERIODS]);
    let mut script = Script::excitation(Which::Record, PERIODS as u32, 30_000, 3);
    let mut motor = Motor { ..SMALL };
    if !coulomb {
        motor.coulomb = 0.0;
    }
    for (slot, step) in duties.iter_mut().zip(&mut steps) {
        let duty = script.next(&[]).unwrap_or(0);
        let before = motor.state.count;
        motor.advance(Some(duty), 1e-3);
        (*slot, *step) = (duty, motor.state.count.wrapping_sub(before) as i16);
    }
    (duties, steps)
}

fn motor<S: Arithmetic>(coulomb: f32) -> Option<Rigid<S>> {
    Rigid::new(&plan(coulomb)).ok()
}

fn plan(coulomb: f32) -> RigidPlan<f32> {
    // Counts, periods and the supply are the units, as in the fit.
    let (gain, mechanical) = (144.7, 16.0);
    RigidPlan {
        machine: Machine {
            kb: 1.0 / gain,
            damping: 0.0,
            inertia: mechanical / gain,
            electrical: 0.48,
        },
        coulomb,
        load: 0.0,
        dead_time: 0.0,
        carriers: 0.0,
        supply: 0.0,
        full: 1.0,
        units: PerUnit {
            volts: 1.0,
            speed: 256.0,
            interval: 1.0,
            counts_per_rev: core::f32::consts::TAU,
        },
    }
}
