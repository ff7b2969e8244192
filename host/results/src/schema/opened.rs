//! `servoid.open/1`: what a log holds, and the command that would fit it.

use super::VERSION;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_io::input::{Survey, SurveyColumn, SurveyTable};

/// What a look into a log calls itself.
pub const SCHEMA: &str = "servoid.open/1";

/// `servoid.open/1`: the tables of a log.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Opened {
    /// `servoid.open/1`.
    pub schema: String,
    /// The file.
    pub file: String,
    /// Its format, for people.
    pub format: String,
    /// The preset of the program that seems to have written it.
    pub preset: Option<String>,
    /// Its tables.
    pub tables: Vec<OpenedTable>,
    /// What its reader has to say.
    pub notes: Vec<String>,
    /// The command that would fit it, ready for a shell.
    pub command: String,
    /// What this command still needs from the user, a sentence each.
    pub needs: Vec<String>,
    /// Version of the program.
    pub version: String,
}

/// One table.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct OpenedTable {
    /// Its name; empty where the file has one table.
    pub name: String,
    /// Rows.
    pub rows: u64,
    /// From the first to the last time, in the unit of the time's column.
    pub span: Option<f64>,
    /// Median of the first steps of the time, in the same unit.
    pub interval: Option<f64>,
    /// Its columns.
    pub columns: Vec<OpenedColumn>,
}

/// One column.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct OpenedColumn {
    /// Its name.
    pub name: String,
    /// `number`, `time` or `text`.
    pub kind: String,
    /// Its unit, where the file says it.
    pub unit: Option<String>,
    /// Least value.
    pub least: Option<f64>,
    /// Greatest value.
    pub greatest: Option<f64>,
    /// What it may be: `time`, `voltage`, `target`, `angle`, `current` or `enabled`.
    pub guess: Option<String>,
    /// The unit that its name tells, as `[units]` calls it.
    pub guessed_unit: Option<String>,
}

impl Opened {
    /// What was seen in `file`; `command` would fit it once it has what it `needs`.
    pub fn new(file: &str, survey: &Survey, command: String, needs: Vec<String>) -> Self {
        Opened {
            schema: SCHEMA.to_owned(),
            file: file.to_owned(),
            format: survey.format.clone(),
            preset: (survey.proposal.motor.log.preset).map(|preset| preset.name.to_owned()),
            tables: survey.tables.iter().map(OpenedTable::new).collect(),
            notes: survey.notes.clone(),
            command,
            needs,
            version: VERSION.to_owned(),
        }
    }
}

impl OpenedTable {
    fn new(table: &SurveyTable) -> Self {
        OpenedTable {
            name: table.name.clone(),
            rows: table.rows,
            span: table.span,
            interval: table.interval,
            columns: table.columns.iter().map(OpenedColumn::new).collect(),
        }
    }
}

impl OpenedColumn {
    fn new(column: &SurveyColumn) -> Self {
        let kind = match (column.is_time, column.is_number) {
            (true, _) => "time",
            (_, true) => "number",
            _ => "text",
        };
        OpenedColumn {
            name: column.name.clone(),
            kind: kind.to_owned(),
            unit: column.unit.clone(),
            least: column.profile.range().map(|[least, _]| least),
            greatest: column.profile.range().map(|[_, greatest]| greatest),
            guess: column.guess.map(str::to_owned),
            guessed_unit: column.guessed_unit.map(str::to_owned),
        }
    }
}
