//! What is true of an effect beyond its equation: how a search for it starts, what it does as well as another
//! effect, how it shows and what tells it apart. A host reads this; nothing on a device does.

use super::{Kind, Place};

/// Facts about an effect, all of them data.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The simpler effects that this one does as well, with some of its parameters at rest.
    pub contains: &'static [Contained],
    /// Where a search for its parameters starts.
    pub starts: Starts,
    /// Whether the relative of its form is so unlike the textbook's that a search must look at both: a fit of the one
    /// is no start for the other.
    pub both_forms: bool,
    /// Whether a search for it takes as long as a dozen others, so that it is tried where nothing else will do.
    pub costly: bool,
    /// Whether a series-parallel model, which is set to the measured state at every sample, follows it: not
    /// where motor and load part ways, or where something bends or rises within a sample.
    pub series_parallel: bool,
    /// Whether it acts by chance, event by event: no search of parameters finds it, its events do.
    pub by_chance: bool,
    /// What the volts that the linear motor misses show of it.
    pub evidence: Evidence,
    /// Its cycles a revolution, if it is periodic in the angle.
    pub periodic: Option<Order>,
    /// How its first two parameters belong together.
    pub pair: Option<Pair>,
    /// What is left of it at speed in the two numbers that most programs have for friction.
    pub at_speed: AtSpeed,
    /// What tells it from another effect. Either of the two may say it.
    pub told_from: &'static [ToldFrom],
    /// What else does the same as this effect in most recordings, and how to find out.
    pub caution: Option<&'static str>,
}

impl Facts {
    /// Of an effect of which nothing special is known.
    pub const PLAIN: Facts = Facts {
        contains: &[],
        starts: Starts::Typical,
        both_forms: false,
        costly: false,
        series_parallel: true,
        by_chance: false,
        evidence: Evidence::LargestShare,
        periodic: None,
        pair: None,
        at_speed: AtSpeed::Nothing,
        told_from: &[],
        caution: None,
    };
}

/// A simpler effect that a more general one does as well.
#[derive(Clone, Copy, Debug)]
pub struct Contained {
    /// The simpler effect.
    pub name: &'static str,
    /// Its parameters, from those of the general one.
    pub values: &'static [Value],
    /// Parameters of the general one, with the values (SI) at which it comes nearest to the simpler one;
    /// parameters of which a [`Value::Mean`] is taken are equal then.
    pub at_rest: &'static [(usize, f64)],
    /// Whether the general one does all that the simpler one can, so that no recording speaks for the simpler
    /// one but its fewer parameters. Else search ranges or shapes differ.
    pub whole: bool,
}

/// One parameter of a simpler effect, from those of a more general one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// This parameter.
    Own(usize),
    /// The mean of two.
    Mean(usize, usize),
    /// The product of two.
    Product(usize, usize),
    /// A constant, in the parameter's SI unit.
    Fixed(f64),
}

impl Value {
    /// The value, from `general`; `None` where that lacks a parameter.
    pub fn from(self, general: &[f64]) -> Option<f64> {
        let own = |index: usize| general.get(index).copied();
        Some(match self {
            Value::Own(index) => own(index)?,
            Value::Mean(one, other) => 0.5 * (own(one)? + own(other)?),
            Value::Product(one, other) => own(one)? * own(other)?,
            Value::Fixed(value) => value,
        })
    }

    /// The parameters of the general effect that stand for it as they are.
    pub fn places(self) -> impl Iterator<Item = usize> {
        let (one, other) = match self {
            Value::Own(index) => (Some(index), None),
            Value::Mean(one, other) => (Some(one), Some(other)),
            Value::Product(..) | Value::Fixed(_) => (None, None),
        };
        one.into_iter().chain(other)
    }
}

/// Where a search for an effect's parameters starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Starts {
    /// At the typical values.
    Typical,
    /// At every combination of these shares of the typical values of these parameters: its cost has several
    /// valleys.
    Shares(&'static [(usize, &'static [f64])]),
    /// At the strongest lines of the angle's spectrum, as cosine, sine and order.
    AngleOrders,
    /// At what a fit of this effect finds, which it [contains](Facts::contains).
    Fit(&'static str),
}

impl Starts {
    /// The effect whose fit must come first.
    pub fn after(self) -> Option<Kind> {
        match self {
            Starts::Fit(name) => Kind::by_name(name),
            _ => None,
        }
    }
}

