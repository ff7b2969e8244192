//! Results do not depend on the number of threads.

use host::prove::{Case, Excite, HowMany, Laws, SetUp};
use servoid_engine::compare::{self, Contest};
use servoid_engine::solve;
use servoid_identify::diagnose::{Budget, search_catalogue};
use servoid_identify::fit::{self, Fit, Options};
use std::fmt::Debug;
use std::sync::atomic::AtomicBool;

const THREADS: [usize; 3] = [1, 2, 5];
const SEED: u64 = 20_261_121;
const BUDGET: usize = 600;

fn case(hidden: &str) -> Case {
    let set_up = SetUp {
        seed: SEED,
        hidden: HowMany::One,
        excite: Excite::Commissioning,
        effects: vec![hidden.to_owned()],
        laws: Laws::Own,
        discover: false,
    };
    Case::record(&set_up, 0).expect("a case")
}

/// What `work` gives is the same with each number of threads, to the last digit that is printed.
fn same<A: Debug + Send>(what: &str, work: impl Fn() -> A + Sync) {
    let results = THREADS.map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        format!("{:?}", pool.expect("threads").install(&work))
    });
    for (threads, result) in THREADS.iter().zip(&results) {
        assert!(
            *result == results[0],
            "{what}, seed {SEED}: {threads} threads give another result than one"
        );
    }
}

#[test]
fn fits_do_not_depend_on_the_number_of_threads() {
    let case = case("coulomb");
    let effects = vec![shared::effects::Kind::Coulomb];
    for solver in solve::all() {
        same(solver.name(), || {
            let options = Options {
                effects: effects.clone(),
                budget: BUDGET,
                ..Options::default()
            };
            let stop = AtomicBool::new(false);
            let problem = fit::problem(&case.fitted, &options).expect("a problem");
            let found = fit::search(&problem, solver.as_ref(), &options, &stop, &mut |_, _| {});
            Fit::conclude(
                &problem,
                solver.name(),
                "squared",
                &found,
                &options,
                Some(&case.held_out),
            )
            .expect("a fit")
        });
    }
}

#[test]
fn comparisons_do_not_depend_on_the_number_of_threads() {
    let case = case("coulomb");
    same("compare", || {
        let problem = fit::problem(&case.fitted, &Options::default()).expect("a problem");
        let contest = Contest {
            problem: &problem,
            budget: BUDGET,
            seeds: (1..=5).collect(),
        };
        let stop = AtomicBool::new(false);
        let rows = compare::run(&contest, &solve::all(), &stop, &|| ());
        // All but the time that they took.
        let runs = rows.into_iter().map(|row| (row.algorithm, row.runs));
        runs.collect::<Vec<_>>()
    });
}

#[test]
fn diagnoses_do_not_depend_on_the_number_of_threads() {
    for hidden in ["cogging", "compliance"] {
        let case = case(hidden);
        same(hidden, || {
            let stop = AtomicBool::new(false);
            let options = Options::default();
            search_catalogue(
                &case.fitted,
                &case.held_out,
                &options,
                &Budget::usual(&stop),
                &|| (),
            )
            .expect("a diagnosis")
        });
    }
}
