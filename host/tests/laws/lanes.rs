//! Candidates computed side by side are the candidates computed one by one.

use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle};
use servoid_engine::simulation::Batch;
use servoid_engine::simulation::{Method, Simulation};
use servoid_engine::simulation::{Mode, Segment, segments};
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::effects::{EffectSet, Kind};
use shared::excite::{COMMISSIONING_COAST, commands};
use shared::model::MeasuredInterval;
use shared::motor::Machine;

const SUPPLY: f64 = 12.0;
const INTERVAL_S: f64 = 1e-3;
const MACHINE: Machine<f64> = Machine {
    kb: 0.05,
    damping: 0.002,
    inertia: 0.0025,
    electrical: 0.0016,
};

/// A motor under the commissioning mix, coasting now and then, with readings of a sine of about its travel.
fn data() -> Data {
    let drive: Vec<_> = commands::<f64>(&COMMISSIONING_COAST, INTERVAL_S, 1)
        .step_by(3)
        .collect();
    let mut angle = 0.0;
    let recording = Recording {
        source: "test".to_owned(),
        time_s: (0..drive.len()).map(|k| k as f64 * INTERVAL_S).collect(),
        counts: drive
            .iter()
            .map(|command| {
                angle += 40.0 * command.drive;
                f64::floor(angle)
            })
            .collect(),
        command: drive.iter().map(|command| command.drive * SUPPLY).collect(),
        measured: Series::NONE,
        enabled: Some(drive.iter().map(|command| command.enabled).collect()),
        counts_per_rev: 2000.0,
        quantised: true,
        supply_v: Some(SUPPLY),
        drive: Drive::Voltage,
        position: None,
    };
    Data::new(&recording).expect("valid bases")
}

/// The motor with an effect of its typical size, changed by a part.
fn candidate(data: &Data, kind: Kind, change: f64) -> Candidate {
    let mut effects = EffectSet::default();
    let values: Vec<f64> = kind
        .parameters()
        .iter()
        .map(|p| p.scaled(p.typical, data.supply, data.units.speed) * (1.0 + change))
        .collect();
    effects.push(kind, &values).expect("a valid effect");
    Candidate {
        machine: Machine {
            kb: MACHINE.kb * (1.0 + change),
            ..MACHINE
        },
        effects,
        start_speed: 0.1 * change,
        start_offset: 0.0,
    }
}

fn modes<'a>(
    seen: &'a [MeasuredInterval<f64>],
    turns: &'a [f64],
) -> [(Mode<'a>, Horizon, &'static str); 4] {
    let windows = |data: &Data| Horizon::windows(data, 0.5);
    [
        (Mode::Free, Horizon::Whole, "free"),
        (Mode::Free, windows(&data()), "in windows"),
        (
            Mode::Observer(0.1),
            Horizon::Observer(0.1),
            "pulled by an observer",
        ),
        (
            Mode::SeriesParallel { seen, turns },
            Horizon::Whole,
            "series-parallel",
        ),
    ]
}

/// Largest difference between lanes and one by one over all modes, counts, with its place.
fn furthest(data: &Data, kind: Kind, changes: &[f64]) -> (f64, &'static str) {
    let turns: Vec<f64> = data
        .counts
        .iter()
        .map(|c| (c / 2000.0).rem_euclid(1.0))
        .collect();
    let seen: Vec<MeasuredInterval<f64>> = turns
        .iter()
        .enumerate()
        .map(|(k, &turns)| MeasuredInterval {
            turns,
            speed: data.command[k] * 0.9,
            speed_change: 0.01,
        })
        .collect();
    let candidates: Vec<Candidate> = changes.iter().map(|&c| candidate(data, kind, c)).collect();
    let mut furthest = (0.0, "");
    for (mode, horizon, name) in modes(&seen, &turns) {
        let run = Batch {
            data,
            method: Method::default(),
            mode,
        };
        let segments = |candidate: &Candidate| -> Vec<Segment> {
            segments(data, candidate, &horizon, StartAngle::Free)
        };
        let batch = run.errors(&candidates, &segments);
        for (candidate, in_lanes) in candidates.iter().zip(batch) {
            let alone = Simulation::new(data, candidate, run.method)
                .expect("a valid model")
                .errors(mode, &segments(candidate));
            let in_lanes = in_lanes.expect("a valid model");
            for (a, b) in alone.iter().zip(&in_lanes) {
                let off = (a - b).abs();
                if off > furthest.0 || off.is_nan() {
                    furthest = (off, name);
                }
            }
        }
    }
    furthest
}

/// Nothing is computed in another way than by [`f64`] itself: with every effect, along every mode of running.
#[test]
fn equal_candidates_in_lanes_are_the_candidate_alone_to_the_bit() {
    let data = data();
    for &kind in Kind::ALL {
        let (off, mode) = furthest(&data, kind, &[0.03; 8]);
        assert_eq!(off, 0.0, "{} {mode}", kind.name());
    }
}

/// Where a part of a step is halved for one lane it is halved for all. Candidates as near as those of a Jacobian
/// want that in nearly the same places; for others it is finer within the arithmetic's own tolerance.
#[test]
fn other_candidates_beside_it_change_no_more_than_finer_steps_would() {
    let data = data();
    for &kind in Kind::ALL {
        let (off, mode) = furthest(&data, kind, &[0.0, 1e-5, -1e-5, 2e-5, 3e-5]);
        assert!(off < 0.05, "{} {mode}: {off} counts", kind.name());
        let (off, mode) = furthest(&data, kind, &[0.0, 0.05, -0.05, 0.1, 0.2, -0.2]);
        assert!(off < 2.0, "{} {mode}: {off} counts, far apart", kind.name());
    }
}

/// One candidate, and groups that differ in more than numbers, are computed one by one.
#[test]
fn what_cannot_be_computed_in_lanes_is_computed_without() {
    let data = data();
    let run = Batch {
        data: &data,
        method: Method::default(),
        mode: Mode::Free,
    };
    let segments = |candidate: &Candidate| -> Vec<Segment> {
        segments(&data, candidate, &Horizon::Whole, StartAngle::Free)
    };
    let mixed = [Kind::Windage, Kind::Cogging, Kind::Coulomb, Kind::Delay]
        .map(|k| candidate(&data, k, 0.0));
    let impossible = Candidate {
        machine: Machine {
            inertia: -1.0,
            ..MACHINE
        },
        ..mixed[0]
    };
    let group: Vec<Candidate> = mixed.into_iter().chain([impossible]).collect();
    let errors = run.errors(&group, &segments);
    for (candidate, errors) in mixed.iter().zip(&errors) {
        let alone = Simulation::new(&data, candidate, run.method).expect("a valid model");
        assert_eq!(
            errors.as_ref(),
            Some(&alone.errors(run.mode, &segments(candidate)))
        );
    }
    assert_eq!(errors[4], None);
}
