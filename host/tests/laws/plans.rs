//! Laws of plans, held against the virtual bench, which shares no code with the model that plans.

use servoid_engine::problem::{Data, Horizon, StartAngle};
use servoid_engine::problem::{errors, rms_counts};
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_identify::fit::{self, Options};
use servoid_identify::plan::{
    Hypothesis, Limits, PlanTask, Ranked, RefitBudget, Separation, Setup, Trial, rank,
};
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_plant::{Bench, DriveSample, Hidden, Machine};
use shared::cost::Cost;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use shared::excite::{COMMISSIONING, Command, Experiment, commands};
use std::sync::atomic::AtomicBool;

const SEED: u64 = 1;
const COUNTS_PER_REV: u32 = 2000;
const SAMPLE_S: f64 = 1e-3;
/// The bench is sampled this much finer than the plan where its currents are looked at.
const FINER: usize = 10;

struct Desk {
    motor: Machine,
    hypotheses: Vec<Hypothesis>,
    setup: Setup,
}

impl Desk {
    fn new(preset: &str, kinds: &[Kind]) -> Self {
        let motor = Machine::preset(preset).expect("a preset");
        Desk {
            hypotheses: kinds
                .iter()
                .map(|&kind| Hypothesis::typical(kind, &motor))
                .collect(),
            setup: Setup {
                supply_v: motor.supply_v,
                no_load_rad_s: motor.top_speed_rad_s(),
                counts_per_rev: f64::from(COUNTS_PER_REV),
                sample_s: SAMPLE_S,
            },
            motor,
        }
    }

    fn plan(&self, limits: Limits, seconds: f64) -> Ranked {
        let ranked = rank(&PlanTask {
            hypotheses: &self.hypotheses,
            setup: self.setup,
            limits,
            seconds,
            seed: SEED,
            stop: &AtomicBool::new(false),
            done: &|| {},
        });
        ranked.expect("a plan").swap_remove(0)
    }

    /// The bench with the hypothesis hidden in it.
    fn bench(&self, hypothesis: &Hypothesis) -> Bench {
        let mut bench = Bench::new(self.motor);
        bench.counts_per_rev = COUNTS_PER_REV;
        bench.sample_s = SAMPLE_S;
        bench.seed = SEED;
        bench.effects = vec![hidden(hypothesis, &self.motor)];
        bench
    }

    fn record(&self, hypothesis: &Hypothesis, drive: &[Command<f64>]) -> Recording {
        let bench = self.bench(hypothesis);
        let samples = samples(drive, self.motor.supply_v);
        bench.record(&samples, "bench", false).expect("a recording")
    }
}

/// A hypothesis in the bench's terms: SI torques, currents instead of volts across the resistance.
fn hidden(hypothesis: &Hypothesis, motor: &Machine) -> Hidden {
    let value = hypothesis.values[0];
    let torque = |volts: f64| volts * motor.kt_n_m_a / motor.resistance_ohm;
    let spec = match hypothesis.effects[0] {
        Kind::Coulomb => format!("coulomb:torque={}", torque(value)),
        Kind::LoadTorque => format!("load_torque:torque={}", torque(value)),
        Kind::OffsetVoltage => format!("offset_voltage:offset={value}"),
        Kind::DeadZone => format!("dead_zone:width={value}"),
        Kind::BrushDrop => {
            let knee = hypothesis.values[1] / motor.resistance_ohm;
            format!("brush_drop:drop={value},knee={knee}")
        }
        kind => panic!("{} is not in these tests", kind.name()),
    };
    Hidden::parse(&spec, motor).expect("an effect")
}

fn samples(drive: &[Command<f64>], supply_v: f64) -> Vec<DriveSample> {
    let sample = |command: &Command<f64>| DriveSample {
        volts: command.drive * supply_v,
        enabled: command.enabled,
    };
    drive.iter().map(sample).collect()
}

/// RMS error above the encoder's own, counts, when `kind` is fitted to a recording as `servoid fit` does.
fn left_after_fit(recording: &Recording, kind: Kind) -> f64 {
    let data = Data::new(recording).expect("data");
    let options = Options {
        effects: vec![kind],
        budget: 400,
        ..Options::default()
    };
    let problem = fit::problem(&data, &options).expect("a motor");
    let solver = LevenbergMarquardt::default();
    let stop = AtomicBool::new(false);
    let found = fit::search(&problem, &solver, &options, &stop, &mut |_, _| {});
    let candidate = problem.structure.candidate_at(&found.x);
    let rms = rms_counts(&data, &problem.errors(&candidate).expect("it runs"));
    (rms * rms - FLOOR_RMS_COUNTS * FLOOR_RMS_COUNTS)
        .max(0.0)
        .sqrt()
}

#[test]
fn a_plan_keeps_its_limits_on_the_bench_whichever_effect_is_true() {
    let cases = [
        ([Kind::Coulomb, Kind::DeadZone], Some(6.0), None, None),
        ([Kind::Coulomb, Kind::DeadZone], None, None, Some(2.0)),
        (
            [Kind::Coulomb, Kind::OffsetVoltage],
            Some(9.0),
            Some(2.0),
            Some(5.0),
        ),
        (
            [Kind::LoadTorque, Kind::OffsetVoltage],
            None,
            Some(3.0),
            Some(100.0),
        ),
        (
            [Kind::Coulomb, Kind::BrushDrop],
            None,
            Some(1.0),
            Some(50.0),
        ),
    ];
    for preset in ["gearmotor", "paper"] {
        for (kinds, voltage_v, current_share, travel_rev) in cases {
            let desk = Desk::new(preset, &kinds);
            // In units of a third of the stall current.
            let current_v = current_share.map(|share| share * desk.motor.supply_v / 3.0);
            let limits = Limits {
                voltage_v,
                current_v,
                travel_rev,
                commands: None,
            };
            let best = desk.plan(limits, 0.8);
            let drive = best.excitation.drive(SAMPLE_S, SEED);
            for hypothesis in &desk.hypotheses {
                let what = format!(
                    "{preset}, {limits:?}, {}: {}",
                    hypothesis.name(),
                    best.excitation
                );
                keeps(&desk, hypothesis, &drive, &limits, &what);
            }
        }
    }
}

