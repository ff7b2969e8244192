//! Laws of every effect of the catalogue.

use super::*;

#[test]
fn an_effect_of_no_strength_is_the_plain_machine_bit_for_bit() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        let plain = bench(machine, vec![]).run(&drive).unwrap();
        for kind in CATALOGUE {
            let absent = bench(machine, vec![hide(&machine, kind.name, 0.0)])
                .run(&drive)
                .unwrap();
            assert!(absent == plain, "{name}, {}: differs", kind.name);
        }
    }
}

#[test]
fn an_effect_shows_and_shows_less_with_less_strength() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        let plain = bench(machine, vec![]).run(&drive).unwrap();
        for kind in CATALOGUE {
            let mark = |strength| {
                let effects = vec![hide(&machine, kind.name, strength)];
                rms_counts(&bench(machine, effects).run(&drive).unwrap(), &plain)
            };
            let (full, weak) = (mark(3.0), mark(0.05));
            println!(
                "{name:>14} {:>16}: {full:10.2} counts, weak {weak:8.3}",
                kind.name
            );
            assert!(
                full > 0.3,
                "{name}, {}: invisible, {full} counts",
                kind.name
            );
            assert!(
                weak < 0.3 * full + 0.3,
                "{name}, {}: {weak} of {full}",
                kind.name
            );
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_does_not() {
    let machine = Machine::gearmotor();
    let drive = lively(&machine);
    let effects: Vec<_> = CATALOGUE
        .iter()
        .map(|kind| hide(&machine, kind.name, 0.5))
        .collect();
    let run = |seed, effects: Vec<Hidden>| {
        let noisy = Bench {
            seed,
            jitter_s: 2e-4,
            current_noise_a: 0.01,
            ..Bench::new(machine)
        };
        Bench { effects, ..noisy }.run(&drive).unwrap()
    };
    let first = run(5, effects.clone());
    assert!(
        first == run(5, effects.iter().rev().cloned().collect()),
        "the order matters"
    );
    assert!(first.counts != run(6, effects).counts);
    assert!(first.time_s.windows(2).all(|pair| pair[0] < pair[1]));
}

#[test]
fn half_the_substep_gives_the_same_recording() {
    for (name, machine) in machines() {
        let drive = lively(&machine);
        for kind in CATALOGUE {
            let coarse = bench(machine, vec![hide(&machine, kind.name, 1.0)]);
            let fine = Bench {
                substep_hz: 2.0 * coarse.substep_hz,
                ..coarse.clone()
            };
            let gap = largest_gap_counts(&coarse.run(&drive).unwrap(), &fine.run(&drive).unwrap());
            println!("{name:>14} {:>16}: {gap:.1e} counts", kind.name);
            assert!(gap < 0.01, "{name}, {}: {gap} counts", kind.name);
        }
    }
}

/// Every other curve of the catalogue, with its effect.
fn other_laws() -> impl Iterator<Item = (&'static str, &'static str)> {
    let kinds = CATALOGUE.iter();
    kinds.flat_map(|kind| kind.other_laws.iter().map(|law| (kind.name, law.name)))
}

#[test]
fn every_other_law_vanishes_converges_and_differs_from_the_first() {
    assert!(other_laws().count() >= 8);
    for (name, machine) in machines() {
        let drive = lively(&machine);
        let plain = bench(machine, vec![]).run(&drive).unwrap();
        for (effect, law) in other_laws() {
            let by_law = |strength| hide(&machine, effect, strength).by_law(law).unwrap();
            let absent = bench(machine, vec![by_law(0.0)]).run(&drive).unwrap();
            assert!(
                absent == plain,
                "{name}, {effect} by {law}: differs at strength 0"
            );
            let coarse = bench(machine, vec![by_law(1.0)]);
            let fine = Bench {
                substep_hz: 2.0 * coarse.substep_hz,
                ..coarse.clone()
            };
            let run = coarse.run(&drive).unwrap();
            let gap = largest_gap_counts(&run, &fine.run(&drive).unwrap());
            assert!(gap < 0.01, "{name}, {effect} by {law}: {gap} counts");
            let first = bench(machine, vec![hide(&machine, effect, 1.0)]);
            let other = rms_counts(&run, &first.run(&drive).unwrap());
            println!(
                "{name:>14} {effect:>16} by {law:16}: {gap:.1e}; from the first law {other:.2} counts"
            );
            assert!(
                other > 0.01,
                "{name}, {effect} by {law}: the first law again"
            );
        }
    }
}

#[test]
fn any_mixture_of_effects_runs_and_converges() {
    for seed in 0..12 {
        let mut chance = Chance::new(seed, "mixtures");
        let preset = (chance.uniform() * PRESETS.len() as f64) as usize;
        let machine = Machine::preset(PRESETS[preset]).unwrap();
        let mut effects = Vec::new();
        for kind in CATALOGUE {
            if chance.uniform() < 0.15 {
                effects.push(hide(&machine, kind.name, 3.0 * chance.uniform()));
            }
        }
        let drive = lively(&machine);
        let plain = Bench::new(machine);
        let coarse = Bench {
            seed,
            effects,
            ..plain
        };
        let fine = Bench {
            substep_hz: 80e3,
            ..coarse.clone()
        };
        let gap = largest_gap_counts(&coarse.run(&drive).unwrap(), &fine.run(&drive).unwrap());
        // Looser than for one effect: a rotor near the edge of a detent magnifies any error.
        let hidden = coarse.effects;
        assert!(
            gap < 0.05,
            "seed {seed}, {}, {hidden:?}: {gap} counts",
            PRESETS[preset]
        );
    }
}
