//! `servoid effects`: what can be told of the catalogue.

use crate::error::Error;
use crate::session::Session;
use servoid_results::report::effects::text;
use servoid_results::schema::effects::Effects;
use shared::effects::Kind;

pub(super) fn run(session: &Session, name: Option<&str>) -> Result<(), Error> {
    session.check_outputs(&[], &[])?;
    let effects = Effects::new(name.and_then(Kind::by_name));
    session.deliver(&text(&effects), &effects)
}
