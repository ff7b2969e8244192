//! Recordings of one motor as they came, and as they are fitted.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{HeldOut, holdout};
use servoid_identify::turns;
use servoid_io::input::{Known, MotorFile, read_recording_from};
use servoid_io::recording::Recording;
use std::sync::{Arc, OnceLock};

/// A file and what is known of it: all that is needed to read it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its text.
    pub csv: String,
    /// A `motor.toml`.
    #[serde(default)]
    pub motor: String,
    /// The part of it that is used, s after its first sample; the whole if none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span_s: Option<[f64; 2]>,
}

/// What messages call the motor file, whether it was a file or fields of the page.
pub(super) const MOTOR: &str = "what is said of the motor";

/// One of several recordings.
#[derive(Clone)]
pub struct Single {
    source: Source,
    recording: Recording,
    /// Counts that were added to its readings.
    turned: f64,
}

/// Recordings on the bench that are taken as one: one, or several of one motor.
pub struct Loaded {
    /// As they came.
    pub sources: Vec<Source>,
    /// Read, in the same order.
    recordings: Vec<Recording>,
    /// Counts that were added to the readings of each, for all to be in terms of one angle of the shaft.
    turned: Vec<f64>,
    /// As they are fitted.
    pub data: Arc<Data>,
    /// Facts about the motor.
    pub known: Known,
    cut: OnceLock<Option<Cut>>,
}

/// Recordings in two parts, where there is no other one to judge by: the end of the only one is held out, or the last of several.
pub struct Cut {
    /// The part to fit.
    pub fitted: Data,
    /// The part to hold out.
    pub held_out: Data,
    /// The same in the words of a diagnosis.
    pub kind: HeldOut,
}

impl Loaded {
    /// Reads recordings of one motor; what is known of it stands beside the first.
    ///
    /// # Errors
    /// What the reader of recordings and of motor files refuse, in their words; recordings that cannot be taken together.
    pub fn read(sources: Vec<Source>) -> Result<Self, Error> {
        let mut known = None;
        let mut recordings = Vec::new();
        for source in &sources {
            let motor = MotorFile::parse(&source.motor, MOTOR)?;
            let whole = read_recording_from(source.csv.as_bytes(), &source.name, &motor)?;
            let recording = match source.span_s {
                None => whole,
                Some([from, to]) => whole.between(from, to).ok_or_else(|| {
                    Error::Usage(format!(
                        "{}: from {from} to {to} s there are fewer than two samples; choose a longer span",
                        source.name
                    ))
                })?,
            };
            recording.check_excited()?;
            known.get_or_insert(motor.known);
            recordings.push(recording);
        }
        let turned = vec![0.0; recordings.len()];
        Self::taken(sources, recordings, turned, known.unwrap_or_default())
    }

    fn taken(
        sources: Vec<Source>,
        mut recordings: Vec<Recording>,
        mut turned: Vec<f64>,
        known: Known,
    ) -> Result<Self, Error> {
        if let Some((first, others)) = recordings.split_first_mut() {
            let turns = turns(first, &others.iter().collect::<Vec<_>>());
            turn(others, &mut turned[1..], turns);
        }
        Self::lowered(sources, recordings, turned, known)
    }

    fn lowered(
        sources: Vec<Source>,
        recordings: Vec<Recording>,
        turned: Vec<f64>,
        known: Known,
    ) -> Result<Self, Error> {
        Ok(Loaded {
            data: Arc::new(joined(&recordings)?),
            known,
            recordings,
            turned,
            sources,
            cut: OnceLock::new(),
        })
    }

    /// The same in terms of the shaft's angle in the first recording of `other`.
    #[must_use]
    pub fn in_angle_of(self: Arc<Self>, other: &Loaded) -> Arc<Self> {
        let own: Vec<&Recording> = self.recordings.iter().collect();
        let first = other.recordings.first();
        let turns = first.map_or(Vec::new(), |first| turns(first, &own));
        if turns.iter().all(|turn| *turn == 0.0) {
            return self;
        }
        let (mut recordings, mut turned) = (self.recordings.clone(), self.turned.clone());
        turn(&mut recordings, &mut turned, turns);
        let (sources, known) = (self.sources.clone(), self.known.clone());
        // What was taken together once can be taken together turned.
        Self::lowered(sources, recordings, turned, known).map_or(self, Arc::new)
    }

