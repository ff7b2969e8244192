//! A Rust module with constants in single precision and the exact step.

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
    let constants = constants(subject, options, "rust", &mut written)?;
    // Plain comments and no inner documentation, so that the file can be included anywhere.
    let mut text = marked(&head(subject, &written), "// ");
    text += "\n";
    text += &marked(&constants.step, "// ");
    for constant in &constants.list {
        let about = plain(&constant.about);
        text += &format!(
            "\n/// {about}.\npub const {}: f32 = {:?};\n",
            constant.name, constant.value
        );
    }
    let laws = functions(subject, Language::Rust, "/// ", &mut written);
    if !laws.is_empty() {
        text += "\n// The laws need the crate `libm`.\n";
        text += &laws;
    }
    written.text = text;
    Ok(written)
}
