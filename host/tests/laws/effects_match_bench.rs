//! The model against the virtual bench: with the true parameters, every effect of the catalogue on
//! every machine leaves nothing but the encoder's rounding.
//!
//! The two share no code. The bench integrates plain SI equations finely; the model takes a few
//! exact maps a sample. Where both agree over twenty seconds to a fraction of a count, two
//! derivations agree. The one thing between them is `Hidden::truth`: the SI parameters of the bench, stated by the
//! bench itself in the volts-referred terms of the model.

use servoid_identify::truth;
use servoid_io::excitation;
use servoid_plant::{Bench, Hidden, Machine, PRESETS, Run};
use shared::cost::Cost;
use shared::effects::{EffectSet, Kind};
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::excite::{COMMISSIONING, Experiment};
use shared::model::{Plan, State};
use shared::units::PerUnit;
use std::f64::consts::TAU;
use std::ops::Range;
use testing::length::has_its_turn;
use testing::motion;

const COUNTS_PER_REV: u32 = 2000;
const INTERVAL_S: f64 = 1e-3;
const START_RAD: f64 = 0.3;
const SEED: u64 = 1;

fn record(machine: Machine, effects: Vec<Hidden>, plan: &[Experiment]) -> Run {
    let drive = excitation::drive(plan, INTERVAL_S, SEED, machine.supply_v);
    let bench = Bench {
        effects,
        counts_per_rev: COUNTS_PER_REV,
        sample_s: INTERVAL_S,
        seed: SEED,
        start_angle_rad: Some(START_RAD),
        ..Bench::new(machine)
    };
    bench.run(&drive).expect("the bench runs")
}

/// Effects of the bench in the terms of the model.
fn truths(machine: &Machine, effects: &[Hidden]) -> EffectSet<f64> {
    let mut set = EffectSet::default();
    for hidden in effects {
        let kind = Kind::by_name(hidden.name()).expect("the catalogues agree");
        let values = hidden.truth(machine, COUNTS_PER_REV);
        set.push(kind, &values).expect("a valid effect");
    }
    set
}

/// RMS error of the model in counts, with the true parameters and the mean error removed.
fn rms(machine: &Machine, effects: &[Hidden], run: &Run, substeps: u16) -> f64 {
    rms_of(machine, truths(machine, effects), run, substeps)
}

fn rms_of(machine: &Machine, set: EffectSet<f64>, run: &Run, substeps: u16) -> f64 {
    let units = PerUnit::new(
        machine.supply_v,
        1.3 * machine.top_speed_rad_s(),
        INTERVAL_S,
        f64::from(COUNTS_PER_REV),
    )
    .expect("valid bases");
    let plan = Plan {
        effects: set,
        substeps,
        ..Plan::linear(truth::physical(machine).machine(), units)
    };
    let start = State::at(START_RAD * f64::from(COUNTS_PER_REV) / TAU, 0.0);
    let commands = run.voltage_v.iter().zip(&run.enabled);
    let commands: Vec<(f64, bool)> = commands
        .map(|(volts, enabled)| (volts / machine.supply_v, !enabled))
        .collect();
    let motion = motion::exact(&plan, start, &commands).expect("a valid model");
    let pairs = motion.readings.iter().zip(&run.counts);
    let errors: Vec<f64> = pairs
        .map(|(reading, &counts)| reading - counts as f64 - FLOOR_OFFSET_COUNTS)
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let squares = errors.iter().map(|e| (e - mean).powi(2)).sum();
    Cost::rms(squares, errors.len())
}

/// Limits on the error that the true parameters leave, counts RMS: the encoder's floor is 0.2887. Below
/// it by much would be as wrong as above.
const LIMITS: Range<f64> = 0.24..0.32;
/// Substeps at which every effect is within them.
const FINE: u16 = 8;

/// Substeps of a quick search, and the limits there.
const COARSE: u16 = 2;
const COARSE_LIMITS: Range<f64> = 0.24..0.36;
/// Bristles that bend within hundredths of a sample want more substeps on a quick motor.
const COARSE_BRISTLE_LIMITS: Range<f64> = 0.24..0.6;

/// What a law that is a mean may leave, as a part of what the effect itself does. Where the electrical time constant is as short as the
/// carrier's period (`coreless_24v`), it leaves 3 %.
const MOST_LEFT_OF_A_MEAN: f64 = 0.05;

