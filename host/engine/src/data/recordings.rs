//! Where each of several recordings lies among the samples.

use servoid_io::position_loop::PositionLoop;
use servoid_io::recording::PositionDrive;
use std::ops::Range;
use std::sync::Arc;

/// The recordings that samples come from, one after the other. Nothing runs from one into the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Recordings {
    /// First sample of each; the first is 0.
    begins: Vec<usize>,
    /// Where each came from.
    sources: Vec<String>,
    /// The position loop that made the command of each, if one did, with its targets.
    drives: Vec<Option<Arc<PositionDrive>>>,
    /// Number of samples.
    end: usize,
}

impl Recordings {
    /// One recording of so many samples.
    pub fn one(source: &str, samples: usize) -> Self {
        Recordings {
            begins: vec![0],
            sources: vec![source.to_owned()],
            drives: vec![None],
            end: samples,
        }
    }

    /// The same, with the position loop that made the command of the last.
    #[must_use]
    pub(super) fn driven_by(mut self, drive: Option<PositionDrive>) -> Self {
        if let Some(last) = self.drives.last_mut() {
            *last = drive.map(Arc::new);
        }
        self
    }

    /// Puts another one of so many samples behind them.
    pub(super) fn push(&mut self, source: &str, samples: usize, drive: Option<PositionDrive>) {
        self.begins.push(self.end);
        self.sources.push(source.to_owned());
        self.drives.push(drive.map(Arc::new));
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
            drives: self.drives[..count].to_vec(),
            end,
        }
    }

    /// One of them alone.
    #[must_use]
    pub(super) fn only(&self, index: usize) -> Self {
        let samples = self.ranges().nth(index).map_or(0, |range| range.len());
        Recordings {
            drives: vec![self.drives[index].clone()],
            ..Recordings::one(&self.sources[index], samples)
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
        let kept = |targets: &[f64]| targets.iter().copied().step_by(every).collect();
        Recordings {
            begins,
            end,
            drives: self.with_targets(kept),
            ..self.clone()
        }
    }

    /// The drives with other targets, counts.
    fn with_targets(
        &self,
        targets: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Vec<Option<Arc<PositionDrive>>> {
        let with = |drive: &Arc<PositionDrive>| {
            Arc::new(PositionDrive {
                control: drive.control,
                target_counts: targets(&drive.target_counts),
            })
        };
        let drives = self.drives.iter();
        drives.map(|drive| drive.as_ref().map(with)).collect()
    }

    /// The same with so many counts added to each target.
    #[must_use]
    pub(super) fn turned(self, counts: f64) -> Self {
        Recordings {
            drives: self.with_targets(|all| all.iter().map(|target| target + counts).collect()),
            ..self
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

    /// The position loop that made the command of each, if one did, with its targets.
    pub fn drives(&self) -> &[Option<Arc<PositionDrive>>] {
        &self.drives
    }

    /// The position loops of those that have one, each with where its recording came from.
    pub fn loops(&self) -> impl Iterator<Item = (&str, &PositionLoop)> {
        let each = self.sources.iter().zip(&self.drives);
        each.filter_map(|(source, drive)| Some((source.as_str(), &drive.as_ref()?.control)))
    }

    /// Samples of each.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.begins.iter().skip(1).copied().chain([self.end]);
        self.begins.iter().zip(ends).map(|(&from, to)| from..to)
    }

    /// Samples of the one that holds sample `k`.
    pub fn holding(&self, k: usize) -> Range<usize> {
        let index = self.index(k);
        self.begins[index]..self.begins.get(index + 1).copied().unwrap_or(self.end)
    }

    /// Which of them holds sample `k`.
    fn index(&self, k: usize) -> usize {
        let next = self.begins.partition_point(|&begin| begin <= k);
        next.saturating_sub(1)
    }

    /// The position loop behind the command of the one that holds sample `k`.
    pub(super) fn drive_at(&self, k: usize) -> Option<&PositionDrive> {
        self.drives[self.index(k)].as_deref()
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
