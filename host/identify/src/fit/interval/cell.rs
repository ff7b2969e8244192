//! One reading: minus the logarithm of the probability of its cell, with derivatives.

use std::f64::consts::{PI, SQRT_2};

/// Beyond so many standard deviations the tail is taken from its continued fraction, which does not underflow.
const FAR: f64 = 5.0;
/// Terms of the continued fraction: beyond `FAR` more change nothing.
const TERMS: u32 = 40;

/// Minus the logarithm of the probability `P = Φ((1 − e)/σ) − Φ(−e/σ)` that an angle which lies `e` counts above the lower edge of
/// a cell is read in it when it has normal noise of `σ` counts; with derivatives by `e` and by `t = ln σ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// −ln P.
    pub surprise: f64,
    /// By e.
    pub slope: f64,
    /// By e twice; never negative.
    pub curvature: f64,
    /// By t.
    pub noise_slope: f64,
    /// By t twice.
    pub noise_curvature: f64,
    /// By e and t.
    pub mixed: f64,
}

impl Cell {
    /// At `above` counts above the lower edge with noise of `noise` counts.
    pub fn at(above: f64, noise: f64) -> Self {
        // By symmetry about the centre the lower edge is the near one.
        if above > 0.5 {
            let mirrored = Self::near(1.0 - above, noise);
            return Cell {
                slope: -mirrored.slope,
                mixed: -mirrored.mixed,
                ..mirrored
            };
        }
        Self::near(above, noise)
    }

    fn near(above: f64, noise: f64) -> Self {
        let (near, far) = (-above / noise, (1.0 - above) / noise);
        // Densities at both edges over the probability.
        let (surprise, at_near, at_far) = if near < FAR {
            let tail = |z: f64| 0.5 * libm::erfc(z / SQRT_2);
            let density = |z: f64| libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt();
            let probability: f64 = tail(near) - tail(far);
            (
                -libm::log(probability),
                density(near) / probability,
                density(far) / probability,
            )
        } else {
            let fall = libm::exp(-0.5 * (far - near) * (far + near));
            let per_density = mills(near) - mills(far) * fall;
            let surprise = 0.5 * near * near + 0.5 * libm::log(2.0 * PI) - libm::log(per_density);
            (surprise, 1.0 / per_density, fall / per_density)
        };
        // What an edge brings that is out of reach is nothing, however high a power of its distance stands before it.
        let of_far = |power: i32| {
            if at_far > 0.0 {
                far.powi(power) * at_far
            } else {
                0.0
            }
        };
        let difference = |power: i32| of_far(power) - near.powi(power) * at_near;
        let (zeroth, first, second, third) =
            (difference(0), difference(1), difference(2), difference(3));
        let slope = zeroth / noise;
        Cell {
            surprise,
            slope,
            curvature: (slope * slope + first / (noise * noise)).max(0.0),
            noise_slope: first,
            noise_curvature: first * first - (first - third),
            mixed: slope * first - (zeroth - second) / noise,
        }
    }
}

/// Mills' ratio, the normal tail over its density, by Laplace's continued fraction (Abramowitz and Stegun, 26.2.14).
fn mills(z: f64) -> f64 {
    let below = (1..=TERMS)
        .rev()
        .fold(z, |below, term| z + f64::from(term) / below);
    1.0 / below
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = (f64, f64)> {
        let noises = [1e-3, 0.01, 0.1, 0.5, 3.0, 40.0];
        noises.into_iter().flat_map(|noise| {
            let places = [
                -30.0, -2.0, -0.1, -0.003, 0.0, 0.2, 0.499, 0.6, 0.998, 1.0, 1.2, 9.0,
            ];
            places.into_iter().map(move |above| (above, noise))
        })
    }

    #[test]
    fn derivatives_are_those_of_the_surprise() {
        for (above, noise) in grid() {
            let at = |e: f64, t: f64| Cell::at(above + e * noise, noise * libm::exp(t));
            let here = at(0.0, 0.0);
            let step = 1e-4;
            let (up, down) = (at(step, 0.0), at(-step, 0.0));
            let (louder, quieter) = (at(0.0, step), at(0.0, -step));
            let quotient = |a: f64, b: f64| (a - b) / (2.0 * step);
            for (what, derivative, quotient) in [
                (
                    "e",
                    here.slope * noise,
                    quotient(up.surprise, down.surprise),
                ),
                ("ee", here.curvature * noise, quotient(up.slope, down.slope)),
                (
                    "t",
                    here.noise_slope,
                    quotient(louder.surprise, quieter.surprise),
                ),
                (
                    "tt",
                    here.noise_curvature,
                    quotient(louder.noise_slope, quieter.noise_slope),
                ),
                ("et", here.mixed, quotient(louder.slope, quieter.slope)),
            ] {
                // The larger the numbers that cancel, the fewer digits are left.
                let size = 1.0 + here.surprise.abs() + derivative.abs() + here.slope.abs();
                assert!(
                    (derivative - quotient).abs() < 1e-5 * size,
                    "{what} at {above}, noise {noise}: {derivative:e}, quotient {quotient:e}"
                );
            }
        }
    }

    #[test]
    fn probabilities_of_all_cells_sum_to_one() {
        for noise in [1e-3, 0.05, 0.3, 2.0] {
            let sum: f64 = (-60..=60)
                .map(|cell| libm::exp(-Cell::at(0.3 - f64::from(cell), noise).surprise))
                .sum();
            assert!((sum - 1.0).abs() < 1e-12, "noise {noise}: {sum}");
        }
    }
}
