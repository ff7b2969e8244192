//! The table of the proving ground, as text and as a document.

use super::{Count, DETECTABLE_COUNTS, Group, Laws, Tally};
use servoid_results::schema::Proof;
use servoid_results::schema::proof::{self, Confusion, Failure, Rate, Spread};

/// Width of the text, columns.
const WIDTH: usize = 80;
/// Width of a question.
const QUESTION: usize = 50;

/// The table.
pub fn text(tally: &Tally) -> String {
    let set_up = &tally.set_up;
    let effects = match &set_up.effects[..] {
        [] => String::new(),
        some => format!(", {}", some.join(", ")),
    };
    let laws = match set_up.laws {
        Laws::Own => String::new(),
        laws => format!(", --law {}", laws.name()),
    };
    let mut out = folded(
        &format!(
            "{} of seed {}: --hidden {}, --excite {}{laws}{effects}",
            cases(tally.cases),
            set_up.seed,
            set_up.hidden.name(),
            set_up.excite.name(),
        ),
        "  ",
    );
    for group in &tally.groups {
        out += &group_text(group);
    }
    out += "\nall cases\n";
    out += &share(
        "a name neither hidden nor a declared look-alike",
        &tally.invented,
    );
    out += &share(
        "held-out RMS above the linear motor's",
        &tally.worse_than_base,
    );
    for (case, reason) in &tally.failures {
        out += &folded(&format!("  case {case} has no diagnosis: {reason}"), "    ");
    }
    let errors = [
        ("sizes", &tally.size_errors),
        ("shapes", &tally.shape_errors),
    ];
    for (what, spread) in errors.into_iter().filter(|(_, spread)| spread.count > 0) {
        out += &format!(
            "  parameter error, {what:6} of effects named rightly: median {}, 90 % below {} %\n",
            number(spread.median),
            number(spread.p90)
        );
    }
    if !tally.confusions.is_empty() {
        out += &confusions_text(&tally.confusions);
    }
    out
}

fn cases(number: u64) -> String {
    match number {
        1 => "1 case".to_owned(),
        _ => format!("{number} cases"),
    }
}

fn group_text(group: &Group) -> String {
    let title = match group.hidden {
        0 => format!("nothing hidden ({})", cases(group.cases)),
        1 => format!(
            "one effect hidden ({} of {} leave > {DETECTABLE_COUNTS} count to the linear motor)",
            group.detectable,
            cases(group.cases)
        ),
        _ => format!(
            "two effects hidden ({} of {}: each alone leaves > {DETECTABLE_COUNTS} count)",
            group.detectable,
            cases(group.cases)
        ),
    };
    let mut out = format!("\n{title}\n");
    for asked in &group.shares {
        out += &share(asked.says, &asked.count);
    }
    out += &format!(
        "  {:QUESTION$} {}\n",
        "seconds a case: median, 90 %, most",
        three(&group.seconds)
    );
    if group.refits.max.is_some_and(|most| most > 0.0) {
        out += &format!(
            "  {:QUESTION$} {}\n",
            "candidates refitted: median, 90 %, most",
            three(&group.refits)
        );
    }
    out
}

/// A question with its count, its rate, and the interval of 95 %.
fn share(says: &str, count: &Count) -> String {
    let of = format!("{}/{}", count.hits, count.of);
    match count.rate() {
        Some(Rate { part, low, high }) => format!(
            "  {says:QUESTION$} {of:>9}{:>6.1}%{:>5.1}-{:.1}\n",
            100.0 * part,
            100.0 * low,
            100.0 * high
        ),
        None => format!("  {says:QUESTION$} {of:>9}\n"),
    }
}

fn three(spread: &Spread) -> String {
    format!(
        "{:>8} {:>8} {:>8}",
        number(spread.median),
        number(spread.p90),
        number(spread.max)
    )
}

/// Three digits, no exponent.
fn number(value: Option<f64>) -> String {
    let Some(value) = value else {
        return "-".to_owned();
    };
    let size = value.abs().max(1e-4).log10().floor() as i32;
    let digits = (2 - size).max(0) as usize;
    format!("{value:.digits$}")
}

fn confusions_text(rows: &[Confusion]) -> String {
    let mut out = format!(
        "\n{:15}{:>6}{:>6}{:>7}{:>8}{:>7}  {}\n",
        "hidden effect", "alone", "right", "in set", "in pair", "named", "alone, it was called"
    );
    for row in rows {
        let called: Vec<String> = row
            .called
            .iter()
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        let counts = format!(
            "{:15}{:>6}{:>6}{:>7}{:>8}{:>7}",
            row.effect, row.alone, row.right, row.in_set, row.paired, row.paired_named
        );
        let indent = " ".repeat(counts.len() + 2);
        out += &folded(&format!("{counts}  {}", called.join(", ")), &indent);
    }
    out
}

/// Breaks a line at blanks so that it fits; further lines begin with `indent`.
fn folded(text: &str, indent: &str) -> String {
    let mut out = String::new();
    let mut line = String::new();
    for word in text.split_inclusive(' ') {
        if line.chars().count() + word.trim_end().chars().count() > WIDTH && !line.trim().is_empty()
        {
            out += line.trim_end();
            out.push('\n');
            line = indent.to_owned();
        }
        line += word;
    }
    out += line.trim_end();
    out.push('\n');
    out
}

/// As the document that is written; `interrupted` where the user stopped the work.
pub fn document(tally: &Tally, interrupted: bool) -> Proof {
    let failures = tally.failures.iter();
    Proof {
        schema: "servoid.prove/1".to_owned(),
        version: tally.version.clone(),
        set_up: proof::SetUp {
            seed: tally.set_up.seed,
            hidden: tally.set_up.hidden.name(),
            excite: tally.set_up.excite.name(),
            effects: tally.set_up.effects.clone(),
            laws: (tally.set_up.laws != Laws::Own).then(|| tally.set_up.laws.name()),
        },
        cases: tally.cases,
        failures: failures
            .map(|(case, reason)| Failure {
                case: *case,
                reason: reason.clone(),
            })
            .collect(),
        shares: vec![
            counted("quite_wrong_name", &tally.invented),
            counted("worse_than_base", &tally.worse_than_base),
        ],
        groups: tally.groups.iter().map(group).collect(),
        size_errors_percent: tally.size_errors,
        shape_errors_percent: tally.shape_errors,
        confusions: tally.confusions.clone(),
        interrupted,
    }
}

fn group(group: &Group) -> proof::Group {
    let shares = group.shares.iter();
    proof::Group {
        hidden: group.hidden,
        cases: group.cases,
        detectable: group.detectable,
        shares: shares
            .map(|share| counted(share.name, &share.count))
            .collect(),
        seconds: group.seconds,
        refits: group.refits,
    }
}

fn counted(name: &str, count: &Count) -> proof::Share {
    proof::Share {
        name: name.to_owned(),
        count: count.hits,
        of: count.of,
        rate: count.rate(),
    }
}
