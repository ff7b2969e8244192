//! The order of a log's times: where they begin anew, run over, or hold one that is absurd.

use super::motor_units::TimeUnit;
use super::read_error::ReadFault;

/// Part of a recording's length, from its beginning, within which a time that goes back begins a new recording.
const RESTART: f64 = 0.1;
/// A step of so many usual ones leads to no time of this recording.
const ABSURD: f64 = 100.0;
/// Bits after which counters of milliseconds and microseconds run over.
const CLOCK_BITS: [i32; 3] = [16, 24, 32];

/// What the next time of a log means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Next {
    /// It goes on.
    On,
    /// It is that of the row before.
    Repeats,
    /// A new recording begins.
    Anew,
    /// The row before had an absurd time, and this one goes on from the one before that.
    WithoutLast,
    /// The row before, the only one of what seemed a new recording, had an absurd time: the recording before goes on.
    Resumes,
}

/// The times of one recording so far, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) first: f64,
    /// The one before the last.
    before: f64,
    pub(super) last: f64,
    /// A usual step: the mean of those that were not absurd.
    usual: f64,
    steps: u32,
    pub(super) count: u64,
}

impl Span {
    pub(super) fn new(first: f64) -> Self {
        Span {
            first,
            before: first,
            last: first,
            usual: 0.0,
            steps: 0,
            count: 1,
        }
    }

    /// Takes a time that goes on.
    pub(super) fn take(&mut self, now: f64) {
        let step = now - self.last;
        if self.steps == 0 || step < ABSURD * self.usual {
            self.steps = (self.steps + 1).min(1000);
            self.usual += (step - self.usual) / f64::from(self.steps);
        }
        (self.before, self.last) = (self.last, now);
        self.count += 1;
    }

    /// Forgets the last time.
    pub(super) fn drop_last(&mut self) {
        self.last = self.before;
        self.count -= 1;
    }

    /// Whether a step leads to no time of this recording.
    fn is_absurd(&self, step: f64) -> bool {
        self.steps > 0 && step > ABSURD * self.usual
    }

    /// What a time means that comes next; `several` where the log may hold several recordings, and `earlier` is the one before this one.
    ///
    /// # Errors
    /// Time goes back.
    pub(super) fn next(
        &self,
        now: f64,
        several: bool,
        earlier: Option<&Span>,
    ) -> Result<Next, ReadFault> {
        let alone = self.count == 1;
        if let Some(earlier) = earlier.filter(|_| alone) {
            let step = now - earlier.last;
            if step > 0.0
                && !earlier.is_absurd(step)
                && (now - self.last).abs() > ABSURD * earlier.usual
            {
                return Ok(Next::Resumes);
            }
        }
        if now > self.last {
            return Ok(Next::On);
        }
        if now == self.last {
            return Ok(Next::Repeats);
        }
        if self.count > 2 && now > self.before && self.is_absurd(self.last - self.before) {
            return Ok(Next::WithoutLast);
        }
        // A clock that goes back begins anew, as it does for every episode of a log; a row out of order does not.
        if several && now - self.first <= RESTART * (self.last - self.first) {
            return Ok(Next::Anew);
        }
        Err(ReadFault::TimeBack {
            before: self.last,
            now,
        })
    }

    /// What a counter of the clock has lost where it ran over before `now`, s.
    pub(super) fn ran_over(&self, now: f64, unit: TimeUnit) -> Option<f64> {
        if self.steps == 0 || now >= self.last {
            return None;
        }
        let lost = CLOCK_BITS.map(|bits| unit.seconds(2f64.powi(bits)));
        lost.into_iter().find(|lost| {
            let step = now + lost - self.last;
            step > 0.0 && step <= 10.0 * self.usual
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(times: &[f64]) -> Span {
        let mut span = Span::new(times[0]);
        times[1..].iter().for_each(|time| span.take(*time));
        span
    }

    #[test]
    fn what_a_time_means_is_told() {
        let even: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
        let span = run(&even);
        assert_eq!(span.next(1.0, true, None).unwrap(), Next::On);
        assert_eq!(span.next(0.99, true, None).unwrap(), Next::Repeats);
        assert_eq!(span.next(0.0, true, None).unwrap(), Next::Anew);
        assert!(span.next(0.0, false, None).is_err());
        assert!(span.next(0.5, true, None).is_err());
        let mut absurd = span;
        absurd.take(4.2e12);
        assert_eq!(absurd.next(1.01, true, None).unwrap(), Next::WithoutLast);
        // One row of time zero, and on as before.
        let zero = Span::new(0.0);
        assert_eq!(zero.next(1.01, true, Some(&span)).unwrap(), Next::Resumes);
        assert_eq!(zero.next(0.01, true, Some(&span)).unwrap(), Next::On);
    }

    #[test]
    fn counters_of_microseconds_run_over() {
        let lost = 2f64.powi(32) / 1e6;
        let times: Vec<f64> = (0..100)
            .map(|k| lost - 0.995 + 0.01 * f64::from(k))
            .collect();
        let span = run(&times);
        assert_eq!(span.ran_over(0.005, TimeUnit::Microseconds), Some(lost));
        assert_eq!(span.ran_over(0.005, TimeUnit::Seconds), None);
        assert_eq!(span.ran_over(100.0, TimeUnit::Microseconds), None);
    }
}
