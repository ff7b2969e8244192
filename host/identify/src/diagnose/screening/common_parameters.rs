//! What one model has found, carried over to another as its start.

use shared::effects::{Kind, Parameter};

/// A model's effects, the same one more than once where it is there in several orders, and the values of their
/// parameters.
#[derive(Clone, Copy)]
pub struct EffectValues<'a> {
    /// The effects.
    pub effects: &'a [Kind],
    /// Their values, one effect after the other.
    pub values: &'a [f64],
}

impl EffectValues<'_> {
    fn parameters(&self) -> Vec<(Kind, &'static Parameter)> {
        let of = |&kind: &Kind| {
            let parameters = kind.parameters().iter();
            parameters.map(move |parameter| (kind, parameter))
        };
        self.effects.iter().flat_map(of).collect()
    }
}

/// The values of `own` with those of `other` in the place of all that both know: parameters of one name, and the
/// sizes of two effects that stand in each other's place, if they have one unit. Friction and a dead zone of so many
/// volts are the same to a motor that turns slowly.
pub fn with_common_parameters(own: EffectValues<'_>, other: EffectValues<'_>) -> Vec<f64> {
    let theirs = other.parameters();
    let value = |(&(kind, parameter), &value): (&(Kind, &Parameter), &f64)| {
        let common = |&(k, p): &(Kind, &Parameter)| {
            p.name == parameter.name && (k == kind || !own.effects.contains(&k))
        };
        let as_large = |&(k, p): &(Kind, &Parameter)| {
            let sizes = p.amplitude && parameter.amplitude;
            let instead = !other.effects.contains(&kind) && !own.effects.contains(&k);
            sizes && instead && p.quantity.unit() == parameter.quantity.unit()
        };
        let place = theirs.iter().position(common);
        let place = place.or_else(|| theirs.iter().position(as_large));
        place.map_or(value, |place| other.values[place])
    };
    own.parameters().iter().zip(own.values).map(value).collect()
}
