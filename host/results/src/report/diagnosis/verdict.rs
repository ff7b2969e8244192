//! The verdict in the words of a motor engineer.

use super::bars::counts;
use super::evidence::changed;
use super::{DiagnosisReport, names};
use crate::report::repeats;
use servoid_identify::diagnose::evidence::largest;
use servoid_identify::diagnose::{
    Errors, Floor, FloorKind, HeldOut, Prediction, ProbableSet, Verdict, moves_both_ways,
};
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;

/// A percentage with as many digits as what is missing from the whole needs: 99.98, 97, 12.
fn percent(part: f64) -> String {
    let missing = (100.0 - part).max(1e-9);
    let digits = (1.0 - missing.log10()).ceil().clamp(0.0, 6.0) as usize;
    // Rounding up to the whole would deny what is missing.
    let scale = 10f64.powi(digits as i32);
    format!("{:.digits$}", (part * scale).floor() / scale)
}

/// Sets of at least this probability are told in the verdict.
const PROBABLE: f64 = 0.1;

/// Sets of effects that are all less probable than this are no names.
const NAMES_NOTHING: f64 = 0.02;
/// Sets that fall short of the last model's by no more than this factor explain the data as well.
const AS_PROBABLE: f64 = 0.4;

fn set_name(set: &ProbableSet) -> String {
    match &set.effects[..] {
        [] => "the linear motor alone".to_owned(),
        effects => names(effects).join(" + "),
    }
}

