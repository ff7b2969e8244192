//! Recordings of one piece of work: which are fitted, which judge, and over which span.

use super::loaded::{Loaded, MOTOR};
use crate::error::Error;
use serde::Deserialize;
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{Budget, Criterion, HeldOut};
use servoid_identify::fit::Options;
use servoid_io::input::MotorFile;
use shared::effects::Kind;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Recordings of one piece of work.
#[derive(Clone)]
pub(super) struct Recordings {
    /// The fitted ones, whole.
    pub(super) fitted: Arc<Loaded>,
    /// Others, never fitted.
    pub(super) held_out: Option<Arc<Loaded>>,
    /// Others that are neither fitted nor judge.
    pub(super) ignored: Option<Arc<Loaded>>,
    /// By which errors models are judged, found when first asked for.
    criterion: Arc<OnceLock<Criterion>>,
    /// Differs from that of all other recordings.
    pub(super) stamp: u64,
}

/// What a recording on the bench is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(super) enum Role {
    /// Models learn from it.
    #[serde(rename = "fitted")]
    Fitted,
    /// It judges them.
    #[serde(rename = "held out")]
    HeldOut,
    /// Nothing.
    #[serde(rename = "ignored")]
    Ignored,
}

/// A number that was not given before.
pub(super) fn stamp() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl Recordings {
    /// Those that are held out are put in terms of the angle of the first that is fitted.
    pub(super) fn new(fitted: Arc<Loaded>, held_out: Option<Arc<Loaded>>) -> Self {
        let held_out = held_out.map(|other| other.in_angle_of(&fitted));
        Recordings {
            fitted,
            held_out,
            ignored: None,
            criterion: Arc::default(),
            stamp: stamp(),
        }
    }

    /// With others that are neither fitted nor judge.
    pub(super) fn ignoring(self, ignored: Option<Arc<Loaded>>) -> Self {
        Recordings { ignored, ..self }
    }

    /// The fitted ones, those held out, and those ignored, as far as there are any.
    pub(super) fn all(&self) -> impl Iterator<Item = &Arc<Loaded>> {
        let others = self.held_out.iter().chain(&self.ignored);
        std::iter::once(&self.fitted).chain(others)
    }

    /// The motor's name, if the first recording's motor file gives one.
    pub(super) fn motor(&self) -> Option<String> {
        let first = self.fitted.sources.first()?;
        MotorFile::parse(&first.motor, MOTOR).ok()?.name
    }

    /// The same recordings in other roles, in the order fitted, held out, ignored in which they stand now.
    ///
    /// # Errors
    /// As many roles as there are recordings, and one at least that is fitted.
    pub(super) fn in_roles(&self, roles: &[Role]) -> Result<Self, Error> {
        let all: Vec<_> = self.all().flat_map(|one| one.singles()).collect();
        if all.len() != roles.len() {
            return Err(Error::Usage(format!(
                "{} recordings have {} roles",
                all.len(),
                roles.len()
            )));
        }
        let of = |role: Role| {
            let own = all.iter().zip(roles).filter(|(_, own)| **own == role);
            let own = own.map(|(single, _)| single.clone());
            Loaded::of(own, &self.fitted.known)
        };
        let fitted = of(Role::Fitted)?.ok_or_else(|| {
            Error::Usage(
                "one recording at least must be fitted; give another that role first".to_owned(),
            )
        })?;
        Ok(Recordings::new(fitted, of(Role::HeldOut)?).ignoring(of(Role::Ignored)?))
    }

    /// The same with another span of recording `k`, s after its own first sample, in the order fitted, held out, ignored; the whole of it
    /// for none.
    ///
    /// # Errors
    /// No such recording; a span that leaves nothing to fit, in words.
    pub(super) fn spanned(&self, k: usize, span_s: Option<[f64; 2]>) -> Result<Self, Error> {
        let mut first = 0;
        let mut changed = |loaded: &Arc<Loaded>| -> Result<Arc<Loaded>, Error> {
            let range = first..first + loaded.sources.len();
            first = range.end;
            if !range.contains(&k) {
                return Ok(Arc::clone(loaded));
            }
            let mut sources = loaded.sources.clone();
            sources[k - range.start].span_s = span_s;
            Ok(Arc::new(Loaded::read(sources)?))
        };
        let fitted = changed(&self.fitted)?;
        let held_out = self.held_out.as_ref().map(&mut changed).transpose()?;
        let ignored = self.ignored.as_ref().map(&mut changed).transpose()?;
        if k >= first {
            return Err(Error::Usage(format!("there is no recording {k}")));
        }
        Ok(Recordings::new(fitted, held_out).ignoring(ignored))
    }

    /// The recording in which samples of what is drawn lie, as [`spanned`](Self::spanned) counts, and the span that they are of it; they end
    /// with that recording.
    pub(super) fn span_of(
        &self,
        samples: &Range<usize>,
        held_out: bool,
    ) -> Option<(usize, [f64; 2])> {
        let last = self.fitted.sources.len() - 1;
        let (loaded, data, first, before) = match (held_out, &self.held_out) {
            (true, Some(other)) => (other, &*other.data, 0, last + 1),
            // Of several the last judges, where no other one does.
            (true, None) => (&self.fitted, self.judge()?, last, 0),
            (false, _) => (&self.fitted, self.shown(), 0, 0),
        };
        let mut ranges = data.recordings.ranges().enumerate();
        let (place, range) = ranges.find(|(_, range)| range.contains(&samples.start))?;
        let place = first + place;
        // What is drawn may be a span already.
        let begin = loaded
            .sources
            .get(place)?
            .span_s
            .map_or(0.0, |span| span[0]);
        let since = |k: usize| begin + data.time_s[k] - data.time_s[range.start];
        let end = samples.end.clamp(samples.start + 1, range.end) - 1;
        Some((before + place, [since(samples.start), since(end)]))
    }

    /// Whether they are the same ones, in the same roles.
    pub(super) fn are(&self, other: &Recordings) -> bool {
        self.stamp == other.stamp
    }

    /// What is fitted and what is held out: the other recordings, or a part of the fitted ones where they are long enough.
    pub(super) fn parts(&self) -> (&Data, &Data) {
        if let Some(other) = &self.held_out {
            return (&self.fitted.data, &other.data);
        }
        match self.fitted.cut() {
            Some(cut) => (&cut.fitted, &cut.held_out),
            None => (&self.fitted.data, &self.fitted.data),
        }
    }

    /// By which errors models are judged. Finding it takes about as long as a fit of the linear motor.
    pub(super) fn criterion(&self) -> &Criterion {
        self.criterion.get_or_init(|| {
            let (data, held_out) = self.parts();
            let never = AtomicBool::new(false);
            let options = options(&self.fitted, &[]);
            Criterion::of(data, held_out, &options, &Budget::usual(&never))
        })
    }

    /// The same, if it is known already.
    pub(super) fn criterion_if_known(&self) -> Option<&Criterion> {
        self.criterion.get()
    }

    /// Options of a fit of a model with these effects, over the span in which it will be judged.
    pub(super) fn options(&self, effects: &[Kind]) -> Options {
        Options {
            window_s: self.criterion().span.window_s,
            ..options(&self.fitted, effects)
        }
    }

    /// What is drawn: all that is fitted, and the end of the only recording, which may be held out.
    pub(super) fn shown(&self) -> &Data {
        match self.kind() {
            HeldOut::Recording(_) => self.parts().0,
            HeldOut::End { .. } | HeldOut::Nothing => &self.fitted.data,
        }
    }

    /// The recordings that are never fitted, where these are recordings of their own.
    pub(super) fn judge(&self) -> Option<&Data> {
        self.kind().source().map(|_| self.parts().1)
    }

    /// What is held out, in the words of a diagnosis.
    pub(super) fn kind(&self) -> HeldOut {
        if let Some(other) = &self.held_out {
            return HeldOut::Recording(other.data.source.clone());
        }
        self.fitted
            .cut()
            .map_or(HeldOut::Nothing, |cut| cut.kind.clone())
    }

    /// Where the held-out end of the only recording begins, s.
    pub(super) fn held_out_from(&self) -> Option<f64> {
        if self.held_out.is_some() {
            return None;
        }
        match self.fitted.cut()?.kind {
            HeldOut::End { from_s, .. } => Some(from_s),
            _ => None,
        }
    }
}

/// Options of work on the bench, of which nothing but the effects and what is known of the motor is said.
pub(super) fn options(loaded: &Loaded, effects: &[Kind]) -> Options {
    Options {
        effects: effects.to_vec(),
        known: loaded.known.clone(),
        ..Options::default()
    }
}
