//! How a text file writes its table: what separates its cells, how it writes numbers, and where its names stand. Told by the
//! first lines of the file; a file with its names in its first row and separators of one kind is read as it ever was.

use super::keyed;
use super::lines::recoded;
use super::row::Row;

/// Bytes by which the dialect is told.
pub(super) const HEAD_BYTES: usize = 1 << 16;
/// Lines with data that are looked at.
const LINES: usize = 100;
/// Lines that may stand before the names: what a device says when it starts, or what a program says of its run.
const MOST_BEFORE: usize = 60;
/// Rows that must look alike for their first one to be the table's beginning.
const ALIKE: usize = 3;

/// Where the names of the columns are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Names {
    /// In a row of their own.
    Row,
    /// Nowhere: the columns are called 1, 2, 3.
    Numbers(usize),
    /// In each cell, as in `t:1 v:2`.
    Keys(Vec<String>),
}

/// How a file writes its table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Dialect {
    /// What separates the cells; a blank stands for any number of blanks.
    pub(super) separator: u8,
    /// Whether 1,5 is one and a half.
    pub(super) decimal_comma: bool,
    /// Whether every row stands in quotes as a whole.
    pub(super) quoted_rows: bool,
    /// Where the names are.
    pub(super) names: Names,
    /// Lines with text before the table.
    pub(super) before: usize,
    /// Whether a row of units stands behind the names.
    pub(super) units_row: bool,
    /// Whether that row says that the columns are pairs of X and Y.
    pub(super) pairs: bool,
}

impl Dialect {
    /// The dialect of a file that begins with `head`.
    pub(super) fn of(head: &[u8]) -> Self {
        let recoded = recoded(head);
        let mut lines = data_lines(recoded.as_ref().map_or(head, String::as_bytes));
        lines.truncate(LINES);
        let usual = Dialect::usual(lines.first().copied().unwrap_or_default());
        let Some(first) = lines.first() else {
            return usual;
        };
        let quoted_rows = is_quoted(first, usual.separator);
        let as_ever = Dialect {
            quoted_rows,
            ..usual.clone()
        };
        // A faulty row is told of in its place: it does not make the table begin behind it.
        let begins = as_ever.cells_of_table(&lines);
        let wider = |other: &Dialect| {
            let mut row = Row::new(other);
            let line = lines.get(other.before);
            line.is_some_and(|line| row.split(line).is_ok() && row.len() > begins)
        };
        let later = |dialect: &Dialect| wider(dialect) || Dialect::is_preamble(&lines, dialect);
        let mut found = Dialect::with_names(&lines, 0, &mut Row::new(&usual))
            .filter(|_| !is_padded(&usual, first))
            .or_else(|| Dialect::keyed(&lines))
            .or_else(|| Dialect::later(&lines).filter(later))
            .unwrap_or(as_ever);
        found.decimal_comma = found.writes_decimal_commas(&lines);
        found
    }

    /// Separators at commas, semicolons or tabs: at what the first row has most of, outside of quotes.
    pub(super) fn usual(header: &[u8]) -> Self {
        let mut quoted = false;
        let mut times = [(b',', 0), (b';', 0), (b'\t', 0)];
        for byte in header {
            quoted ^= *byte == b'"';
            for (separator, times) in &mut times {
                *times += usize::from(!quoted && byte == separator);
            }
        }
        // Of equals the last: a comma is part of a number or a text more often than the others are.
        let most = times.into_iter().max_by_key(|(_, times)| *times);
        let separator = most
            .filter(|(_, times)| *times > 0)
            .map_or(b',', |(byte, _)| byte);
        Dialect::plain(separator)
    }

    /// Names in the first row, and nothing unusual.
    fn plain(separator: u8) -> Self {
        Dialect {
            separator,
            decimal_comma: false,
            quoted_rows: false,
            names: Names::Row,
            before: 0,
            units_row: false,
            pairs: false,
        }
    }

