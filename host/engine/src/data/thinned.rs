//! Every so manyeth sample of a recording.

use super::{Data, interval_lengths};
use shared::error::ModelError;
use shared::units::PerUnit;
use std::ops::Range;

impl Data {
    /// Every `every`th sample of each recording. A command is the mean of those that it stands for, which is what a motor feels of commands
    /// much faster than its time constant.
    ///
    /// # Errors
    /// Bases that are not positive.
    pub fn thinned(&self, every: usize) -> Result<Data, ModelError> {
        let groups = |range: Range<usize>| {
            let end = range.end;
            range.step_by(every).map(move |k| k..(k + every).min(end))
        };
        let groups: Vec<_> = self.recordings.ranges().flat_map(groups).collect();
        let kept: Vec<usize> = groups.iter().map(|group| group.start).collect();
        let some = |values: &[f64]| -> Vec<f64> { kept.iter().map(|&k| values[k]).collect() };
        let recordings = self.recordings.thinned(every);
        let units = PerUnit::new(
            self.units.volts,
            self.units.speed,
            self.units.interval * every as f64,
            self.units.counts_per_rev,
        )?;
        let (time_s, counts) = (some(&self.time_s), some(&self.counts));
        let fastest = recordings.steps(&counts).map(f64::abs).fold(0.0, f64::max);
        let (lengths, length_of) = interval_lengths(&time_s, &recordings, units.interval, fastest);
        let mean = |group: &Range<usize>| {
            self.command[group.clone()].iter().sum::<f64>() / group.len() as f64
        };
        Ok(Data {
            source: self.source.clone(),
            command: groups.iter().map(mean).collect(),
            open: (self.open.as_ref()).map(|open| kept.iter().map(|&k| open[k]).collect()),
            measured: self.measured.at(&kept),
            recordings,
            end_of: None,
            units,
            time_s,
            counts,
            lengths,
            length_of,
            ..*self
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::channel::Series;
    use servoid_io::recording::{Drive, Recording};

    fn recording(samples: usize) -> Recording {
        Recording {
            source: "made up".to_owned(),
            time_s: (0..samples).map(|k| k as f64 * 1e-3).collect(),
            command: (0..samples).map(|k| 1.0 + (k % 4) as f64).collect(),
            counts: (0..samples).map(|k| (k * k / 50) as f64).collect(),
            measured: Series::NONE,
            enabled: None,
            counts_per_rev: 2000.0,
            quantised: true,
            supply_v: Some(12.0),
            drive: Drive::Voltage,
            position: None,
        }
    }

    #[test]
    fn every_recording_keeps_its_own_readings_and_the_mean_of_its_commands() {
        let (first, second) = (recording(401), recording(203));
        let data = Data::joined(vec![first.clone(), second.clone()]).expect("two recordings");
        let thin = data.thinned(4).expect("thinned");
        let ranges: Vec<_> = thin.recordings.ranges().collect();
        assert_eq!(ranges, [0..101, 101..152]);
        assert_eq!(thin.units.interval, 4.0 * data.units.interval);
        for (recording, range) in [first, second].iter().zip(ranges) {
            for (at, k) in range.clone().zip((0..recording.len()).step_by(4)) {
                assert_eq!(thin.counts[at], recording.counts[k]);
                let group = &recording.command[k..(k + 4).min(recording.len())];
                let mean = group.iter().sum::<f64>() / group.len() as f64;
                assert!((thin.command[at] * thin.units.volts - mean).abs() < 1e-12);
            }
        }
        assert!(
            thin.lengths
                .iter()
                .all(|length| (length - 1.0).abs() < 1e-9 || *length > 1.0)
        );
    }

    #[test]
    fn every_sample_is_the_recording_itself() {
        let data = Data::new(&recording(100)).expect("a recording");
        let same = data.thinned(1).expect("thinned");
        assert_eq!(same.counts, data.counts);
        assert_eq!(same.command, data.command);
        assert_eq!(same.lengths, data.lengths);
    }
}
