//! Residuals compressed while they come say what all of them together say, and a search led by them ends at the same place.

use nalgebra::DMatrix;
use servoid_engine::block_cost::BlockCost;
use servoid_engine::problem::{Candidate, Centring, Data, FitProblem, Horizon, StartAngle};
use servoid_engine::simulation::{Method, Simulation};
use servoid_engine::solve::{self, Compressed, Evaluator, Found, Objective};
use servoid_identify::fit::{self, Options};
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::cost::Cost;
use shared::effects::{EffectSet, Kind};
use shared::motor::Machine;
use shared::rng;
use std::sync::atomic::AtomicBool;

const SUPPLY: f64 = 12.0;
const MOTORS: u64 = 12;
const ABSOLUTE: Cost = Cost::Absolute {
    model_floored: false,
};
/// Step to the moved points, as in the search.
const STEP: f64 = 1e-6;

/// What is commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Commands {
    /// Held for long: many samples can be had at a time.
    Held,
    /// Another one each sample, now and then with the bridge open.
    Restless,
}

fn draw(generator: &mut impl rng::Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng::uniform::<f64>(generator))
}

/// A recording of a drawn motor with friction.
fn data(seed: u64, commands: Commands) -> Data {
    let mut generator = rng::seeded(seed);
    let gain = draw(&mut generator, 5.0, 60.0);
    let machine = Machine {
        kb: 1.0 / gain,
        damping: 0.02 / gain,
        inertia: draw(&mut generator, 0.01, 0.3) / gain,
        electrical: draw(&mut generator, 1e-4, 5e-3),
    };
    let samples = 3000 + (seed % 7) as usize;
    let mut command = Vec::new();
    while command.len() < samples {
        let held = match commands {
            Commands::Held => 200 + (400.0 * rng::uniform::<f64>(&mut generator)) as usize,
            Commands::Restless => 1 + (9.0 * rng::uniform::<f64>(&mut generator)) as usize,
        };
        let volts = SUPPLY * (2.0 * rng::uniform::<f64>(&mut generator) - 1.0);
        command.extend(std::iter::repeat_n(volts, held));
    }
    command.truncate(samples);
    let enabled = (commands == Commands::Restless)
        .then(|| (0..samples).map(|k| k % 900 < 850).collect::<Vec<bool>>());
    // Some motion, for the bases; then that of the motor.
    let counts = (0..samples).map(|k| (gain * SUPPLY * 0.3 * k as f64).floor());
    let mut recording = Recording {
        source: "test".to_owned(),
        time_s: (0..samples).map(|k| k as f64 * 1e-3).collect(),
        counts: counts.collect(),
        command,
        measured: Series::NONE,
        enabled,
        counts_per_rev: 2000.0,
        quantised: true,
        supply_v: Some(SUPPLY),
        drive: Drive::Voltage,
        position: None,
    };
    let bases = Data::new(&recording).expect("valid bases");
    let mut effects = EffectSet::default();
    effects.push(Kind::Coulomb, &[0.1]).expect("an effect");
    let motor = Candidate {
        machine,
        effects,
        start_speed: 0.0,
        start_offset: 0.0,
    };
    let simulation = Simulation::new(&bases, &motor, Method::default()).expect("a motor");
    let segment = servoid_engine::simulation::Segment {
        range: 0..samples,
        angle: 100.3,
        speed: 0.0,
    };
    let errors = simulation.errors(servoid_engine::simulation::Mode::Free, &[segment]);
    for (reading, error) in recording.counts.iter_mut().zip(errors) {
        *reading = (*reading + error).floor();
    }
    Data::new(&recording).expect("valid bases")
}

fn options(effects: &[Kind]) -> Options {
    Options {
        effects: effects.to_vec(),
        ..Options::default()
    }
}

/// Points moved by a step each.
fn moved(x: &[f64]) -> Vec<Vec<f64>> {
    (0..x.len())
        .map(|axis| {
            let mut moved = x.to_vec();
            moved[axis] += if x[axis] + STEP > 1.0 { -STEP } else { STEP };
            moved
        })
        .collect()
}

/// The triangle of the matrix of all residuals and changes.
fn whole(problem: &FitProblem<'_>, x: &[f64], moved: &[Vec<f64>]) -> (DMatrix<f64>, f64) {
    let (residuals, cost) = problem.residuals_and_cost(x).expect("residuals");
    let changes = problem.changes(x, moved);
    let matrix = DMatrix::from_fn(residuals.len(), 1 + moved.len(), |row, column| match column
        .checked_sub(1)
    {
        None => residuals[row],
        Some(k) => changes[k].as_ref().expect("changes")[row],
    });
    (matrix.qr().r(), cost)
}

fn check(problem: &FitProblem<'_>, compressed: &dyn Compressed, x: &[f64], label: &str) {
    let moved = moved(x);
    let (all, cost) = whole(problem, x, &moved);
    let (squares, own) = compressed.squares_and_cost(x).expect("a cost");
    assert!((own / cost - 1.0).abs() < 1e-9, "{label}: {own} {cost}");
    assert!(
        (squares * problem.weight / cost - 1.0).abs() < 1e-9,
        "{label}"
    );
    let tangent = compressed.tangent(x, &moved).expect("a tangent");
    let products = |triangle: &DMatrix<f64>| triangle.tr_mul(triangle);
    let (own, all) = (products(&tangent.triangle), products(&all));
    for i in 0..own.nrows() {
        for j in 0..own.ncols() {
            let scale = (all[(i, i)] * all[(j, j)]).sqrt();
            let off = (own[(i, j)] - all[(i, j)]).abs();
            assert!(
                off <= 1e-6 * scale,
                "{label}: ({i}, {j}) is off by {off:e} of {scale:e}"
            );
        }
    }
    assert!(tangent.possible.iter().all(|&possible| possible), "{label}");
}

