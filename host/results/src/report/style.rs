//! Colour for what a person reads first. Texts carry it as escape sequences; `Session::deliver` takes them out again for
//! everything that is not a terminal, and for users who set `NO_COLOR`.

use anstyle::{AnsiColor, Style};
use std::fmt::Display;

/// Heads of tables and lists.
pub const HEADING: Style = Style::new().bold();
/// Sizes that are drawn, and answers that stand. Not green beside red, which one man in twelve cannot tell apart.
pub const GOOD: Style = AnsiColor::Cyan.on_default();
/// What is not explained.
pub const BAD: Style = AnsiColor::Yellow.on_default();

/// A text in a style.
pub fn painted(style: Style, text: impl Display) -> String {
    format!("{style}{text}{style:#}")
}
