//! Location and scatter that some odd values do not move: median, median absolute deviation, and from them the orthogonalised
//! estimate of several quantities together (Maronna and Zamar, 2002, Technometrics 44).

use nalgebra::{DMatrix, SymmetricEigen};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Median absolute deviation of a normal distribution, standard deviations.
const NORMAL_MAD: f64 = 0.674_489_750_196_082;
/// Part of the units by whose distances these are scaled; fewer odd ones than the rest do not move it.
const BULK: f64 = 0.8;

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

/// Squared distance of each row from the middle of all, in the units of a χ² distribution with as many degrees of freedom as there
/// are columns. Columns without spread say nothing. The bulk of the rows is what the distances are scaled by.
pub(crate) fn distances(rows: &[Vec<f64>]) -> Vec<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    let standard: Vec<Vec<f64>> = (0..columns)
        .filter_map(|k| {
            let column: Vec<f64> = rows.iter().map(|row| row[k]).collect();
            let (middle, spread) = centre(&column);
            let one = |value: f64| (value - middle) / spread;
            (spread > 0.0).then(|| column.into_iter().map(one).collect())
        })
        .collect();
    let width = standard.len();
    if width == 0 {
        return vec![0.0; rows.len()];
    }
    // Robust correlations by the spreads of sums and differences.
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
    let mut squares = vec![0.0; rows.len()];
    for axis in 0..width {
        let along: Vec<f64> = (0..rows.len())
            .map(|row| (0..width).map(|k| axes[(k, axis)] * standard[k][row]).sum())
            .collect();
        let (middle, spread) = centre(&along);
        if spread > 0.0 {
            for (square, value) in squares.iter_mut().zip(along) {
                *square += ((value - middle) / spread).powi(2);
            }
        }
    }
    let Ok(law) = ChiSquared::new(width as f64) else {
        return squares;
    };
    let ratio = |part: f64| quantile(&squares, part) / law.inverse_cdf(part);
    let scale = ratio(0.5).max(ratio(BULK));
    if scale > 0.0 {
        squares.iter_mut().for_each(|square| *square /= scale);
    }
    squares
}

/// How many of the columns have a spread.
pub(crate) fn spread_columns(rows: &[Vec<f64>]) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    let has_spread = |k: &usize| {
        let column: Vec<f64> = rows.iter().map(|row| row[*k]).collect();
        centre(&column).1 > 0.0
    };
    (0..columns).filter(has_spread).count()
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
        let law = ChiSquared::new(2.0).unwrap();
        let far = law.inverse_cdf(0.999);
        let found = distances(&rows);
        assert!(found[900..].iter().all(|square| *square > far));
        let wrong = found[..900].iter().filter(|square| **square > far).count();
        assert!(
            wrong <= 9,
            "seed 3: {wrong} of 900 beyond a distance of one in a thousand"
        );
        assert_eq!(spread_columns(&rows), 2);
    }
}
