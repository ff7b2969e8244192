//! Drawings of a result for a page, interactive, by plotly: one idea a file. The same drawings stand in the report and
//! on the workbench.
//!
//! | file | shows |
//! |---|---|
//! | `chart` | charts as plain data |
//! | `timeline` | measured against model, the residual with the quantiser's band, the command |
//! | `ladder` | the error as effects are added, down to the encoder's own |
//! | `maps` | the volts that a model misses against speed, current, voltage, time, time since reversal |
//! | `orders` | their strongest lines in the angle, forward and backward |
//! | `correlations` | the residual's correlation with itself and with the command |
//! | `intervals` | how even the samples are |
//! | `forest` | parameters with intervals |
//! | `bode` | position loops with the lines at which margins are read |
//! | `curves` | best cost against model evaluations |
//! | `steady` | steady speeds against voltage, and what a straight line misses |
//! | `profiles` | how much worse a fit becomes as one parameter is held elsewhere |
//! | `refuted` | the readings that no model meets together |
//! | `distribution` | a quantity over many motors |
//! | `histogram` | counting values into bins |

mod bode;
mod chart;
mod correlations;
mod curves;
mod distribution;
mod effect_curve;
mod forest;
mod histogram;
mod intervals;
mod ladder;
mod maps;
mod orders;
mod profiles;
mod refuted;
mod steady;
mod timeline;

pub use bode::bode;
pub use chart::Chart;
pub use correlations::correlations;
pub use curves::cost_curves;
pub use distribution::{Distribution, distribution};
pub use effect_curve::effect_curve;
pub use forest::{Estimates, forest};
pub use intervals::intervals;
pub use ladder::{Judged, LadderBar, ladder};
pub use maps::maps;
pub use orders::orders;
pub use profiles::profiles;
pub use refuted::refuted;
pub use steady::{SteadyLine, steady_curve, steady_residual};
pub use timeline::{IN_A_FILE, Run, Timeline, timeline};

use crate::palette as colour;
use chart::Properties;
use serde_json::json;

/// A drawing with its words and its numbers.
pub struct Picture {
    /// Unique on its page.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// The drawing.
    pub drawing: Drawing,
    /// Its numbers, for those who cannot see it or want them.
    pub table: Option<Table>,
}

/// What is drawn.
pub enum Drawing {
    /// A chart that the page hands to plotly as it is.
    Chart(Chart),
    /// Long series, which the page thins for the width that is seen.
    Timeline(Box<Timeline>),
    /// Nothing: there are numbers only.
    Nothing,
}

/// Rows of text under a head.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub head: Vec<String>,
    /// Rows as long as the head.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with this head and no rows.
    pub fn new(head: &[&str]) -> Self {
        Table {
            head: head.iter().map(|name| (*name).to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

/// An axis with its title; the page gives it the colours of light or dark.
fn axis(title: &str) -> Properties {
    Properties::default()
        .set("title", json!({ "text": title }))
        .set("zeroline", false)
        .set("automargin", true)
}

/// What all charts share: a height, px, and a legend above the drawing, where it hides nothing.
fn layout(height: usize) -> Properties {
    let legend =
        json!({ "orientation": "h", "x": 0.0, "y": 1.02, "xanchor": "left", "yanchor": "bottom" });
    Properties::default()
        .set("height", height)
        .set("margin", json!({ "l": 64, "r": 16, "t": 36, "b": 48 }))
        .set("legend", legend)
        .set(
            "font",
            json!({ "family": "system-ui, sans-serif", "size": 13 }),
        )
}

/// Four digits are more than a drawing shows.
fn rounded(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let scale = 10f64.powi(5 - x.abs().log10().floor() as i32);
    let rounded = (x * scale).round() / scale;
    if rounded.is_finite() { rounded } else { x }
}
