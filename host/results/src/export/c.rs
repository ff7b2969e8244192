//! A C header (C99 and later, C++ too) with constants in single precision and the exact step.

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
    let constants = constants(subject, options, "c", &mut written)?;
    let mut text = String::from("/*\n");
    text += &marked(&head(subject, &written), " * ");
    text += " */\n#ifndef SERVOID_MOTOR_H\n#define SERVOID_MOTOR_H\n\n";
    for constant in &constants.list {
        let about = plain(&constant.about);
        text += &format!(
            "#define SERVOID_{} ({:?}f) /* {about} */\n",
            constant.name, constant.value
        );
    }
    text += "\n/*\n";
    text += &marked(&constants.step, " * ");
    text += " */\n\n";
    let laws = functions(subject, Language::C, "", &mut written);
    if !laws.is_empty() {
        text += "#include <math.h>\n\n";
        text += &laws;
    }
    text += "#endif\n";
    for mapped in &mut written.mapping {
        mapped.to = format!("SERVOID_{}", mapped.to);
    }
    written.text = text;
    Ok(written)
}
