//! Times of a log in seconds: numbers in a unit, or dates.

use super::cell::number;
use super::read_error::ReadFault;
use super::scale::Scale;
use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::TimeZone;

/// Reads the time column of one file.
#[derive(Default)]
pub(super) struct Clock {
    /// The first date: the others are told from it.
    first: Option<Timestamp>,
}

impl Clock {
    /// Seconds of a cell: in the motor file's unit where it holds a number, since the first row where it holds a date.
    pub(super) fn seconds(&mut self, text: &str, scale: &Scale<'_>) -> Result<f64, ReadFault> {
        let why = match number(text) {
            Ok(time) => return Ok(scale.time(time)),
            Err(why) => why,
        };
        let Some(date) = date(text) else {
            return Err(why);
        };
        let first = *self.first.get_or_insert(date);
        Ok((date.as_nanosecond() - first.as_nanosecond()) as f64 / 1e9)
    }
}

/// Whether a text is a date with a time of the day.
pub(super) fn is_date(text: &str) -> bool {
    date(text).is_some()
}

/// A date with a time of the day, with a zone or without.
fn date(text: &str) -> Option<Timestamp> {
    if let Ok(instant) = text.parse::<Timestamp>() {
        return Some(instant);
    }
    let local: DateTime = text.parse().ok()?;
    let instant = TimeZone::UTC.to_timestamp(local);
    instant.ok()
}

#[cfg(test)]
mod tests {
    use super::super::motor_file::MotorFile;
    use super::super::samples::Further;
    use super::*;

    #[test]
    fn dates_are_told_from_the_first() {
        let motor = MotorFile {
            counts_per_rev: Some(1.0),
            ..MotorFile::default()
        };
        let scale = Scale::new(&motor, &Further::default()).expect("a scale");
        for (first, second, wanted) in [
            ("2024-03-01T12:00:00.25Z", "2024-03-01T12:00:01.5Z", 1.25),
            ("2024-03-01 12:00:00.25", "2024-03-01 12:00:00.252", 0.002),
            (
                "2024-03-01T12:00:00+01:00",
                "2024-03-01T12:01:00+01:00",
                60.0,
            ),
        ] {
            let mut clock = Clock::default();
            assert_eq!(clock.seconds(first, &scale).expect(first), 0.0);
            let seconds = clock.seconds(second, &scale).expect(second);
            assert!((seconds - wanted).abs() < 1e-9, "{second}: {seconds}");
        }
        for text in ["noon", "12:00", "", "nan", "2024-03-01"] {
            let read = Clock::default().seconds(text, &scale);
            assert!(read.is_err() || text == "2024-03-01", "{text}");
        }
    }
}
