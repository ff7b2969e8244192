//! The table of the proving ground as text.

use super::DETECTABLE_COUNTS;
use super::tally::words;
use servoid_results::plot::{ReliabilityLine, Statement};
use servoid_results::report::fold::folded_to;
use servoid_results::schema::Proof;
use servoid_results::schema::proof::{
    Confusion, Failure, FormulaGroup, Group, Rate, Reliability, Share, Spread,
};

/// Width of the text, columns.
const WIDTH: usize = 80;
/// Width of a question.
const QUESTION: usize = 50;

/// The table.
pub fn text(proof: &Proof) -> String {
    let set_up = &proof.set_up;
    let effects = match &set_up.effects[..] {
        [] => String::new(),
        some => format!(", {}", some.join(", ")),
    };
    let laws = set_up.laws.as_ref();
    let laws = laws.map_or(String::new(), |laws| format!(", --law {laws}"));
    let mut out = folded(
        &format!(
            "{} of seed {}: --hidden {}, --excite {}{laws}{effects}",
            cases(proof.cases),
            set_up.seed,
            set_up.hidden,
            set_up.excite,
        ),
        "  ",
    );
    for group in &proof.groups {
        out += &group_text(group);
    }
    out += &proof.formula.as_ref().map_or(String::new(), formula_text);
    out += "\nall cases\n";
    for counted in &proof.shares {
        out += &share(
            match counted.name.as_str() {
                "quite_wrong_name" => "a name neither hidden nor a declared look-alike",
                name => words(name),
            },
            counted,
        );
    }
    for Failure { case, reason } in &proof.failures {
        out += &folded(&format!("  case {case} has no diagnosis: {reason}"), "    ");
    }
    let errors = [
        ("sizes", &proof.size_errors_percent),
        ("shapes", &proof.shape_errors_percent),
    ];
    for (what, spread) in errors.into_iter().filter(|(_, spread)| spread.count > 0) {
        out += &format!(
            "  parameter error, {what:6} of effects named rightly: median {}, 90 % below {} %\n",
            number(spread.median),
            number(spread.p90)
        );
    }
    out += &proof
        .reliability
        .as_ref()
        .map_or(String::new(), reliability);
    if !proof.confusions.is_empty() {
        out += &confusions_text(&proof.confusions);
    }
    out
}

/// What a drawing of the probabilities shows.
pub const AXES: [&str; 2] = [
    "stated probability of a set of effects",
    "part of them that is right",
];

/// The probabilities as a drawing has them.
pub fn lines(proof: &Proof) -> Vec<ReliabilityLine> {
    let line = |found: &Reliability| ReliabilityLine {
        name: format!("{} diagnoses", found.diagnoses),
        points: (found.bins.iter())
            .filter_map(|bin| {
                let Rate { part, low, high } = bin.right.rate?;
                Some(Statement {
                    stated: bin.probability,
                    found: part,
                    interval: Some((low, high)),
                })
            })
            .collect(),
    };
    proof.reliability.iter().map(line).collect()
}

/// How often sets are right that have so much probability.
fn reliability(found: &Reliability) -> String {
    let mut out = format!(
        "\nprobabilities of sets: Brier score {:.3} of {}\n",
        found.brier,
        cases(found.diagnoses)
    );
    for bin in &found.bins {
        let says = format!(
            "sets of {:.0} to {:.0} %, {:.0} % in the mean: right",
            100.0 * bin.low,
            100.0 * bin.high,
            100.0 * bin.probability
        );
        out += &share(&says, &bin.right);
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
    for counted in &group.shares {
        out += &share(words(&counted.name), counted);
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

fn formula_text(group: &FormulaGroup) -> String {
    let mut out = format!(
        "\na law outside the catalogue hidden ({} of {} leave > {DETECTABLE_COUNTS} count to the linear motor)\n",
        group.detectable,
        cases(group.cases)
    );
    for counted in &group.shares {
        out += &share(words(&counted.name), counted);
    }
    for (says, spread) in [
        (
            "all named less the law, % of it: median, 90 %, most",
            &group.departure_percent,
        ),
        ("seconds a case: median, 90 %, most", &group.seconds),
    ] {
        out += &format!("  {says:QUESTION$} {}\n", three(spread));
    }
    out += &format!(
        "\n{:22}{:>6}{:>11}{:>13}{:>17}\n",
        "hidden law", "cases", "law named", "within 10 %", "% off: median"
    );
    for form in &group.forms {
        out += &format!(
            "{:22}{:>6}{:>11}{:>13}{:>17}\n",
            form.form,
            form.cases,
            form.law_named,
            form.right_curve,
            number(form.departure_percent.median)
        );
    }
    out
}

/// A question with its count, its rate, and the interval of 95 %.
fn share(says: &str, share: &Share) -> String {
    let of = format!("{}/{}", share.count, share.of);
    match share.rate {
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

/// The text in lines of the table's width, the further ones indented.
pub(crate) fn folded(text: &str, indent: &str) -> String {
    folded_to(WIDTH, text, indent) + "\n"
}
