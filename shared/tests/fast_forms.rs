//! The law of `model/fast`: each fast form gives what [`Model::step`] gives, bit for bit, with every effect, for random motors
//! under random drives, in every number format that the form supports. A failure prints the case, which is the seed.

use shared::discretise::Discretisation;
use shared::effects::{EffectSet, Kind};
use shared::model::{Increments, Model, Motion, Plan, Rigid, RigidPlan, State};
use shared::motor::Machine;
use shared::rng::{self, Generator};
use shared::scalar::Fixed;
use shared::units::PerUnit;
use testing::motion::Steps;

/// Seed of the first case; the others count on from here.
const SEED: u64 = 20_261_122;

/// Random motors of each combination of effects.
const MOTORS: u64 = 4;

const SAMPLES: usize = 1_500;

/// Bits of a number or a motion, as text: a float's shortest text is another for each of its values, and shows the zero's sign.
fn bits(x: impl std::fmt::Debug) -> String {
    format!("{x:?}")
}

/// A number between two positive ones, evenly spread over its logarithm.
fn between(rng: &mut Generator, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng::uniform::<f64>(rng))
}

/// A linear motor of 5 to 50 V, 50 to 1500 rad/s and 2 to 200 intervals.
fn motor(rng: &mut Generator) -> Plan<f64> {
    let supply = between(rng, 5.0, 50.0);
    let no_load = between(rng, 50.0, 1500.0);
    let interval = between(rng, 2e-4, 5e-3);
    let units = PerUnit::new(
        supply,
        1.3 * no_load,
        interval,
        between(rng, 100.0, 20_000.0).round(),
    );
    let units = units.expect("positive bases");
    let total = supply / no_load;
    let damping = total * 0.2 * rng::uniform::<f64>(rng);
    let machine = Machine {
        kb: total - damping,
        damping,
        inertia: total * interval * between(rng, 2.0, 200.0),
        // Euler's step is stable down to half an interval.
        electrical: interval * between(rng, 0.6, 3.0),
    };
    Plan {
        substeps: 1 + rng::below(rng, 2) as u16,
        ..Plan::linear(machine, units)
    }
}

/// The typical effects of a motor, each parameter between a third and three times its typical value, within its range;
/// any form.
fn with_effects(plan: Plan<f64>, kinds: &[Kind], rng: &mut Generator) -> Plan<f64> {
    let supply = plan.units.volts;
    let no_load = supply * plan.machine.response().gain;
    let mut effects = EffectSet::default();
    for &kind in kinds {
        let parameters = kind.parameters().iter();
        let values: Vec<f64> = parameters
            .map(|p| {
                if p.form.is_some() {
                    return p.range.0 + (p.range.1 - p.range.0) * rng::uniform::<f64>(rng);
                }
                let value = p.typical * between(rng, 1.0 / 3.0, 3.0);
                p.scaled(value.clamp(p.range.0, p.range.1), supply, no_load)
            })
            .collect();
        effects.push(kind, &values).expect("a valid effect");
    }
    Plan { effects, ..plan }
}

/// Held commands, small ones too at which the shaft rests, with stretches of an open bridge.
fn drive(rng: &mut Generator) -> Vec<(f64, bool)> {
    let mut held = (0.0, false);
    (0..SAMPLES)
        .map(|k| {
            if k % 23 == 0 {
                let size = rng::uniform::<f64>(rng);
                let sign = 2.0 * rng::uniform::<f64>(rng) - 1.0;
                held = (size * size * sign, rng::below(rng, 9) == 0);
            }
            held
        })
        .collect()
}

/// Runs a model by the plain step, and by the fast form wherever there is one; returns how many steps that took.
fn constant_force_is_the_step<S: Steps>(
    plan: &Plan<f64>,
    drive: &[(f64, bool)],
    case: &str,
) -> usize {
    // A plan whose coefficients do not fit the format is no model in it.
    let Ok(model) = Model::<S>::new(plan) else {
        return 0;
    };
    let (mut plain, mut state) = (State::<S>::default(), State::<S>::default());
    let mut fast_steps = 0;
    for (k, &(command, open)) in drive.iter().enumerate() {
        let command = S::from_f64(command);
        S::step(&model, &mut plain, command, open);
        let fast = model.constant_force(&state).filter(|_| !open);
        let next = fast.and_then(|mut fast| {
            fast.set_command(command);
            let motion = fast.step(&state.motion)?;
            Some((fast, motion))
        });
        match next {
            Some((fast, motion)) => {
                fast.store(&mut state, motion);
                fast_steps += 1;
            }
            None => S::step(&model, &mut state, command, open),
        }
        assert_eq!(bits(plain.motion), bits(state.motion), "step {k} of {case}");
    }
    fast_steps
}

