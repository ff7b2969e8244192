//! Columns that a recording must have and has not, and how to map them.

use super::proposal::Proposal;
use super::shown::quoted_list;

/// A column that the recording must have and has not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingColumn {
    /// Key in `[columns]`.
    pub key: &'static str,
    /// The name looked for.
    pub wanted: String,
    /// Whether the user's `[columns]` asked for that name.
    pub mapped: bool,
    /// The name in the header that is spelt nearly like it, or else means the same.
    pub near: Option<String>,
}

/// What the values of the columns tell of a log that nobody has described.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// What would be written into a `motor.toml`.
    toml: String,
    /// The same as options.
    options: String,
    /// What keeps it from being taken, a sentence each.
    doubts: Vec<String>,
}

impl Advice {
    pub(super) fn of(proposal: &Proposal) -> Self {
        let blanks = proposal.needs.iter().map(|need| need.option.clone());
        let options: Vec<String> = proposal.options().into_iter().chain(blanks).collect();
        Advice {
            toml: proposal.motor.to_toml().trim_end().replace('\n', "\n    "),
            options: options.join(" "),
            doubts: proposal.doubts.clone(),
        }
    }
}

/// All missing columns in one message, and the lines that map what the header has.
pub(super) fn missing_text(
    missing: &[MissingColumn],
    header: &[String],
    motor: &str,
    advice: Option<&Advice>,
) -> String {
    let wanted: Vec<&str> = missing
        .iter()
        .map(|column| column.wanted.as_str())
        .collect();
    let plural = if missing.len() == 1 {
        "column"
    } else {
        "columns"
    };
    let mut text = format!(
        "no {plural} {}; the header has {}",
        quoted_list(&wanted),
        quoted_list(header)
    );
    if missing.iter().any(|column| column.mapped) {
        text += &format!(" ([columns] in {motor} asks for it)");
    }
    if let Some(advice) = advice {
        let Advice {
            toml,
            options,
            doubts,
        } = advice;
        return format!(
            "{text}. It may be read as below, but {}. Say in {motor} which is which:\n    {toml}\nor give {options}",
            doubts.join(", and ")
        );
    }
    let each = missing.iter().map(|column| {
        let near = column.near.as_deref().unwrap_or("...");
        let option = for_shell(&format!("{}={near}", column.key));
        (
            format!("\n    {} = {near:?}", column.key),
            format!(" --column {option}"),
        )
    });
    let (lines, options): (String, String) = each.unzip();
    text + &format!(". Say in {motor} which is which:\n    [columns]{lines}\nor give{options}")
}

/// A word of a command line, quoted where a shell would take it apart.
pub fn for_shell(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-=./".contains(c);
    if word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}
