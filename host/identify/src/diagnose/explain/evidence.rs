//! What was measured that speaks for an effect, as a sentence. The volts that the linear motor misses, with the
//! constants that the refit found, are drawn without any model of the effect: a sentence is only said where
//! that drawing shows it.

use super::settings::{DIFFERENT, IN_PHASE, LEVEL, LINE, SURE};
use crate::diagnose::models::FittedModel;
use crate::diagnose::outcome::Diagnosis;
use crate::error::Error;
use crate::residual_analysis::{self, Against, Bin, Line, Map, ResidualAnalysis};
use servoid_engine::problem::Data;
use shared::effects::{Evidence, Kind};

/// The quantity against which the volts of an effect are drawn, where its equation names one.
pub fn axis(kind: Kind) -> Option<Against> {
    match kind.facts().evidence {
        Evidence::ChangesSign | Evidence::Constant | Evidence::Grows => Some(Against::Speed),
        Evidence::Drifts => Some(Against::Time),
        Evidence::Repeats | Evidence::LargestShare => None,
    }
}

/// The model before step `index`.
pub fn before(diagnosis: &Diagnosis, index: usize) -> &FittedModel {
    let earlier = index.checked_sub(1).and_then(|k| diagnosis.steps.get(k));
    let after = earlier.and_then(|step| step.candidates.first());
    after.unwrap_or(&diagnosis.base)
}

/// Where the recording asks for the effect of step `index`: what the model with it would miss without it, its
/// other constants kept.
///
/// # Errors
/// Where a model cannot run.
pub fn asked_for(
    diagnosis: &Diagnosis,
    index: usize,
    data: &Data,
) -> Result<Option<ResidualAnalysis>, Error> {
    let Some(step) = diagnosis.steps.get(index) else {
        return Ok(None);
    };
    let Some(after) = step.candidates.first() else {
        return Ok(None);
    };
    let without = after.candidate.without(step.added);
    residual_analysis::analyse_residual(data, &without, &after.candidate, after.method).map(Some)
}

/// What the drawing shows of the effect `kind` with these `values` of its parameters, if it shows anything.
pub fn sentence(kind: Kind, values: &[f64], missing: &ResidualAnalysis) -> Option<String> {
    let speed = missing.map(Against::Speed).and_then(Directions::of);
    let facts = kind.facts();
    let special = match facts.evidence {
        Evidence::ChangesSign => speed.and_then(|s| s.friction()),
        Evidence::Constant => speed.and_then(|s| s.constant()),
        Evidence::Grows => speed.and_then(|s| s.growing()),
        Evidence::Repeats => facts
            .periodic
            .and_then(|order| line(missing, order.of(values)?)),
        Evidence::Drifts => missing.map(Against::Time).and_then(drift),
        Evidence::LargestShare => None,
    };
    special.or_else(|| missing.most().map(general))
}

/// Levels of the missing volts in each direction, slow, mean and fast.
#[derive(Clone, Copy)]
struct Directions {
    forward: Level,
    backward: Level,
}

#[derive(Clone, Copy)]
struct Level {
    /// Of the slowest bin, which also holds the smear of the moments of reversal.
    slowest: f64,
    slow: f64,
    mean: f64,
    fast: f64,
    error: f64,
}

impl Level {
    /// From bins by rising speed, without sign.
    fn of(bins: &[Bin]) -> Option<Level> {
        if bins.len() < 3 {
            return None;
        }
        let total: usize = bins.iter().map(|bin| bin.samples).sum();
        let weighted = |value: fn(&Bin) -> f64| {
            let sum: f64 = bins.iter().map(|b| value(b) * b.samples as f64).sum();
            sum / total.max(1) as f64
        };
        Some(Level {
            slowest: bins[0].mean_v,
            slow: bins[1].mean_v,
            mean: weighted(|bin| bin.mean_v),
            fast: bins[bins.len() - 1].mean_v,
            error: weighted(|bin| bin.error_v) / (bins.len() as f64).sqrt(),
        })
    }

    fn sure(&self) -> bool {
        self.mean.abs() > SURE * self.error
    }

    fn even(&self) -> bool {
        (self.fast - self.slow).abs() < LEVEL * self.mean.abs()
    }
}

impl Directions {
    fn of(map: &Map) -> Option<Directions> {
        let forward: Vec<Bin> = map.bins.iter().filter(|b| b.low > 0.0).copied().collect();
        let mut backward: Vec<Bin> = map.bins.iter().filter(|b| b.high < 0.0).copied().collect();
        backward.reverse();
        Some(Directions {
            forward: Level::of(&forward)?,
            backward: Level::of(&backward)?,
        })
    }

    fn sure(&self) -> bool {
        self.forward.sure() && self.backward.sure()
    }

