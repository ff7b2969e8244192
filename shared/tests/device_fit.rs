//! The fit on the device finds motors: swarm and fireflies, f32 and fixed point, over many seeds.

use shared::effects::{EffectSet, Kind};
use shared::excite::{Experiment, Shape, commands};
use shared::fit::{Arithmetic, Estimate, Evaluation, Fit, Method, Outcome, Settings};
use shared::model::{Model, Motion, Plan, Rigid, RigidPlan, State};
use shared::motor::Machine;
use shared::rng;
use shared::scalar::{Angle, Fixed, Readable, Scalar};
use shared::trace::{DUTY, Trace};
use shared::units::PerUnit;
use testing::motion::Steps;

const PERIODS: usize = 2_000;

/// A motor as its terminals show it, per supply, period and count.
#[derive(Clone, Copy, Debug)]
struct Motor {
    gain: f64,
    mechanical: f64,
    electrical: f64,
    coulomb: f64,
}

/// Motors of a tenth to a hundred counts a period, a few to a few hundred periods slow.
fn motor(seed: u64) -> Motor {
    let mut rng = rng::seeded(seed);
    let mut log =
        |low: f64, high: f64| (low.ln() + rng::uniform::<f64>(&mut rng) * (high / low).ln()).exp();
    Motor {
        gain: log(3.0, 600.0),
        mechanical: log(5.0, 300.0),
        electrical: log(0.1, 3.0),
        coulomb: log(0.005, 0.1),
    }
}

struct Recorded {
    duties: Vec<i16>,
    steps: Vec<i16>,
}

impl Recorded {
    fn of(motor: &Motor) -> Self {
        let plan = [
            Experiment {
                shape: Shape::Telegraph {
                    levels: 9,
                    hold_s: 60.0,
                },
                seconds: 1400.0,
                amplitude: 0.95,
            },
            Experiment {
                shape: Shape::Triangle { waves: 1 },
                seconds: 600.0,
                amplitude: 0.6,
            },
        ];
        let drives = commands::<f64>(&plan, 1.0, 5);
        let duties: Vec<i16> = drives
            .map(|command| (command.drive * 32_767.0) as i16)
            .take(PERIODS)
            .collect();
        let kb = 1.0 / motor.gain;
        let mut effects = EffectSet::default();
        effects.push(Kind::Coulomb, &[motor.coulomb]).unwrap();
        let model = Model::<f64>::new(&Plan {
            effects,
            ..Plan::linear(
                Machine {
                    kb,
                    damping: 0.0,
                    inertia: motor.mechanical * kb,
                    electrical: motor.electrical,
                },
                PerUnit::new(1.0, motor.gain, 1.0, std::f64::consts::TAU).unwrap(),
            )
        })
        .unwrap();
        let mut state = State::at(<f64 as Scalar>::Angle::from_counts(0.37), 0.0);
        let mut before = 0;
        let steps = duties.iter().map(|&duty| {
            f64::step(&model, &mut state, f64::from(duty) * DUTY, false);
            let count = Readable::<f64>::floor(model.reading(&state));
            let step = count - before;
            before = count;
            i16::try_from(step).unwrap()
        });
        let steps = steps.collect();
        Recorded { duties, steps }
    }

    fn trace(&self) -> Trace<'_> {
        Trace::new(&self.duties, &self.steps)
    }
}

fn fit<S: Arithmetic>(recorded: &Recorded, settings: Settings, slice: u32) -> Outcome {
    let mut fit = Fit::<S>::idle();
    assert!(fit.begin(&recorded.trace(), settings), "the shaft moved");
    loop {
        if let Some(outcome) = fit.work(&recorded.trace(), slice) {
            return outcome;
        }
    }
}

fn relative(estimate: Estimate, truth: f64) -> f64 {
    (f64::from(estimate.value) / truth - 1.0).abs()
}

const SEEDS: u64 = 60;

