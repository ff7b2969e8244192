//! What each effect of the catalogue leaves in a recording, for a bench on which nothing lies yet. It is drawn of the virtual bench's motor when the
//! program is made, and a law compares the file with what the program would draw.

/// Every effect with its signature, if a quantity tells it, as JSON.
pub(super) const EFFECTS: &str = include_str!("assets/gallery.json");

#[cfg(test)]
mod tests {
    use super::EFFECTS;
    use crate::workbench::proposals::drawn;
    use rayon::prelude::*;
    use serde_json::{Value, json};
    use servoid_engine::problem::Data;
    use servoid_engine::simulation::Method;
    use servoid_identify::residual_analysis::signature;
    use servoid_identify::truth;
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::Kind;

    /// Digits of a small drawing.
    fn rounded(value: &Value) -> Value {
        match value {
            Value::Number(number) => {
                let text = format!("{:.3e}", number.as_f64().unwrap_or(0.0));
                json!(text.parse::<f64>().unwrap_or(0.0))
            }
            Value::Array(all) => Value::Array(all.iter().map(rounded).collect()),
            other => other.clone(),
        }
    }

    fn entry(kind: Kind) -> Value {
        let machine = showcase::machine();
        let hidden = [Hidden::typical(kind.name(), &machine).expect("an effect")];
        let recording = showcase::record(&hidden, 1, kind.name()).expect("a recording");
        let candidate = truth::model(&machine, &hidden, showcase::COUNTS_PER_REV).expect("a model");
        let data = Data::new(&recording).expect("data");
        let found = signature(&data, &candidate, kind, Method::default());
        let description = kind.description();
        let drawn = found.as_ref().map(|found| {
            let own = drawn(found);
            json!({ "against": own["against"], "unit": own["unit"], "curve": rounded(&own["curve"]) })
        });
        json!({
            "effect": kind.name(),
            "title": description.title,
            "said": description.signature,
            "signature": drawn,
        })
    }

    /// `UPDATE_REFERENCE=1 cargo test -p host --lib gallery` writes the file anew.
    #[test]
    fn the_gallery_is_what_the_catalogue_leaves() {
        let effects: Vec<Value> = Kind::ALL.par_iter().map(|&kind| entry(kind)).collect();
        let lines: Vec<String> = effects.iter().map(Value::to_string).collect();
        let text = format!("[\n{}\n]\n", lines.join(",\n"));
        if std::env::var_os("UPDATE_REFERENCE").is_some() {
            let path = concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/src/workbench/assets/gallery.json"
            );
            std::fs::write(path, &text).expect("written");
            return;
        }
        assert!(
            text == EFFECTS,
            "the gallery is stale: write it anew with UPDATE_REFERENCE=1 cargo test -p host --lib gallery"
        );
    }
}