/// What is handed over in parts is what the whole lists of errors differ by.
fn check_stream(problem: &FitProblem<'_>, x: &[f64], label: &str) {
    let model = |x: &[f64]| problem.structure.candidate_at(x);
    for cost in [Cost::Squared, ABSOLUTE] {
        let problem = FitProblem {
            cost,
            ..problem.begun_at(&model(x))
        };
        let moved = moved(x);
        let models: Vec<Candidate> = moved.iter().map(|x| model(x)).collect();
        let mut columns = vec![Vec::new(); moved.len()];
        let centring = problem
            .stream_changes(&model(x), &models, |some| {
                for (column, some) in columns.iter_mut().zip(some) {
                    column.extend_from_slice(some);
                }
            })
            .expect("changes");
        for (k, (column, whole)) in columns.iter().zip(problem.changes(x, &moved)).enumerate() {
            let whole = whole.expect("changes");
            assert_eq!(column.len(), whole.len(), "{label}");
            let mean = match centring {
                Centring::Pending => column.iter().sum::<f64>() / column.len() as f64,
                Centring::Done => 0.0,
            };
            for (change, whole) in column.iter().zip(&whole) {
                let off = (change - mean - whole).abs();
                assert!(off < 1e-8, "{label}, {cost:?}, unknown {k}: off by {off:e}");
            }
        }
    }
}

/// With held and with restless commands, effects or none, few unknowns and many, every horizon and start.
#[test]
fn what_is_compressed_is_what_all_residuals_say() {
    let sets: [&[Kind]; 4] = [
        &[],
        &[Kind::Coulomb],
        &[Kind::Coulomb, Kind::Windage],
        &[Kind::Stribeck, Kind::Cogging, Kind::Windage],
    ];
    for seed in 0..MOTORS {
        for commands in [Commands::Held, Commands::Restless] {
            let data = data(seed, commands);
            for effects in sets {
                let Ok(mut problem) = fit::problem(&data, &options(effects)) else {
                    continue;
                };
                let x = problem.start.clone().expect("a start");
                let windows = Horizon::windows(&data, 0.25);
                let modes = [
                    (Horizon::Whole, StartAngle::Free),
                    (Horizon::Whole, StartAngle::Known),
                    (windows, StartAngle::Free),
                    (Horizon::Observer(0.1), StartAngle::Free),
                ];
                for (horizon, start_angle) in modes {
                    let label = format!("seed {seed}, {commands:?}, {effects:?}, {start_angle:?}");
                    problem.horizon = horizon;
                    problem.start_angle = start_angle;
                    check(&problem, &problem, &x, &label);
                    check_stream(&problem, &x, &label);
                    check(
                        &problem,
                        &BlockCost::new(&problem),
                        &x,
                        &format!("{label}, quick"),
                    );
                }
            }
        }
    }
}

/// The same problem, of which only the lists of residuals are to be had.
struct Listed<'a>(&'a FitProblem<'a>);

impl Objective for Listed<'_> {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn cost(&self, x: &[f64]) -> f64 {
        self.0.cost(x)
    }
    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.0.residuals_and_cost(x)
    }
    fn start(&self) -> Option<Vec<f64>> {
        self.0.start()
    }
}

fn search(objective: &dyn Objective) -> Found {
    let stop = AtomicBool::new(false);
    let mut nobody = |_: usize, _: f64| {};
    let mut evaluator = Evaluator::new(objective, 5000, &stop, &mut nobody);
    let solver = solve::by_name("lm").expect("a method");
    solver.search(&mut evaluator, 1);
    evaluator.finish()
}

#[test]
fn a_search_led_by_them_ends_at_the_same_place() {
    let mut ended = 0;
    for seed in 0..MOTORS {
        for commands in [Commands::Held, Commands::Restless] {
            let data = data(seed, commands);
            for effects in [&[][..], &[Kind::Coulomb][..]] {
                let Ok(problem) = fit::problem(&data, &options(effects)) else {
                    continue;
                };
                let label = format!("seed {seed}, {commands:?}, {effects:?}");
                let listed = search(&Listed(&problem));
                let quick = search(&BlockCost::new(&problem));
                let apart = quick.cost / listed.cost - 1.0;
                assert!(apart < 1e-6, "{label}: {} and {}", quick.cost, listed.cost);
                assert!(quick.evaluations <= listed.evaluations + 40, "{label}");
                ended += 1;
            }
        }
    }
    assert!(ended > 40, "{ended}");
}

/// Where a moved model cannot run its column is empty, and the others are what they are.
#[test]
fn an_impossible_neighbour_leaves_the_others_as_they_are() {
    let data = data(1, Commands::Restless);
    let problem = fit::problem(&data, &options(&[])).expect("a start");
    let x = problem.start.clone().expect("a start");
    let mut moved = moved(&x);
    moved[1][1] = f64::NAN;
    let tangent = problem.tangent(&x, &moved).expect("a tangent");
    let possible: Vec<bool> = (0..x.len()).map(|axis| axis != 1).collect();
    assert_eq!(tangent.possible, possible);
    assert_eq!(tangent.triangle.column(2).norm(), 0.0);
    let (all, _) = whole(&problem, &x, &[moved[0].clone(), moved[2].clone()]);
    for (own, plain) in [(0, 0), (1, 1), (3, 2)] {
        let (own, plain) = (
            tangent.triangle.column(own).norm(),
            all.column(plain).norm(),
        );
        assert!((own / plain - 1.0).abs() < 1e-6, "{own} {plain}");
    }
}
