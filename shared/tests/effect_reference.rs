//! The book's catalogue of effects is what the effects say about themselves. After a change, write it anew with
//! `UPDATE_REFERENCE=1 cargo test -p shared --test effect_reference`.

use shared::effects::{Description, Kind, Place};
use std::{env, fs, path::Path};

const BEGIN: &str = "# Catalogue of effects

From the `DESCRIPTION` of each file in `shared/src/effects/`, in the order of their numbers on the wire. Torques are in V, referred to the winding.
Viscous friction is part of the linear motor.

| name | acts on | equation | sign in the residual | exposed by | look-alikes |
|---|---|---|---|---|---|
";
const SOURCES: &str = "
## Sources

| name | source |
|---|---|
";

fn place(place: Place) -> &'static str {
    match place {
        Place::Drive => "drive",
        Place::Winding => "winding",
        Place::Torque => "torque",
        Place::Friction => "friction",
        Place::Load => "load",
        Place::Sensed => "sensed",
    }
}

fn row(effect: &Description) -> String {
    let alike: Vec<String> = effect
        .look_alikes
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    format!(
        "| `{}`: {} | {} | `{}` | {} | {} | {} |\n",
        effect.name,
        effect.title,
        place(effect.place),
        effect.equation.replace('|', "\\|"),
        effect.signature,
        effect.exposed_by,
        alike.join(", ")
    )
}

#[test]
fn the_book_lists_every_effect_as_it_describes_itself() {
    let effects: Vec<&Description> = Kind::ALL.iter().map(|kind| kind.description()).collect();
    let rows: String = effects.iter().map(|effect| row(effect)).collect();
    let sources = effects
        .iter()
        .map(|effect| format!("| `{}` | {} |\n", effect.name, effect.source));
    let text = BEGIN.to_owned() + &rows + SOURCES + &sources.collect::<String>();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/book/src/reference/effects.md");
    if env::var_os("UPDATE_REFERENCE").is_some() {
        fs::write(&page, &text).expect("the book is beside this crate");
    }
    let book = fs::read_to_string(&page).expect("the book is beside this crate");
    assert!(
        book == text,
        "docs/book/src/reference/effects.md is not what the effects say: run this test with UPDATE_REFERENCE=1"
    );
}
