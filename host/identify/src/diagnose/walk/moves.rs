//! From a set of effects to its neighbours: one effect more, one less, or one in the place of a look-alike.

use super::node::Node;
use super::pool::Pool;
use crate::diagnose::context::{Context, together_move_both_ways};
use crate::diagnose::models::same;
use shared::effects::{Kind, MAX_EFFECTS};

/// Of these a model has one: along a motion they are nearly the same.
const CONSTANTS: [Kind; 2] = [Kind::OffsetVoltage, Kind::LoadTorque];

/// These differ between the directions.
const OF_DIRECTIONS: [Kind; 2] = [Kind::AsymCoulomb, Kind::AsymViscous];

/// A neighbour to be fitted from where `parent` stands.
pub struct Start {
    /// The effects that stay.
    pub kept: Vec<Kind>,
    /// The effect that comes, if one does.
    pub added: Option<Kind>,
}

impl Start {
    /// `node` without the effects that are `gone`, and with `added`.
    fn from(node: &Node, gone: impl Fn(Kind) -> bool, added: Option<Kind>) -> Self {
        let kept = node.effects.iter().copied().filter(|own| !gone(*own));
        Start {
            kept: kept.collect(),
            added,
        }
    }

    /// The set that it leads to.
    pub fn effects(&self) -> Vec<Kind> {
        self.kept.iter().copied().chain(self.added).collect()
    }
}

/// The neighbours of `node` that are not in the pool yet.
pub fn neighbours(
    context: &Context<'_>,
    node: &Node,
    pool: &Pool<'_>,
    most_effects: usize,
) -> Vec<Start> {
    let mut starts = Vec::new();
    for kind in possible(context) {
        if node.effects.contains(&kind) {
            continue;
        }
        let with = |gone: &dyn Fn(Kind) -> bool| Start::from(node, gone, Some(kind));
        // One that holds another as a special case takes its place, alone or with the constant that the special case lacks.
        let contained = |own: Kind| {
            let both_constant = CONSTANTS.contains(&own) && CONSTANTS.contains(&kind);
            both_constant || kind.containing(own).is_some()
        };
        if !node.effects.iter().any(|own| own.refines(kind)) {
            starts.push(with(&contained));
        }
        if node.effects.iter().any(|own| contained(*own)) {
            starts.push(with(&|own| contained(own) || CONSTANTS.contains(&own)));
        }
        for &place in node.effects.iter().filter(|own| own.looks_like(kind)) {
            starts.push(with(&|own| own == place));
        }
    }
    starts.extend(removals(node));
    unknown(starts, pool, most_effects)
}

/// The neighbours of `node` with one effect more; what it holds as a special case goes.
pub fn additions(context: &Context<'_>, node: &Node, pool: &Pool<'_>) -> Vec<Start> {
    let mut starts = neighbours(context, node, pool, MAX_EFFECTS);
    starts.retain(|start| {
        let gone = node.effects.iter().filter(|own| !start.kept.contains(own));
        let mut gone = gone.copied();
        (start.added).is_some_and(|added| gone.all(|own| added.containing(own).is_some()))
    });
    starts
}

/// Sets in which a look-alike stands in the place of an effect.
pub fn substitutes(context: &Context<'_>, node: &Node) -> Vec<Start> {
    let new = possible(context).filter(|kind| !node.effects.contains(kind));
    let pairs = new.flat_map(|kind| node.effects.iter().map(move |&place| (place, kind)));
    // Where the motor never reverses a constant does what friction does.
    let one_way = !together_move_both_ways(context.data, context.held_out);
    let alike =
        |place: Kind, kind: Kind| place.looks_like(kind) || one_way && CONSTANTS.contains(&kind);
    pairs
        .filter(|(place, kind)| alike(*place, *kind))
        .map(|(place, kind)| Start::from(node, |own| own == place, Some(kind)))
        .collect()
}

/// `node` without each of its effects.
pub fn removals(node: &Node) -> impl Iterator<Item = Start> {
    let places = node.effects.iter().copied();
    places.map(|place| Start::from(node, |own| own == place, None))
}

/// Simpler sets that may do what `node` does: without an effect, with a special case of one in its place, or with one effect that is the sum of
/// another and a constant.
pub fn simpler(context: &Context<'_>, node: &Node) -> Vec<Start> {
    let mut starts: Vec<Start> = removals(node).collect();
    let new = possible(context).filter(|kind| !node.effects.contains(kind));
    for kind in new {
        for &place in node
            .effects
            .iter()
            .filter(|own| own.containing(kind).is_some())
        {
            starts.push(Start::from(node, |own| own == place, Some(kind)));
        }
        let sum = Start::from(
            node,
            |own| CONSTANTS.contains(&own) || kind.containing(own).is_some(),
            Some(kind),
        );
        if sum.kept.len() + 1 < node.effects.len() {
            starts.push(sum);
        }
    }
    starts
}

/// `node` with effects that cost much to simulate in the place of their special cases.
pub fn costly(context: &Context<'_>, node: &Node) -> Vec<Start> {
    let candidates = context.candidates.iter().copied();
    let costly = candidates.filter(|kind| kind.facts().costly && !node.effects.contains(kind));
    let contained = |kind: Kind| move |own: Kind| kind.containing(own).is_some();
    costly
        .filter(|kind| node.effects.iter().any(|own| contained(*kind)(*own)))
        .map(|kind| Start::from(node, contained(kind), Some(kind)))
        .collect()
}

/// Each set once, if it is small enough and not in the pool.
fn unknown(mut starts: Vec<Start>, pool: &Pool<'_>, most_effects: usize) -> Vec<Start> {
    let mut seen: Vec<Vec<Kind>> = Vec::new();
    starts.retain(|start| {
        let effects = start.effects();
        let fits = effects.len() <= most_effects.min(MAX_EFFECTS);
        let known = pool.knows(&effects) || seen.iter().any(|other| same(other, &effects));
        if fits && !known {
            seen.push(effects);
        }
        fits && !known
    });
    starts
}

/// The effects that may come.
pub fn possible<'c>(context: &'c Context<'_>) -> impl Iterator<Item = Kind> + 'c {
    let candidates = context.candidates.iter().copied();
    candidates.filter(|kind| may_be(context, *kind))
}

/// Lost counts are found, not fitted; bristles cost much; and a motor that never reverses shows one direction only.
fn may_be(context: &Context<'_>, kind: Kind) -> bool {
    let facts = kind.facts();
    let both_ways = || together_move_both_ways(context.data, context.held_out);
    !facts.by_chance && !facts.costly && (!OF_DIRECTIONS.contains(&kind) || both_ways())
}
