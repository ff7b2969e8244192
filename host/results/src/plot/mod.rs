//! Drawings as SVG text: columns of a log, measured against model, cost curves, Bode plots, reliability.

mod bode;
mod columns;
mod curves;
mod overlay;
mod reliability;

pub use bode::bode;
pub use columns::columns;
pub use curves::cost_curves;
pub use overlay::overlay;
pub use reliability::{ReliabilityLine, Statement, reliability};

use crate::error::Error;
use crate::palette;
use plotters::prelude::RGBColor;

/// A colour of the palette as plotters takes it.
pub(crate) fn rgb(colour: &str) -> RGBColor {
    let (red, green, blue) = palette::rgb(colour);
    RGBColor(red, green, blue)
}

/// Fonts by family, as a browser or viewer finds them.
pub(crate) const FONT: &str = "sans-serif";

/// A drawing that fails leaves the numbers untouched; say so.
pub(crate) fn failed(error: impl std::fmt::Display) -> Error {
    Error::Failed(format!("the drawing could not be made: {error}"))
}

/// The legend of a chart, in its upper right corner.
macro_rules! legend {
    ($chart:expr) => {
        $chart
            .configure_series_labels()
            .position(plotters::prelude::SeriesLabelPosition::UpperRight)
            .border_style(plotters::prelude::BLACK.mix(0.4))
            .background_style(plotters::prelude::WHITE.mix(0.9))
            .label_font(($crate::plot::FONT, 14))
            .draw()
            .map_err($crate::plot::failed)?
    };
}
pub(crate) use legend;
