//! A direction in words: two of them, of which one is backwards, and perhaps one for a motor that is to stand.

use super::read_error::ReadFault;
use super::shown::shown;
use crate::recording::Recording;

/// The words of a column of directions, in the order in which they came.
#[derive(Clone, Debug, Default)]
pub(super) struct DirectionWords {
    words: Vec<String>,
}

impl DirectionWords {
    /// The sign of a word, as far as it is known while the file is read: the first word is forwards.
    ///
    /// # Errors
    /// A third word.
    pub(super) fn sign(&mut self, text: &str) -> Result<f64, ReadFault> {
        let place = (self.words.iter()).position(|word| word.eq_ignore_ascii_case(text));
        let place = match place {
            Some(place) => place,
            None if is_halt(text) => return Ok(0.0),
            None if self.words.len() < 2 => {
                self.words.push(text.to_owned());
                self.words.len() - 1
            }
            None => {
                return Err(ReadFault::ThirdDirection {
                    text: shown(text),
                    first: shown(&self.words[0]),
                    second: shown(&self.words[1]),
                });
            }
        };
        Ok(if place == 0 { 1.0 } else { -1.0 })
    }

    /// Turns the commands of recordings where the motion shows that the first word is backwards, and says which word is which.
    pub(super) fn settle(&self, recordings: &mut [Recording]) -> Option<String> {
        let [first, second] = &self.words[..] else {
            return None;
        };
        let along: f64 = recordings.iter().map(along).sum();
        let (forward, backward) = if along >= 0.0 {
            (first, second)
        } else {
            for recording in recordings.iter_mut() {
                for command in &mut recording.command {
                    *command = 0.0 - *command;
                }
            }
            (second, first)
        };
        Some(format!(
            "`{}` is forwards and `{}` backwards: so the motion follows the command",
            shown(forward),
            shown(backward)
        ))
    }
}

/// Words for a motor that is to stand; lower case.
const HALTS: [&str; 9] = [
    "halt", "stop", "stopp", "brake", "idle", "neutral", "bremse", "arret", "parada",
];

/// Whether a word says that the motor is to stand.
pub(super) fn is_halt(word: &str) -> bool {
    HALTS.iter().any(|halt| word.eq_ignore_ascii_case(halt))
}

/// How much the motion has the sign of the command.
fn along(recording: &Recording) -> f64 {
    let steps = recording.counts.windows(2).zip(&recording.command);
    steps
        .map(|(pair, command)| (pair[1] - pair[0]) * command)
        .sum()
}
