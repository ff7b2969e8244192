//! All output fits a terminal of 80 columns.

use crate::desk::Desk;

/// Columns of a terminal that nobody has widened.
const COLUMNS: usize = 80;

/// No line of what a command printed is wider than a terminal.
pub fn fits_a_terminal(command: &str, printed: &str) {
    for line in printed.lines() {
        assert!(line.chars().count() <= COLUMNS, "{command}: {line}");
    }
}

/// The words of a text that is folded to a terminal, on one line.
pub fn unfolded(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Beside the examples of the help, of which the same is asked where they run.
#[test]
fn no_line_is_wider_than_a_terminal() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --hide coulomb --out friction.csv");
    desk.done("fit friction.csv --with coulomb --json fit.json");
    for line in [
        "paper --seeds 1 --population 5 --iterations 10",
        "fit friction.csv --with coulomb",
        "diagnose friction.csv --json diagnosis.json",
        "report fit.json",
        "report diagnosis.json",
    ] {
        fits_a_terminal(line, &desk.done(line).stdout);
    }
}
