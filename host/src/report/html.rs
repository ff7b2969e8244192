//! One self-contained page: text and drawings, nothing fetched.

/// A page of a title, and of sections with a heading, text and perhaps a drawing.
#[derive(Clone, Debug)]
pub struct Page {
    /// Title.
    pub title: String,
    /// Sections in order.
    pub sections: Vec<Section>,
}

/// One section of a [`Page`].
#[derive(Clone, Debug)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// Preformatted text.
    pub text: String,
    /// A drawing as SVG text.
    pub drawing: Option<String>,
}

/// Light and dark; drawings stay on white, as they were made.
const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;\
color:#1e1e1e;background:#fff}pre{overflow-x:auto;font-size:.85rem;background:#f4f4f2;padding:.8rem;border-radius:4px}\
svg{max-width:100%;height:auto;background:#fff;border-radius:4px}\
@media(prefers-color-scheme:dark){body{color:#e8e8e6;background:#17181a}pre{background:#242629}}";

impl Page {
    /// The page as HTML.
    pub fn render(&self) -> String {
        let mut out = format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
             <title>{0}</title>\n<style>{STYLE}</style>\n<h1>{0}</h1>\n",
            escaped(&self.title)
        );
        for section in &self.sections {
            out += &format!("<h2>{}</h2>\n", escaped(&section.heading));
            if let Some(svg) = &section.drawing {
                out += &with_view_box(svg);
                out.push('\n');
            }
            if !section.text.is_empty() {
                out += &format!("<pre>{}</pre>\n", escaped(&section.text));
            }
        }
        out += "</html>\n";
        out
    }
}

/// Text made safe inside HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// The drawing with a role for screen readers.
fn with_view_box(svg: &str) -> String {
    svg.replacen("<svg ", "<svg role=\"img\" ", 1)
}
