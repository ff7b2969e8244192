//! Effects that are too small to matter. A model may come down to the encoder's floor by what an effect brings with it, and not by
//! the effect: flanks about a gap of nothing swing as a spring does, and beside a sag of nothing viscous friction is free. Such an
//! effect is not named, whatever its error says.

use super::candidate::polish::polish;
use super::candidate::search::fit_problem;
use super::context::Context;
use super::models::FittedModel;
use super::selection::{backward_elimination, judge};
use crate::fit::uncertainty::uncertainty;
use servoid_engine::problem::Data;
use shared::effects::{Kind, Pair, Parameter};
use shared::units::Quantity;
use std::f64::consts::TAU;

/// Part of its typical size below which an effect is negligible: of a voltage or a torque, about 1e-4 of the supply.
const PART_OF_TYPICAL: f64 = 1.0 / 300.0;
/// Part of a count below which an angle is.
const PART_OF_COUNT: f64 = 0.1;
/// A size that is not so many standard errors from nothing is not known to be there.
const STANDARD_ERRORS: f64 = 3.0;

/// `chosen`, or the best other model where an effect of it is negligible: of those in `known` without such an effect that do as
/// well, else what is left without the effect. `None` where that is the linear motor.
pub fn without_negligible(
    context: &Context<'_>,
    chosen: FittedModel,
    known: &[FittedModel],
) -> Option<FittedModel> {
    let mut chosen = chosen;
    while let Some(place) = negligible_in(context, &chosen) {
        let does_as_well = |model: &&FittedModel| {
            !model.effects.contains(&place)
                && small_in(context.data, model).is_none()
                && !judge::removes(model, &chosen)
        };
        let other = known.iter().filter(does_as_well);
        let other = other.min_by(|a, b| a.by_score(b)).cloned();
        let rest = || match chosen.effects.len() {
            0 | 1 => None,
            _ => backward_elimination::left(context, &chosen, place),
        };
        let model = other.or_else(rest)?;
        let fewer = model.effects.len() < chosen.effects.len();
        // What is chosen in its place is brought to its end as the chosen one was.
        chosen = if model.is_proven() {
            model
        } else {
            polish(context, &model).unwrap_or(model)
        };
        // An equal that was found on another way is not looked at again.
        if !fewer {
            break;
        }
    }
    Some(chosen)
}

/// An effect of a model that is too small to matter, or not known to be there.
fn negligible_in(context: &Context<'_>, model: &FittedModel) -> Option<Kind> {
    small_in(context.data, model).or_else(|| unsure_in(context, model))
}

/// An effect of a model that is too small to matter.
pub(super) fn small_in(data: &Data, model: &FittedModel) -> Option<Kind> {
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

/// An effect none of whose sizes is known to be there. Only where the model's own run says so: an error under an observer has no
/// such standard errors.
fn unsure_in(context: &Context<'_>, model: &FittedModel) -> Option<Kind> {
    if model.losses.is_some() || model.observed.is_some() {
        return None;
    }
    let problem = fit_problem(context, &model.structure, model.method);
    let values = model.structure.values(&model.x);
    let spread = uncertainty(&problem, &values).ok()??;
    if !spread.converged {
        return None;
    }
    let is_known = |name: &str| {
        let places = model.structure.unknowns.iter().enumerate();
        let mut places = places.filter(|(_, unknown)| unknown.name == name);
        places.any(|(k, _)| {
            let std = spread.std(k);
            std.is_none_or(|std| values[k].abs() >= STANDARD_ERRORS * std)
        })
    };
    let is_unsure = |kind: &Kind| {
        // Each of a pair may be uncertain where their difference is not.
        if kind.facts().pair == Some(Pair::Difference) {
            return false;
        }
        let sizes = kind.parameters().iter().filter(|p| p.amplitude);
        let mut names = sizes
            .map(|p| format!("{}.{}", kind.name(), p.name))
            .peekable();
        names.peek().is_some() && !names.any(|name| is_known(&name))
    };
    model.effects.iter().copied().find(is_unsure)
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
