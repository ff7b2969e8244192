//! The results as JSON Schema, made from their types.

use crate::export::Motor;
use crate::schema::check::Check;
use crate::schema::coverage::Coverage;
use crate::schema::effects::Effects;
use crate::schema::opened::Opened;
use crate::schema::{Contest, Demo, DeviceRun, Diagnosis, Fit, Plan, Proof, Steady, Verification};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

/// One result as JSON Schema.
pub struct Reference {
    /// Name of its file, without the ending.
    pub name: &'static str,
    /// What is written; a reader needs no more than it uses.
    pub schema: Schema,
}

/// The schemas of all results.
pub fn all() -> Vec<Reference> {
    vec![
        of::<Opened>("open"),
        of::<Effects>("effects"),
        of::<Check>("check"),
        of::<Fit>("fit"),
        of::<Demo>("demo"),
        of::<Diagnosis>("diagnosis"),
        of::<Steady>("steady"),
        of::<Contest>("compare"),
        of::<Plan>("plan"),
        of::<Proof>("prove"),
        of::<Coverage>("coverage"),
        of::<DeviceRun>("device"),
        of::<Verification>("verify"),
        of::<Motor<'_>>("motor"),
    ]
}

fn of<T: JsonSchema>(name: &'static str) -> Reference {
    let generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    Reference {
        name,
        schema: generator.into_root_schema_for::<T>(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    /// Where the book has them.
    const BOOK: &str = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/book/src/reference/schema"
    );

    /// `UPDATE_REFERENCE=1 cargo test -p servoid-results reference` writes them anew.
    #[test]
    fn the_reference_in_the_book_is_that_of_the_types() {
        let update = std::env::var_os("UPDATE_REFERENCE").is_some();
        let page = fs::read_to_string(Path::new(BOOK).with_extension("md")).expect("a page");
        let mut names = Vec::new();
        for Reference { name, schema } in all() {
            let file = Path::new(BOOK).join(format!("{name}.json"));
            let text = serde_json::to_string_pretty(&schema).expect("JSON") + "\n";
            if update {
                fs::create_dir_all(BOOK).expect("a folder");
                fs::write(&file, &text).expect("a file");
            }
            let book = fs::read_to_string(&file).unwrap_or_default();
            assert!(
                book == text,
                "{} is not that of the types: UPDATE_REFERENCE=1 cargo test -p servoid-results reference",
                file.display()
            );
            let link = format!("(schema/{name}.json)");
            assert!(page.contains(&link), "schema.md lacks {link}");
            names.push(format!("{name}.json"));
        }
        for entry in fs::read_dir(BOOK).expect("a folder") {
            let name = entry.expect("a file").file_name();
            let name = name.to_string_lossy().into_owned();
            assert!(names.contains(&name), "{name} belongs to no result");
        }
    }

    #[test]
    fn every_key_of_the_reference_says_what_it_means() {
        for Reference { name, schema } in all() {
            let whole = schema.as_value();
            let parts = whole["$defs"].as_object().into_iter().flatten();
            for part in std::iter::once(whole).chain(parts.map(|(_, part)| part)) {
                for (key, value) in part["properties"].as_object().into_iter().flatten() {
                    assert!(value["description"].is_string(), "{name}: {key}: {value}");
                }
            }
        }
    }
}