#[test]
fn constant_force_is_the_step_with_every_effect() {
    println!("cases from seed {SEED}");
    let pair = [Kind::Coulomb, Kind::LoadTorque];
    let single = Kind::ALL.iter().map(std::slice::from_ref);
    let sets = [&[][..], &pair[..]].into_iter().chain(single);
    let cases = sets.flat_map(|kinds| (0..MOTORS).map(move |_| kinds));
    let mut accepted: Vec<&[Kind]> = Vec::new();
    for (seed, kinds) in (SEED..).zip(cases) {
        let mut rng = rng::seeded(seed);
        let linear = motor(&mut rng);
        let plan = with_effects(linear, kinds, &mut rng);
        let drive = drive(&mut rng);
        for discretisation in [Discretisation::Exact, Discretisation::Euler] {
            let plan = Plan {
                discretisation,
                ..plan
            };
            let case = format!("case {seed}, {kinds:?}, {discretisation:?}");
            let steps = constant_force_is_the_step::<f64>(&plan, &drive, &format!("f64, {case}"));
            constant_force_is_the_step::<f32>(&plan, &drive, &format!("f32, {case}"));
            constant_force_is_the_step::<Fixed>(&plan, &drive, &format!("fixed, {case}"));
            if steps > SAMPLES / 2 {
                accepted.push(kinds);
            }
        }
    }
    // The form exists for these, and takes most of their steps.
    for kinds in [&[][..], &[Kind::Coulomb], &[Kind::LoadTorque], &pair] {
        let cases = accepted.iter().filter(|&&set| set == kinds).count();
        assert!(cases as u64 > MOTORS, "{kinds:?}: {cases} fast cases");
    }
}

/// The rigid motor knows Coulomb friction and a load. It has the step's maps, and its own event location.
fn rigid_is_the_step<S: Steps<Mask = bool>>(
    plan: &RigidPlan<f64>,
    drive: &[(f64, bool)],
    case: &str,
) {
    let mut effects = EffectSet::default();
    effects.push(Kind::Coulomb, &[plan.coulomb]).expect("valid");
    effects.push(Kind::LoadTorque, &[plan.load]).expect("valid");
    let model = Model::<S>::new(&Plan {
        effects,
        ..Plan::linear(plan.machine, plan.units)
    });
    let (model, rigid) = (model, Rigid::<S>::new(plan));
    let (Ok(model), Ok(rigid)) = (&model, &rigid) else {
        assert!(model.is_err() && rigid.is_err(), "one refuses {case}");
        return;
    };
    let (mut state, mut motion) = (State::<S>::default(), Motion::<S>::default());
    for (k, &(command, open)) in drive.iter().enumerate() {
        let command = S::from_f64(command);
        S::step(model, &mut state, command, open);
        rigid.step(&mut motion, command, open);
        // The twist and the slip of a load, which it has not, stay at rest.
        let of = |motion: &Motion<S>| bits((motion.current, motion.speed, motion.angle));
        assert_eq!(of(&state.motion), of(&motion), "step {k} of {case}");
    }
}

#[test]
fn a_rigid_motor_is_the_step() {
    println!("cases from seed {SEED}");
    for seed in SEED..SEED + 10 * MOTORS {
        let mut rng = rng::seeded(seed);
        let Plan { machine, units, .. } = motor(&mut rng);
        let of_supply = |rng: &mut Generator, most: f64| {
            let share = most * (2.0 * rng::uniform::<f64>(rng) - 1.0);
            if rng::below(rng, 4) == 0 {
                0.0
            } else {
                units.volts * share
            }
        };
        let plan = RigidPlan {
            machine,
            coulomb: of_supply(&mut rng, 0.1).abs(),
            load: of_supply(&mut rng, 0.1),
            dead_time: 0.0,
            carriers: 0.0,
            supply: 0.0,
            full: 1.0,
            units,
        };
        let drive = drive(&mut rng);
        rigid_is_the_step::<f64>(&plan, &drive, &format!("f64, case {seed}, {plan:?}"));
        rigid_is_the_step::<f32>(&plan, &drive, &format!("f32, case {seed}, {plan:?}"));
        rigid_is_the_step::<Fixed>(&plan, &drive, &format!("fixed, case {seed}, {plan:?}"));
    }
}

/// Increments are f64 and of a motor without effects. Current and speed are the step's to the bit; the angle is in counts
/// already, and so rounded elsewhere.
#[test]
fn increments_are_the_step() {
    println!("cases from seed {SEED}");
    for seed in SEED..SEED + 100 * MOTORS {
        let mut rng = rng::seeded(seed);
        let mut plan = motor(&mut rng);
        let interval = plan.units.interval;
        plan.machine.electrical = match seed % 4 {
            0 => 0.0,
            1 => 0.01 * interval,
            _ => plan.machine.electrical,
        };
        for discretisation in [Discretisation::Exact, Discretisation::Euler] {
            let plan = Plan {
                discretisation,
                ..plan
            };
            let case = format!("case {seed}: {plan:?}");
            let (model, by) = (Model::<f64>::new(&plan), Increments::new(&plan));
            let (Ok(model), Ok(by)) = (&model, &by) else {
                let refused = model.is_err() && by.is_err() && plan.machine.electrical == 0.0;
                assert!(refused, "{case}");
                continue;
            };
            let mut signed = || 2.0 * rng::uniform::<f64>(&mut rng) - 1.0;
            let (current, speed, command) = (signed(), signed(), signed());
            let mut state = State::<f64>::at(0.0, speed);
            state.motion.current = current;
            f64::step(model, &mut state, command, false);
            let sum = |row: [f64; 2], by_command: f64| {
                row[0] * current + row[1] * speed + by_command * command
            };
            let ends = [
                (
                    state.motion.current,
                    current + sum(by.state[0], by.state_by_command[0]),
                ),
                (
                    state.motion.speed,
                    speed + sum(by.state[1], by.state_by_command[1]),
                ),
            ];
            for (model, own) in ends {
                assert_eq!(model.to_bits(), own.to_bits(), "{case}");
            }
            let (model, own) = (state.motion.angle, sum(by.angle, by.angle_by_command));
            let scale = model.abs().max(own.abs()).max(1.0);
            assert!((model - own).abs() < 1e-14 * scale, "{model} {own}: {case}");
        }
    }
}
