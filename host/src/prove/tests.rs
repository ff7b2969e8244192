//! Laws of the cases, the file and the counting. None says how good the diagnosis is.

use super::draws::Draws;
use super::hide::{self, acts_otherwise};
use super::*;
use servoid_plant::Hidden;
use servoid_plant::effects::CATALOGUE;
use servoid_results::schema::diagnosis::Hypothesis;
use shared::effects::Kind;
use std::collections::BTreeSet;
use std::path::PathBuf;

const SEED: u64 = 7;

fn set_up(hidden: HowMany, excite: Excite) -> SetUp {
    SetUp {
        seed: SEED,
        hidden,
        excite,
        effects: Vec::new(),
        laws: Laws::Own,
        discover: false,
    }
}

fn draw(set_up: &SetUp, number: u64) -> Drawn {
    Drawn::draw(set_up, number, 0).expect("a draw")
}

/// An outcome in which `named` is said, alone or with its look-alikes: `coulomb|stribeck`.
fn outcome(set_up: &SetUp, case: u64, named: &[&str]) -> Outcome {
    let naming = |text: &&str| {
        let mut names = text.split('|').map(str::to_owned);
        Naming {
            effect: names.next().unwrap_or_default(),
            alike: names.collect(),
        }
    };
    Outcome {
        seed: set_up.seed,
        case,
        drawn: draw(set_up, case),
        base: Errors::default(),
        detectable: true,
        alone: Vec::new(),
        named: named.iter().map(naming).collect(),
        hypotheses: Vec::new(),
        verdict: "missing_effects".to_owned(),
        last: Errors::default(),
        parameters: Vec::new(),
        steps: None,
        ran_out: false,
        evaluations: None,
        refits: 0,
        seconds: 0.1,
        law_found: None,
        failure: None,
    }
}

#[test]
fn every_effect_comes_equally_often_and_a_pair_acts_in_two_ways() {
    let one = set_up(HowMany::One, Excite::Commissioning);
    let two = set_up(HowMany::Two, Excite::Mixed);
    let rounds = 3;
    let mut seen = std::collections::BTreeMap::new();
    for number in 0..rounds * CATALOGUE.len() as u64 {
        for name in hide::names(&one, number) {
            *seen.entry(name).or_insert(0) += 1;
        }
        let pair = hide::names(&two, number);
        assert!(acts_otherwise(pair[0], pair[1]), "{pair:?}");
    }
    assert_eq!(seen.len(), CATALOGUE.len());
    assert!(seen.values().all(|&count| count == rounds), "{seen:?}");
}

#[test]
fn only_the_wanted_effects_are_hidden() {
    let mut wanted = set_up(HowMany::Two, Excite::Commissioning);
    wanted.effects = vec!["cogging".to_owned(), "coulomb".to_owned()];
    for number in 0..20 {
        let mut pair = hide::names(&wanted, number);
        pair.sort_unstable();
        assert_eq!(pair, ["cogging", "coulomb"]);
    }
    wanted.effects.pop();
    for number in 0..20 {
        let pair = hide::names(&wanted, number);
        assert_eq!((pair[0], pair.len()), ("cogging", 2));
    }
}

#[test]
fn a_law_is_alone_or_beside_one_of_the_wanted_effects() {
    let mut set_up = set_up(HowMany::Formula, Excite::Commissioning);
    let alone = draw(&set_up, 3);
    assert!(alone.hidden.is_empty());
    assert_eq!(alone.apart(), std::slice::from_ref(&alone));
    set_up.effects = vec!["cogging".to_owned(), "coulomb".to_owned()];
    let mut seen = BTreeSet::new();
    for number in 0..2 * servoid_plant::Outside::ALL.len() as u64 {
        let drawn = draw(&set_up, number);
        let law = drawn.law.as_ref().expect("a law");
        let [name] = drawn.names()[..] else {
            panic!("{:?}", drawn.hidden)
        };
        seen.insert((name.to_owned(), law.form.clone()));
        let apart = drawn.apart();
        assert_eq!(apart.len(), 2);
        assert_eq!((&apart[0].hidden, &apart[0].law), (&drawn.hidden, &None));
        assert_eq!((&apart[1].hidden[..], &apart[1].law), (&[][..], &drawn.law));
    }
    let effects = seen.iter().map(|(effect, _)| effect);
    let forms = seen.iter().map(|(_, form)| form);
    assert_eq!(effects.collect::<BTreeSet<_>>().len(), 2);
    assert_eq!(
        forms.collect::<BTreeSet<_>>().len(),
        servoid_plant::Outside::ALL.len()
    );
}