    /// The table whose names, or first numbers, stand in line `at`, split by `row`; `None` where what follows does not look like it.
    fn with_names(lines: &[&[u8]], at: usize, row: &mut Row) -> Option<Self> {
        let rows = lines.get(at..)?;
        let mut dialect = Dialect {
            quoted_rows: is_quoted(rows.first()?, row.separator()),
            before: at,
            ..Dialect::plain(row.separator())
        };
        row.set_quoted_rows(dialect.quoted_rows);
        let split = |row: &mut Row, line: &[u8]| row.split(line).ok().map(|()| Shape::of(row));
        let names = split(row, rows.first()?)?;
        let speaks = row.separator() == b' ' && is_message(row);
        let next = split(row, rows.get(1)?)?;
        if speaks || names.width < 2 || next.cells < names.width || next.width > names.cells {
            return None;
        }
        let mut first = 1;
        if !names.is_numbers() && next.is_words() {
            dialect.units_row = true;
            dialect.pairs = row.len() >= 4
                && (0..row.len()).all(|k| {
                    let name = if k % 2 == 0 { "x" } else { "y" };
                    let bare = |cell| axis_and_unit(cell).0.eq_ignore_ascii_case(name);
                    row.cell(k).is_ok_and(bare)
                });
            // No column without a name has a unit.
            if next.width > names.width && !dialect.pairs {
                return None;
            }
            first = 2;
        }
        if names.is_numbers() {
            dialect.names = Names::Numbers(names.cells);
        }
        let alike = rows.get(first..)?.iter().take(ALIKE);
        let mut any = false;
        for line in alike {
            let shape = split(row, line)?;
            let as_wide = shape.width <= names.cells && shape.cells >= names.width;
            if !as_wide || !shape.is_numbers() {
                return None;
            }
            any = true;
        }
        any.then_some(dialect)
    }

    /// Cells of the first two lines, where they have as many; none where these do not look like a table.
    fn cells_of_table(&self, lines: &[&[u8]]) -> usize {
        let mut row = Row::new(self);
        let mut cells = |line: Option<&&[u8]>| {
            let split = row.split(line?).ok();
            split.map(|()| row.len())
        };
        let first = cells(lines.first());
        let alike = first == cells(lines.get(1));
        first.filter(|cells| alike && *cells >= 2).unwrap_or(0)
    }

    /// A table that begins later than in the first line, or whose cells blanks separate.
    fn later(lines: &[&[u8]]) -> Option<Self> {
        let most = lines.len().min(MOST_BEFORE + 1);
        let mut rows =
            [b';', b'\t', b',', b' '].map(|separator| Row::new(&Dialect::plain(separator)));
        (0..most).find_map(|at| {
            rows.iter_mut()
                .find_map(|row| Dialect::with_names(lines, at, row))
        })
    }

    /// Cells that hold their names.
    fn keyed(lines: &[&[u8]]) -> Option<Self> {
        let most = lines.len().min(MOST_BEFORE + 1);
        (0..most).find_map(|at| {
            let keys = keyed::keys(lines.get(at)?)?;
            let alike = lines.get(at + 1..)?.iter().take(ALIKE);
            let alike: Vec<_> = alike.map(|line| keyed::keys(line)).collect();
            let same = |other: &Option<Vec<String>>| other.as_ref() == Some(&keys);
            (!alike.is_empty() && alike.iter().all(same)).then(|| Dialect {
                names: Names::Keys(keys.clone()),
                before: at,
                ..Dialect::plain(b' ')
            })
        })
    }

    /// Whether line 0 is of a preamble that is filled up with separators to the width of the table, which begins at that of `dialect`: no row
    /// of names has mostly empty cells.
    fn is_preamble(lines: &[&[u8]], dialect: &Dialect) -> bool {
        let mut row = Row::new(dialect);
        let mut filled_up = |line: &&[u8]| is_filled_up(&mut row, line);
        dialect.before > 0 && lines.iter().take(dialect.before).all(&mut filled_up)
    }

    /// The row of units, cell by cell, of a file that begins with `head`.
    pub(super) fn units(&self, head: &[u8]) -> Option<Vec<String>> {
        if !self.units_row {
            return None;
        }
        let recoded = recoded(head);
        let lines = data_lines(recoded.as_ref().map_or(head, String::as_bytes));
        let mut row = Row::new(self);
        row.split(lines.get(self.before + 1)?).ok()?;
        let unit = |cell| match self.pairs {
            true => axis_and_unit(cell).1,
            false => cell,
        };
        let cells = (0..row.len()).map(|k| row.cell(k).map(|cell| unit(cell).to_owned()));
        cells.collect::<Result<_, _>>().ok()
    }

