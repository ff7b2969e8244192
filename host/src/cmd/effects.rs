//! `servoid effects`: what can be told of the catalogue, and of laws of the user's own.

use super::formula;
use crate::cli::EffectsArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_io::output::write_whole;
use servoid_results::report::effects::text;
use servoid_results::schema::effects::Effects;
use shared::effects::Kind;
use std::path::Path;

pub(super) fn run(session: &Session, args: &EffectsArgs) -> Result<(), Error> {
    let stated = formula::stated(&args.formulas)?;
    let outputs: Vec<_> = (args.emit_rust.as_deref().into_iter())
        .map(|path| ("--emit-rust", path))
        .collect();
    let inputs = args.formulas.effects.iter();
    let inputs: Vec<_> = inputs.map(|path| ("--effects", &**path)).collect();
    session.check_outputs(&outputs, &inputs)?;
    if let Some(path) = &args.emit_rust {
        emit(path, &stated)?;
    }
    let effects = if stated.is_empty() {
        Effects::new(args.name.as_deref().and_then(Kind::by_name))
    } else {
        Effects::stated(&stated)
    };
    session.deliver(&text(&effects), &effects)
}

/// Writes the laws as statics of Rust.
fn emit(path: &Path, stated: &[Kind]) -> Result<(), Error> {
    if stated.is_empty() {
        return Err(Error::Usage(
            "--emit-rust: there is no law to write; state one by --effect or --effects".to_owned(),
        ));
    }
    let laws = stated
        .iter()
        .filter_map(|kind| servoid_formula::law_of(*kind));
    let laws: Vec<_> = laws.collect();
    let statics: Vec<String> = laws.iter().map(|law| law.rust()).collect();
    let remembers = laws.iter().any(|law| law.formula.program.has_state());
    let state = if remembers { "State, " } else { "" };
    let text = format!(
        "//! Laws that were stated as text: `servoid effects --emit-rust` has written this file.\n\nuse \
         shared::effects::formula::{{Formula, Op, Output, Program, {state}Variable}};\nuse shared::effects::{{Description, Facts, \
         Parameter, Place}};\nuse shared::units::Quantity;\n\n{}",
        statics.join("\n")
    );
    Ok(write_whole(path, |out| out.write_all(text.as_bytes()))?)
}
