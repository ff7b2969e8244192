//! All parameters as CSV, a row each. Comments begin with `#`.

use super::comment::{head, marked};
use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::table::rows;
use super::written::Written;

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let rows = rows(subject, &mut written);
    let mut text = marked(&head(subject, &written), "# ");
    text += "name,value,unit,std,identifiable,side\n";
    let number = |number: Option<f64>| number.map_or_else(String::new, |x| format!("{x:?}"));
    for row in rows {
        // Names and units are those of servoid and hold neither commas nor quotes.
        text += &format!(
            "{},{},{},{},{},{}\n",
            row.name,
            number(row.value),
            row.unit,
            number(row.std),
            row.identifiable,
            row.side
        );
    }
    written.text = text;
    Ok(written)
}