#[test]
fn what_is_drawn_prints_and_reads_back_to_the_bit() {
    for excite in [Excite::Commissioning, Excite::Mixed] {
        let set_up = set_up(HowMany::Mix, excite);
        for number in 0..200 {
            let drawn = draw(&set_up, number);
            let text = serde_json::to_string(&drawn).unwrap();
            let again: Drawn = serde_json::from_str(&text).unwrap();
            assert_eq!(drawn, again, "{text}");
            let machine = drawn.motor.machine;
            for (hidden, spec) in drawn.hidden().unwrap().iter().zip(&drawn.hidden) {
                assert_eq!(&hidden.to_string(), spec);
                let truth = hidden.truth(&machine, drawn.counts_per_rev);
                assert!(truth.iter().all(|value| value.is_finite()));
            }
        }
    }
}

/// A search range is in parts of the fastest speed of the recording, which a drive of 0.6 may leave at
/// hardly more than half of the top speed.
const SLOWEST: f64 = 0.5;

/// Ranges of the model that end below the strongest that is hidden: the diagnosis can name such an
/// effect, but not fit it quite.
const NARROW: [(Kind, &str); 2] = [(Kind::LSat, "falloff"), (Kind::Lugre, "damping_time")];

#[test]
fn whatever_is_hidden_lies_in_the_search_range() {
    for kind in Kind::ALL {
        for number in 0..300 {
            let mut draws = Draws::of(&[SEED, number]);
            let machine = Motor::draw(&mut draws).unwrap().machine;
            let hidden: Hidden = hide::draw(kind.name(), &machine, &mut draws).unwrap();
            let truth = hidden.truth(&machine, 4096);
            let top = machine.top_speed_rad_s();
            for (parameter, value) in kind.parameters().iter().zip(truth) {
                if NARROW.contains(&(*kind, parameter.name)) {
                    continue;
                }
                let (low, high) = parameter.range;
                let at = |x: f64, speed: f64| parameter.scaled(x, machine.supply_v, speed);
                let low = at(low, top).max(at(low, SLOWEST * top));
                let high = at(high, top).min(at(high, SLOWEST * top));
                assert!(
                    (low..=high).contains(&value),
                    "{hidden} in {machine:?}: {} = {value}, not {low} to {high}",
                    parameter.name
                );
            }
        }
    }
}

/// Outcomes of these cases, without what differs from run to run.
fn proved(set_up: &SetUp, numbers: &[u64]) -> Vec<Outcome> {
    let stop = AtomicBool::new(false);
    let mut outcomes = Vec::new();
    run(set_up, numbers, &stop, &mut |outcome| {
        outcomes.push(Outcome {
            seconds: 0.0,
            ..outcome
        });
        Ok(())
    })
    .unwrap();
    outcomes.sort_by_key(|outcome| outcome.case);
    outcomes
}

