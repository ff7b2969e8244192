//! Where a model fails: the volts that its equation misses along the measured motion, and the error of its free run.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::Findings;
use servoid_identify::residual_analysis as found;
use servoid_identify::residual_analysis::whiteness::{AUTOCORRELATION_LIMIT, INPUT_LIMIT};

/// Lines of the spectrum that are written for each direction.
const LINES: usize = 5;

/// What the linear motor and the last model leave.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Residual {
    /// Where the linear motor fails.
    pub base: Where,
    /// Where the last model fails on what was fitted.
    #[serde(rename = "final")]
    pub last: Where,
    /// Where the last model fails on what was held out.
    pub final_on_held_out: Where,
    /// Whether the linear motor's error is the encoder's alone; null where the motor moved too little.
    pub base_whiteness: Option<Whiteness>,
    /// Whether the last model's error is the encoder's alone; null where the motor moved too little.
    pub final_whiteness: Option<Whiteness>,
}

/// Where a model fails; a torque against forward motion counts positive.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Where {
    /// RMS of the missing volts, V.
    pub volts_rms: Option<f64>,
    /// What a perfect model would show, V.
    pub perfect_volts_rms: Option<f64>,
    /// The quantity that explains most of them; null where none explains more than chance.
    pub most: Option<String>,
    /// The missing volts against each quantity.
    pub maps: Vec<Map>,
    /// Strongest lines in the angle, forward.
    pub orders_forward: Vec<Line>,
    /// Strongest lines in the angle, backward.
    pub orders_backward: Vec<Line>,
    /// The open-loop error in parts of the recording.
    pub free_run: Vec<Part>,
}

/// The missing volts against one quantity.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Map {
    /// The quantity.
    pub against: String,
    /// Its unit.
    pub unit: String,
    /// Part of the variance beyond `perfect_volts_rms` that the bins explain.
    pub share: Option<f64>,
    /// The part that is left by the quantities before it (time and the time since a reversal come last), and explained by this one: these
    /// sum to what all explain together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_share: Option<f64>,
    /// Whether that is more than chance.
    pub beyond_chance: bool,
    /// Samples that are worth as much as independent ones.
    pub effective_samples: Option<f64>,
    /// The bins.
    pub bins: Vec<Bin>,
}

/// One bin of a map.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Bin {
    /// Lower end.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
    /// Mean of the missing volts, V.
    pub mean_v: Option<f64>,
    /// Its standard error, V.
    pub error_v: Option<f64>,
    /// Samples in it.
    pub samples: usize,
}

/// A wave of the missing volts in the shaft's angle.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Line {
    /// Waves a revolution.
    pub order: usize,
    /// Amplitude, V.
    pub volts: Option<f64>,
    /// Phase, degrees.
    pub phase_deg: Option<f64>,
    /// Part of the variance that it explains.
    pub share: Option<f64>,
}

/// The open-loop error in one part of the recording.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Part {
    /// Begin, s.
    pub from_s: Option<f64>,
    /// End, s.
    pub to_s: Option<f64>,
    /// Mean error, counts.
    pub mean_counts: Option<f64>,
    /// RMS error, counts.
    pub rms_counts: Option<f64>,
}

/// Whether an error is the encoder's alone. The limits were found by simulating motors that hide nothing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Whiteness {
    /// Whether it is.
    pub white: bool,
    /// Samples.
    pub samples: usize,
    /// Samples that are worth as much as independent ones.
    pub effective_samples: Option<f64>,
    /// Mean autocorrelation.
    pub autocorrelation: Option<f64>,
    /// Its limit.
    pub autocorrelation_limit: f64,
    /// Correlation with the command, standard deviations.
    pub input: Option<f64>,
    /// Its limit.
    pub input_limit: f64,
}

impl From<&Findings> for Residual {
    fn from(findings: &Findings) -> Self {
        Residual {
            base: (&findings.base).into(),
            last: (&findings.last).into(),
            final_on_held_out: (&findings.held_out).into(),
            base_whiteness: findings.base_whiteness.as_ref().map(Into::into),
            final_whiteness: findings.last_whiteness.as_ref().map(Into::into),
        }
    }
}

impl From<&found::ResidualAnalysis> for Where {
    fn from(found: &found::ResidualAnalysis) -> Self {
        let lines = |lines: &[found::Line]| lines.iter().take(LINES).map(Line::from).collect();
        Where {
            volts_rms: finite(found.volts_rms),
            perfect_volts_rms: finite(found.perfect_volts_rms),
            most: found.most().map(|map| map.against.name().0.to_owned()),
            maps: found.maps.iter().map(Map::from).collect(),
            orders_forward: lines(&found.spectrum.forward),
            orders_backward: lines(&found.spectrum.backward),
            free_run: (found.free_run.iter())
                .map(|part| Part {
                    from_s: finite(part.from_s),
                    to_s: finite(part.to_s),
                    mean_counts: finite(part.mean_counts),
                    rms_counts: finite(part.rms_counts),
                })
                .collect(),
        }
    }
}

impl From<&found::Map> for Map {
    fn from(map: &found::Map) -> Self {
        let (against, unit) = map.against.name();
        let bin = |bin: &found::Bin| Bin {
            low: finite(bin.low),
            high: finite(bin.high),
            mean_v: finite(bin.mean_v),
            error_v: finite(bin.error_v),
            samples: bin.samples,
        };
        Map {
            against: against.to_owned(),
            unit: unit.to_owned(),
            share: finite(map.share),
            own_share: finite(map.own_share),
            beyond_chance: map.beyond_chance,
            effective_samples: finite(map.effective_samples),
            bins: map.bins.iter().map(bin).collect(),
        }
    }
}

impl From<&found::Line> for Line {
    fn from(line: &found::Line) -> Self {
        Line {
            order: line.order,
            volts: finite(line.volts),
            phase_deg: finite(line.phase_deg),
            share: finite(line.share),
        }
    }
}

impl From<&found::Whiteness> for Whiteness {
    fn from(found: &found::Whiteness) -> Self {
        Whiteness {
            white: found.is_white(),
            samples: found.samples,
            effective_samples: finite(found.effective_samples),
            autocorrelation: finite(found.autocorrelation),
            autocorrelation_limit: AUTOCORRELATION_LIMIT,
            input: finite(found.input),
            input_limit: INPUT_LIMIT,
        }
    }
}
