//! When which command reaches the bridge.

/// One sample of the drive, held until the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSample {
    /// Commanded armature voltage, V (or current, A, with [`Amplifier::Current`](super::Amplifier)).
    pub volts: f64,
    /// False opens the bridge: no current flows and the motor coasts.
    pub enabled: bool,
}

/// The drive samples as the bridge meets them: each `latency_s` after its own time.
pub(super) struct Timeline<'a> {
    drive: &'a [DriveSample],
    times_s: &'a [f64],
    latency_s: f64,
    /// Number of samples that have reached the bridge.
    arrived: usize,
}

impl<'a> Timeline<'a> {
    pub(super) fn new(drive: &'a [DriveSample], times_s: &'a [f64], latency_s: f64) -> Self {
        Timeline {
            drive,
            times_s,
            latency_s,
            arrived: 0,
        }
    }

    /// Calls `hold(sample, duration_s)` for each stretch of `from_s … to_s` in which the command is
    /// constant, until it fails. Calls must follow each other in time. Before the first sample arrives the
    /// command is 0.
    pub(super) fn play<E>(
        &mut self,
        from_s: f64,
        to_s: f64,
        mut hold: impl FnMut(DriveSample, f64) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut now = from_s;
        while now < to_s {
            while self.next_arrival() <= now {
                self.arrived += 1;
            }
            let until = self.next_arrival().min(to_s);
            hold(self.in_force(), until - now)?;
            now = until;
        }
        Ok(())
    }

    fn next_arrival(&self) -> f64 {
        self.times_s
            .get(self.arrived)
            .map_or(f64::INFINITY, |time| time + self.latency_s)
    }

    fn in_force(&self) -> DriveSample {
        match self.arrived {
            0 => DriveSample {
                volts: 0.0,
                enabled: self.drive[0].enabled,
            },
            arrived => self.drive[arrived - 1],
        }
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
        let mut timeline = Timeline::new(&drive, &times[..3], 1.25);
        let mut played = Vec::new();
        for pair in times.windows(2) {
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
