//! Drawings as SVG text: measured against model, cost curves, Bode plots. Colours are safe for the
//! colour-blind (Okabe, Ito, 2008).

mod bode;
mod curves;
mod overlay;

pub use bode::bode;
pub use curves::cost_curves;
pub use overlay::overlay;

use crate::error::Error;
use plotters::prelude::RGBColor;

/// Blue, vermilion, green, purple, orange, sky blue, black, brownish grey.
pub(crate) const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 90, 150),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(30, 30, 30),
    RGBColor(130, 120, 110),
];

/// Fonts by family, as a browser or viewer finds them.
pub(crate) const FONT: &str = "sans-serif";

/// A drawing that fails leaves the numbers untouched; say so.
pub(crate) fn failed(error: impl std::fmt::Display) -> Error {
    Error::Failed(format!("the drawing could not be made: {error}"))
}

/// At most about `most` of `count` indices, the last included.
pub(crate) fn thinned(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let step = count.div_ceil(most.max(1)).max(1);
    (0..count)
        .step_by(step)
        .chain(count.checked_sub(1).filter(|last| last % step != 0))
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
