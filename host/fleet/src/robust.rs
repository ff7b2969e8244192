//! Location and scatter that some odd values do not move: median, median absolute deviation, and from them the orthogonalised
//! estimate of several quantities together, reweighted (Maronna and Zamar, 2002, Technometrics 44).

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// Median absolute deviation of a normal distribution, standard deviations.
const NORMAL_MAD: f64 = 0.674_489_750_196_082;
/// Part of the units by whose distances these are scaled; fewer odd ones than the rest do not move it.
const BULK: f64 = 0.8;
/// Part of usual rows that a first look takes for usual.
const USUAL: f64 = 0.975;
/// Rows a column that a covariance is made of, at least.
const ROWS_A_COLUMN: usize = 3;

/// The middle value; NaN of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a part of the others lie, between two by a straight line; NaN of none.
pub(crate) fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = part * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// Median and spread: the median absolute deviation as a normal distribution's standard deviation.
pub(crate) fn centre(values: &[f64]) -> (f64, f64) {
    let middle = median(values);
    let away: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
    (middle, median(&away) / NORMAL_MAD)
}

/// Squared distances of rows from the middle of all.
pub(crate) struct Distances {
    /// One a row.
    pub(crate) squares: Vec<f64>,
    /// Columns with a spread; the others say nothing.
    pub(crate) columns: usize,
    /// Usual rows, from which mean and covariance are.
    pub(crate) usual: usize,
}

impl Distances {
    /// Probability that a usual row is as far as this one, with mean and covariance estimated (Hotelling, 1931).
    pub(crate) fn p_value(&self, row: usize) -> Option<f64> {
        let (columns, usual) = (self.columns as f64, self.usual as f64);
        let law = FisherSnedecor::new(columns, usual - columns).ok()?;
        let part = usual * (usual - columns) / (columns * (usual * usual - 1.0));
        Some(law.sf(part * self.squares[row]))
    }

    /// Of the rows. A first distance by the orthogonalised estimate says which rows are usual; mean and covariance of these give the
    /// second. Both are scaled by the bulk of the rows.
    pub(crate) fn of(rows: &[Vec<f64>]) -> Self {
        let columns = rows.first().map_or(0, Vec::len);
        let standard: Vec<Vec<f64>> = (0..columns)
            .filter_map(|k| {
                let column: Vec<f64> = rows.iter().map(|row| row[k]).collect();
                let (middle, spread) = centre(&column);
                let one = |value: f64| (value - middle) / spread;
                (spread > 0.0).then(|| column.into_iter().map(one).collect())
            })
            .collect();
        let mut found = Distances {
            squares: vec![0.0; rows.len()],
            columns: standard.len(),
            usual: rows.len(),
        };
        let Ok(law) = ChiSquared::new(found.columns as f64) else {
            return found;
        };
        found.squares = scaled(orthogonalised(&standard, rows.len()), &law);
        let far = law.inverse_cdf(USUAL);
        let usual: Vec<usize> = (0..rows.len())
            .filter(|row| found.squares[*row] < far)
            .collect();
        if let Some(squares) = of_usual(&standard, rows.len(), &usual) {
            found.squares = scaled(squares, &law);
            found.usual = usual.len();
        }
        found
    }
}

/// Squares whose bulk is that of the law.
fn scaled(mut squares: Vec<f64>, law: &ChiSquared) -> Vec<f64> {
    let ratio = |part: f64| quantile(&squares, part) / law.inverse_cdf(part);
    let scale = ratio(0.5).max(ratio(BULK));
    if scale > 0.0 {
        squares.iter_mut().for_each(|square| *square /= scale);
    }
    squares
}

/// Distances along the axes of robust correlations, which are of the spreads of sums and differences.
fn orthogonalised(standard: &[Vec<f64>], rows: usize) -> Vec<f64> {
    let width = standard.len();
    let spread_of = |a: &[f64], b: &[f64], sign: f64| {
        let sum: Vec<f64> = a.iter().zip(b).map(|(a, b)| a + sign * b).collect();
        centre(&sum).1
    };
    let correlations = DMatrix::from_fn(width, width, |j, k| {
        if j == k {
            return 1.0;
        }
        let (a, b) = (&standard[j.min(k)], &standard[j.max(k)]);
        0.25 * (spread_of(a, b, 1.0).powi(2) - spread_of(a, b, -1.0).powi(2))
    });
    let axes = SymmetricEigen::new(correlations).eigenvectors;
    let mut squares = vec![0.0; rows];
    for axis in 0..width {
        let along: Vec<f64> = (0..rows)
            .map(|row| (0..width).map(|k| axes[(k, axis)] * standard[k][row]).sum())
            .collect();
        let (middle, spread) = centre(&along);
        if spread > 0.0 {
            for (square, value) in squares.iter_mut().zip(along) {
                *square += ((value - middle) / spread).powi(2);
            }
        }
    }
    squares
}

/// Distances by mean and covariance of the usual rows; none where these are too few or lie in a plane.
fn of_usual(standard: &[Vec<f64>], rows: usize, usual: &[usize]) -> Option<Vec<f64>> {
    let width = standard.len();
    if usual.len() < ROWS_A_COLUMN * width {
        return None;
    }
    let count = usual.len() as f64;
    let mean: Vec<f64> = standard
        .iter()
        .map(|column| usual.iter().map(|row| column[*row]).sum::<f64>() / count)
        .collect();
    let away = |row: usize| DVector::from_fn(width, |k, _| standard[k][row] - mean[k]);
    let mut covariance = DMatrix::zeros(width, width);
    for &row in usual {
        let away = away(row);
        covariance += &away * away.transpose() / (count - 1.0);
    }
    let factor = covariance.cholesky()?;
    Some(
        (0..rows)
            .map(|row| away(row).dot(&factor.solve(&away(row))))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng::{normal, seeded};

    #[test]
    fn a_tenth_of_odd_rows_moves_no_distance_of_the_others() {
        let mut rng = seeded(3);
        let mut rows: Vec<Vec<f64>> = (0..900)
            .map(|_| {
                let (a, b): (f64, f64) = (normal(&mut rng), normal(&mut rng));
                vec![5.0 + a, 2.0 * a + 0.2 * b, 7.0]
            })
            .collect();
        rows.extend((0..90).map(|_| vec![5.0, 3.0, 7.0]));
        let found = Distances::of(&rows);
        assert_eq!(found.columns, 2);
        let p = |row: usize| found.p_value(row).unwrap();
        assert!((900..990).all(|row| p(row) < 1e-6));
        let wrong = (0..900).filter(|row| p(*row) < 1e-3).count();
        assert!(
            wrong <= 5,
            "seed 3: {wrong} of 900 are as far as one in a thousand"
        );
    }

    /// Of usual rows as many are called far as are expected, however few they are.
    #[test]
    fn usual_rows_are_as_far_as_the_law_says() {
        for rows in [24_usize, 60, 400] {
            let mut rng = seeded(11);
            let fleets = 24_000 / rows;
            let mut far = 0;
            for _ in 0..fleets {
                let fleet: Vec<Vec<f64>> = (0..rows)
                    .map(|_| (0..4).map(|_| normal(&mut rng)).collect())
                    .collect();
                let found = Distances::of(&fleet);
                far += (0..rows)
                    .filter(|row| found.p_value(*row).unwrap() < 1e-3)
                    .count();
            }
            let often = far as f64 / (fleets * rows) as f64;
            assert!(often < 4e-3, "seed 11: {often} of rows of {rows}");
        }
    }
}
