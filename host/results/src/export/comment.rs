//! The head of every file that takes comments, and text that no comment can end early.

use super::subject::Subject;
use super::written::Written;

/// What every file says first, a line each.
pub(super) fn head(subject: &Subject, written: &Written) -> Vec<String> {
    let mut lines = vec![format!(
        "made by servoid {} from {} ({})",
        env!("CARGO_PKG_VERSION"),
        plain(&subject.source),
        subject.schema
    )];
    if let Some(recording) = &subject.recording {
        lines.push(format!("recording: {}", plain(recording)));
    }
    lines.push(format!("all numbers: {}", subject.side.words()));
    lines.extend(written.lines());
    lines
}

/// The lines behind a mark, as in `# `.
pub(super) fn marked(lines: &[String], mark: &str) -> String {
    let mut out = String::new();
    for line in lines {
        out.push_str(&format!("{mark}{}\n", plain(line)));
    }
    out
}

/// The lines as comment of XML, which may not hold two hyphens in a row nor end in one.
pub(super) fn xml(lines: &[String]) -> String {
    let mut out = String::from("<!--\n");
    for line in lines {
        let mut line = plain(line);
        while line.contains("--") {
            line = line.replace("--", "- -");
        }
        out.push_str(&format!("  {line}\n"));
    }
    out + "-->\n"
}

/// Foreign text on one line, without what would end a comment of C.
pub(super) fn plain(text: &str) -> String {
    let text: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    text.replace("*/", "* /").replace("/*", "/ *")
}
