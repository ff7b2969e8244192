//! A part of the units or cases, for one machine of several.

use std::fmt;
use std::str::FromStr;

/// Shard `index` of `count`, both from 1: every `count`-th case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

/// A shard that is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("needs i/n with 1 <= i <= n, as in 2/3 for the second of three parts")]
pub struct BadShard;

impl Shard {
    /// All cases.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// How many shards there are.
    pub fn count(self) -> u64 {
        self.count
    }

    /// Whether this number is one of its own.
    pub fn has(self, number: u64) -> bool {
        number % self.count == self.index - 1
    }

    /// Its numbers below `cases`.
    pub fn numbers(self, cases: u64) -> impl Iterator<Item = u64> {
        (0..cases).filter(move |number| self.has(*number))
    }
}

impl FromStr for Shard {
    type Err = BadShard;

    fn from_str(text: &str) -> Result<Shard, BadShard> {
        let (index, count) = text.split_once('/').ok_or(BadShard)?;
        let whole = |text: &str| text.trim().parse::<u64>().map_err(|_| BadShard);
        let (index, count) = (whole(index)?, whole(count)?);
        if index == 0 || index > count {
            return Err(BadShard);
        }
        Ok(Shard { index, count })
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_the_whole_without_overlap() {
        for count in 1..8 {
            let mut all: Vec<u64> = (1..=count)
                .map(|index| format!("{index}/{count}").parse::<Shard>().unwrap())
                .flat_map(|shard| shard.numbers(50).collect::<Vec<_>>())
                .collect();
            all.sort_unstable();
            assert_eq!(all, (0..50).collect::<Vec<_>>());
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in [
            "", "1", "0/2", "3/2", "1/0", "a/b", "1/2/3", "-1/2", "1.5/2",
        ] {
            assert_eq!(text.parse::<Shard>(), Err(BadShard), "{text}");
        }
    }
}
