//! All output fits a terminal of 80 columns.

use crate::desk::Desk;

/// Columns of a terminal that nobody has widened.
const COLUMNS: usize = 80;

#[test]
fn no_line_is_wider_than_a_terminal() {
    let desk = Desk::with_recording();
    desk.done("simulate --seconds 4 --hide coulomb --out friction.csv");
    desk.done("fit friction.csv --with coulomb --json fit.json");
    for line in [
        "demo --hide enc_ecc",
        "demo --blind --seed 5",
        "paper --seeds 1 --population 5 --iterations 10",
        "compare rec.csv --seeds 2 --budget 40 --algorithm ga,pso,firefly",
        "fit friction.csv --with coulomb",
        "diagnose friction.csv --json diagnosis.json",
        "report fit.json",
        "report diagnosis.json",
    ] {
        let output = desk.done(line).stdout;
        for text in output.lines() {
            assert!(text.chars().count() <= COLUMNS, "{line}: {text}");
        }
    }
}