#[test]
fn true_parameters_leave_the_encoders_own_error_for_every_effect_on_every_machine() {
    for (m, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).expect("a preset");
        let told = Kind::ALL.iter().filter(|kind| !kind.facts().by_chance);
        for (k, kind) in told.enumerate() {
            if !has_its_turn(m + k, PRESETS.len()) {
                continue;
            }
            let hidden = vec![Hidden::typical(kind.name(), &machine).expect("in the catalogue")];
            let run = record(machine, hidden.clone(), &COMMISSIONING);
            if *kind == Kind::DeadTime {
                // Its law is the mean of a carrier wave that the bench switches edge by edge.
                let left = rms(&machine, &hidden, &run, FINE);
                let without = rms(&machine, &[], &run, FINE);
                println!("{name} with dead_time: {left:.4} of {without:.1} counts RMS");
                assert!(
                    left < MOST_LEFT_OF_A_MEAN * without,
                    "{name}: {left} of {without} counts RMS"
                );
                continue;
            }
            let coarse_limits = match kind {
                Kind::Lugre => COARSE_BRISTLE_LIMITS,
                _ => COARSE_LIMITS,
            };
            for (substeps, limits) in [(COARSE, coarse_limits), (FINE, LIMITS)] {
                let error = rms(&machine, &hidden, &run, substeps);
                let case = format!("{name} with {} at {substeps} substeps", kind.name());
                println!("{case}: {error:.4} counts RMS");
                assert!(limits.contains(&error), "{case}: {error} counts RMS");
            }
        }
    }
}

/// Shapes of the Stribeck hump, from Tustin's exponential to the Gaussian.
const EXPONENTS: [f64; 5] = [1.0, 1.2, 1.5, 1.8, 2.0];

#[test]
fn every_shape_of_the_stribeck_hump_leaves_the_encoders_own_error_on_every_machine() {
    for (m, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).expect("a preset");
        for (k, exponent) in EXPONENTS.into_iter().enumerate() {
            if !has_its_turn(m + k, PRESETS.len()) {
                continue;
            }
            let mut hidden = Hidden::typical("stribeck", &machine).expect("in the catalogue");
            hidden.set("exponent", exponent).expect("in its range");
            let hidden = vec![hidden];
            let run = record(machine, hidden.clone(), &COMMISSIONING);
            for (substeps, limits) in [(COARSE, COARSE_LIMITS), (FINE, LIMITS)] {
                let error = rms(&machine, &hidden, &run, substeps);
                let case = format!("{name} with exponent {exponent} at {substeps} substeps");
                println!("{case}: {error:.4} counts RMS");
                assert!(limits.contains(&error), "{case}: {error} counts RMS");
            }
        }
    }
}

#[test]
fn every_other_form_leaves_the_encoders_own_error_on_every_machine() {
    for (m, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).expect("a preset");
        for (k, kind) in Kind::ALL.iter().enumerate() {
            let typical = Hidden::typical(kind.name(), &machine).expect("in the catalogue");
            for (l, law) in typical.other_forms().enumerate() {
                if !has_its_turn(m + k + l, PRESETS.len()) {
                    continue;
                }
                let hidden = vec![typical.clone().by_law(law).expect("its own law")];
                let run = record(machine, hidden.clone(), &COMMISSIONING);
                // Damping that falls with the speed changes within the hundredth of a sample in which bristles bend.
                let substeps = if *kind == Kind::Lugre { 4 * FINE } else { FINE };
                let error = rms(&machine, &hidden, &run, substeps);
                let case = format!(
                    "{name} with {} as {law} at {substeps} substeps",
                    kind.name()
                );
                println!("{case}: {error:.4} counts RMS");
                assert!(LIMITS.contains(&error), "{case}: {error} counts RMS");
            }
        }
    }
}

/// Parts of the dry friction that the load has.
const SHARES: [f64; 3] = [0.3, 0.7, 1.0];

#[test]
fn friction_on_both_sides_of_a_gap_or_a_spring_leaves_the_encoders_own_error() {
    for (m, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).expect("a preset");
        for (k, kind) in [Kind::Backlash, Kind::Compliance].into_iter().enumerate() {
            for (l, share) in SHARES.into_iter().enumerate() {
                if !has_its_turn(m + k + l, PRESETS.len()) {
                    continue;
                }
                let torque = 0.03 * machine.stall_torque_n_m();
                let mut coupling = Hidden::typical(kind.name(), &machine).expect("a coupling");
                coupling
                    .set("friction", share * torque)
                    .expect("in its range");
                let mut own = Hidden::typical("coulomb", &machine).expect("friction");
                own.set("torque", (1.0 - share) * torque)
                    .expect("in its range");
                let run = record(machine, vec![own.clone(), coupling.clone()], &COMMISSIONING);
                own.set("torque", torque).expect("in its range");
                let mut set = truths(&machine, &[own]);
                let mut values = coupling.truth(&machine, COUNTS_PER_REV);
                *values.last_mut().expect("the share") = share;
                set.push(kind, &values).expect("a valid effect");
                for (substeps, limits) in [(COARSE, COARSE_LIMITS), (FINE, LIMITS)] {
                    let error = rms_of(&machine, set, &run, substeps);
                    let case = format!(
                        "{name} with {share} of the friction behind {} at {substeps} substeps",
                        kind.name()
                    );
                    println!("{case}: {error:.4} counts RMS");
                    assert!(limits.contains(&error), "{case}: {error} counts RMS");
                }
            }
        }
    }
}
