//! Style and scripts of pages.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::sync::LazyLock;

/// Style of every page.
pub const STYLE: &str = include_str!("assets/page.css");
/// Draws pictures.
pub const PLOTS: &str = include_str!("assets/plots.js");
/// Draws those of a report.
pub const REPORT: &str = include_str!("assets/report.js");
/// Plotly's basic bundle, which draws lines and bars, all that a page has: a quarter of the whole one.
pub const PLOTLY: &str = include_str!("assets/vendor/plotly-basic.min.js");

/// The same as a page of its own carries it: by gzip, in base64.
pub fn packed_plotly() -> &'static str {
    static PACKED: LazyLock<String> = LazyLock::new(|| {
        let mut packer = GzEncoder::new(Vec::new(), Compression::best());
        // Memory takes all that is written.
        let _ = packer.write_all(PLOTLY.as_bytes());
        STANDARD.encode(packer.finish().unwrap_or_default())
    });
    &PACKED
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;

    #[test]
    fn what_is_packed_is_the_script() {
        let bytes = STANDARD.decode(packed_plotly()).expect("base64");
        let mut script = String::new();
        let mut reader = GzDecoder::new(&bytes[..]);
        reader.read_to_string(&mut script).expect("gzip");
        assert_eq!(script, PLOTLY);
    }
}
