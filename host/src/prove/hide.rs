//! What is hidden in a case: which effects, how strong, and of which shape.

use super::draws::{Draws, rounded};
use super::{HowMany, SetUp};
use servoid_plant::effects::CATALOGUE;
use servoid_plant::{BenchError, Hidden, Machine};
use shared::effects::Kind;
use std::f64::consts::PI;

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
    let wanted: Vec<&'static str> = all.iter().copied().filter(asked).collect();
    let offered = if wanted.is_empty() { &all } else { &wanted };
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

/// Whether neither is the other, nor declared to look like it.
pub fn acts_otherwise(a: &str, b: &str) -> bool {
    let looks_like = |a: &str, b: &str| {
        Kind::by_name(a).is_some_and(|kind| kind.description().look_alikes.contains(&b))
    };
    a != b && !looks_like(a, b) && !looks_like(b, a)
}

/// The effect of that name with a random strength and shape.
///
/// # Errors
/// [`BenchError::UnknownEffect`].
pub fn draw(name: &str, machine: &Machine, draws: &mut Draws) -> Result<Hidden, BenchError> {
    let mut hidden = Hidden::typical(name, machine)?;
    for (key, value) in shape(&hidden, machine, draws) {
        hidden.set(key, value)?;
    }
    // Few digits, so that the printed effect is the hidden one.
    let exact: Vec<_> = hidden.parameters().collect();
    for (key, value, _) in exact {
        hidden.set(key, rounded(value))?;
    }
    hidden.scaled(draws.log_uniform(STRENGTH.0, STRENGTH.1))
}

/// Values of the parameters that make the effect's form rather than its size.
fn shape(hidden: &Hidden, machine: &Machine, draws: &mut Draws) -> Vec<(&'static str, f64)> {
    let typical = |key: &str| {
        let mut all = hidden.parameters();
        all.find(|(name, ..)| *name == key)
            .map_or(0.0, |(_, value, _)| value)
    };
    let top = machine.top_speed_rad_s();
    match hidden.name() {
        "load_torque" => vec![("torque", draws.sign() * typical("torque"))],
        "offset_voltage" => vec![("offset", draws.sign() * typical("offset"))],
        "asym_coulomb" => {
            let mean = 0.5 * (typical("forward") + typical("backward"));
            let lean = draws.sign() * draws.log_uniform(0.1, 0.6);
            vec![
                ("forward", mean * (1.0 + lean)),
                ("backward", mean * (1.0 - lean)),
            ]
        }
        "asym_viscous" => {
            let (much, little) = (
                typical("forward"),
                typical("forward") * draws.uniform(0.0, 0.6),
            );
            let (forward, backward) = if draws.chance(0.5) {
                (much, little)
            } else {
                (little, much)
            };
            vec![("forward", forward), ("backward", backward)]
        }
        "cogging" => vec![
            ("order", draws.log_uniform(4.0, 60.0).round()),
            ("phase", draws.uniform(-PI, PI)),
        ],
        "unbalance" | "enc_ecc" => vec![("phase", draws.uniform(-PI, PI))],
        "stribeck" => vec![
            ("extra", typical("extra") * draws.log_uniform(0.3, 1.5)),
            ("speed", top * draws.log_uniform(0.01, 0.06)),
            ("exponent", draws.uniform(1.0, 2.0)),
        ],
        "lugre" => vec![
            ("extra", draws.uniform(0.0, 0.6)),
            ("speed", top * draws.log_uniform(0.01, 0.06)),
            ("presliding", draws.log_uniform(0.002, 0.03)),
            ("damping", draws.uniform(0.2, 1.0)),
        ],
        "brush_drop" => vec![("knee", typical("knee") * draws.log_uniform(0.3, 3.0))],
        "backlash" => vec![
            ("load_share", draws.uniform(0.2, 0.7)),
            ("contact_hz", draws.log_uniform(250.0, 1000.0)),
            ("damping", draws.uniform(0.4, 1.0)),
        ],
        "compliance" => vec![
            ("load_share", draws.uniform(0.2, 0.7)),
            ("damping", draws.log_uniform(0.02, 0.2)),
        ],
        "heating" => vec![
            ("time_constant", draws.log_uniform(5.0, 60.0)),
            ("magnet", draws.uniform(0.0, 0.002)),
        ],
        "missed_counts" => vec![("largest", draws.log_uniform(4.0, 40.0).round())],
        // Only their size, or a form that the model does not know (a dead zone that is cut).
        _ => Vec::new(),
    }
}
