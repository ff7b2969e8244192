//! Words, tables and pictures as HTML.

use super::{Block, Section, Unfold};
use crate::picture::{Drawing, Picture, Table};

/// Text made safe inside HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Names and values in a grid.
pub(super) fn facts(facts: &[(String, String)]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let cells: String = facts
        .iter()
        .map(|(name, value)| {
            format!(
                "<div><dt>{}</dt><dd>{}</dd></div>",
                escaped(name),
                escaped(value)
            )
        })
        .collect();
    format!("<dl class=\"facts\">{cells}</dl>\n")
}

/// Links to the sections.
pub(super) fn contents(sections: &[Section]) -> String {
    let links: String = sections
        .iter()
        .map(|s| format!("<a href=\"#{}\">{}</a>", s.id, escaped(&s.heading)))
        .collect();
    format!("<nav class=\"contents no-print\" aria-label=\"Contents\">{links}</nav>\n")
}

/// A section with its heading.
pub fn section(section: &Section) -> String {
    let blocks: String = section.blocks.iter().map(block).collect();
    format!(
        "<section id=\"{}\">\n<h2>{}</h2>\n{blocks}</section>\n",
        section.id,
        escaped(&section.heading)
    )
}

fn block(block: &Block) -> String {
    match block {
        Block::Heading(text) => format!("<h3>{}</h3>\n", escaped(text)),
        Block::Text(text) => format!("<p>{}</p>\n", escaped(text)),
        Block::List(points) => {
            let points: String = points
                .iter()
                .map(|point| format!("<li>{}</li>", escaped(point)))
                .collect();
            format!("<ul>{points}</ul>\n")
        }
        Block::Verbatim(text) => format!("<pre tabindex=\"0\">{}</pre>\n", escaped(text)),
        Block::Table(caption, content) => table(caption, content),
        Block::Picture(one) => picture(one),
        Block::Pictures(several) => {
            let pictures: String = several.iter().map(picture).collect();
            format!("<div class=\"pictures\">{pictures}</div>\n")
        }
        Block::Unfolds(several) => several.iter().map(unfold).collect(),
    }
}

/// A line that unfolds.
fn unfold(unfold: &Unfold) -> String {
    let name = escaped(&unfold.name);
    let blocks: String = unfold.blocks.iter().map(block).collect();
    format!(
        "<details class=\"unfold\" data-name=\"{name}\"><summary><b>{name}</b> {}</summary>\n{blocks}</details>\n",
        escaped(&unfold.line)
    )
}

/// A table under its caption.
fn table(caption: &str, table: &Table) -> String {
    let head: String = table
        .head
        .iter()
        .map(|name| format!("<th scope=\"col\">{}</th>", escaped(name)))
        .collect();
    let rows: String = table
        .rows
        .iter()
        .map(|row| {
            let cells: String = row
                .iter()
                .map(|cell| format!("<td>{}</td>", escaped(cell)))
                .collect();
            format!("<tr>{cells}</tr>\n")
        })
        .collect();
    let caption = if caption.is_empty() {
        String::new()
    } else {
        format!("<caption>{}</caption>", escaped(caption))
    };
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table>{caption}<thead><tr>{head}</tr></thead>\n<tbody>{rows}</tbody></table></div>\n"
    )
}

/// A figure with the place for its drawing; its numbers folded beneath.
fn picture(picture: &Picture) -> String {
    let (title, caption) = (escaped(&picture.title), escaped(&picture.caption));
    let place = |time: &str, more: &str| {
        format!(
            "<div class=\"plot\" id=\"{}\" role=\"group\" aria-label=\"{title}\"{time}></div>{more}",
            picture.id
        )
    };
    let place = match picture.drawing {
        Drawing::Chart(_) => place("", ""),
        Drawing::Timeline(_) => place(
            " data-time=\"yes\"",
            "<div class=\"cursors scroll\" aria-live=\"polite\"></div>",
        ),
        Drawing::Nothing => String::new(),
    };
    let numbers = picture.table.as_ref().map_or(String::new(), |content| {
        format!(
            "<details{}><summary>The numbers</summary>{}</details>",
            // Where there is nothing else they are what is to be seen.
            if matches!(picture.drawing, Drawing::Nothing) {
                " open"
            } else {
                ""
            },
            table("", content)
        )
    });
    format!(
        "<figure id=\"figure-{}\"><figcaption><h3>{title}</h3><p>{caption}</p></figcaption>{place}{numbers}</figure>\n",
        picture.id
    )
}
