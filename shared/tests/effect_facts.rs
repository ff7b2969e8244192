//! Laws over what the effects say about themselves.

mod motors;

use motors::{BENCHES, Bench, INTERVAL, furthest, run};
use shared::effects::{AtSpeed, Contained, Form, Kind, Order, Other, Parameter, Starts, Value};
use shared::excite::{COMMISSIONING, commands};

/// A contained effect is met over the whole commissioning mix to a count and to this part of what it changes: if it is
/// contained as a whole, and if it is only come near to (flanks of a closed gap push and never pull, a spring does both).
const MET: (f64, f64) = (1e-3, 0.05);

fn counterpart(name: &str, of: Kind) -> Kind {
    let kind = Kind::by_name(name).unwrap_or_else(|| panic!("{of:?} names the unknown `{name}`"));
    assert_ne!(kind, of, "an effect names itself");
    kind
}

#[test]
fn names_of_effects_and_of_the_parameters_of_each_are_unique() {
    for &kind in Kind::ALL {
        assert_eq!(Kind::by_name(kind.name()), Some(kind));
        for (index, parameter) in kind.parameters().iter().enumerate() {
            let first = kind
                .parameters()
                .iter()
                .position(|other| other.name == parameter.name);
            assert_eq!(first, Some(index), "{kind:?}.{}", parameter.name);
        }
    }
}

#[test]
fn a_form_is_the_last_parameter_and_has_the_textbooks_and_its_relative_inside_its_range() {
    for &kind in Kind::ALL {
        let parameters = kind.parameters();
        for (index, form) in parameters
            .iter()
            .enumerate()
            .filter(|(_, p)| p.form.is_some())
        {
            assert_eq!(index + 1, parameters.len(), "{kind:?}.{}", form.name);
            assert_eq!(
                form.typical, 0.0,
                "{kind:?}: the textbook's form is typical"
            );
            match form.form {
                Some(Form::FrictionShare) => assert_eq!(form.range, (0.0, 1.0), "{kind:?}"),
                _ => assert!(form.range.0 <= 0.0 && 1.0 < form.range.1, "{kind:?}"),
            }
        }
    }
}

#[test]
fn whatever_an_effect_says_of_others_is_of_effects_of_the_catalogue() {
    for &kind in Kind::ALL {
        for name in kind.description().look_alikes {
            counterpart(name, kind);
        }
        for told in kind.facts().told_from {
            let Other::Effect(name) = told.other else {
                continue;
            };
            let other = counterpart(name, kind);
            let says = |told: &&shared::effects::ToldFrom| told.other.is(kind);
            assert!(
                !other.facts().told_from.iter().any(|told| says(&told)),
                "{kind:?} and {other:?} both say what tells them apart"
            );
        }
        if let Starts::Fit(name) = kind.facts().starts {
            let first = counterpart(name, kind);
            assert!(
                kind.containing(first).is_some(),
                "{kind:?} starts from a stranger"
            );
        }
    }
}

#[test]
fn whatever_an_effect_says_of_its_parameters_is_of_those_that_it_has() {
    for &kind in Kind::ALL {
        let (facts, has) = (kind.facts(), kind.parameters().len());
        let mut named: Vec<usize> = Vec::new();
        match facts.starts {
            Starts::Shares(axes) => {
                for (index, shares) in axes {
                    named.push(*index);
                    let Parameter { range, typical, .. } = kind.parameters()[*index];
                    for share in *shares {
                        let start = share * typical;
                        assert!(
                            (range.0..=range.1).contains(&start),
                            "{kind:?} starts at {start}"
                        );
                    }
                }
            }
            Starts::AngleOrders => assert_eq!(has, 3, "{kind:?}: cosine, sine and order"),
            Starts::Typical | Starts::Fit(_) => {}
        }
        if let Some(Order::Parameter(index)) = facts.periodic {
            named.push(index);
        }
        if facts.pair.is_some() {
            named.push(1);
        }
        if let AtSpeed::Sliding { mean_of, .. } | AtSpeed::Viscous { mean_of, .. } = facts.at_speed
        {
            named.extend(mean_of);
        }
        for contained in facts.contains {
            named.extend(contained.at_rest.iter().map(|(index, _)| index));
            for value in contained.values {
                named.extend(value.places());
                if let Value::Product(one, other) = *value {
                    named.extend([one, other]);
                }
            }
        }
        assert!(
            named.iter().all(|&index| index < has),
            "{kind:?} names {named:?} of {has}"
        );
    }
}

/// Readings in counts under the commissioning mix, in many short substeps.
fn readings(bench: &Bench, effect: Option<(Kind, &[f64])>) -> Vec<f64> {
    let drive: Vec<_> = commands::<f64>(&COMMISSIONING, INTERVAL, 1).collect();
    run::<f64>(&bench.plan(effect.as_slice(), 16), &drive)
}

/// Typical values of the general effect, SI, but those at rest that make it the contained one.
fn at_rest(bench: &Bench, general: Kind, contained: &Contained) -> Vec<f64> {
    let mut values = bench.typical(general);
    for (index, value) in contained.at_rest {
        values[*index] = *value;
    }
    for value in contained.values {
        if let Value::Mean(one, other) = *value {
            let mean = value.from(&values).expect("its parameters");
            (values[one], values[other]) = (mean, mean);
        }
    }
    values
}

#[test]
fn an_effect_does_what_it_contains_when_its_further_parameters_are_at_rest() {
    for bench in &BENCHES {
        let linear = readings(bench, None);
        for &general in Kind::ALL {
            for contained in general.facts().contains {
                let simpler = counterpart(contained.name, general);
                let values = at_rest(bench, general, contained);
                let special: Vec<f64> = contained.values_from(&values).expect("values").collect();
                assert_eq!(special.len(), simpler.parameters().len());
                let reached = readings(bench, Some((general, &values)));
                let expected = readings(bench, Some((simpler, &special)));
                let (off, changes) = (furthest(&reached, &expected), furthest(&linear, &expected));
                let case = format!("{}: {general:?} as {simpler:?}", bench.name);
                println!("{case}: {off:.4} counts of {changes:.0}");
                let part = if contained.whole { MET.0 } else { MET.1 };
                assert!(off < 1.0 + part * changes, "{case} is {off} counts off");
            }
        }
    }
}

#[test]
fn an_effect_contains_the_whole_of_another_only_if_its_search_ranges_do() {
    for &general in Kind::ALL {
        for contained in general.facts().contains {
            let simpler = counterpart(contained.name, general);
            let covers = |(value, parameter): (&Value, &Parameter)| {
                let (low, high) = parameter.range;
                let within = |index: usize| {
                    let own = general.parameters()[index].range;
                    own.0 <= low && own.1 >= high
                };
                value.places().next().is_some() && value.places().all(within)
            };
            let whole = contained
                .values
                .iter()
                .zip(simpler.parameters())
                .all(covers);
            assert_eq!(contained.whole, whole, "{general:?} contains {simpler:?}");
        }
    }
}
