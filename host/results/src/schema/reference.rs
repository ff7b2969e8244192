//! The results as JSON Schema, made from their types.

use super::{Contest, Demo, DeviceRun, Diagnosis, Fit, Plan, Proof, Steady, Verification};
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
        of::<Fit>("fit"),
        of::<Demo>("demo"),
        of::<Diagnosis>("diagnosis"),
        of::<Steady>("steady"),
        of::<Contest>("compare"),
        of::<Plan>("plan"),
        of::<Proof>("prove"),
        of::<DeviceRun>("device"),
        of::<Verification>("verify"),
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
