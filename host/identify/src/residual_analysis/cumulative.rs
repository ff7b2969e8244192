//! The squared error of a model, summed up in the order of time and in the order of speed: where it rises above the band of a right
//! model, the model fails (as the cumulative residuals by which X-ray spectra are judged).

use servoid_engine::problem::Data;

/// Points of a curve.
const POINTS: usize = 160;
/// Encoders at other angles on the same shaft, by which the band is found.
const OTHERS: usize = 40;
/// Samples to both sides over which a speed is taken.
const AROUND: usize = 5;

/// A cumulative share of the squared error.
#[derive(Clone, Debug, PartialEq)]
pub struct Cumulative {
    /// The abscissa: s, or rad/s.
    pub x: Vec<f64>,
    /// Share of the squared error up to there.
    pub share: Vec<f64>,
    /// Least and greatest share that the model leaves there if it is right, and only the encoder's steps are not its own. Empty where
    /// readings are not floored, or something else is not its own.
    pub band: Vec<[f64; 2]>,
}

/// Of a residual (counts, one a sample), over time, and over the model's speed. `free` says that the model ran on its own, so that a
/// right one leaves the encoder's steps only.
pub fn cumulative(data: &Data, errors: &[f64], free: bool) -> [Cumulative; 2] {
    let centre = data.half_cell();
    // Where the shaft is, if the model is right.
    let run: Vec<f64> = (0..data.len())
        .map(|k| data.counts[k] + centre + errors[k])
        .collect();
    let by_time: Vec<usize> = (0..data.len()).collect();
    let radians = core::f64::consts::TAU / data.units.counts_per_rev;
    let speeds: Vec<f64> = (0..data.len())
        .map(|k| data.rate_of(&run, k, AROUND) * radians)
        .collect();
    let mut by_speed = by_time.clone();
    by_speed.sort_by(|&a, &b| speeds[a].total_cmp(&speeds[b]));
    let squares: Vec<f64> = errors.iter().map(|e| e * e).collect();
    let summed = |order: &[usize], x: &[f64]| {
        let at = places(order.len());
        let mut band = Vec::new();
        if data.quantised && free {
            for other in 0..OTHERS {
                let shift = (other as f64 + 0.5) / OTHERS as f64;
                let steps = |k: usize| {
                    let part = (run[k] + shift).rem_euclid(1.0) - 0.5;
                    part * part
                };
                widen(&mut band, shares(order, &at, steps));
            }
        }
        Cumulative {
            x: at.iter().map(|&place| x[order[place]]).collect(),
            share: shares(order, &at, |k| squares[k]),
            band,
        }
    };
    [summed(&by_time, &data.time_s), summed(&by_speed, &speeds)]
}

/// Places in an order of so many samples that are drawn, the last among them.
fn places(samples: usize) -> Vec<usize> {
    let points = POINTS.min(samples);
    (1..=points).map(|k| k * samples / points - 1).collect()
}

/// Shares of the sum of `squares` up to each of the places.
fn shares(order: &[usize], at: &[usize], squares: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sums = Vec::with_capacity(at.len());
    let (mut sum, mut from) = (0.0, 0);
    for &place in at {
        sum += order[from..=place].iter().map(|&k| squares(k)).sum::<f64>();
        from = place + 1;
        sums.push(sum);
    }
    let total = sum.max(f64::MIN_POSITIVE);
    sums.iter().map(|sum| sum / total).collect()
}

fn widen(band: &mut Vec<[f64; 2]>, shares: Vec<f64>) {
    if band.is_empty() {
        *band = shares.iter().map(|&share| [share; 2]).collect();
        return;
    }
    for (band, share) in band.iter_mut().zip(shares) {
        *band = [band[0].min(share), band[1].max(share)];
    }
}
