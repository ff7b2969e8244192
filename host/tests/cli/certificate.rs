//! `servoid fit --certificate`.

use crate::contract::{list, number};
use crate::desk::Desk;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.done("simulate --seconds 5 --seed 1 --out linear.csv");
    desk.done("simulate --seconds 5 --seed 2 --hide coulomb --out rubs.csv");
    desk
}

#[test]
fn every_reading_is_reproduced_or_a_few_say_why_not() {
    let desk = desk();
    let linear = &desk.json("fit linear.csv --certificate")["certificate"];
    assert_eq!(linear["feasible"], true, "{linear}");
    assert_eq!(linear["reproduced"], linear["readings"]);
    for bounds in list(linear, "bounds") {
        assert!(number(bounds, "low") < number(bounds, "high"), "{bounds}");
    }
    let refuted = &desk.json("fit rubs.csv --certificate")["certificate"];
    assert_eq!(refuted["feasible"], false, "{refuted}");
    assert!(list(refuted, "bounds").is_empty() && number(refuted, "room_counts") < 0.0);
    let few = list(refuted, "contradiction");
    assert!((2..=5).contains(&few.len()), "{refuted}");
    // Models cannot lie on one side of all.
    assert!(
        few.iter().any(|reading| reading["above"] == true),
        "{refuted}"
    );
    assert!(
        few.iter().any(|reading| reading["above"] == false),
        "{refuted}"
    );
}

#[test]
fn what_makes_no_inequalities_is_refused_with_the_remedy() {
    let desk = desk();
    for (line, says) in [
        ("fit linear.csv rubs.csv --certificate", "give one"),
        (
            "fit linear.csv --certificate --window 0.5",
            "leave out --window",
        ),
    ] {
        desk.refused(line, 2, &[says]);
    }
}

#[test]
fn the_report_draws_where_the_model_is_refuted() {
    let desk = desk();
    desk.done("fit rubs.csv --certificate --report page.html");
    assert!(
        desk.read("page.html")
            .contains("Where the model is refuted")
    );
    desk.done("fit linear.csv --certificate --report page.html");
    assert!(desk.read("page.html").contains("Bounds of the parameters"));
}