/// Fits drawn motors and returns how many the search missed; the others must be found to a thousandth.
fn missed<S: Arithmetic>(method: Method) -> usize {
    let mut missed = 0;
    let mut errors = Vec::new();
    for seed in 0..SEEDS {
        let motor = motor(seed);
        let recorded = Recorded::of(&motor);
        let settings = Settings {
            method,
            seed,
            ..Settings::default()
        };
        let outcome = fit::<S>(&recorded, settings, 3000);
        if outcome.mean_square.sqrt() > 0.35 {
            println!("seed {seed} missed: {motor:?}, {outcome:?}");
            missed += 1;
            continue;
        }
        for (estimate, truth) in outcome.estimates.iter().zip([motor.gain, motor.mechanical]) {
            errors.push(relative(*estimate, truth));
            let off = f64::from(estimate.value) - truth;
            assert!(
                off.abs() < 5.0 * f64::from(estimate.std),
                "seed {seed}: {off} off at a standard deviation of {}, {motor:?}",
                estimate.std
            );
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |part: f64| errors[(part * (errors.len() - 1) as f64) as usize];
    println!(
        "{method:?}: {missed} of {SEEDS} missed; gain and time constant off by {:.1e} in the median, {:.1e} at 90 %",
        at(0.5),
        at(0.9)
    );
    assert!(at(0.9) < 1e-3);
    missed
}

#[test]
fn fireflies_find_drawn_motors_in_both_formats() {
    assert!(missed::<f32>(Method::Firefly) <= 1);
    assert!(missed::<Fixed>(Method::Firefly) <= 1);
}

#[test]
fn the_swarm_finds_drawn_motors_in_both_formats() {
    assert!(missed::<f32>(Method::Pso) <= 1);
    assert!(missed::<Fixed>(Method::Pso) <= 1);
}

#[test]
fn the_outcome_does_not_depend_on_how_the_work_is_sliced() {
    let recorded = Recorded::of(&motor(3));
    for (method, carriers) in [
        (Method::Pso, 0),
        (Method::Firefly, 0),
        (Method::Firefly, 20),
    ] {
        let settings = Settings {
            method,
            evaluations: 400,
            carriers,
            dead_time: 30 * carriers,
            ..Settings::default()
        };
        let whole = fit::<Fixed>(&recorded, settings, u32::MAX);
        for slice in [1, 100, 777, 3000] {
            assert_eq!(
                fit::<Fixed>(&recorded, settings, slice),
                whole,
                "slices of {slice}"
            );
        }
    }
}

#[test]
fn a_motor_that_did_not_move_with_the_drive_is_not_fitted() {
    let settings = Settings::default();
    for (duties, steps) in [
        (vec![], vec![]),
        (vec![900; 50], vec![0; 50]),
        (vec![900; 50], vec![-3; 50]),
    ] {
        let trace = Trace::new(&duties, &steps);
        assert!(!Fit::<f32>::idle().begin(&trace, settings));
    }
}

/// Whole counts of a motor behind a bridge with dead time: of the hot loop, and of the step that it is a short form of.
fn whole_counts<S: Arithmetic>(plan: &RigidPlan<f64>, duties: &[i16]) -> Vec<[i32; 2]> {
    let model = Rigid::<S>::new(plan).expect("a motor");
    let mut run = Evaluation::new(model).expect("within the format");
    let mut motion = Motion::default();
    let both = duties.iter().map(|&duty| {
        run.step(duty, 0);
        S::step(&model, &mut motion, S::from_q15(duty), false);
        [
            run.error().floor() as i32,
            Readable::<S>::floor(motion.angle),
        ]
    });
    both.collect()
}

#[test]
fn behind_a_bridge_the_hot_loop_is_the_step() {
    for seed in 0..SEEDS {
        let Motor {
            gain,
            mechanical,
            electrical,
            coulomb,
        } = motor(seed);
        let mut rng = rng::seeded(seed);
        let mut part = |most: f64| most * rng::uniform::<f64>(&mut rng);
        let viscous = part(0.3) / gain;
        let plan = RigidPlan {
            machine: Machine {
                kb: 1.0 / gain - viscous,
                damping: viscous,
                inertia: mechanical / gain,
                electrical,
            },
            coulomb,
            load: part(0.02),
            dead_time: part(0.05),
            carriers: 20.0,
            supply: 0.0,
            full: 1.0,
            units: PerUnit::new(1.0, gain, 1.0, std::f64::consts::TAU).unwrap(),
        };
        let duties: Vec<i16> = (0..400)
            .map(|k| match k % 40 {
                0..20 => part(30_000.0) as i16,
                20..30 => -(part(8_000.0) as i16),
                _ => 0,
            })
            .collect();
        for counts in [
            whole_counts::<f32>(&plan, &duties),
            whole_counts::<Fixed>(&plan, &duties),
        ] {
            for (k, [loops, steps]) in counts.into_iter().enumerate() {
                assert!(
                    (loops - steps).abs() <= 1,
                    "seed {seed}, period {k}: {loops} {steps}, {plan:?}"
                );
            }
        }
    }
}

#[test]
fn dead_time_takes_its_part_of_a_current_that_flows_and_nothing_of_one_that_the_ripple_turns() {
    let steady = |dead_time: f64, load: f64, duty: f64| {
        let plan = RigidPlan {
            machine: Machine {
                kb: 0.01,
                damping: 0.0,
                inertia: 0.2,
                electrical: 0.5,
            },
            coulomb: 0.0,
            load,
            dead_time,
            carriers: 20.0,
            supply: 0.0,
            full: 1.0,
            units: PerUnit::new(1.0, 100.0, 1.0, std::f64::consts::TAU).unwrap(),
        };
        let model = Rigid::<f64>::new(&plan).unwrap();
        let mut motion = Motion::default();
        for _ in 0..2_000 {
            model.step(&mut motion, duty, false);
        }
        motion.speed
    };
    for dead_time in [0.0, 0.004, 0.02, 0.05] {
        for load in [-0.2, 0.0, 0.1] {
            for duty in [-0.7, 0.3, 0.5] {
                let lost = if load == 0.0 { 0.0 } else { dead_time };
                let right = duty - load - lost * load.signum();
                let found = steady(dead_time, load, duty);
                assert!(
                    (found - right).abs() < 1e-3,
                    "{dead_time} {load} {duty}: {found} {right}"
                );
            }
        }
    }
}
