//! Sentences folded for a terminal of 80 columns.

/// Width of the text.
const WIDTH: usize = 78;

/// Folded to the width, further lines behind `indent`; spaces within the first line's head are kept.
pub fn folded(text: &str, indent: &str) -> String {
    folded_to(WIDTH, text, indent)
}

/// The same to another width, columns.
pub fn folded_to(width: usize, text: &str, indent: &str) -> String {
    let head = text.len() - text.trim_start().len();
    let mut out = String::new();
    let mut line = text[..head].to_owned();
    for word in text[head..].split(' ') {
        let long = line.chars().count() + 1 + word.chars().count() > width;
        if long && !line.trim().is_empty() {
            out += line.trim_end();
            out.push('\n');
            line = indent.to_owned();
            line += word;
        } else {
            if line.len() > head || !line.trim().is_empty() {
                line.push(' ');
            }
            line += word;
        }
    }
    out + line.trim_end()
}
