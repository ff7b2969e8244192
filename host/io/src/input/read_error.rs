//! What can be wrong with a recording, each with its remedy.

use std::io;

use super::missing::{Advice, MissingColumn, for_shell, missing_text};
use super::place::Place;
use super::shown::plain;
use crate::position_loop::GainUnknown;

/// A recording that cannot be used: where, and why.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {fault}")]
pub struct ReadError {
    /// File, line, number of the cell and its name.
    pub place: Box<Place>,
    /// What was seen there and what to do.
    pub fault: ReadFault,
}

impl ReadError {
    /// A fault at a place.
    pub(super) fn new(place: Place, fault: ReadFault) -> Self {
        ReadError {
            place: Box::new(place),
            fault,
        }
    }
}

/// What was seen in a recording, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ReadFault {
    /// The system refused to read it.
    #[error("cannot be read: {0}; check the path and its permissions")]
    Io(io::Error),
    /// A log of another format than text.
    #[cfg(feature = "formats")]
    #[error("{place}{}{fault}", if place.is_empty() { "" } else { ": " })]
    Log {
        /// Where in it.
        place: String,
        /// What is wrong there.
        fault: servoid_formats::FormatFault,
    },
    /// A table without times, of which a column is to be joined to those of another table.
    #[error(
        "the table `{table}` has no times, so its rows cannot be joined to those of another table"
    )]
    NoClock {
        /// The table.
        table: String,
    },
    /// The path is a folder.
    #[error("is a folder; name the CSV file inside it")]
    Folder,
    /// Nothing but comments and blank lines.
    #[error(
        "is empty; a recording has a header row (t_s,voltage_v,angle_counts) and at least two samples"
    )]
    Empty,
    /// Not UTF-8, or a NUL byte.
    #[error("this is not UTF-8 text; save the recording as CSV in UTF-8")]
    NotText,
    /// A line that does not end.
    #[error(
        "the line does not end within {limit} bytes; a recording has one short row a sample: is this a CSV file?"
    )]
    LineTooLong {
        /// The limit in bytes.
        limit: usize,
    },
    /// Lines ended by carriage returns alone.
    #[error("a carriage return inside the line; save the file with line ends LF or CRLF")]
    CarriageReturn,
    /// A quote that the line does not close.
    #[error(
        "a quote (\") is opened and not closed on this line; numbers need no quotes: remove it"
    )]
    OpenQuote,
    /// More rows than will be held in memory.
    #[error(
        "more than {limit} samples; read a part of it by --from and --to (from_s and to_s under [log]), or keep every second row"
    )]
    TooManyRows {
        /// The limit in rows.
        limit: usize,
    },
    /// The memory is not there.
    #[error("no memory for more samples; split the recording, or keep every second row")]
    OutOfMemory,
    /// The first row holds numbers.
    #[error(
        "the first row holds numbers ({first}) where the columns' names must stand; add a header row such as \
         t_s,voltage_v,angle_counts (a line that begins with # is a comment, not a header), or say which column is which \
         by its number: --column time=1 --column voltage=2 --column angle=3"
    )]
    NoHeader {
        /// The first row.
        first: String,
    },
    /// Columns that are not there.
    #[error("{}", missing_text(.missing, .header, .motor, .advice.as_deref()))]
    MissingColumns {
        /// What is missing.
        missing: Vec<MissingColumn>,
        /// The names the header has.
        header: Vec<String>,
        /// How to speak of the motor file.
        motor: String,
        /// What the values of the columns tell.
        advice: Option<Box<Advice>>,
    },
    /// Two columns of one name.
    #[error("the header has this name {times} times; rename all but the one that is meant")]
    RepeatedColumn {
        /// How often.
        times: usize,
    },
    /// A row with too many or too few cells.
    #[error(
        "the row has {cells} cells, the header {header}; write one cell a column, or correct the separators"
    )]
    Ragged {
        /// Cells in the row.
        cells: usize,
        /// Cells in the header.
        header: usize,
    },
    /// A row that names other numbers than the first one.
    #[error("this row does not name the same numbers as the first one; remove it")]
    OtherKeys,
    /// An empty cell.
    #[error("the cell is empty; fill in the number or remove the row")]
    EmptyCell,
    /// Text where a number belongs.
    #[error("\"{text}\" is not a number; {remedy}")]
    NotANumber {
        /// The cell.
        text: String,
        /// What to do.
        remedy: &'static str,
    },
    /// NaN.
    #[error(
        "\"{text}\" is not a number (NaN); remove the row or find out why the logger had no value"
    )]
    Nan {
        /// The cell.
        text: String,
    },
    /// Infinite, or beyond what a double holds.
    #[error("\"{text}\" is infinite or too large; remove the row or correct the number")]
    Infinite {
        /// The cell.
        text: String,
    },
    /// Neither 0 nor 1.
    #[error(
        "\"{text}\" is neither 0 nor 1, nor a word as ON and OFF; write 1 while the bridge drives the motor and 0 while it is open"
    )]
    NotASwitch {
        /// The cell.
        text: String,
    },
    /// Time goes back.
    #[error(
        "time goes back from {} s to {} s; it must increase from row to row: sort the rows, or cut the \
         recording where the clock was reset",
        plain(*.before), plain(*.now)
    )]
    TimeBack {
        /// Time of the row before, s.
        before: f64,
        /// Time of this row, s.
        now: f64,
    },
    /// Times that lie far outside the recording.
    #[error(
        "{count} rows have times that lie far outside the recording, this one first; correct the clock's column, or state the rate of the \
         samples in its place: --rate HZ"
    )]
    AbsurdTimes {
        /// How many.
        count: u64,
    },
    /// No row tells an angle.
    #[error("no row has an angle; name another column: --column angle=NAME")]
    NoAngle,
    /// Rows of several motors that take turns.
    #[error(
        "the rows of several motors take turns: the column `{column}` is {}; say which one is meant: --select {}", values.join(", "),
        for_shell(&format!("{column}={}", values.first().map_or("", String::as_str)))
    )]
    SeveralMotors {
        /// The column that tells them apart.
        column: String,
        /// Its values.
        values: Vec<String>,
    },
    /// A counter that was set to another value, where one recording is wanted.
    #[error(
        "the angle jumps from {from} to {to} counts at sample {sample} (t = {time_s} s), as a counter that is set to another value \
         (re-zeroed, or its index found); give what is before and behind as two recordings, or add the difference"
    )]
    SetAnew {
        /// The first reading after it, from one.
        sample: usize,
        /// Its time, s.
        time_s: f64,
        /// Reading before, counts.
        from: f64,
        /// Reading after, counts.
        to: f64,
    },
    /// A third word in a column of directions.
    #[error(
        "the direction is \"{text}\" here, and \"{first}\" or \"{second}\" before; a direction has two words, or numbers (0 or negative: \
         backwards)"
    )]
    ThirdDirection {
        /// The cell.
        text: String,
        /// One word.
        first: String,
        /// The other.
        second: String,
    },
    /// Several recordings where one is wanted.
    #[error(
        "holds {count} recordings, and one is wanted here; name one of them: {source_name}#{first}"
    )]
    Several {
        /// How many.
        count: usize,
        /// The file.
        source_name: String,
        /// What the first is called.
        first: String,
    },
    /// A part that is not there.
    #[error("has no part `{part}`; it has {known}")]
    NoSuchPart {
        /// What was asked for.
        part: String,
        /// What there is.
        known: String,
    },
    /// A selection by a column that is not there.
    #[error("no column `{name}` to select rows by; {hint}")]
    NoSelectColumn {
        /// Its name.
        name: String,
        /// The nearest name, or all of them.
        hint: String,
    },
    /// A selection that no row meets.
    #[error("no row has {selection}")]
    NothingSelected {
        /// The selection.
        selection: String,
    },
    /// Time stands still.
    #[error(
        "time repeats {} s; it must increase from row to row: remove the repeated row, or log time with more digits",
        plain(*.now)
    )]
    TimeRepeats {
        /// Time of both rows, s.
        now: f64,
    },
    /// A reading no 32-bit counter can hold.
    #[error(
        "{} counts are beyond a 32-bit counter (-2147483648 ... 2147483647); subtract the first reading from all \
         (the angle may start anywhere)",
        plain(*.counts)
    )]
    BeyondCounter {
        /// The reading, counts.
        counts: f64,
    },
    /// A fraction of a count.
    #[error(
        "{} is not a whole number of counts; if the column holds an angle, name its unit under [units] in \
         {motor}: angle = \"rad\" (or deg, rev, m)",
        plain(*.counts)
    )]
    FractionalCounts {
        /// The reading.
        counts: f64,
        /// How to speak of the motor file.
        motor: String,
    },
    /// Too short to be a recording.
    #[error("the recording has {} after the header; at least two samples are needed", samples(*.0))]
    TooFewSamples(usize),
    /// Columns of different lengths.
    #[error("{column} has {length} samples, time has {samples}; give as many of each")]
    Uneven {
        /// The other column.
        column: &'static str,
        /// Its samples.
        length: usize,
        /// Samples of the time.
        samples: usize,
    },
    /// The encoder is unknown.
    #[error(
        "counts_per_rev is not known; add `counts_per_rev = 2048` (your encoder's lines times 4) at the top of \
         {motor}, or give --counts-per-rev"
    )]
    NoCountsPerRev {
        /// How to speak of the motor file.
        motor: String,
    },
    /// A duty without a supply.
    #[error(
        "the command is a duty, so the supply voltage is needed; add `supply_v = 24.0` (your supply) at the top of \
         {motor}, or give --supply-v"
    )]
    NoSupply {
        /// How to speak of the motor file.
        motor: String,
    },
    /// A position loop of unknown limit.
    #[error(
        "the largest voltage of the position loop is not known; add `supply_v = 7.4` (your supply) at the top of \
         {motor} or `limit_v = 7.4` under [drive], or give --supply-v"
    )]
    NoLimit {
        /// How to speak of the motor file.
        motor: String,
    },
    /// A position loop of unknown gain, in a recording that does not tell it.
    #[error(
        "volts cannot be told from the position loop's gain: {why}; give the gain (gain_v_per_rad = 8.4 under [drive] in \
         {motor}, or --loop gain_v_per_rad=8.4), or record a step of the target large enough that the drive's voltage \
         reaches its limit"
    )]
    LoopGain {
        /// Why this recording does not tell it.
        why: GainUnknown,
        /// How to speak of the motor file.
        motor: String,
    },
    /// Metres without a pitch.
    #[error(
        "the angle is in metres, so the travel per revolution is needed; add `metres_per_rev = 0.0025` (your screw or \
         pulley) at the top of {motor}, or give --metres-per-rev"
    )]
    NoMetresPerRev {
        /// How to speak of the motor file.
        motor: String,
    },
    /// A number of the motor file, or of a flag in its place, that has no meaning.
    #[error("{key} is {}; a finite number greater than zero is needed", plain(*.value))]
    NotPositive {
        /// The key.
        key: &'static str,
        /// The value.
        value: f64,
    },
    /// A duty beyond all of the supply.
    #[error(
        "a duty of {} is more than all of the supply ({full} in the unit `{unit}`); say the command's unit: --unit \
         voltage=percent for -100 ... 100, pwm8 for -255 ... 255, int8 for -127 ... 127, V for volts",
        plain(*.duty)
    )]
    DutyBeyondSupply {
        /// The duty.
        duty: f64,
        /// All of the supply in this unit.
        full: f64,
        /// The unit.
        unit: &'static str,
    },
    /// Nothing was commanded.
    #[error(
        "the command is zero in every row while the bridge is driven, so there is no response to fit; record the motor \
         while a voltage is applied, or map the right column"
    )]
    NoCommand,
    /// The encoder stood still.
    #[error(
        "the encoder reads {counts} counts in every row: it never moved; check its wiring, the voltage against \
         friction, and the angle's column"
    )]
    NeverMoved {
        /// The reading.
        counts: f64,
    },
    /// The encoder moved by less than can be fitted.
    #[error(
        "the encoder moved only {travel} counts; at least {needed} are needed to tell motion from quantisation: apply \
         more voltage or record longer"
    )]
    TooLittleTravel {
        /// Largest less smallest reading, counts.
        travel: f64,
        /// What is needed, counts.
        needed: f64,
    },
    /// A reading that stands alone.
    #[error(
        "the encoder reads {at} counts at t = {time_s} s (sample {sample}), {off:+.0} counts off its neighbours {from} and \
         {to}: no shaft goes there and back within one sample; it is a glitch, or a counter read while it ran over \
         (65536 for 16 bits). Correct that reading, or leave its row out"
    )]
    Spike {
        /// Its time, s.
        time_s: f64,
        /// Its number, from one.
        sample: usize,
        /// Reading before.
        from: f64,
        /// The reading.
        at: f64,
        /// Reading after.
        to: f64,
        /// Its distance from the middle of its neighbours, counts.
        off: f64,
    },
    /// A counter of 16 or 32 bits that ran over.
    #[error(
        "the encoder jumps from {from} to {to} counts at t = {time_s} s, as a {bits}-bit counter does when it runs \
         over; add the multiples of 2^{bits} in the logger, so that the reading is cumulative"
    )]
    CounterRanOver {
        /// Time of the second reading, s.
        time_s: f64,
        /// Reading before.
        from: f64,
        /// Reading after.
        to: f64,
        /// Width of the counter.
        bits: u32,
    },
    /// An angle that starts anew every turn.
    #[error(
        "the angle jumps from {from} to {to} counts at t = {time_s} s, and again later, as one does that wraps every \
         {turn} counts; some of its steps are too large a part of that to tell their direction, so that nothing can unwrap it: log the \
         counter as it is (cumulative), or more often"
    )]
    Wraps {
        /// Time of the second reading of the first jump, s.
        time_s: f64,
        /// Reading before.
        from: f64,
        /// Reading after.
        to: f64,
        /// Where it wraps, counts.
        turn: f64,
    },
}

impl ReadFault {
    /// Whether the log can be read once it is said what its columns are, or a fact that they need.
    pub fn asks_what_a_log_is(&self) -> bool {
        matches!(
            self,
            ReadFault::NoHeader { .. }
                | ReadFault::MissingColumns { .. }
                | ReadFault::FractionalCounts { .. }
                | ReadFault::NoCountsPerRev { .. }
                | ReadFault::NoSupply { .. }
                | ReadFault::NoLimit { .. }
                | ReadFault::NoMetresPerRev { .. }
                | ReadFault::SeveralMotors { .. }
                | ReadFault::DutyBeyondSupply { .. }
        )
    }
}

fn samples(count: usize) -> &'static str {
    match count {
        0 => "no sample",
        1 => "one sample",
        _ => "too few samples",
    }
}
