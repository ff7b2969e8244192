//! A column in bins of equally many rows, each with its least and its greatest value: what a drawing shows of a log of any length, in
//! bounded memory.

/// Some rows of a column. One without a finite value has its least value above its greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The least finite value.
    pub least: f64,
    /// The greatest finite value.
    pub greatest: f64,
}

impl Bin {
    const EMPTY: Bin = Bin {
        least: f64::INFINITY,
        greatest: f64::NEG_INFINITY,
    };

    /// Both ends; none where no value is finite.
    pub fn ends(self) -> Option<[f64; 2]> {
        (self.least <= self.greatest).then_some([self.least, self.greatest])
    }

    fn with(self, other: Bin) -> Bin {
        Bin {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
        }
    }
}

/// The bins of a column. Those of two columns with as many rows hold the same rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    bins: Vec<Bin>,
    /// Rows of a full bin.
    every: u64,
    /// Rows of the last bin.
    filled: u64,
}

impl Default for Envelope {
    fn default() -> Self {
        Envelope {
            bins: Vec::new(),
            every: 1,
            filled: 0,
        }
    }
}

impl Envelope {
    /// Bins at most: about as many as a drawing is wide. Even, so that they merge in pairs.
    pub const MOST: usize = 1024;

    /// The bins, in the order of the rows.
    pub fn bins(&self) -> &[Bin] {
        &self.bins
    }

    /// Rows of each bin; the last one may have fewer.
    pub fn every(&self) -> u64 {
        self.every
    }

    /// Takes the value of the next row. One that is not finite takes its place and shows as nothing.
    pub(super) fn take(&mut self, value: f64) {
        if self.bins.is_empty() || self.filled == self.every {
            if self.bins.len() == Envelope::MOST {
                self.merge();
            }
            self.bins.push(Bin::EMPTY);
            self.filled = 0;
        }
        self.filled += 1;
        if let Some(last) = self.bins.last_mut().filter(|_| value.is_finite()) {
            let (least, greatest) = (value, value);
            *last = last.with(Bin { least, greatest });
        }
    }

    fn merge(&mut self) {
        for k in 0..self.bins.len() / 2 {
            self.bins[k] = self.bins[2 * k].with(self.bins[2 * k + 1]);
        }
        self.bins.truncate(self.bins.len() / 2);
        self.every *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bin_holds_its_rows_and_no_more() {
        let most = Envelope::MOST;
        for count in [0, 1, 2, most - 1, most, most + 1, 5 * most + 3, 64 * most] {
            let value = |k: usize| match k % 7 {
                3 => f64::NAN,
                5 => f64::INFINITY,
                _ => ((k * k) % 1013) as f64 - 500.0,
            };
            let mut envelope = Envelope::default();
            (0..count).for_each(|k| envelope.take(value(k)));
            let every = envelope.every() as usize;
            assert_eq!(envelope.bins().len(), count.div_ceil(every), "{count}");
            assert!(envelope.bins().len() <= most, "{count}");
            assert!(
                count <= most || 2 * envelope.bins().len() >= most,
                "{count}"
            );
            for (bin, from) in envelope.bins().iter().zip((0..count).step_by(every)) {
                let rows = (from..(from + every).min(count)).map(value);
                let finite: Vec<f64> = rows.filter(|value| value.is_finite()).collect();
                let least = finite.iter().copied().reduce(f64::min);
                let greatest = finite.iter().copied().reduce(f64::max);
                assert_eq!(
                    bin.ends(),
                    least.zip(greatest).map(|(a, b)| [a, b]),
                    "{count}"
                );
            }
        }
    }
}