    fn means(&self) -> String {
        format!(
            "{} V forward, {} V backward",
            volts(self.forward.mean),
            volts(self.backward.mean)
        )
    }

    fn friction(&self) -> Option<String> {
        let (f, b) = (&self.forward, &self.backward);
        if !self.sure() || f.mean * b.mean >= 0.0 {
            return None;
        }
        let sizes = (f.mean.abs() - b.mean.abs()).abs() / f.mean.abs().max(b.mean.abs());
        let hump =
            |level: &Level| level.slowest.abs() - level.fast.abs() > LEVEL * level.mean.abs();
        let text = if f.even() && b.even() {
            "residual torque changes sign with speed and does not grow with it"
        } else if hump(f) && hump(b) {
            "residual torque changes sign with speed and is largest near zero speed"
        } else {
            "residual torque changes sign with speed"
        };
        let sizes = if sizes > DIFFERENT {
            ", of different size in the two directions"
        } else {
            ""
        };
        Some(format!("{text}{sizes} ({})", self.means()))
    }

    fn constant(&self) -> Option<String> {
        let (f, b) = (&self.forward, &self.backward);
        let alike = (f.mean - b.mean).abs() < LEVEL * f.mean.abs().max(b.mean.abs());
        (self.sure() && alike && f.mean * b.mean > 0.0).then(|| {
            format!(
                "the same constant voltage is missing in both directions ({})",
                self.means()
            )
        })
    }

    fn growing(&self) -> Option<String> {
        let (f, b) = (&self.forward, &self.backward);
        let grows = |level: &Level| {
            level.fast.abs() - level.slow.abs() > (SURE * level.error).max(LEVEL * level.mean.abs())
        };
        (grows(f) || grows(b)).then(|| {
            format!(
                "residual torque grows with speed (forward from {} to {} V, backward from {} to {} V)",
                volts(f.slow),
                volts(f.fast),
                volts(b.slow),
                volts(b.fast)
            )
        })
    }
}

/// A line that both directions show at the same angles.
fn line(missing: &ResidualAnalysis, order: usize) -> Option<String> {
    let (f, b): (Line, Line) = missing.spectrum.both(order)?;
    let apart = (f.phase_deg - b.phase_deg + 540.0).rem_euclid(360.0) - 180.0;
    (f.share > LINE && b.share > LINE && apart.abs() < IN_PHASE).then(|| {
        format!(
            "a wave of {} cycles a revolution stands in the residual torque at the same angles forward ({} V) and \
             backward ({} V)",
            order,
            plain(f.volts),
            plain(b.volts)
        )
    })
}

/// From the begin to the end of the recording.
fn drift(map: &Map) -> Option<String> {
    let (first, last) = (map.bins.first()?, map.bins.last()?);
    let sure = SURE * libm::hypot(first.error_v, last.error_v);
    ((last.mean_v - first.mean_v).abs() > sure).then(|| {
        format!(
            "the residual against the motion drifts from {} V at the begin to {} V at the end of the recording",
            volts(first.mean_v),
            volts(last.mean_v)
        )
    })
}

/// What explains most, and where it is largest.
fn general(map: &Map) -> String {
    let (name, unit) = map.against.name();
    let name = name.replace('_', " ");
    let largest = map
        .bins
        .iter()
        .max_by(|a, b| a.mean_v.abs().total_cmp(&b.mean_v.abs()));
    let place = largest.map_or(String::new(), |bin| {
        format!(
            ", largest from {} to {} {unit} ({} V)",
            plain(bin.low),
            plain(bin.high),
            volts(bin.mean_v)
        )
    });
    format!(
        "{:.0} % of the volts missing without it depend on the {name}{place}",
        100.0 * map.share
    )
}

/// Where the last model leaves most, for a verdict that cannot name it.
pub fn largest(missing: &ResidualAnalysis) -> Option<String> {
    let mut said = Vec::new();
    if let Some(map) = missing.most() {
        said.push(general(map).replace(" without it", ""));
    }
    let strongest = missing.spectrum.forward.first();
    if let Some(text) = strongest.and_then(|strongest| line(missing, strongest.order)) {
        said.push(text);
    }
    if let Some(part) = missing.worst_part() {
        said.push(format!(
            "the free run is worst from {:.3} to {:.3} s, by {} counts RMS",
            part.from_s,
            part.to_s,
            plain(part.rms_counts)
        ));
    }
    (!said.is_empty()).then(|| said.join("; "))
}

/// Three digits and a sign.
fn volts(x: f64) -> String {
    let text = plain(x.abs());
    if x < 0.0 {
        format!("-{text}")
    } else {
        format!("+{text}")
    }
}

/// Three digits.
pub fn plain(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return "0".to_owned();
    }
    let digits = (2 - libm::log10(x.abs()).floor() as i32).clamp(0, 6) as usize;
    format!("{x:.digits$}")
}