/// What the volts that the linear motor misses show of an effect, if they show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// They change sign with the speed.
    ChangesSign,
    /// They are the same in both directions.
    Constant,
    /// They grow with the speed.
    Grows,
    /// They repeat with the angle, alike in both directions, as often as the effect does.
    Repeats,
    /// They drift with time.
    Drifts,
    /// Nothing of a form of its own: where most of them are is all that can be said.
    LargestShare,
}

/// Cycles a revolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// One.
    Once,
    /// As this parameter says.
    Parameter(usize),
}

impl Order {
    /// The whole number, from the effect's parameters; `None` where they lack it.
    pub fn of(self, values: &[f64]) -> Option<usize> {
        match self {
            Order::Once => Some(1),
            Order::Parameter(index) => values.get(index).map(|order| libm::round(*order) as usize),
        }
    }
}

/// How two parameters belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pair {
    /// Amplitudes of cosine and sine: the length of the vector is the size.
    CosineAndSine,
    /// Only their difference is the effect's own: the linear motor can take any common part.
    Difference,
}

/// What is left of an effect at speed in the two numbers that most programs have for friction, one constant and
/// one on the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtSpeed {
    /// Nothing; the place where it acts says why.
    Nothing,
    /// Nothing: it is a torque of another form, as a remark says.
    OtherForm(&'static str),
    /// A constant against motion: the mean of these parameters.
    Sliding {
        /// The parameters.
        mean_of: &'static [usize],
        /// What that leaves out, in words.
        without: Option<&'static str>,
    },
    /// Friction on the speed: the mean of these parameters.
    Viscous {
        /// The parameters.
        mean_of: &'static [usize],
        /// What that leaves out, in words.
        without: Option<&'static str>,
    },
}

/// What tells an effect from another one.
#[derive(Clone, Copy, Debug)]
pub struct ToldFrom {
    /// The other one.
    pub other: Other,
    /// What to record, to follow "to separate them record".
    pub record: &'static str,
    /// What to measure besides, where no recording of voltage and angle separates them within the limits.
    pub measure: Option<&'static str>,
}

/// Another effect, or any of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// The one of this name.
    Effect(&'static str),
    /// Any that acts there.
    At(Place),
}

impl Other {
    /// Whether `kind` is meant.
    pub fn is(self, kind: Kind) -> bool {
        match self {
            Other::Effect(name) => kind.name() == name,
            Other::At(place) => kind.description().place == place,
        }
    }
}

impl Kind {
    /// What is true of it beyond its equation.
    pub fn facts(self) -> &'static Facts {
        &self.description().facts
    }

    /// The special case `simpler` of this effect, if it is one.
    pub fn containing(self, simpler: Kind) -> Option<&'static Contained> {
        let mut all = self.facts().contains.iter();
        all.find(|contained| contained.name == simpler.name())
    }

    /// Whether this effect does all that `simpler` can, with some parameters at rest.
    pub fn refines(self, simpler: Kind) -> bool {
        self.containing(simpler)
            .is_some_and(|special| special.whole)
    }

    /// Cycles a revolution of an effect that is a torque which repeats with the angle.
    pub fn periodic_torque(self) -> Option<Order> {
        let periodic = self.facts().periodic;
        periodic.filter(|_| self.description().place == Place::Torque)
    }

    /// Whether one of the two is declared to look like the other.
    pub fn looks_like(self, other: Kind) -> bool {
        let declares = |a: Kind, b: Kind| a.description().look_alikes.contains(&b.name());
        declares(self, other) || declares(other, self)
    }

    /// What tells the two apart, if either says so.
    pub fn told_from(self, other: Kind) -> Option<&'static ToldFrom> {
        let says = |a: Kind, b: Kind| a.facts().told_from.iter().find(|told| told.other.is(b));
        says(self, other).or_else(|| says(other, self))
    }
}

impl Contained {
    /// The simpler effect.
    pub fn kind(&self) -> Option<Kind> {
        Kind::by_name(self.name)
    }

    /// Its parameters, from those of the general one; `None` where `general` lacks one.
    pub fn values_from(&self, general: &[f64]) -> Option<impl Iterator<Item = f64>> {
        let all = self.values.iter().map(|value| value.from(general));
        all.clone()
            .all(|value| value.is_some())
            .then(|| all.flatten())
    }
}
