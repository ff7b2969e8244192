//! Where a model fails, as tables and as JSON.

use super::json::finite;
use serde::Serialize;
use servoid_identify::diagnose::Findings;
use servoid_identify::diagnose::evidence::plain;
use servoid_identify::diagnose::residual_analysis::whiteness::{
    AUTOCORRELATION_LIMIT, INPUT_LIMIT,
};
use servoid_identify::diagnose::residual_analysis::{Bin, Line, Map, ResidualAnalysis, Whiteness};

/// What the linear motor and the last model leave.
#[derive(Debug, Serialize)]
pub(super) struct ResidualJson {
    base: WhereJson,
    #[serde(rename = "final")]
    last: WhereJson,
    final_on_held_out: WhereJson,
    base_whiteness: Option<WhitenessJson>,
    final_whiteness: Option<WhitenessJson>,
}

impl From<&Findings> for ResidualJson {
    fn from(findings: &Findings) -> Self {
        ResidualJson {
            base: (&findings.base).into(),
            last: (&findings.last).into(),
            final_on_held_out: (&findings.held_out).into(),
            base_whiteness: findings.base_whiteness.as_ref().map(Into::into),
            final_whiteness: findings.last_whiteness.as_ref().map(Into::into),
        }
    }
}

/// Where a model fails.
#[derive(Debug, Serialize)]
pub(super) struct WhereJson {
    volts_rms: Option<f64>,
    perfect_volts_rms: Option<f64>,
    most: Option<&'static str>,
    maps: Vec<MapJson>,
    orders_forward: Vec<LineJson>,
    orders_backward: Vec<LineJson>,
    free_run: Vec<PartJson>,
}

#[derive(Debug, Serialize)]
struct MapJson {
    against: &'static str,
    unit: &'static str,
    share: Option<f64>,
    beyond_chance: bool,
    effective_samples: Option<f64>,
    bins: Vec<BinJson>,
}

#[derive(Debug, Serialize)]
struct BinJson {
    low: Option<f64>,
    high: Option<f64>,
    mean_v: Option<f64>,
    error_v: Option<f64>,
    samples: usize,
}

#[derive(Debug, Serialize)]
struct LineJson {
    order: usize,
    volts: Option<f64>,
    phase_deg: Option<f64>,
    share: Option<f64>,
}

#[derive(Debug, Serialize)]
struct PartJson {
    from_s: Option<f64>,
    to_s: Option<f64>,
    mean_counts: Option<f64>,
    rms_counts: Option<f64>,
}

#[derive(Debug, Serialize)]
struct WhitenessJson {
    white: bool,
    samples: usize,
    effective_samples: Option<f64>,
    autocorrelation: Option<f64>,
    autocorrelation_limit: f64,
    input: Option<f64>,
    input_limit: f64,
}

impl From<&ResidualAnalysis> for WhereJson {
    fn from(found: &ResidualAnalysis) -> Self {
        let lines = |lines: &[Line]| lines.iter().take(LINES).map(line).collect();
        WhereJson {
            volts_rms: finite(found.volts_rms),
            perfect_volts_rms: finite(found.perfect_volts_rms),
            most: found.most().map(|map| map.against.name().0),
            maps: found.maps.iter().map(map).collect(),
            orders_forward: lines(&found.spectrum.forward),
            orders_backward: lines(&found.spectrum.backward),
            free_run: (found.free_run.iter())
                .map(|part| PartJson {
                    from_s: finite(part.from_s),
                    to_s: finite(part.to_s),
                    mean_counts: finite(part.mean_counts),
                    rms_counts: finite(part.rms_counts),
                })
                .collect(),
        }
    }
}

impl From<&Whiteness> for WhitenessJson {
    fn from(found: &Whiteness) -> Self {
        WhitenessJson {
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

fn map(map: &Map) -> MapJson {
    let (against, unit) = map.against.name();
    let bin = |bin: &Bin| BinJson {
        low: finite(bin.low),
        high: finite(bin.high),
        mean_v: finite(bin.mean_v),
        error_v: finite(bin.error_v),
        samples: bin.samples,
    };
    MapJson {
        against,
        unit,
        share: finite(map.share),
        beyond_chance: map.beyond_chance,
        effective_samples: finite(map.effective_samples),
        bins: map.bins.iter().map(bin).collect(),
    }
}

fn line(line: &Line) -> LineJson {
    LineJson {
        order: line.order,
        volts: finite(line.volts),
        phase_deg: finite(line.phase_deg),
        share: finite(line.share),
    }
}

/// Lines of the spectrum that are told for each direction.
const LINES: usize = 5;
/// Half the width of a bar, characters.
const HALF: usize = 12;

/// The shares of all quantities, and the table of the one that explains most.
pub(super) fn table(found: &ResidualAnalysis) -> String {
    let shares: Vec<String> = found
        .maps
        .iter()
        .filter(|map| map.beyond_chance)
        .map(|map| {
            let name = map.against.name().0.replace('_', " ");
            format!("{name} {:.0} %", 100.0 * map.share)
        })
        .collect();
    let mut out = format!(
        "   missing along the measured motion: {} V RMS\n   (a perfect model would show {} V here)\n",
        plain(found.volts_rms),
        plain(found.perfect_volts_rms)
    );
    let Some(most) = found.most() else {
        return out + "   it goes with none of speed, voltage, current and time\n";
    };
    out += &format!("   it goes with {}\n", shares.join(", "));
    let (name, unit) = most.against.name();
    out += &format!(
        "   {:>22}   {:>9}\n",
        format!("{}, {unit}", name.replace('_', " ")),
        "missing, V"
    );
    let sizes = most.bins.iter().map(|bin| bin.mean_v.abs());
    let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
    for bin in &most.bins {
        let length = (bin.mean_v.abs() / largest * HALF as f64).round() as usize;
        let bar = if bin.mean_v < 0.0 {
            format!("{:>HALF$}|", "#".repeat(length))
        } else {
            format!("{:HALF$}|{}", "", "#".repeat(length))
        };
        let line = format!(
            "   {:>9} .. {:>9}   {:>+9.4}  {bar}",
            short(bin.low),
            short(bin.high),
            bin.mean_v
        );
        out += line.trim_end();
        out.push('\n');
    }
    out
}

/// Three digits, with the sign of a negative number.
fn short(x: f64) -> String {
    let sign = if x < 0.0 { "-" } else { "" };
    format!("{sign}{}", plain(x.abs()))
}

/// One line on what is left of an error.
pub(super) fn whiteness_text(found: Option<&Whiteness>) -> String {
    match found {
        None => {
            "the motor moved too little to tell whether its error is the encoder's alone".to_owned()
        }
        Some(found) if found.is_white() => format!(
            "what is left does not hang together (mean autocorrelation {:.2}, limit {AUTOCORRELATION_LIMIT}) nor go \
             with the command ({:.1} standard deviations, limit {INPUT_LIMIT})",
            found.autocorrelation, found.input
        ),
        Some(found) => format!(
            "what is left is no noise: mean autocorrelation {:.2} (limit {AUTOCORRELATION_LIMIT}), correlation with \
             the command {:.1} standard deviations (limit {INPUT_LIMIT})",
            found.autocorrelation, found.input
        ),
    }
}
