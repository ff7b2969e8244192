//! A whole fit and whole diagnoses, CPU seconds on one core.

use super::clock;
use host::prove::{Case, Excite, HowMany, Laws, SetUp};
use servoid_engine::solve;
use servoid_identify::diagnose::{Budget, search_catalogue};
use servoid_identify::fit::{self, Fit, Options};
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

const CASES: u64 = 5;
const SEED: u64 = 503;

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

fn case(hidden: HowMany, number: u64) -> Case {
    let set_up = SetUp {
        seed: SEED,
        hidden,
        excite: Excite::Commissioning,
        effects: Vec::new(),
        laws: Laws::Own,
        discover: false,
    };
    Case::record(&set_up, number).expect("a case")
}

/// Prints them.
pub fn rows() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread").install(|| {
        let one = case(HowMany::One, 0);
        println!("{:44} {:>10}", "", "s");
        for effects in [
            vec![],
            vec![Kind::Coulomb],
            vec![Kind::Coulomb, Kind::Cogging],
        ] {
            let names: Vec<&str> = effects.iter().map(|kind| kind.name()).collect();
            let options = Options {
                effects: effects.clone(),
                ..Options::default()
            };
            let stop = AtomicBool::new(false);
            let solver = solve::by_name("lm").expect("a method");
            let (seconds, _) = clock::once(|| {
                let problem = fit::problem(&one.fitted, &options).expect("a start");
                let found = fit::search(&problem, solver.as_ref(), &options, &stop, &mut |_, _| {});
                let held_out = Some(&one.held_out);
                Fit::conclude(&problem, "lm", "squared", &found, &options, held_out)
            });
            let what = format!("fit of {} samples, {names:?}", one.fitted.len());
            println!("{what:44} {seconds:10.3}");
        }
        for (hidden, name) in [(HowMany::One, "one effect"), (HowMany::Two, "two effects")] {
            let seconds: Vec<f64> = (0..CASES)
                .map(|number| {
                    let case = case(hidden, number);
                    let stop = AtomicBool::new(false);
                    let options = Options::default();
                    let work = || {
                        search_catalogue(
                            &case.fitted,
                            &case.held_out,
                            &options,
                            &Budget::usual(&stop),
                            &|| (),
                        )
                    };
                    clock::once(work).0
                })
                .collect();
            let most = seconds.iter().fold(0.0f64, |most, s| most.max(*s));
            let what = format!("diagnose, {name} hidden: median of {CASES}, most");
            println!("{what:44} {:10.3} {most:10.3}", median(seconds));
        }
    });
}
