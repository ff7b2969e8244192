//! What stands first on a page that is kept: of which motor it is, and of which day.

use jiff::Timestamp;
use servoid_results::page::Page;

/// Puts the motor's name, if it has one, and today's date (UTC) before the other facts.
pub(crate) fn titled(mut page: Page, motor: Option<&str>) -> Page {
    let day = Timestamp::now().strftime("%Y-%m-%d (UTC)").to_string();
    let name = motor.map(|name| ("motor".to_owned(), name.to_owned()));
    let first = name.into_iter().chain([("date".to_owned(), day)]);
    page.facts.splice(0..0, first);
    page
}