    /// Counts that were added to the readings of each.
    pub fn turned(&self) -> &[f64] {
        &self.turned
    }

    /// These recordings and further ones.
    ///
    /// # Errors
    /// Recordings that cannot be taken together.
    pub fn with(&self, further: &Loaded) -> Result<Self, Error> {
        let sources = [&self.sources[..], &further.sources].concat();
        let recordings = [&self.recordings[..], &further.recordings].concat();
        let turned = [&self.turned[..], &further.turned].concat();
        Self::taken(sources, recordings, turned, self.known.clone())
    }

    /// Each of them on its own.
    pub fn singles(&self) -> impl Iterator<Item = Single> + '_ {
        let sources = self.sources.iter().zip(&self.turned);
        let each = sources.zip(&self.recordings);
        each.map(|((source, turned), recording)| Single {
            source: source.clone(),
            recording: recording.clone(),
            turned: *turned,
        })
    }

    /// These recordings of one motor, of which `known` is known; nothing of none.
    ///
    /// # Errors
    /// Recordings that cannot be taken together.
    pub fn of(
        singles: impl IntoIterator<Item = Single>,
        known: &Known,
    ) -> Result<Option<Arc<Self>>, Error> {
        let (mut sources, mut recordings, mut turned) = (Vec::new(), Vec::new(), Vec::new());
        for single in singles {
            sources.push(single.source);
            recordings.push(single.recording);
            turned.push(single.turned);
        }
        if sources.is_empty() {
            return Ok(None);
        }
        let taken = Self::taken(sources, recordings, turned, known.clone())?;
        Ok(Some(Arc::new(taken)))
    }

    /// Name, seconds and samples of each.
    pub fn recordings(&self) -> impl Iterator<Item = (&str, f64, usize)> {
        self.recordings.iter().map(|recording| {
            let time = &recording.time_s;
            let seconds = time
                .last()
                .zip(time.first())
                .map_or(0.0, |(last, first)| last - first);
            (recording.source.as_str(), seconds, recording.len())
        })
    }

    /// Whether one of them holds the same samples as one of the others: then it tests nothing that was fitted to that.
    pub fn has_copy_of(&self, other: &Loaded) -> bool {
        let mut own = self.recordings.iter();
        own.any(|own| other.recordings.iter().any(|other| own.is_copy_of(other)))
    }

    /// The part to fit and the part to hold out, made when they are first asked for. `None` where it is too short.
    pub fn cut(&self) -> Option<&Cut> {
        self.cut.get_or_init(|| self.cut_now()).as_ref()
    }

    fn cut_now(&self) -> Option<Cut> {
        match &self.recordings[..] {
            [] => None,
            [only] => {
                let (first, rest, kind) = holdout::cut(only)?;
                Some(Cut {
                    fitted: Data::new(&first).ok()?,
                    held_out: Data::new(&rest).ok()?.at_end_of(Arc::clone(&self.data)),
                    kind,
                })
            }
            [first @ .., last] => Some(Cut {
                fitted: joined(first).ok()?,
                held_out: Data::new(last).ok()?,
                kind: HeldOut::Recording(last.source.clone()),
            }),
        }
    }
}

/// Adds `turns` to the readings, and to what was `turned` before.
fn turn(recordings: &mut [Recording], turned: &mut [f64], turns: Vec<f64>) {
    for ((recording, turned), turn) in recordings.iter_mut().zip(turned).zip(turns) {
        recording.turn(turn);
        *turned += turn;
    }
}

fn joined(recordings: &[Recording]) -> Result<Data, Error> {
    Ok(Data::joined(recordings.to_vec()).map_err(servoid_identify::Error::from)?)
}
