//! Which recordings repeat one command, and which of their samples belong together.

use super::periods::periods;
use super::settings::{COMMON, EVEN, ONE_COMMAND, ONE_INTERVAL};
use servoid_engine::problem::Data;
use std::ops::Range;

/// Recordings of one motor that repeat commands of each other.
#[derive(Clone, Debug)]
pub struct Repeats<'a> {
    pub(super) groups: Vec<Group<'a>>,
}

/// Runs of one command.
#[derive(Clone, Debug)]
pub(super) struct Group<'a> {
    pub(super) members: Vec<Member<'a>>,
    /// Samples that all of them hold.
    pub(super) common: usize,
    /// Time between samples, s.
    pub(super) interval_s: f64,
}

/// One run of a group: a recording, or a period of one.
#[derive(Clone, Debug)]
pub(super) struct Member<'a> {
    pub(super) data: &'a Data,
    /// Its samples in `data`.
    pub(super) range: Range<usize>,
    /// The one of them at which the group's common samples begin.
    pub(super) first: usize,
}

impl<'a> Repeats<'a> {
    /// The repeats among all recordings in `sets`, and within those that no other repeats; `None` where no command was recorded twice.
    pub fn among(sets: &[&'a Data]) -> Option<Self> {
        let mut groups: Vec<Vec<Lagged<'a>>> = Vec::new();
        for &data in sets {
            for range in data.recordings.ranges() {
                let Some(interval_s) = even_interval(data, &range) else {
                    continue;
                };
                let new = Lagged {
                    data,
                    range,
                    interval_s,
                    lag: 0,
                };
                let lag = |group: &Vec<Lagged<'_>>| group[0].lag_of(&new);
                match groups
                    .iter_mut()
                    .find_map(|group| Some((lag(group)?, group)))
                {
                    Some((lag, group)) => group.push(Lagged { lag, ..new }),
                    None => groups.push(vec![new]),
                }
            }
        }
        let groups: Vec<Group<'a>> = groups
            .into_iter()
            .map(|group| match group.as_slice() {
                [alone] => alone.periods(),
                _ => group,
            })
            .filter(|group| group.len() > 1)
            .map(common)
            .collect();
        (!groups.is_empty()).then_some(Repeats { groups })
    }

    /// Recordings, or periods of one, that repeat another or are repeated.
    pub fn runs(&self) -> usize {
        self.groups.iter().map(|group| group.members.len()).sum()
    }
}

impl Group<'_> {
    /// Samples of a window of so many seconds.
    pub(super) fn window(&self, seconds: f64) -> usize {
        (seconds / self.interval_s).round().max(2.0) as usize
    }

    /// Where its members were recorded, each once.
    pub(super) fn sources(&self) -> Vec<String> {
        let members = self.members.iter();
        let mut all: Vec<String> = members.map(|member| member.source().to_owned()).collect();
        all.dedup();
        all
    }
}

impl Member<'_> {
    fn source(&self) -> &str {
        let places = self.data.recordings.ranges();
        let mut named = places.zip(self.data.recordings.sources());
        let own = named.find(|(range, _)| range.contains(&self.range.start));
        own.map_or("", |(_, source)| source)
    }
}

/// A run that begins `lag` samples before the first of its group.
struct Lagged<'a> {
    data: &'a Data,
    range: Range<usize>,
    interval_s: f64,
    lag: isize,
}

impl<'a> Lagged<'a> {
    /// The periods of a recording as runs of their own.
    fn periods(&self) -> Vec<Lagged<'a>> {
        let each = periods(self.data, &self.range, self.interval_s);
        let own = |range| Lagged { range, ..*self };
        each.into_iter().map(own).collect()
    }

    fn command(&self) -> &[f64] {
        &self.data.command[self.range.clone()]
    }

    /// Samples by which `other` begins before this one, if it repeats its command. Recordings of one command share their start, or their
    /// end where one of them was cut at its start.
    fn lag_of(&self, other: &Lagged<'_>) -> Option<isize> {
        let differs = (self.interval_s / other.interval_s - 1.0).abs();
        if differs > ONE_INTERVAL || self.data.drive != other.data.drive {
            return None;
        }
        let scale = other.data.units.volts / self.data.units.volts;
        let at_end = other.range.len() as isize - self.range.len() as isize;
        let lags = [0, at_end].map(|lag| (self.difference(other, lag, scale), lag));
        let nearest = lags.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        (nearest.0 < ONE_COMMAND).then_some(nearest.1)
    }

    /// RMS difference of the commands as a part of their RMS; infinite where too little is common.
    fn difference(&self, other: &Lagged<'_>, lag: isize, scale: f64) -> f64 {
        let own = self.command().get((-lag).max(0) as usize..);
        let others = other.command().get(lag.max(0) as usize..);
        let (Some(own), Some(others)) = (own, others) else {
            return f64::INFINITY;
        };
        let common = own.len().min(others.len());
        let longer = self.range.len().max(other.range.len());
        let squares: f64 = own.iter().take(common).map(|u| u * u).sum();
        if (common as f64) < COMMON * longer as f64 || squares <= 0.0 {
            return f64::INFINITY;
        }
        let pairs = own.iter().zip(others);
        let apart: f64 = pairs.map(|(u, v)| (u - v * scale).powi(2)).sum();
        (apart / squares).sqrt()
    }
}

fn common(group: Vec<Lagged<'_>>) -> Group<'_> {
    let begin = group.iter().map(|one| -one.lag).max().unwrap_or(0);
    let ends = group.iter().map(|one| one.range.len() as isize - one.lag);
    let end = ends.min().unwrap_or(0);
    let interval_s = group.first().map_or(0.0, |one| one.interval_s);
    Group {
        common: (end - begin).max(0) as usize,
        interval_s,
        members: group
            .into_iter()
            .map(|one| Member {
                data: one.data,
                first: (one.range.start as isize + begin + one.lag) as usize,
                range: one.range,
            })
            .collect(),
    }
}

/// The time between samples, s, where they are even: else no sample of one recording belongs to one of another.
fn even_interval(data: &Data, range: &Range<usize>) -> Option<f64> {
    let time = &data.time_s[range.clone()];
    let (first, last) = (time.first()?, time.last()?);
    let interval = (last - first) / (time.len() - 1).max(1) as f64;
    let beside = |(k, t): (usize, &f64)| (t - first - k as f64 * interval).abs();
    let is_even = time
        .iter()
        .enumerate()
        .map(beside)
        .all(|off| off < EVEN * interval);
    (interval > 0.0 && is_even).then_some(interval)
}
