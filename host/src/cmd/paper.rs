//! `servoid paper`.
use crate::cli::PaperArgs;
use crate::error::Error;
use crate::session::Session;
pub(super) fn run(_session: &Session, _args: &PaperArgs) -> Result<(), Error> {
    Ok(())
}
