//! Where each of several recordings lies among the samples.

use servoid_io::position_loop::PositionLoop;
use std::ops::Range;

/// The recordings that samples come from, one after the other. Nothing runs from one into the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Recordings {
    /// First sample of each; the first is 0.
    begins: Vec<usize>,
    /// Where each came from.
    sources: Vec<String>,
    /// The position loop that made the command of each, if one did.
    loops: Vec<Option<PositionLoop>>,
    /// Number of samples.
    end: usize,
}

impl Recordings {
    /// One recording of so many samples.
    pub fn one(source: &str, samples: usize) -> Self {
        Recordings {
            begins: vec![0],
            sources: vec![source.to_owned()],
            loops: vec![None],
            end: samples,
        }
    }

    /// The same, with the position loop that made the command of the last.
    #[must_use]
    pub(super) fn driven_by(mut self, control: Option<PositionLoop>) -> Self {
        if let Some(last) = self.loops.last_mut() {
            *last = control;
        }
        self
    }

    /// Puts another one of so many samples behind them.
    pub(super) fn push(&mut self, source: &str, samples: usize, control: Option<PositionLoop>) {
        self.begins.push(self.end);
        self.sources.push(source.to_owned());
        self.loops.push(control);
        self.end += samples;
    }

    /// Those of the first `samples` samples.
    #[must_use]
    pub(super) fn first(&self, samples: usize) -> Self {
        let end = samples.min(self.end);
        let count = self.begins.partition_point(|&begin| begin < end).max(1);
        Recordings {
            begins: self.begins[..count].to_vec(),
            sources: self.sources[..count].to_vec(),
            loops: self.loops[..count].to_vec(),
            end,
        }
    }

    /// Those of every `every`th sample of each.
    #[must_use]
    pub(super) fn thinned(&self, every: usize) -> Self {
        let mut begins = Vec::with_capacity(self.count());
        let mut end = 0;
        for range in self.ranges() {
            begins.push(end);
            end += range.len().div_ceil(every);
        }
        Recordings {
            begins,
            end,
            ..self.clone()
        }
    }

    /// Number of recordings.
    pub fn count(&self) -> usize {
        self.begins.len()
    }

    /// Whether there are several.
    pub fn are_several(&self) -> bool {
        self.count() > 1
    }

    /// Where each came from.
    pub fn sources(&self) -> &[String] {
        &self.sources
    }

    /// The position loop that made the command of each, if one did.
    pub fn loops(&self) -> &[Option<PositionLoop>] {
        &self.loops
    }

    /// Samples of each.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.begins.iter().skip(1).copied().chain([self.end]);
        self.begins.iter().zip(ends).map(|(&from, to)| from..to)
    }

    /// Samples of the one that holds sample `k`.
    pub fn holding(&self, k: usize) -> Range<usize> {
        let next = self.begins.partition_point(|&begin| begin <= k);
        let from = self.begins[next.saturating_sub(1)];
        from..self.begins.get(next).copied().unwrap_or(self.end)
    }

    /// Whether sample `k` is the first of its recording.
    pub fn is_first(&self, k: usize) -> bool {
        self.begins.binary_search(&k).is_ok()
    }

    /// Whether sample `k` is the last of its recording.
    pub fn is_last(&self, k: usize) -> bool {
        k + 1 == self.end || self.is_first(k + 1)
    }

    /// Samples around `k`, `half` to each side, fewer at the ends of its recording.
    pub fn around(&self, k: usize, half: usize) -> Range<usize> {
        let whole = self.holding(k);
        k.saturating_sub(half).max(whole.start)..(k + half + 1).min(whole.end)
    }

    /// Changes of the readings from sample to sample within the recordings, counts.
    pub fn steps<'a>(&'a self, counts: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.ranges()
            .flat_map(|range| counts[range].windows(2).map(|pair| pair[1] - pair[0]))
    }
}
