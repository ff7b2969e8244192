//! What is known of a channel.

use super::kind::{Channel, Measured};
use super::table;
use super::unit::LinearUnit;

/// What is known of a channel.
#[derive(Debug)]
pub struct Facts {
    /// The channel.
    pub channel: Channel,
    /// Its key under `[columns]` and `[units]`.
    pub key: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// The column's name in recordings of our own.
    pub column: &'static str,
    /// What a column of it is good for; empty where a recording must have it.
    pub good_for: &'static str,
    /// What it is called in logs, the likeliest first: in lower case and without accents.
    pub(crate) words: &'static [&'static str],
    /// What stands in the name of another quantity that shares a word with this one.
    pub(crate) others: &'static [&'static str],
    /// The last part of a name, and the unit that it tells.
    pub(crate) told_units: &'static [(&'static str, &'static str)],
    /// Units that a factor and a zero convert, the own one first; none where the unit is of another kind.
    pub units: &'static [LinearUnit],
    /// Values that it can have, in its own unit.
    pub(crate) range: [f64; 2],
}

impl Channel {
    /// What is known of it.
    pub fn facts(self) -> &'static Facts {
        let mut all = table::CHANNELS.iter();
        all.find(|facts| facts.channel == self)
            .unwrap_or(&table::CHANNELS[0])
    }
}

impl Measured {
    /// What is known of it.
    pub fn facts(self) -> &'static Facts {
        Channel::Measured(self).facts()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_has_facts_of_its_own() {
        for channel in Channel::ALL {
            let facts = channel.facts();
            assert_eq!(facts.channel, channel);
            assert_eq!(Channel::by_key(facts.key), Some(channel));
            assert!(!facts.words.is_empty() && !facts.title.is_empty());
            let is_measured = matches!(channel, Channel::Measured(_));
            assert_eq!(is_measured, !facts.units.is_empty(), "{channel:?}");
        }
        for (k, channel) in Measured::ALL.into_iter().enumerate() {
            assert_eq!(channel.place(), k);
        }
    }
}
