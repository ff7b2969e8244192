//! What is hidden in a case: which effects, how strong, and of which shape.

use super::draws::{Draws, rounded};
use super::{HowMany, Laws, SetUp};
use servoid_plant::effects::CATALOGUE;
use servoid_plant::{BenchError, Hidden, Machine};
use shared::effects::Kind;

/// Strength, in times the typical.
const STRENGTH: (f64, f64) = (0.3, 3.0);
/// In a mixture: share of cases that hide nothing, and share that hides one effect.
const MIX: (f64, f64) = (0.2, 0.4);

/// Purposes of the streams of draws.
const HOW_MANY: u64 = 0x686f_7720_6d61_6e79;
const DECK: u64 = 0x6465_636b;
const SURPRISE: u64 = 0x7375_7270_7269_7365;

/// Names of the effects that case `number` hides. The first comes from a deck that is shuffled anew
/// when it is through, so that all effects come equally often whatever the number of cases.
pub fn names(set_up: &SetUp, number: u64) -> Vec<&'static str> {
    let mut draws = Draws::of(&[set_up.seed, number, HOW_MANY]);
    let many = match set_up.hidden {
        HowMany::None => 0,
        // A law is alone, unless it is said what is beside it.
        HowMany::Formula => set_up.effects.len().min(1),
        HowMany::One => 1,
        HowMany::Two => 2,
        HowMany::Mix if draws.chance(MIX.0) => 0,
        HowMany::Mix if draws.chance(MIX.1 / (1.0 - MIX.0)) => 1,
        HowMany::Mix => 2,
    };
    if many == 0 {
        return Vec::new();
    }
    let all: Vec<&'static str> = CATALOGUE.iter().map(|kind| kind.name).collect();
    let asked = |name: &&str| set_up.effects.iter().any(|effect| effect == name);
    let has_laws = |name: &&str| !other_laws(name).is_empty();
    let wanted: Vec<&'static str> = all.iter().copied().filter(asked).collect();
    let able: Vec<&'static str> = all.iter().copied().filter(has_laws).collect();
    let offered = match set_up.laws {
        _ if !wanted.is_empty() => &wanted,
        Laws::Other => &able,
        Laws::Own | Laws::Any => &all,
    };
    let block = number / offered.len() as u64;
    let deck = Draws::of(&[set_up.seed, block, DECK]).permutation(offered.len());
    let first = offered[deck[(number % offered.len() as u64) as usize]];
    let mut names = vec![first];
    if many == 2 {
        let apart = |from: &[&'static str]| -> Vec<&'static str> {
            let others = from.iter().copied();
            others.filter(|name| acts_otherwise(first, name)).collect()
        };
        let mut partners = apart(offered);
        if partners.is_empty() {
            partners = apart(&all);
        }
        names.extend(draws.pick(&partners));
    }
    names
}

/// A random effect in `machine`: a function of nothing but the seed.
///
/// # Errors
/// None, as long as the catalogues agree with each other.
pub fn surprise(machine: &Machine, seed: u64) -> Result<Hidden, BenchError> {
    let mut draws = Draws::of(&[seed, SURPRISE]);
    let names: Vec<&'static str> = CATALOGUE.iter().map(|kind| kind.name).collect();
    draw(draws.pick(&names).unwrap_or_default(), machine, &mut draws)
}

/// Names of the other curves by which that effect may act.
fn other_laws(effect: &str) -> Vec<&'static str> {
    let laws = servoid_plant::effects::Kind::find(effect).map(|kind| kind.other_laws);
    laws.unwrap_or_default()
        .iter()
        .map(|law| law.name)
        .collect()
}

/// Lets the effect act by one of its other curves, where `laws` draws that and it has any.
///
/// # Errors
/// None, as long as the catalogue agrees with itself.
pub fn by_law(hidden: Hidden, laws: Laws, draws: &mut Draws) -> Result<Hidden, BenchError> {
    let another = match laws {
        Laws::Own => false,
        Laws::Other => true,
        Laws::Any => draws.chance(0.5),
    };
    match draws.pick(&other_laws(hidden.name())) {
        Some(law) if another => hidden.by_law(law),
        _ => Ok(hidden),
    }
}

/// Whether neither is the other, nor declared to look like it.
pub fn acts_otherwise(a: &str, b: &str) -> bool {
    let kinds = Kind::by_name(a).zip(Kind::by_name(b));
    a != b && !kinds.is_some_and(|(a, b)| a.looks_like(b))
}

/// The effect of that name with a random strength and shape.
///
/// # Errors
/// [`BenchError::UnknownEffect`].
pub fn draw(name: &str, machine: &Machine, draws: &mut Draws) -> Result<Hidden, BenchError> {
    let mut hidden = Hidden::typical(name, machine)?;
    hidden.draw_form(machine, draws)?;
    // Few digits, so that the printed effect is the hidden one.
    let exact: Vec<_> = hidden.parameters().collect();
    for (key, value, _) in exact {
        hidden.set(key, rounded(value))?;
    }
    hidden.scaled(draws.log_uniform(STRENGTH.0, STRENGTH.1))
}