impl DiagnosisReport<'_> {
    /// What is missing if the data allow several answers, and two sentences.
    pub(super) fn verdict_text(&self) -> String {
        self.ambiguity_text() + &self.conclusion_text()
    }

    /// The sets of effects that are probable, where there is more than one.
    fn ambiguity_text(&self) -> String {
        let sets = &self.diagnosis.hypotheses;
        let probable = sets.iter().filter(|set| set.probability >= PROBABLE);
        let said: Vec<String> = probable
            .map(|set| format!("{} ({:.2})", set_name(set), set.probability))
            .collect();
        if said.len() < 2 || self.verdict() == Verdict::Complete {
            return String::new();
        }
        let none = 1.0 - sets.iter().map(|set| set.probability).sum::<f64>();
        format!(
            "These recordings allow several answers, with probabilities: {}; none of the sets that were tried ({:.2}). ",
            said.join(", or "),
            none.max(0.0)
        )
    }

    /// Sets of several effects without `kind` that are nearly as probable as the last model's.
    pub(super) fn other_sets(&self, kind: Kind) -> Vec<String> {
        let sets = &self.diagnosis.hypotheses;
        let own = sets.first().map_or(0.0, |set| set.probability);
        let others = sets.iter().skip(1).filter(|set| {
            set.effects.len() > 1
                && !set.effects.contains(&kind)
                && set.probability >= AS_PROBABLE * own
        });
        others.map(set_name).collect()
    }

    fn conclusion_text(&self) -> String {
        let diagnosis = self.diagnosis;
        let base = counts(diagnosis.base.rms_counts);
        let (fitted, held_out) = self.last_errors();
        match self.verdict() {
            Verdict::Complete | Verdict::MissingEffects if self.repeats_itself().is_some() => {
                self.repeatability_text()
            }
            Verdict::Complete => {
                format!(
                    "The linear motor explains this recording down to the encoder: {} counts RMS are left where it was \
                 fitted and {} {}, and the encoder alone leaves {FLOOR_RMS_COUNTS:.3}. Nothing is missing that these \
                 data could show.",
                    counts(fitted),
                    counts(held_out),
                    self.where_held_out()
                ) + if moves_both_ways(self.data) {
                    ""
                } else {
                    " But the motor never reverses in it: friction, an offset or a load would pass for another gain."
                }
            }
            Verdict::MissingEffects => format!(
                "The linear motor misses this recording by {base} counts RMS; with {} the error falls to {}, and to {} \
                 {}, where the encoder alone leaves {FLOOR_RMS_COUNTS:.3}.{}",
                self.titles(),
                counts(fitted),
                counts(held_out),
                self.where_held_out(),
                self.both_text() + &self.chaos_text() + &self.look_alikes_text()
            ),
            Verdict::Unexplained if diagnosis.fits_only_its_own() => {
                format!(
                    "{} explains the recording that it was fitted to down to the encoder ({} counts RMS), but errs by {} \
                 counts {}. The two are not of one motor in one state, or the second shows what the first does not{}.",
                    match self.names() {
                        Some(names) => format!("The linear motor with {names}"),
                        None => "The linear motor".to_owned(),
                    },
                    counts(fitted),
                    counts(held_out),
                    self.where_held_out(),
                    largest(&self.findings.held_out)
                        .map_or(String::new(), |text| format!(": {text}"))
                ) + &self
                    .cause()
                    .map_or(String::new(), |cause| format!(" {cause}."))
            }
            Verdict::Unexplained => {
                let begins = match diagnosis.steps.len() {
                    0 => format!("The linear motor misses this recording by {base} counts RMS"),
                    _ if self.names_nothing() => format!(
                        "No effect can be named: every set that was tried has a probability below {:.0} %. The model that \
                         predicts best has {}; with it {}",
                        100.0 * NAMES_NOTHING,
                        self.titles(),
                        changed("the error", diagnosis.base.rms_counts, fitted)
                    ),
                    _ => format!(
                        "With {} {}",
                        self.titles(),
                        changed("the error", diagnosis.base.rms_counts, fitted)
                    ),
                };
                if let Some(cause) = self.cause() {
                    return format!(
                        "{begins} ({} {}). Before physics is blamed for the rest, see to the recording: {cause}.",
                        counts(held_out),
                        self.where_held_out()
                    );
                }
                format!(
                    "{begins} ({} {}); {} % of the motion's variance is explained. No effect of the catalogue explains \
                     the rest, which is {:.0} times what the encoder alone leaves.{}",
                    counts(held_out),
                    self.where_held_out(),
                    percent(self.explained_percent()),
                    fitted.max(held_out) / FLOOR_RMS_COUNTS,
                    largest(&self.findings.last)
                        .map_or(String::new(), |text| format!(" Of what is left, {text}."))
                ) + &self.unreached_floor_text()
            }
            Verdict::Inconclusive if self.interrupted => format!(
                "The work was stopped before all effects were tried: the linear motor misses this recording by {base} \
                 counts RMS, the best model so far by {}. Run it again to its end for a verdict.",
                counts(fitted)
            ),
            Verdict::Inconclusive if diagnosis.ran_out => format!(
                "The work ran out before all effects were tried: the linear motor misses this recording by {base} counts \
                 RMS, the best model so far by {}. Run it again with a larger --budget for a verdict.",
                counts(fitted)
            ),
            Verdict::Inconclusive => {
                format!(
                    "The linear motor misses this recording by {base} counts RMS, so that something is missing, but this \
                 recording cannot tell what. See the advice for what to record."
                ) + &self.unreached_floor_text()
            }
        }
    }

    /// The floor, where it is the motor's own repeatability.
    pub(super) fn repeats_itself(&self) -> Option<Floor> {
        let floor = self.diagnosis.floor?;
        (floor.kind == FloorKind::Repeatability && floor.is_reached()).then_some(floor)
    }

    /// That the last model explains the recordings down to what the motor repeats.
    fn repeatability_text(&self) -> String {
        let Some((floor, windows)) = self.repeats_itself().zip(self.diagnosis.last.windowed) else {
            return String::new();
        };
        let seconds = floor.window_s.unwrap_or_default();
        let before = self
            .diagnosis
            .base
            .windowed
            .map_or(f64::NAN, |before| before.fitted);
        let with = match &self.titles()[..] {
            "" => "The linear motor".to_owned(),
            titles => format!("The linear motor with {titles}"),
        };
        let rest = match floor.repeats {
            Some(repeats) => repeats::sentences(&repeats.last.into()),
            None => format!(
                "Two runs of this command would part by some {} counts there, by torque that neither the command nor the motion foretells.",
                counts(floor.counts)
            ),
        };
        format!(
            "{with} explains this recording down to what the motor repeats. In windows of {seconds:.3} s {}, and to {} {}. {rest} Over the \
             whole recording {} counts RMS are left, since such torque adds up.{}",
            changed("the error", before, windows.fitted),
            counts(windows.held_out),
            self.where_held_out(),
            counts(self.last_errors().0),
            self.look_alikes_text()
        )
    }

    /// What is known of a floor that is not reached.
    fn unreached_floor_text(&self) -> String {
        if let Some(repeats) = self.diagnosis.floor.and_then(|floor| floor.repeats) {
            return format!(" {}", repeats::sentences(&repeats.last.into()));
        }
        let Some(floor) = self
            .diagnosis
            .floor
            .filter(|floor| floor.kind == FloorKind::Unknown)
        else {
            return String::new();
        };
        match floor.foretold.map(|foretold| (foretold.share, foretold.from)) {
            Some((share, Some(from))) => format!(
                " Something is missing that depends on the {from}: {:.0} % of what an observer does not expect is foretold by its \
                 own prediction, most of it by the {from}.",
                100.0 * share
            ),
            Some((share, None)) => format!(
                " Something is missing: {:.0} % of what an observer does not expect is foretold by its own prediction.",
                100.0 * share
            ),
            None => " Whether the rest is the motor's own repeatability these readings in motion are too few to tell: record the \
                     same command three times."
                .to_owned(),
        }
    }

    /// Whether the effects of the last model stand there for its prediction alone.
    fn names_nothing(&self) -> bool {
        let sets = &self.diagnosis.hypotheses;
        sets.iter().all(|set| set.probability < NAMES_NOTHING)
    }

    /// RMS errors of the last model, counts.
    pub(super) fn last_errors(&self) -> (f64, f64) {
        let held_out = self.last.validate_rms_counts.unwrap_or(f64::NAN);
        (self.last.rms_counts, held_out)
    }

    /// The last model's errors over the span in which models were judged.
    pub(super) fn last_over_span(&self) -> (f64, f64) {
        if self.diagnosis.span.window_s.is_none() {
            return self.last_errors();
        }
        let predicted = self.diagnosis.predicts.as_ref();
        let ran = || self.diagnosis.last.ran();
        let last = predicted.map_or_else(ran, |own| self.over_span(own));
        (last.fitted, last.held_out)
    }

    /// What a model predicts over the span in which models were judged.
    pub(super) fn over_span(&self, prediction: &Prediction) -> Errors {
        let windows = self.diagnosis.span.window_s.is_some();
        let of = |windowed: f64, whole: f64| if windows { windowed } else { whole };
        Errors {
            fitted: of(prediction.windowed, prediction.whole),
            held_out: of(prediction.held_out_windowed, prediction.held_out_whole),
            floor: FLOOR_RMS_COUNTS,
        }
    }

    /// Part of the fitted motion's variance that the last model explains in one run over the whole recording, per cent; none where
    /// it strays further than the motion itself.
    pub(super) fn explained_percent(&self) -> f64 {
        let counts = &self.data.counts;
        let n = counts.len().max(1) as f64;
        let mean = counts.iter().sum::<f64>() / n;
        let variance = counts.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / n;
        (100.0 * (1.0 - self.last.rms_counts.powi(2) / variance)).max(0.0)
    }

    fn where_held_out(&self) -> &'static str {
        match self.held_out {
            HeldOut::Recording(_) => "on the held-out recording",
            HeldOut::End { .. } => "on the end that was held out",
            HeldOut::Nothing => "on the same recording again",
        }
    }

    /// Titles of the effects that were added.
    pub(super) fn titles(&self) -> String {
        let title = |kind: Kind| format!("{} ({})", kind.description().title, kind.name());
        let titles: Vec<String> = self
            .diagnosis
            .steps
            .iter()
            .map(|s| title(s.added))
            .collect();
        titles.join(" and ")
    }

    /// What one set of parameters leaves on both recordings, where that shows that one motor made them.
    fn both_text(&self) -> String {
        let last = &self.diagnosis.last;
        match last.on_both.filter(|_| last.explains_both()) {
            Some(errors) => format!(
                " One set of parameters leaves {} and {} counts on the two: the fitted recording alone does not determine it better.",
                counts(errors.fitted),
                counts(errors.held_out)
            ),
            None => String::new(),
        }
    }

    /// By what the model was judged where free runs over the whole recording say little.
    fn chaos_text(&self) -> String {
        let last = &self.diagnosis.last;
        let (why, errors) = match (&self.diagnosis.span.window_s, last.windowed, last.observed) {
            (Some(seconds), Some(windowed), _) => (
                format!(
                    "The model was judged in windows of {seconds:.3} s, since {}",
                    self.diagnosis.span.reason
                ),
                windowed,
            ),
            (_, _, Some(tracked)) if !last.free().at_floor() => (
                format!(
                    "A free run is chaotic here, so the model was judged with errors that are forgotten within {} s",
                    tracked.memory_s
                ),
                tracked.errors,
            ),
            _ => return String::new(),
        };
        let followed = match last.followed_fraction {
            part if part > 0.0 && part < 1.0 => format!(
                " On its own it keeps to the readings over the first {:.0} % of the recording.",
                100.0 * part
            ),
            _ => String::new(),
        };
        format!(
            " {why}: {} counts fitted, {} held out.{followed}",
            counts(errors.fitted),
            counts(errors.held_out)
        )
    }

    fn look_alikes_text(&self) -> String {
        let mut text = String::new();
        for step in &self.diagnosis.steps {
            let alike = self.look_alikes(step);
            if !alike.is_empty() {
                text += &format!(
                    " In the place of {}, {} would explain these data as well.",
                    step.added.name(),
                    names(&alike).join(" or ")
                );
            }
        }
        text
    }
}