    /// The rows of the table among the first lines.
    pub(super) fn first_rows<'h>(&self, lines: &[&'h [u8]]) -> Vec<&'h [u8]> {
        let names = usize::from(self.names == Names::Row);
        let skipped = self.before + names + usize::from(self.units_row);
        lines.iter().skip(skipped).copied().collect()
    }

    fn writes_decimal_commas(&self, lines: &[&[u8]]) -> bool {
        if matches!(self.names, Names::Keys(_)) {
            return false;
        }
        let mut row = Row::new(self);
        let (mut commas, mut points, mut thousands) = (0, 0, 0);
        for line in lines.iter().skip(self.before + 1) {
            if row.split(line).is_err() {
                continue;
            }
            for cell in (0..row.len()).filter_map(|k| row.cell(k).ok()) {
                let with_point = cell.replace(',', ".");
                commas += usize::from(cell.contains(',') && with_point.parse::<f64>().is_ok());
                points += usize::from(cell.contains('.') && cell.parse::<f64>().is_ok());
                thousands += usize::from(may_be_thousands(cell));
            }
        }
        // In quotes between commas, 12,345 may as well be twelve thousand.
        let ambiguous = self.separator == b',' && thousands == commas;
        commas > 0 && points == 0 && !ambiguous
    }
}

/// The axis and the unit, which may be empty, of a cell as `X[s]` in a row that says which columns are X and which are Y.
fn axis_and_unit(cell: &str) -> (&str, &str) {
    let at = cell.find(['[', '(']).unwrap_or(cell.len());
    (cell[..at].trim_end(), &cell[at..])
}

/// Whether a cell is written as a number with commas between its thousands may be: `12,345`, but not `0,005`.
fn may_be_thousands(cell: &str) -> bool {
    let bare = cell.trim_start_matches(['-', '+']);
    let mut groups = bare.split(',');
    let first = groups.next().unwrap_or_default();
    let rest: Vec<&str> = groups.collect();
    (1..=3).contains(&first.len())
        && !first.starts_with('0')
        && !rest.is_empty()
        && rest.iter().all(|group| group.len() == 3)
}

/// Whether most cells of a row are empty, as of a text that is filled up with separators.
fn is_padded(dialect: &Dialect, line: &[u8]) -> bool {
    let mut row = Row::new(dialect);
    if row.split(line).is_err() || row.len() < 3 {
        return false;
    }
    let shape = Shape::of(&row);
    2 * shape.empty >= shape.cells && shape.width <= 2
}

/// Whether a row has one or two cells, as a preamble does, and empty ones behind them.
fn is_filled_up(row: &mut Row, line: &[u8]) -> bool {
    let shape = row.split(line).map(|()| Shape::of(row));
    shape.is_ok_and(|shape| shape.cells >= 3 && shape.width <= 2)
}

/// Whether a cell is a date with a time of the day.
fn is_date(text: &str) -> bool {
    text.len() >= 16 && text.as_bytes()[0].is_ascii_digit() && super::clock::is_date(text)
}

/// How many cells a row has, and how many of them are numbers.
struct Shape {
    cells: usize,
    /// Cells without the empty ones at the end.
    width: usize,
    numbers: usize,
    empty: usize,
}

impl Shape {
    fn of(row: &Row) -> Self {
        let cells = (0..row.len()).filter_map(|k| row.cell(k).ok());
        let mut shape = Shape {
            cells: row.len(),
            width: 0,
            numbers: 0,
            empty: 0,
        };
        for (k, cell) in cells.enumerate() {
            let number = |text: &str| text.parse::<f64>().is_ok() || is_date(text);
            shape.empty += usize::from(cell.is_empty());
            if !cell.is_empty() {
                shape.width = k + 1;
            }
            shape.numbers += usize::from(number(cell) || number(&cell.replace(',', ".")));
        }
        shape
    }

    /// Whether most of it are texts, as in a row of units.
    fn is_words(&self) -> bool {
        self.cells - self.empty > 2 * self.numbers
    }

    /// Whether the row holds data: two numbers or more, and as many as texts.
    fn is_numbers(&self) -> bool {
        let texts = self.cells - self.numbers - self.empty;
        self.numbers >= 2 && self.numbers >= texts
    }
}

