//! Reference results that the PC and a microcontroller must compute bit for bit, as lines of text.
//!
//! Every effect of the catalogue runs in f32 and in fixed point, as do laws that a user stated, with every operation between them; both
//! searches fit a recording in both. Whoever runs it prints the same lines, or the host cannot repeat what a device found.

use core::fmt::{self, Write};
use shared::cost::{Cost, evaluate};
use shared::effects::formula::Formula;
use shared::effects::{EffectSet, Kind, MAX_PARAMETERS};
use shared::fit::{Arithmetic, Fit, Method, Settings};
use shared::model::{Model, Plan, State};
use shared::motor::Machine;
use shared::recording::Recording;
use shared::rng;
use shared::scalar::{ErrorValue, Fixed, Readable};
use shared::trace::Trace;
use shared::units::PerUnit;

#[path = "proof_laws.rs"]
mod laws;

/// Laws that use every operation between them.
const STATED: &[&Formula] = &[
    &laws::AGEING,
    &laws::CONTACT,
    &laws::CRANK,
    &laws::DRAG,
    &laws::FALLING,
    &laws::GEAR,
    &laws::MASS,
    &laws::STEPS,
    &laws::TEETH,
    &laws::WEAK,
];

/// Samples that each effect runs for.
const SAMPLES: usize = 200;
/// Periods that are fitted.
const PERIODS: usize = 300;
/// Models of a search.
const EVALUATIONS: u16 = 300;

/// V.
const SUPPLY: f64 = 24.0;
/// rad/s.
const SPEED: f64 = 512.0;

/// FNV-1a, 64 bits: any bit that differs changes all.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bits: u64) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Writes all lines.
///
/// # Errors
/// Errors of the writer.
pub fn prove(out: &mut impl Write) -> fmt::Result {
    let stated = STATED.iter().map(|law| Some(Kind::Formula(law)));
    for kind in [None]
        .into_iter()
        .chain(Kind::ALL.iter().copied().map(Some))
        .chain(stated)
    {
        let name = kind.map_or("linear", Kind::name);
        line::<f32>(out, "f32", name, kind)?;
        line::<Fixed>(out, "fixed", name, kind)?;
    }
    for method in [Method::Pso, Method::Firefly] {
        fitted::<f32>(out, "f32", method, 0)?;
        fitted::<Fixed>(out, "fixed", method, 0)?;
    }
    fitted::<f32>(out, "f32", Method::Firefly, 20)?;
    fitted::<Fixed>(out, "fixed", Method::Firefly, 20)?;
    Ok(())
}

/// Steps and cost of the motor with one effect at its typical size.
#[inline(never)]
fn line<S: Arithmetic>(
    out: &mut impl Write,
    format: &str,
    name: &str,
    kind: Option<Kind>,
) -> fmt::Result {
    let Some(model) = model::<S>(kind) else {
        return writeln!(out, "{format} {name} does not fit the format");
    };
    let mut state = State::default();
    let mut steps = Hash::new();
    let mut commands = [S::zero(); SAMPLES];
    let mut counts = [0; SAMPLES];
    let mut rng = rng::seeded(3);
    let mut level = S::zero();
    for k in 0..SAMPLES {
        if k % 25 == 0 {
            level = S::from_q15((rng::below(&mut rng, 60_000) as i32 - 30_000) as i16);
        }
        commands[k] = level;
        let reading = model.reading(&state);
        counts[k] = reading.floor() + k as i32 % 3 - 1;
        steps.add(reading.minus(0).to_f64().to_bits());
        model.step(&mut state, level, k % 60 > 50);
    }
    let recording = Recording {
        command: &commands,
        counts: &counts,
        open: None,
        temperature: None,
    };
    let sum = evaluate(&model, State::default(), &recording, Cost::Squared, None);
    let cost = sum.value.to_f64().to_bits();
    writeln!(
        out,
        "{format} {name} steps {:016x} cost {cost:016x}",
        steps.0
    )
}

#[inline(never)]
fn model<S: Arithmetic>(kind: Option<Kind>) -> Option<Model<S>> {
    let machine = Machine {
        kb: 0.05f32,
        damping: 0.001,
        inertia: 0.002,
        electrical: 0.5e-3,
    };
    let units = PerUnit::new(SUPPLY as f32, SPEED as f32, 1e-3, 2000.0).ok()?;
    let mut effects = EffectSet::default();
    if let Some(kind) = kind {
        let mut values = [0.0f32; MAX_PARAMETERS];
        for (value, parameter) in values.iter_mut().zip(kind.parameters()) {
            *value = parameter.scaled(parameter.typical, SUPPLY, SPEED) as f32;
        }
        effects.push(kind, &values).ok()?;
    }
    let plan = Plan {
        effects,
        substeps: 2,
        ..Plan::linear(machine, units)
    };
    Model::new(&plan).ok()
}

/// A whole fit.
#[inline(never)]
fn fitted<S: Arithmetic>(
    out: &mut impl Write,
    format: &str,
    method: Method,
    carriers: u16,
) -> fmt::Result {
    let (mut duties, mut steps) = ([0; PERIODS], [0; PERIODS]);
    let mut rng = rng::seeded(5);
    let (mut duty, mut speed) = (0i16, 0i32);
    for k in 0..PERIODS {
        if k % 30 == 0 {
            duty = (rng::below(&mut rng, 60_000) as i32 - 30_000) as i16;
        }
        // A motor in whole numbers: no model's arithmetic has a part in it.
        speed += (i32::from(duty) * 4 - speed * 1000) / 20_000;
        duties[k] = duty;
        steps[k] = speed as i16;
    }
    let trace = Trace::new(&duties, &steps);
    let settings = Settings {
        method,
        evaluations: EVALUATIONS,
        carriers,
        dead_time: 400,
        supply: carriers > 0,
        full: 16_800,
        ..Settings::USUAL
    };
    let name = match (method, carriers) {
        (Method::Pso, _) => "pso",
        (Method::Firefly, 0) => "firefly",
        (Method::Firefly, _) => "firefly behind a bridge",
    };
    let mut fit = Fit::<S>::idle();
    if !fit.begin(&trace, settings) {
        return writeln!(out, "{format} {name} has nothing to fit");
    }
    let outcome = loop {
        if let Some(outcome) = fit.work(&trace, 1000) {
            break outcome;
        }
    };
    let mut hash = Hash::new();
    for estimate in &outcome.estimates {
        hash.add(estimate.value.to_bits().into());
        hash.add(estimate.std.to_bits().into());
    }
    hash.add(outcome.mean_square.to_bits().into());
    hash.add(outcome.evaluations.into());
    writeln!(
        out,
        "{format} {name} fit {:016x} after {} models",
        hash.0, outcome.evaluations
    )
}
