//! A Python module with constants and the exact step; laws are functions that take numpy's arrays.

use super::comment::{head, marked, plain};
use super::constants::constants;
use super::error::ExportError;
use super::law_code::functions;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use servoid_formula::Language;

pub(super) fn write(subject: &Subject, options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let constants = constants(subject, options, "python", &mut written)?;
    let mut text = marked(&head(subject, &written), "# ");
    text += "\n";
    text += &marked(&constants.step, "# ");
    text += "\n";
    for constant in &constants.list {
        let about = plain(&constant.about);
        text += &format!("{} = {:?}  # {about}\n", constant.name, constant.value);
    }
    let laws = functions(subject, Language::Python, "# ", &mut written);
    if !laws.is_empty() {
        text += "\nimport numpy as np\n\n";
        text += &laws;
    }
    written.text = text;
    Ok(written)
}
