//! When which command reaches the bridge.

use std::collections::VecDeque;

/// One sample of the drive, held until the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSample {
    /// Commanded armature voltage, V (or current, A, or target angle, rad: see [`Amplifier`](super::Amplifier)).
    pub volts: f64,
    /// False opens the bridge: no current flows and the motor coasts.
    pub enabled: bool,
}

/// The drive samples as the bridge meets them: each `latency_s` after its own time.
pub(super) struct Timeline {
    /// Commands on their way, each with the time of its arrival.
    coming: VecDeque<(f64, DriveSample)>,
    latency_s: f64,
    in_force: Option<DriveSample>,
}

impl Timeline {
    pub(super) fn new(latency_s: f64) -> Self {
        Timeline {
            coming: VecDeque::new(),
            latency_s,
            in_force: None,
        }
    }

    /// Sends a command at `time_s`, which must not be earlier than that of the one before.
    pub(super) fn send(&mut self, time_s: f64, sample: DriveSample) {
        // Before the first one arrives the command is 0.
        self.in_force.get_or_insert(DriveSample {
            volts: 0.0,
            ..sample
        });
        self.coming.push_back((time_s + self.latency_s, sample));
    }

    /// Calls `hold(sample, duration_s)` for each stretch of `from_s … to_s` in which the command is
    /// constant, until it fails. Calls must follow each other in time, and come after the first command.
    pub(super) fn play<E>(
        &mut self,
        from_s: f64,
        to_s: f64,
        mut hold: impl FnMut(DriveSample, f64) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut now = from_s;
        while now < to_s {
            while let Some((arrival, sample)) = self.coming.front().copied()
                && arrival <= now
            {
                self.coming.pop_front();
                self.in_force = Some(sample);
            }
            let arrival = self.coming.front().map_or(f64::INFINITY, |next| next.0);
            let until = arrival.min(to_s);
            if let Some(sample) = self.in_force {
                hold(sample, until - now)?;
            }
            now = until;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_arrive_late_by_the_latency_and_fill_the_time_without_gap() {
        let drive = [1.0, 2.0, 3.0].map(|volts| DriveSample {
            volts,
            enabled: true,
        });
        let times = [0.0, 1.0, 2.0, 3.0];
        let mut timeline = Timeline::new(1.25);
        let mut played = Vec::new();
        for (pair, sample) in times.windows(2).zip(drive) {
            timeline.send(pair[0], sample);
            timeline
                .play(pair[0], pair[1], |sample, dt| {
                    played.push((sample.volts, dt));
                    Ok::<_, ()>(())
                })
                .unwrap();
        }
        assert_eq!(
            played,
            [
                (0.0, 1.0),
                (0.0, 0.25),
                (1.0, 0.75),
                (1.0, 0.25),
                (2.0, 0.75)
            ]
        );
    }
}