#[test]
fn shards_in_any_order_joined_are_the_whole() {
    const CASES: u64 = 4;
    let set_up = set_up(HowMany::None, Excite::Commissioning);
    let header = Header::new(&set_up);
    let folder = tempfile::tempdir().unwrap();
    let whole = proved(&set_up, &(0..CASES).collect::<Vec<_>>());
    assert_eq!(whole.len() as u64, CASES);
    let files: Vec<PathBuf> = ["1/2", "2/2"]
        .map(|text| {
            let shard: Shard = text.parse().unwrap();
            let mut numbers: Vec<u64> = shard.numbers(CASES).collect();
            numbers.reverse();
            let path = folder.path().join(text.replace('/', "-"));
            let mut store = Store::create(&path, &header).unwrap();
            for outcome in proved(&set_up, &numbers) {
                store.append(&outcome).unwrap();
            }
            path
        })
        .to_vec();
    let twice = [&files[..], &files[..1]].concat();
    for paths in [&files, &twice] {
        let joint = merge(paths).unwrap().unwrap();
        assert_eq!(joint.outcomes, whole);
        assert_eq!(joint.header, header);
    }
    let table = |outcomes: &[Outcome]| tally(&header, outcomes, false);
    assert_eq!(
        table(&whole),
        table(&merge(&files).unwrap().unwrap().outcomes)
    );
}

#[test]
fn a_file_that_was_cut_anywhere_is_continued_to_the_whole() {
    let set_up = set_up(HowMany::Mix, Excite::Mixed);
    let header = Header::new(&set_up);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole");
    let whole: Vec<Outcome> = (0..4)
        .map(|case| Outcome {
            failure: Some("a cut through \u{3a9} too".to_owned()),
            ..outcome(&set_up, case, &["coulomb|stribeck", "windage"])
        })
        .collect();
    let mut store = Store::create(&path, &header).unwrap();
    whole.iter().for_each(|o| store.append(o).unwrap());
    let bytes = std::fs::read(&path).unwrap();
    let cut = folder.path().join("cut");
    for length in 0..=bytes.len() {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        let (mut store, done) = Store::resume(&cut, &header).unwrap();
        assert_eq!(done, whole[..done.len()]);
        whole[done.len()..]
            .iter()
            .for_each(|o| store.append(o).unwrap());
        assert_eq!(std::fs::read(&cut).unwrap(), bytes, "cut at {length}");
    }
    assert_eq!(read(&path).unwrap().outcomes, whole);
}

#[test]
fn a_file_of_something_else_is_refused_and_stays_as_it_is() {
    let own = set_up(HowMany::One, Excite::Commissioning);
    let header = Header::new(&own);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other");
    let line = |value: &Outcome| serde_json::to_string(value).unwrap() + "\n";
    let mut elsewhere = header.clone();
    elsewhere.set_up.seed += 1;
    let mut redrawn = outcome(&own, 3, &[]);
    redrawn.drawn.counts_per_rev += 1;
    let begins = |header: &Header| serde_json::to_string(header).unwrap() + "\n";
    let cases = [
        ("a,b\n1,2\n".to_owned(), "no file of servoid prove"),
        ("a".to_owned(), "no file of servoid prove"),
        (begins(&elsewhere), "--seed 8, not 7"),
        (begins(&header) + "{}\n", "other:2: is no finished case"),
        (
            begins(&header) + &line(&redrawn),
            "case 3 was drawn in another way",
        ),
        (
            begins(&header) + &line(&outcome(&own, 3, &[])) + &line(&redrawn),
            "case 3 was drawn in another way",
        ),
    ];
    for (content, says) in cases {
        std::fs::write(&path, &content).unwrap();
        let message = Store::resume(&path, &header).unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), content);
    }
    let message = Store::create(&path, &header).unwrap_err().to_string();
    assert!(message.contains("--resume"), "{message}");
}

#[test]
fn files_of_different_set_ups_do_not_mix() {
    let folder = tempfile::tempdir().unwrap();
    let paths = [HowMany::One, HowMany::Two].map(|hidden| {
        let header = Header::new(&set_up(hidden, Excite::Commissioning));
        let path = folder.path().join(hidden.name());
        Store::create(&path, &header).unwrap();
        path
    });
    let message = merge(&paths).unwrap_err().to_string();
    assert!(message.contains("--hidden two, not one"), "{message}");
}

