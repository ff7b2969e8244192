//! What the values of a column are like, as far as that tells what it holds.

/// Values of a column that are kept, from its beginning.
pub(super) const KEPT: usize = 20_000;
/// Different texts of a column that are kept.
const WORDS: usize = 16;

/// What the values of a column are like.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Rows.
    pub(super) rows: u64,
    /// Finite numbers.
    pub(super) numbers: u64,
    /// Whole ones among them.
    pub(super) whole: u64,
    /// Least and greatest.
    range: Option<[f64; 2]>,
    /// How many times the number is another than the one before.
    pub(super) changes: u64,
    /// And a greater one.
    pub(super) rises: u64,
    /// The least difference from one number to the next.
    pub(super) least_step: Option<f64>,
    last: Option<f64>,
    /// Different texts, in the order in which they came.
    pub(super) words: Vec<String>,
    /// Texts that are dates with a time of the day.
    pub(super) dates: u64,
    /// The first values; of a text its place among the words, NaN where there is nothing.
    pub(super) first: Vec<f64>,
}

impl Profile {
    /// Takes the cell of the next row.
    pub(super) fn take_text(&mut self, cell: &str) {
        match cell.parse::<f64>() {
            Ok(value) => self.take(value),
            Err(_) if !super::cell::is_told(cell) => self.take(f64::NAN),
            Err(_) => self.take_word(cell),
        }
    }

    fn take_word(&mut self, cell: &str) {
        self.rows += 1;
        let place = self.words.iter().position(|word| word == cell);
        if self.dates > 0 || self.words.is_empty() {
            self.dates += u64::from(super::clock::is_date(cell));
        }
        let place = place.unwrap_or_else(|| {
            if self.words.len() < WORDS {
                self.words.push(cell.to_owned());
            }
            self.words.len() - 1
        });
        self.keep(place as f64);
    }

    /// Takes the number of the next row; NaN where it has none.
    pub(super) fn take(&mut self, value: f64) {
        self.rows += 1;
        self.keep(value);
        if !value.is_finite() {
            return;
        }
        self.numbers += 1;
        self.whole += u64::from(value.fract() == 0.0);
        let [least, greatest] = self.range.unwrap_or([value; 2]);
        self.range = Some([least.min(value), greatest.max(value)]);
        if let Some(last) = self.last.replace(value) {
            let step = value - last;
            self.changes += u64::from(step != 0.0);
            self.rises += u64::from(step > 0.0);
            if step != 0.0 {
                let least = self.least_step.unwrap_or(f64::INFINITY);
                self.least_step = Some(least.min(step.abs()));
            }
        }
    }

    fn keep(&mut self, value: f64) {
        if self.first.len() < KEPT {
            self.first.push(value);
        }
    }

    /// The value of one of the first rows as a text; none where there is nothing.
    pub fn first_as_text(&self, row: usize) -> Option<String> {
        let value = self.first.get(row).filter(|value| !value.is_nan())?;
        let is_word = self.numbers == 0 && !self.words.is_empty();
        let word = self.words.get(*value as usize).filter(|_| is_word);
        Some(word.cloned().unwrap_or_else(|| value.to_string()))
    }

    /// Least and greatest number.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.range
    }

    /// The largest number without its sign.
    pub(super) fn largest(&self) -> f64 {
        self.range
            .map_or(0.0, |[low, high]| low.abs().max(high.abs()))
    }

    /// Whether all numbers are whole.
    pub(super) fn is_whole(&self) -> bool {
        self.numbers > 0 && self.whole == self.numbers
    }

    /// Whether it holds numbers, and hardly anything else.
    pub(super) fn is_number(&self) -> bool {
        self.words.is_empty()
            || self.numbers > 0 && self.words.len() < 3 && self.numbers * 20 > self.rows * 19
    }

    /// Whether all numbers are one.
    pub(super) fn is_constant(&self) -> bool {
        self.changes == 0
    }

    /// Whether it rises from nearly every row to the next, as times and numbers of rows do.
    pub(super) fn is_rising(&self) -> bool {
        self.rises > 2 && self.rises * 20 >= self.changes * 19 && self.rises * 4 > self.numbers
    }

    /// Different numbers, if they are few; none where there are more than `most`.
    pub(super) fn levels(&self, most: usize) -> Option<Vec<f64>> {
        let mut levels: Vec<f64> = Vec::new();
        for value in self.first.iter().filter(|value| value.is_finite()) {
            if !levels.contains(value) {
                levels.push(*value);
            }
            if levels.len() > most {
                return None;
            }
        }
        levels.sort_by(f64::total_cmp);
        Some(levels)
    }
}
