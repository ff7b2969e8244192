//! Effects that are too small to matter. A model may come down to the encoder's floor by what an effect brings with it, and not by
//! the effect: flanks about a gap of nothing swing as a spring does, and beside a sag of nothing viscous friction is free. Such an
//! effect is not named, whatever its error says.

use super::models::FittedModel;
use crate::diagnose::settings::{PART_OF_COUNT, PART_OF_TYPICAL};
use servoid_engine::problem::Data;
use shared::effects::{Kind, Pair, Parameter};
use shared::units::Quantity;
use std::f64::consts::TAU;

/// An effect of a model that is too small to matter.
pub fn small_in(data: &Data, model: &FittedModel) -> Option<Kind> {
    let small = |kind: &Kind| is_small(*kind, &model.values_of(*kind), data);
    model.effects.iter().copied().find(small)
}

/// Whether an effect with these values, SI, is too small to matter in a recording.
fn is_small(kind: Kind, values: &[f64], data: &Data) -> bool {
    if kind.facts().by_chance || values.is_empty() {
        return false;
    }
    let count = TAU / data.units.counts_per_rev;
    let small = |parameter: &Parameter, value: f64| {
        let typical = parameter.scaled(parameter.typical, data.supply, data.units.speed);
        let below_count =
            parameter.quantity == Quantity::Angle && value.abs() < PART_OF_COUNT * count;
        below_count || value.abs() < PART_OF_TYPICAL * typical.abs()
    };
    let parameters = kind.parameters();
    if let (Some(Pair::Difference), [one, other, ..]) = (kind.facts().pair, values) {
        return small(&parameters[0], one - other);
    }
    let sizes = parameters.iter().zip(values);
    let mut sizes = sizes
        .filter(|(parameter, _)| parameter.amplitude)
        .peekable();
    sizes.peek().is_some() && sizes.all(|(parameter, &value)| small(parameter, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::showcase;
    use servoid_plant::Hidden;

    /// For every effect of the catalogue that has a size.
    #[test]
    fn an_effect_of_typical_size_matters_and_a_thousandth_of_it_does_not() {
        let hidden = Hidden::typical("coulomb", &showcase::machine()).unwrap();
        let data = Data::new(&showcase::record(std::slice::from_ref(&hidden), 1, "bench").unwrap())
            .unwrap();
        let mut tried = 0;
        for &kind in Kind::ALL {
            let parameters = kind.parameters();
            if kind.facts().by_chance || !parameters.iter().any(|p| p.amplitude) {
                continue;
            }
            let typical = |p: &Parameter| p.scaled(p.typical, data.supply, data.units.speed);
            let mut values: Vec<f64> = parameters.iter().map(typical).collect();
            if kind.facts().pair == Some(Pair::Difference) {
                values[1] = 0.0;
            }
            assert!(!is_small(kind, &values, &data), "{}", kind.name());
            for (value, parameter) in values.iter_mut().zip(parameters) {
                if parameter.amplitude {
                    *value *= 1e-3;
                }
            }
            assert!(is_small(kind, &values, &data), "{}", kind.name());
            tried += 1;
        }
        assert!(tried > 15, "{tried}");
    }
}