#[test]
fn names_are_judged_by_what_is_hidden() {
    let mut set_up = set_up(HowMany::Two, Excite::Commissioning);
    set_up.effects = vec!["coulomb".to_owned(), "offset_voltage".to_owned()];
    let judged = |named: &[&str]| {
        let o = outcome(&set_up, 0, named);
        (
            o.any_named(),
            o.all_named(),
            o.all_in_sets(),
            o.wrong_names().len(),
            o.quite_wrong_names().len(),
        )
    };
    let both = ["offset_voltage", "coulomb"];
    assert_eq!(judged(&both), (true, true, true, 0, 0));
    assert_eq!(judged(&["coulomb"]), (true, false, false, 0, 0));
    assert_eq!(judged(&[]), (false, false, false, 0, 0));
    // A look-alike of both stands for one of them only.
    assert_eq!(judged(&["asym_coulomb"]), (false, false, false, 1, 0));
    let half = ["asym_coulomb", "coulomb"];
    assert_eq!(judged(&half), (true, false, true, 1, 0));
    let printed = ["load_torque|offset_voltage", "stribeck|coulomb"];
    assert_eq!(judged(&printed), (false, false, true, 2, 0));
    let invented = ["coulomb", "offset_voltage", "windage"];
    assert_eq!(judged(&invented), (true, true, true, 1, 1));
}

#[test]
fn the_table_counts_each_case_once() {
    let set_up = set_up(HowMany::Mix, Excite::Commissioning);
    let outcomes: Vec<Outcome> = (0..60)
        .map(|case| {
            let mut first = outcome(&set_up, case, &[]);
            first.named = outcome(&set_up, case, &first.drawn.names()).named;
            first
        })
        .collect();
    let tally = tally(&Header::new(&set_up), &outcomes, false);
    assert_eq!(tally.cases, 60);
    assert_eq!(
        tally.groups.iter().map(|group| group.cases).sum::<u64>(),
        60
    );
    for group in &tally.groups {
        for share in &group.shares {
            let right = ["right", "both", "at_least"];
            let good = right.iter().any(|start| share.name.starts_with(start));
            let expected = if good { share.of } else { 0 };
            assert_eq!(share.count, expected, "{share:?}");
        }
    }
    assert!(
        tally
            .confusions
            .iter()
            .all(|row| row.missed_cases.is_empty())
    );
    let hidden: usize = outcomes.iter().map(|o| o.drawn.hidden.len()).sum();
    let counted: u64 = tally
        .confusions
        .iter()
        .map(|row| row.alone + row.paired)
        .sum();
    assert_eq!(counted, hidden as u64);
    let text = super::report::text(&tally);
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
}

/// A diagnosis that gives a set 80 % is right in four of five cases: on the diagonal, with the score of its uncertainty.
#[test]
fn probabilities_are_counted_against_the_truth() {
    let one = set_up(HowMany::One, Excite::Commissioning);
    let mut outcomes: Vec<Outcome> = (0..50)
        .map(|case| {
            let mut outcome = outcome(&one, case, &[]);
            let truth = outcome.drawn.names()[0].to_owned();
            let said = if case % 5 == 0 {
                "none such".to_owned()
            } else {
                truth
            };
            let set = |effects: Vec<String>, probability| Hypothesis {
                effects,
                probability,
                nats: None,
            };
            outcome.hypotheses = vec![set(vec![said], 0.8), set(Vec::new(), 0.1)];
            outcome
        })
        .collect();
    let proof = tally(&Header::new(&one), &outcomes, false);
    let found = proof.reliability.expect("probabilities");
    assert!((found.brier - 0.16).abs() < 1e-12, "{found:?}");
    let [unlikely, likely] = &found.bins[..] else {
        panic!("{found:?}");
    };
    assert_eq!((unlikely.right.count, unlikely.right.of), (0, 50));
    assert_eq!((likely.right.count, likely.right.of), (40, 50));
    assert!((likely.probability - 0.8).abs() < 1e-12);
    // No set of the catalogue is right where a law outside of it is hidden.
    for outcome in &mut outcomes {
        outcome.drawn.law = Some(DrawnLaw {
            form: "crank".to_owned(),
            values: Vec::new(),
        });
    }
    assert_eq!(
        tally(&Header::new(&one), &outcomes, false).reliability,
        None
    );
}
