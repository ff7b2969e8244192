//! Steady speeds against voltages, read from a CSV file.

use std::path::Path;

/// Columns of a curve.
const COLUMNS: [&str; 2] = ["voltage_V", "speed_rad_s"];
/// Why a curve cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CurveError {
    /// The file cannot be read as CSV.
    #[error("{file}: {fault}; a curve has a header row voltage_V,speed_rad_s and numbers below it")]
    Csv {
        /// The file.
        file: String,
        /// What the reader says, with the line.
        fault: csv::Error,
    },
    /// A column is missing.
    #[error("{file}: there is no column {column}; a steady curve needs voltage_V and speed_rad_s")]
    Column {
        /// The file.
        file: String,
        /// The column.
        column: &'static str,
    },
    /// A cell is no finite number.
    #[error("{file}:{line}: {column} is not a finite number; correct it or remove the row")]
    Number {
        /// The file.
        file: String,
        /// The line.
        line: u64,
        /// The column.
        column: &'static str,
    },
}

/// Steady speeds of an unloaded motor.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyCurve {
    /// Where they came from.
    pub source: String,
    /// Voltage, V, and steady speed, rad/s.
    pub points: Vec<(f64, f64)>,
}

impl SteadyCurve {
    /// Whether a file holds such a curve and no recording in time: its header names a voltage and a speed,
    /// and no other column.
    pub fn is_in(path: &Path) -> bool {
        let reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_path(path);
        let Ok(mut reader) = reader else { return false };
        let Ok(header) = reader.headers() else {
            return false;
        };
        let is = |name: &str| {
            COLUMNS
                .iter()
                .any(|column| name.eq_ignore_ascii_case(column))
        };
        header.len() == COLUMNS.len() && header.iter().all(is) && header.get(0) != header.get(1)
    }

    /// Reads the columns `voltage_V` and `speed_rad_s`, whatever their case.
    ///
    /// # Errors
    /// See [`CurveError`].
    pub fn read(path: &Path) -> Result<Self, CurveError> {
        let file = path.display().to_string();
        let csv_fault = |fault| CurveError::Csv {
            file: file.clone(),
            fault,
        };
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_path(path)
            .map_err(csv_fault)?;
        let header = reader.headers().map_err(csv_fault)?.clone();
        let place = |column: &'static str| {
            let found = header
                .iter()
                .position(|name| name.eq_ignore_ascii_case(column));
            let file = file.clone();
            found.ok_or(CurveError::Column { file, column })
        };
        let places = [place(COLUMNS[0])?, place(COLUMNS[1])?];
        let mut points = Vec::new();
        for record in reader.records() {
            let record = record.map_err(csv_fault)?;
            let number = |index: usize| {
                let cell = record.get(places[index]).and_then(|cell| cell.parse().ok());
                cell.filter(|value: &f64| value.is_finite())
                    .ok_or_else(|| CurveError::Number {
                        file: file.clone(),
                        line: record.position().map_or(0, csv::Position::line),
                        column: COLUMNS[index],
                    })
            };
            points.push((number(0)?, number(1)?));
        }
        Ok(SteadyCurve {
            source: file,
            points,
        })
    }
}