/// Whether a line is one cell in quotes that holds a row.
fn is_quoted(line: &[u8], separator: u8) -> bool {
    let line = line.trim_ascii();
    let Some(inner) = line
        .strip_prefix(b"\"")
        .and_then(|rest| rest.strip_suffix(b"\""))
    else {
        return false;
    };
    inner.contains(&separator) && !inner.contains(&b'"')
}

/// The first lines with data, each without its end. The last line is left out where the head ends in it.
pub(super) fn data_lines(head: &[u8]) -> Vec<&[u8]> {
    let whole = if head.len() < HEAD_BYTES {
        head
    } else {
        let end = head.iter().rposition(|byte| *byte == b'\n');
        &head[..end.map_or(head.len(), |end| end + 1)]
    };
    let whole = whole.strip_prefix(b"\xef\xbb\xbf").unwrap_or(whole);
    whole
        .split(|byte| *byte == b'\n')
        .map(<[u8]>::trim_ascii_end)
        .filter(|line| !line.trim_ascii().is_empty() && line.trim_ascii()[0] != b'#')
        .collect()
}

/// Whether a row of words is what a device says of itself, as `board: rev 2`, and no names.
fn is_message(row: &Row) -> bool {
    let speaks = |k: usize| row.cell(k).is_ok_and(|cell| cell.ends_with(':'));
    row.len() > 1 && speaks(0) && !speaks(row.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Dialect {
        Dialect::of(text.as_bytes())
    }

    #[test]
    fn a_plain_file_is_read_as_ever() {
        for text in [
            "t_s,voltage_v,angle_counts\n0,1,2\n1,2,3\n",
            "# made by hand\n\n t , u \n1,2\n",
            "t;u\n1;2\n3;4\n",
            "a,b\n",
            "",
            "t,u\nx,y\n",
            "t,u\n1,2,3\n",
        ] {
            let first = data_lines(text.as_bytes());
            let usual = Dialect::usual(first.first().copied().unwrap_or_default());
            assert_eq!(of(text), usual, "{text:?}");
        }
    }

    #[test]
    fn separators_and_decimal_commas_are_told() {
        let found = of("t;u;n\n0,001;1,5;3\n0,002;-1,5e1;4\n0,003;2;5\n");
        assert_eq!((found.separator, found.decimal_comma), (b';', true));
        let found = of("t\tu\n0,001\t1,5\n0,002\t2\n");
        assert_eq!((found.separator, found.decimal_comma), (b'\t', true));
        let found = of("t u n\n0.0  1.5   3\n 0.1 1.5 4\n0.2 1 5\n");
        assert_eq!((found.separator, found.decimal_comma), (b' ', false));
        let found = of("t;u\n0.001;1,5\n0.002;2\n");
        assert!(!found.decimal_comma, "it writes both");
        let found = of("\"t,u,n\"\n\"0,1,2\"\n\"1,2,3\"\n\"2,2,3\"\n");
        assert_eq!((found.separator, found.quoted_rows), (b',', true));
    }

    #[test]
    fn what_stands_before_the_table_is_passed_over() {
        let boot = "ets Jul 29 2019 12:21:46\n\nrst:0x1 (POWERON_RESET),boot:0x13\nready\nt_ms,u,n\n0,1,2\n1,1,3\n2,1,4\n";
        let found = of(boot);
        assert_eq!((found.before, found.names), (3, Names::Row));
        let found =
            of("Motor test;4;x\nDate;today\nt;u;n\n[s];[V];[1]\n0,1;1;2\n0,2;1;3\n0,3;1;4\n");
        assert_eq!((found.before, found.units_row), (2, true));
        assert!(found.decimal_comma);
    }

    #[test]
    fn a_table_without_names_has_numbers_or_keys() {
        let found = of("0,1.5,2\n1,1.5,3\n2,1.5,4\n3,1,5\n");
        assert_eq!(found.names, Names::Numbers(3));
        let found = of("hello\nt:0 v:1.5 pos:3\nt:1 v:1.5 pos:4\nt:2 v:-1 pos:5\n");
        let keys = ["t", "v", "pos"].map(str::to_owned).to_vec();
        assert_eq!((found.before, found.names), (1, Names::Keys(keys)));
    }
}
