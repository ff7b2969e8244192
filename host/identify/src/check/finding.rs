//! One finding on a recording.

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Remark,
    /// May keep any model from explaining the recording.
    Warning,
    /// Makes a fit meaningless; `--force` overrides it.
    Refusal,
}

impl Severity {
    /// Its name in JSON and text.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Remark => "remark",
            Severity::Warning => "warning",
            Severity::Refusal => "refusal",
        }
    }
}

/// What one look at a recording found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What scripts know it by, such as `held_readings`.
    pub code: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// What was seen, with its numbers.
    pub seen: String,
    /// What to do.
    pub remedy: String,
}

impl Finding {
    pub(crate) fn new(
        code: &'static str,
        severity: Severity,
        seen: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Finding {
            code,
            severity,
            seen: seen.into(),
            remedy: remedy.into(),
        }
    }

    /// Both in one sentence.
    pub fn text(&self) -> String {
        format!("{}: {}", self.seen, self.remedy)
    }
}
