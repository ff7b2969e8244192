//! The same seed gives the same bytes; another seed gives others.

use serde_json::Value;

use crate::desk::Desk;

/// Takes out what may differ: computing time.
pub fn without_times(value: &mut Value) {
    match value {
        Value::Object(object) => {
            object.remove("wall_s");
            object.values_mut().for_each(without_times);
        }
        Value::Array(list) => list.iter_mut().for_each(without_times),
        _ => {}
    }
}

#[test]
fn the_same_seed_gives_the_same_json_twice() {
    let desk = Desk::with_recording();
    let mut lines = vec![
        "compare rec.csv --seeds 3 --budget 200".to_owned(),
        "paper --seeds 2 --population 5 --iterations 20".to_owned(),
        "fit rec.csv --with coulomb,cogging --validate rec.csv".to_owned(),
        "demo".to_owned(),
    ];
    lines.extend(
        servoid_engine::solve::names()
            .iter()
            .map(|name| format!("fit rec.csv --algorithm {name} --budget 150")),
    );
    for line in &lines {
        let run = || {
            let mut json = desk.json(&format!("{line} --seed 7"));
            without_times(&mut json);
            serde_json::to_string(&json).expect("JSON")
        };
        assert_eq!(run(), run(), "{line}");
    }
}

#[test]
fn the_same_seed_gives_the_same_files_twice() {
    for line in [
        "simulate --seconds 2 --jitter 1e-4 --current-noise 0.1 --hide missed_counts --out file",
        "demo --out file",
        "simulate --seconds 2 --excite telegraph --out file",
    ] {
        let made_with = |seed: u64| {
            let desk = Desk::new();
            desk.done(&format!("{line} --seed {seed}"));
            desk.read("file")
        };
        let first = made_with(3);
        assert_eq!(first, made_with(3), "{line}");
        assert_ne!(first, made_with(4), "{line}");
    }
}
