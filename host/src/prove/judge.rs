//! What the diagnosis of a case got right.

use super::hide::acts_otherwise;
use super::{Naming, Outcome};

/// Held-out error up to which a model counts as complete, counts RMS: the encoder's floor of 0.289
/// with a fifth to spare.
pub const COMPLETE_COUNTS: f64 = 0.35;

/// How far what is named may be from a hidden law, as a part of the law.
const NEAR: f64 = 0.1;

impl Outcome {
    /// The effect named first.
    pub fn first(&self) -> Option<&str> {
        self.named.first().map(|naming| naming.effect.as_str())
    }

    /// Whether the first effect named is a hidden one.
    pub fn right_first(&self) -> bool {
        self.first()
            .is_some_and(|first| self.drawn.names().contains(&first))
    }

    /// Whether a hidden effect is in the first set that is printed: the effect named, and those that are
    /// said to explain the recording as well.
    pub fn right_in_set(&self) -> bool {
        let names = self.drawn.names();
        let first = self.named.first();
        first.is_some_and(|first| names.iter().any(|name| first.says(name)))
    }

    /// Whether the first effect named is a hidden one or a declared look-alike of one.
    pub fn right_or_look_alike_first(&self) -> bool {
        let names = self.drawn.names();
        let first = self.first();
        first.is_some_and(|first| names.iter().any(|name| !acts_otherwise(first, name)))
    }

    /// Whether every hidden effect is named.
    pub fn all_named(&self) -> bool {
        self.matched(&|naming, name| naming.effect == name) == self.drawn.hidden.len()
    }

    /// Whether for every hidden effect it is named itself, or printed as alike, or a declared look-alike
    /// is named, for each by another naming.
    pub fn all_in_sets(&self) -> bool {
        let fits = |naming: &Naming, name: &str| {
            naming.says(name) || !acts_otherwise(&naming.effect, name)
        };
        self.matched(&fits) == self.drawn.hidden.len()
    }

    /// Whether any hidden effect is named.
    pub fn any_named(&self) -> bool {
        self.matched(&|naming, name| naming.effect == name) > 0
    }

    /// Names that are no hidden effect.
    pub fn wrong_names(&self) -> Vec<&str> {
        let hidden = self.drawn.names();
        let names = self.named.iter().map(|naming| naming.effect.as_str());
        names.filter(|name| !hidden.contains(name)).collect()
    }

    /// Names that are no hidden effect, nor a declared look-alike of one.
    pub fn quite_wrong_names(&self) -> Vec<&str> {
        let hidden = self.drawn.names();
        let mut names = self.wrong_names();
        names.retain(|name| hidden.iter().all(|truth| acts_otherwise(name, truth)));
        names
    }

    /// Whether the model is complete on the held-out recording.
    pub fn complete(&self) -> bool {
        let held_out = self.last.held_out;
        held_out.is_some_and(|rms| rms <= COMPLETE_COUNTS)
    }

    /// Whether a law outside the catalogue is named.
    pub fn names_law(&self) -> bool {
        self.law_found
            .as_ref()
            .is_some_and(|law| !law.named.is_empty())
    }

    /// Whether the laws that are named depend on what the hidden one does.
    pub fn right_variables(&self) -> bool {
        self.law_found
            .as_ref()
            .is_some_and(|law| law.right_variables)
    }

    /// How far all that is named is from the hidden law, as a part of the law.
    pub fn departure(&self) -> Option<f64> {
        self.law_found.as_ref()?.departure
    }

    /// Whether all that is named is near the hidden law.
    pub fn right_curve(&self) -> bool {
        self.departure().is_some_and(|part| part <= NEAR)
    }

    /// Whether the held-out error falls to a tenth of the linear motor's, or to twice the encoder's own.
    pub fn error_falls(&self) -> bool {
        let (last, base) = (self.last.held_out, self.base.held_out);
        last.zip(base).is_some_and(|(last, base)| {
            last <= 0.1 * base || last <= 2.0 * shared::encoder::FLOOR_RMS_COUNTS
        })
    }

    /// Whether the model is worse on the held-out recording than the linear motor.
    pub fn worse_than_base(&self) -> bool {
        matches!((self.last.held_out, self.base.held_out), (Some(last), Some(base)) if last > base)
    }

    /// How many hidden effects find a naming of their own that `fits`.
    fn matched(&self, fits: &dyn Fn(&Naming, &str) -> bool) -> usize {
        let hidden = self.drawn.names();
        let taken = vec![false; self.named.len()];
        most_pairs(&hidden, &self.named, taken, fits)
    }
}

/// The largest number of `hidden` that can be paired with namings that are not `taken`; tried in all ways,
/// since both are few.
fn most_pairs(
    hidden: &[&str],
    named: &[Naming],
    taken: Vec<bool>,
    fits: &dyn Fn(&Naming, &str) -> bool,
) -> usize {
    let Some((first, rest)) = hidden.split_first() else {
        return 0;
    };
    let without = most_pairs(rest, named, taken.clone(), fits);
    let open = (0..named.len()).filter(|&k| !taken[k] && fits(&named[k], first));
    let with = open.map(|k| {
        let mut taken = taken.clone();
        taken[k] = true;
        1 + most_pairs(rest, named, taken, fits)
    });
    with.max().unwrap_or(0).max(without)
}

impl Naming {
    /// Whether it names `name`, or says that `name` explains the recording as well.
    pub fn says(&self, name: &str) -> bool {
        self.effect == name || self.alike.iter().any(|alike| alike == name)
    }
}
