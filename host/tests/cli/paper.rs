//! The paper's table beside ours.

use crate::contract::{are_margins, has, is_comparison, is_row, list, number};
use crate::desk::Desk;

const LINE: &str = "paper --seeds 2 --population 5 --iterations 40";

/// Table 1 as printed: gain margin in dB, phase margin in degrees.
const PRINTED: &[(&str, f64, f64)] = &[
    ("actual", 11.4, 23.7),
    ("pso", 11.8, 24.0),
    ("ga", 23.3, 29.2),
    ("firefly", 11.8, 24.0),
];

#[test]
fn the_papers_margins_follow_from_its_parameters_to_the_printed_digit() {
    let paper = Desk::new().json(LINE);
    is_comparison(&paper);
    let rows = list(&paper, "rows");
    assert_eq!(rows.len(), PRINTED.len());
    for (row, &(name, gain_db, phase_deg)) in rows.iter().zip(PRINTED) {
        assert_eq!(row["algorithm"], name);
        let column = &row["paper"];
        has(column, "cost: number?, parameters: object");
        assert_eq!(column["cost"].is_null(), name == "actual", "{column:#}");
        assert_eq!(
            column["parameters"].as_object().expect("an object").len(),
            6
        );
        are_margins(&column["margins_printed"]);
        are_margins(&column["margins_computed"]);
        for (key, printed) in [("gain_db", gain_db), ("phase_deg", phase_deg)] {
            assert_eq!(number(&column["margins_printed"], key), printed, "{name}");
            let computed = number(&column["margins_computed"], key);
            assert_eq!(
                format!("{computed:.1}"),
                format!("{printed:.1}"),
                "{key} of {name}"
            );
        }
    }
}

#[test]
fn our_runs_stand_beside_the_papers() {
    let paper = Desk::new().json(LINE);
    let methods = servoid_engine::solve::names();
    for row in list(&paper, "rows") {
        let name = row["algorithm"].as_str().expect("a name");
        if methods.contains(&name) {
            is_row(row, 200.0);
            assert_eq!(
                row["parameters"].as_object().expect("an object").len(),
                6,
                "{name}"
            );
        }
    }
}

#[test]
fn plots_and_remarks_come_with_it() {
    let desk = Desk::new();
    desk.write("plots/keep.txt", "");
    let outcome = desk.done(&format!("{LINE} --plots plots"));
    assert!(outcome.stdout.contains("cannot be reproduced"), "{outcome}");
    let drawings: Vec<_> = desk
        .listing()
        .into_keys()
        .filter(|path| path.extension().is_some_and(|e| e == "svg"))
        .collect();
    assert!(
        drawings.iter().any(|path| path.ends_with("plots/bode.svg")),
        "{drawings:?}"
    );
    assert!(
        drawings
            .iter()
            .any(|path| path.to_string_lossy().contains("cost-curves")),
        "{drawings:?}"
    );
    for path in drawings {
        let drawing = std::fs::read_to_string(&path).expect("readable");
        assert!(
            drawing.starts_with("<svg") && drawing.contains("</svg>"),
            "{}",
            path.display()
        );
        assert!(!drawing.contains("NaN"), "{}", path.display());
    }
}
