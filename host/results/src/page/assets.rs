//! Style and scripts of pages.

use std::sync::LazyLock;

/// Style of every page.
pub const STYLE: &str = include_str!("assets/page.css");
/// Draws pictures.
pub const PLOTS: &str = include_str!("assets/plots.js");
/// Draws those of a report.
pub const REPORT: &str = include_str!("assets/report.js");

/// Plotly's script, from its crate. The crate gives it wrapped in a tag, with a typesetter for formulas behind, which
/// would double a page's size for nothing.
pub fn plotly() -> &'static str {
    static SCRIPT: LazyLock<String> = LazyLock::new(|| {
        let tags = plotly::Plot::offline_js_sources();
        let inside = tags.split_once('>').map_or("", |(_, rest)| rest);
        inside
            .split_once("</script>")
            .map_or(inside, |(script, _)| script)
            .to_owned()
    });
    &SCRIPT
}

#[cfg(test)]
mod tests {
    use super::plotly;

    #[test]
    fn the_script_is_plotly_alone() {
        let script = plotly();
        assert!(
            script.starts_with("/**\n* plotly.js v3"),
            "{}",
            &script[..80]
        );
        assert!(!script.contains("MathJax=") && script.len() < 5_000_000);
    }
}
