//! Laws that every excitation obeys.

use shared::excite::{
    COMMISSIONING, COMMISSIONING_COAST, Command, Experiment, Shape, commands, device_commands,
    narrowed,
};

fn all() -> Vec<(&'static str, Vec<Experiment>)> {
    let mut plans = vec![
        ("commissioning", COMMISSIONING.to_vec()),
        ("commissioning-coast", COMMISSIONING_COAST.to_vec()),
        (
            "multisine",
            vec![Experiment {
                shape: Shape::Multisine {
                    base_hz: 0.5,
                    lines: 20,
                },
                seconds: 4.0,
                amplitude: 0.7,
            }],
        ),
    ];
    for (name, shape) in Shape::ALL {
        plans.push((
            name,
            vec![Experiment {
                shape,
                seconds: 5.0,
                amplitude: 0.6,
            }],
        ));
    }
    plans
}

fn run(plan: &[Experiment], seed: u64) -> Vec<Command<f64>> {
    commands::<f64>(plan, 1e-3, seed).collect()
}

#[test]
fn every_command_is_finite_and_within_the_amplitude() {
    for (name, plan) in all() {
        let top = plan.iter().map(|e| e.amplitude).fold(0.0, f64::max);
        for (k, command) in run(&plan, 3).iter().enumerate() {
            assert!(
                command.drive.is_finite() && command.drive.abs() <= top + 1e-12,
                "{name}, sample {k}: {command:?}"
            );
            assert!(
                command.enabled || command.drive == 0.0,
                "{name}, sample {k}: drives an open bridge"
            );
        }
    }
}

#[test]
fn the_length_is_what_was_asked_for() {
    for (name, plan) in all() {
        let seconds: f64 = plan.iter().map(|e| e.seconds).sum();
        assert_eq!(
            run(&plan, 3).len(),
            (seconds / 1e-3).round() as usize,
            "{name}"
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_seeds_matter_to_telegraphs_only() {
    for (name, plan) in all() {
        assert_eq!(run(&plan, 7), run(&plan, 7), "{name}");
        let random = plan
            .iter()
            .any(|e| matches!(e.shape, Shape::Telegraph { .. }));
        assert_eq!(run(&plan, 7) != run(&plan, 8), random, "{name}");
    }
}

#[test]
fn single_precision_commands_are_the_same_to_its_precision() {
    for (name, plan) in all() {
        let narrowed: Vec<Experiment<f32>> = plan.iter().map(Experiment::narrowed).collect();
        let single: Vec<Command<f32>> = commands(&narrowed, 1e-3, 3).collect();
        let double = run(&plan, 3);
        assert_eq!(single.len(), double.len(), "{name}");
        // At the edge between two levels rounding may decide for one sample; nowhere else.
        let apart = single
            .iter()
            .zip(&double)
            .filter(|(a, b)| (f64::from(a.drive) - b.drive).abs() > 2e-3);
        assert!(apart.count() <= 20, "{name}");
    }
}

#[test]
fn a_device_plays_its_plans_as_anybody_does() {
    for plan in [narrowed(COMMISSIONING), narrowed(COMMISSIONING_COAST)] {
        let device = device_commands(&plan, 1e-3, 5);
        assert!(device.eq(commands(&plan, 1e-3, 5)));
    }
}

#[test]
fn all_but_the_one_sided_ones_drive_both_ways_and_twice_the_same_to_both_sides() {
    for (name, plan) in all() {
        if ["rest", "step"].contains(&name) {
            continue;
        }
        let drive = run(&plan, 3);
        let high = drive
            .iter()
            .map(|c| c.drive)
            .fold(f64::NEG_INFINITY, f64::max);
        let low = drive.iter().map(|c| c.drive).fold(f64::INFINITY, f64::min);
        assert!(
            (high + low).abs() < 0.25 * (high - low),
            "{name}: from {low} to {high}"
        );
    }
}