#[test]
fn a_device_can_hold_a_plan_that_is_made_for_one() {
    let desk = Desk::new("gearmotor", &[Kind::Coulomb, Kind::BrushDrop]);
    for most in [16, 256] {
        let limits = Limits {
            commands: Some(most),
            ..Limits::default()
        };
        let best = desk.plan(limits, 4.0);
        let drive = best.excitation.drive(SAMPLE_S, SEED);
        let commands = 1 + drive.windows(2).filter(|two| two[0] != two[1]).count();
        assert!(
            commands <= most,
            "{commands} of {most}: {}",
            best.excitation
        );
        assert!(
            best.least() > 10.0,
            "{most} commands separate: {}",
            best.least()
        );
    }
}

/// Plays the drive on the bench, looked at ten times as often, and holds it to the limits themselves:
/// the plan was made for nine tenths of them.
fn keeps(
    desk: &Desk,
    hypothesis: &Hypothesis,
    drive: &[Command<f64>],
    limits: &Limits,
    what: &str,
) {
    let mut bench = desk.bench(hypothesis);
    bench.sample_s = SAMPLE_S / FINER as f64;
    let finer: Vec<DriveSample> = samples(drive, desk.motor.supply_v)
        .into_iter()
        .flat_map(|sample| [sample; FINER])
        .collect();
    let run = bench.run(&finer).expect("a run");
    let largest = |values: &[f64]| values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let volts = largest(&run.voltage_v);
    assert!(
        limits.voltage_v.is_none_or(|limit| volts <= limit),
        "{volts} V: {what}"
    );
    let across = largest(&run.current_a) * desk.motor.resistance_ohm;
    assert!(
        limits.current_v.is_none_or(|limit| across <= limit),
        "{across} V of current: {what}"
    );
    let low = run.angle_rad.iter().copied().fold(f64::INFINITY, f64::min);
    let high = run
        .angle_rad
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let turns = (high - low) / std::f64::consts::TAU;
    assert!(
        limits.travel_rev.is_none_or(|limit| turns <= limit),
        "{turns} rev: {what}"
    );
}

#[test]
fn the_separation_of_friction_and_brushes_is_what_refits_on_the_bench_show() {
    let desk = Desk::new("gearmotor", &[Kind::Coulomb, Kind::BrushDrop]);
    let best = desk.plan(Limits::default(), 2.0);
    let drive = best.excitation.drive(SAMPLE_S, SEED);
    for pair in &best.separations {
        let (truth, fitted) = (&desk.hypotheses[pair.truth], &desk.hypotheses[pair.fitted]);
        let seen = left_after_fit(&desk.record(truth, &drive), fitted.effects[0]);
        let ratio = seen / pair.counts;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{} as {}: {seen} counts seen, {} predicted; {}",
            truth.name(),
            fitted.name(),
            pair.counts,
            best.excitation
        );
        // And the truth itself leaves nothing but the encoder's rounding.
        let own = left_by(truth, &desk.record(truth, &drive));
        assert!(
            (0.24..0.33).contains(&own),
            "{}: {own} counts RMS",
            truth.name()
        );
    }
}

/// RMS error of a hypothesis as it stands, counts.
fn left_by(hypothesis: &Hypothesis, recording: &Recording) -> f64 {
    let data = Data::new(recording).expect("data");
    let candidate = hypothesis.candidate().expect("a model");
    let method = Options::default().method;
    let errors = errors(
        &data,
        &candidate,
        method,
        &Horizon::Whole,
        StartAngle::Free,
        Cost::Squared,
    );
    rms_counts(&data, &errors.expect("it runs"))
}

#[test]
fn coasting_separates_a_load_from_an_offset_and_commissioning_alone_does_not() {
    let desk = Desk::new("gearmotor", &[Kind::LoadTorque, Kind::OffsetVoltage]);
    let seconds = 3.0;
    let best = desk.plan(Limits::default(), seconds);
    assert!(best.excitation.coasts(), "{}", best.excitation);
    let usual: f64 = COMMISSIONING.iter().map(|part| part.seconds).sum();
    let shortened: Vec<Experiment> = COMMISSIONING
        .iter()
        .map(|part| Experiment {
            seconds: part.seconds * seconds / usual,
            ..*part
        })
        .collect();
    let drive: Vec<Command<f64>> = commands(&shortened, SAMPLE_S, SEED).collect();
    let trial = Trial {
        hypotheses: &desk.hypotheses,
        setup: &desk.setup,
        drive: &drive,
        stop: &AtomicBool::new(false),
    };
    let budget = RefitBudget {
        steps: 25,
        regression: 10,
    };
    for pair in Separation::pairs(&desk.hypotheses) {
        let closed = trial.refit(&pair, budget).expect("a refit").counts;
        assert!(closed < 1.0, "commissioning alone: {closed} counts");
        assert!(
            best.least() > 10.0 * closed.max(1.0),
            "{} counts",
            best.least()
        );
    }
}
