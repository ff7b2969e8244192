//! A page that stands alone: words, tables and drawings in one file, of which no request leaves.
//!
//! | file | holds |
//! |---|---|
//! | `body` | words, tables and pictures as HTML |
//! | `assets` | style and scripts; plotly's own script, vendored |

pub mod assets;
mod body;

pub use body::{escaped, section};

use crate::picture::{Drawing, Picture, Table};
use serde_json::{Value, json};

/// A page of a title, words, facts and sections.
#[derive(Default)]
pub struct Page {
    /// Title.
    pub title: String,
    /// What it comes to, in a few sentences.
    pub lead: Vec<String>,
    /// Names and values.
    pub facts: Vec<(String, String)>,
    /// Sections in order.
    pub sections: Vec<Section>,
}

/// One section of a [`Page`].
pub struct Section {
    /// Unique on the page.
    pub id: String,
    /// Heading.
    pub heading: String,
    /// Its content.
    pub blocks: Vec<Block>,
}

impl Section {
    /// A section with nothing in it yet.
    pub fn new(id: &str, heading: &str) -> Self {
        Section {
            id: id.to_owned(),
            heading: heading.to_owned(),
            blocks: Vec::new(),
        }
    }
}

/// A piece of a section.
pub enum Block {
    /// A heading within a section.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// Points.
    List(Vec<String>),
    /// Text as it stands, as in a terminal.
    Verbatim(String),
    /// A table under its caption.
    Table(String, Table),
    /// A drawing.
    Picture(Picture),
    /// Small drawings side by side.
    Pictures(Vec<Picture>),
    /// What unfolds when it is clicked, one below the other.
    Unfolds(Vec<Unfold>),
}

/// Something of which a line is shown until it is clicked. A point in a drawing that has its name as its text opens it as well.
pub struct Unfold {
    /// Unique on the page.
    pub name: String,
    /// The line behind its name.
    pub line: String,
    /// What is folded.
    pub blocks: Vec<Block>,
}

impl Block {
    /// Whether it is without drawings.
    fn is_words(&self) -> bool {
        match self {
            Block::Picture(_) | Block::Pictures(_) => false,
            Block::Unfolds(unfolds) => unfolds
                .iter()
                .all(|one| one.blocks.iter().all(Block::is_words)),
            _ => true,
        }
    }
}

/// Nothing may be fetched, whatever the file is asked to do.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

impl Page {
    /// Its words and tables, to stand in another page: without title, drawings and links.
    pub fn words(self) -> Vec<Block> {
        let mut facts = Table::new(&["what", "value"]);
        for (name, value) in self.facts {
            facts.row([name, value]);
        }
        let lead = self.lead.into_iter().map(Block::Text);
        let facts = (!facts.rows.is_empty()).then(|| Block::Table(String::new(), facts));
        let blocks = self.sections.into_iter().flat_map(|section| {
            let words = section.blocks.into_iter().filter(Block::is_words);
            let words: Vec<Block> = words.collect();
            let heading = (!words.is_empty()).then_some(Block::Heading(section.heading));
            heading.into_iter().chain(words)
        });
        lead.chain(facts).chain(blocks).collect()
    }

    /// The page as HTML.
    pub fn render(&self) -> String {
        let title = escaped(&self.title);
        let mut out = format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <title>{title}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n\
             <div class=\"top\"><h1>{title}</h1>\
             <button type=\"button\" class=\"no-print\" data-switch-theme>Light / dark</button></div>\n",
            assets::STYLE
        );
        for text in &self.lead {
            out += &format!("<p class=\"lead\">{}</p>\n", escaped(text));
        }
        out += &body::facts(&self.facts);
        out += &body::contents(&self.sections);
        for section in &self.sections {
            out += &body::section(section);
        }
        out += &format!(
            "</main>\n<footer>Made by servoid {}.</footer>\n",
            env!("CARGO_PKG_VERSION")
        );
        out += &format!(
            "<script type=\"application/json\" id=\"drawings\">{}</script>\n",
            inside_script(&drawings(&self.sections))
        );
        out += &format!(
            "<script type=\"text/plain\" id=\"plotly\">{}</script>\n",
            assets::packed_plotly()
        );
        for script in [assets::PLOTS, assets::REPORT] {
            out += &format!("<script>{script}</script>\n");
        }
        out += "</body>\n</html>\n";
        out
    }
}

/// The drawings of sections by their places.
pub fn drawings(sections: &[Section]) -> Value {
    let blocks = sections.iter().flat_map(|section| &section.blocks);
    let pictures = blocks.flat_map(|block| match block {
        Block::Picture(picture) => std::slice::from_ref(picture),
        Block::Pictures(pictures) => pictures,
        _ => &[],
    });
    Value::Object(pictures.filter_map(drawing).collect())
}

/// A picture's place and its drawing as the page's script takes it, if it has one.
pub fn drawing(picture: &Picture) -> Option<(String, Value)> {
    let drawing = match &picture.drawing {
        Drawing::Chart(plot) => json!({ "chart": plot }),
        Drawing::Timeline(timeline) => json!({ "timeline": timeline }),
        Drawing::Nothing => return None,
    };
    Some((picture.id.clone(), drawing))
}

/// JSON that ends no script.
fn inside_script(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}
