//! The files of the page, which it has from this program alone.

use servoid_results::page::assets;

/// A file of the page.
#[derive(Clone, Copy)]
pub(super) struct File {
    /// Its name beneath the secret; none for the page itself.
    pub(super) name: &'static str,
    /// Its kind.
    pub(super) kind: &'static str,
    /// What is in it.
    pub(super) content: &'static [u8],
}

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

macro_rules! file {
    ($kind:expr, $name:literal) => {
        File {
            name: $name,
            kind: $kind,
            content: include_bytes!(concat!("assets/", $name)),
        }
    };
}

/// All of them.
pub(super) fn files() -> Vec<File> {
    let shared = |name, kind, content: &'static str| File {
        name,
        kind,
        content: content.as_bytes(),
    };
    vec![
        File {
            name: "",
            kind: HTML,
            content: include_bytes!("assets/bench.html"),
        },
        file!(STYLE, "tokens.css"),
        file!(STYLE, "bench.css"),
        file!(SCRIPT, "js/main.js"),
        file!(SCRIPT, "js/ask.js"),
        file!(SCRIPT, "js/details.js"),
        file!(SCRIPT, "js/device.js"),
        file!(SCRIPT, "js/elements.js"),
        file!(SCRIPT, "js/error.js"),
        file!(SCRIPT, "js/exports.js"),
        file!(SCRIPT, "js/failing.js"),
        file!(SCRIPT, "js/gallery.js"),
        file!(SCRIPT, "js/keyboard.js"),
        file!(SCRIPT, "js/floor.js"),
        file!(SCRIPT, "js/ladder.js"),
        file!(SCRIPT, "js/lanes.js"),
        file!(SCRIPT, "js/law.js"),
        file!(SCRIPT, "js/live.js"),
        file!(SCRIPT, "js/mapping.js"),
        file!(SCRIPT, "js/names.js"),
        file!(SCRIPT, "js/numbers.js"),
        file!(SCRIPT, "js/parameters.js"),
        file!(SCRIPT, "js/proposals.js"),
        file!(SCRIPT, "js/pyramid.js"),
        file!(SCRIPT, "js/recordings.js"),
        file!(SCRIPT, "js/remedy.js"),
        file!(SCRIPT, "js/searches.js"),
        file!(SCRIPT, "js/signature.js"),
        file!(SCRIPT, "js/sliders.js"),
        file!(SCRIPT, "js/theme.js"),
        file!(SCRIPT, "js/tree.js"),
        file!(SCRIPT, "vendor/uPlot.iife.min.js"),
        file!(STYLE, "vendor/uPlot.min.css"),
        file!("font/woff2", "vendor/inter-latin.woff2"),
        shared("plots.js", SCRIPT, assets::PLOTS),
        shared("plotly.js", SCRIPT, assets::PLOTLY),
        shared("page.css", STYLE, assets::STYLE),
    ]
}
