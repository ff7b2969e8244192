//! How often which.

use super::Outcome;
use std::fmt::Write;

/// The table.
pub fn text(outcomes: &[Outcome]) -> String {
    let mut out = String::new();
    for many in 0..=2 {
        let of: Vec<&Outcome> = outcomes
            .iter()
            .filter(|o| o.drawn.hidden.len() == many)
            .collect();
        let seen: Vec<&&Outcome> = of.iter().filter(|o| o.detectable).collect();
        let count = |test: &dyn Fn(&Outcome) -> bool| seen.iter().filter(|o| test(o)).count();
        if of.is_empty() {
            continue;
        }
        let mut seconds: Vec<f64> = of.iter().map(|o| o.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let _ = writeln!(
            out,
            "{many} hidden: {} cases, {} detectable; right first {}, in set {}, all named {}; any name {}; s {:.2} / {:.2} / {:.2}",
            of.len(),
            seen.len(),
            count(&|o| o.right_first()),
            count(&|o| o.right_in_set()),
            count(&|o| o.right_names() == many),
            of.iter().filter(|o| !o.named.is_empty()).count(),
            crate::compare::quantile(&seconds, 0.5),
            crate::compare::quantile(&seconds, 0.9),
            crate::compare::quantile(&seconds, 1.0),
        );
    }
    for o in outcomes {
        if let Some(failure) = &o.failure {
            let _ = writeln!(out, "  case {:4} failed: {failure}", o.case);
        }
    }
    for o in outcomes
        .iter()
        .filter(|o| o.detectable && o.right_names() < o.drawn.hidden.len())
    {
        let named: Vec<&str> = o.named.iter().map(|n| n.effect.as_str()).collect();
        let _ = writeln!(
            out,
            "  case {:4} {:30} named {:20} {}",
            o.case,
            o.drawn.names().join("+"),
            named.join("+"),
            o.verdict
        );
    }
    out
}
