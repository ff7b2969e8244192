//! Laws of the bench: exact solutions, energy, and laws of every effect of the catalogue. Here are
//! the drives and the measures that they share, and the orders that must be refused.

use super::effects::{CATALOGUE, Stall};
use super::*;
use std::f64::consts::TAU;

mod catalogue;
mod friction;
mod linear;
mod physics;

fn machines() -> impl Iterator<Item = (&'static str, Machine)> {
    PRESETS
        .iter()
        .map(|name| (*name, Machine::preset(name).unwrap()))
}

fn hide(machine: &Machine, name: &str, strength: f64) -> Hidden {
    Hidden::typical(name, machine)
        .unwrap()
        .scaled(strength)
        .unwrap()
}

/// The true value of an effect's parameter.
fn truth(hidden: &Hidden, key: &str) -> f64 {
    hidden
        .parameters()
        .find(|(name, ..)| *name == key)
        .unwrap()
        .1
}

/// A bench with a fixed start, so that runs differ by nothing but what a test changes.
fn bench(machine: Machine, effects: Vec<Hidden>) -> Bench {
    Bench {
        effects,
        start_angle_rad: Some(0.3),
        ..Bench::new(machine)
    }
}

fn hold(volts: f64, seconds: f64) -> Vec<DriveSample> {
    vec![
        DriveSample {
            volts,
            enabled: true
        };
        (seconds / 1e-3) as usize
    ]
}

fn coast(seconds: f64) -> Vec<DriveSample> {
    vec![
        DriveSample {
            volts: 0.0,
            enabled: false
        };
        (seconds / 1e-3) as usize
    ]
}

/// Both directions, all levels, standstill, reversal and coasting.
fn lively(machine: &Machine) -> Vec<DriveSample> {
    let mut drive = Vec::new();
    for level in [0.02, 0.3, -0.6, 0.9, 0.0, -0.05, -1.0, 1.0, 0.15] {
        drive.extend(hold(level * machine.supply_v, 0.1));
    }
    drive.extend(coast(0.1));
    for step in 0..200 {
        let level = 0.3 * (TAU * f64::from(step * step) / 15_000.0).sin();
        drive.extend(hold(level * machine.supply_v, 1e-3));
    }
    drive
}

fn rms_counts(a: &Run, b: &Run) -> f64 {
    let squares: f64 = a
        .counts
        .iter()
        .zip(&b.counts)
        .map(|(a, b)| ((a - b) as f64).powi(2))
        .sum();
    (squares / a.counts.len() as f64).sqrt()
}

fn largest_gap_counts(a: &Run, b: &Run) -> f64 {
    let gaps = a
        .angle_rad
        .iter()
        .zip(&b.angle_rad)
        .map(|(a, b)| (a - b).abs());
    gaps.fold(0.0, f64::max) * 4096.0 / TAU
}

#[test]
fn impossible_orders_are_refused_by_name() {
    let machine = Machine::paper();
    let drive = hold(1.0, 0.01);
    let good = bench(machine, vec![]);
    let twice = vec![
        hide(&machine, "coulomb", 1.0),
        hide(&machine, "coulomb", 2.0),
    ];
    let broken = Machine {
        inertia_kg_m2: 0.0,
        ..machine
    };
    let cases = [
        (
            Bench {
                counts_per_rev: 0,
                ..good.clone()
            },
            "counts_per_rev = 0",
        ),
        (
            Bench {
                sample_s: -1.0,
                ..good.clone()
            },
            "sample_s = -1",
        ),
        (
            Bench {
                jitter_s: 1.0,
                ..good.clone()
            },
            "jitter_s = 1",
        ),
        (
            Bench {
                substep_hz: 1e3,
                ..good.clone()
            },
            "substep_hz = 1000",
        ),
        (
            Bench {
                current_noise_a: f64::NAN,
                ..good.clone()
            },
            "current_noise_a = NaN",
        ),
        (
            Bench {
                machine: broken,
                ..good.clone()
            },
            "machine.inertia_kg_m2 = 0",
        ),
        (
            Bench {
                effects: twice,
                ..good.clone()
            },
            "`coulomb` is listed twice",
        ),
    ];
    for (bench, expected) in cases {
        let message = bench.run(&drive).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    let extremes = [
        ("brush_drop:knee=1e-300", "too short to simulate"),
        ("compliance:compliance=1e-12", "too short to simulate"),
        ("lugre:presliding=1e-5,coulomb=1e9", "too short to simulate"),
        ("windage:drag=1e300", "diverged"),
        ("load_torque:torque=1e306", "diverged"),
    ];
    for (spec, expected) in extremes {
        let effects = vec![Hidden::parse(spec, &machine).unwrap()];
        let message = bench(machine, effects).run(&drive).unwrap_err().to_string();
        assert!(message.contains(expected), "{spec}: {message}");
    }
    let mut drive = drive;
    drive[3].volts = f64::INFINITY;
    let message = good.run(&drive).unwrap_err().to_string();
    assert!(message.contains("drive sample 3"), "{message}");
}
