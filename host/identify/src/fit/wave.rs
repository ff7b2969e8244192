//! Amplitude and phase of a wave `A·cos(kθ) + B·sin(kθ) = C·cos(kθ − p)`, of which the unknowns are A and B.

use super::physical::Estimate;
use super::uncertainty::Uncertainty;

/// A wave that is not zero.
pub struct Wave<'a> {
    cosine: f64,
    sine: f64,
    amplitude: f64,
    /// The places of the two among the unknowns, and the covariance of these.
    places: [usize; 2],
    spread: Option<&'a Uncertainty>,
}

impl<'a> Wave<'a> {
    /// The wave of the unknowns at two places, with their values; `None` for no wave.
    pub fn new(
        [cosine, sine]: [f64; 2],
        places: [usize; 2],
        spread: Option<&'a Uncertainty>,
    ) -> Option<Self> {
        let amplitude = libm::hypot(cosine, sine);
        (amplitude > 0.0).then_some(Wave {
            cosine,
            sine,
            amplitude,
            places,
            spread: spread.filter(|s| places.iter().all(|&place| s.std(place).is_some())),
        })
    }

    /// Its amplitude, in the unit of the two.
    pub fn amplitude(&self) -> (f64, Option<f64>) {
        let std = self.std([self.cosine / self.amplitude, self.sine / self.amplitude]);
        (self.amplitude, std)
    }

    /// Its amplitude, where its standard error is known.
    pub fn estimate(&self) -> Option<Estimate> {
        let (value, std) = self.amplitude();
        std.map(|std| Estimate { value, std })
    }

    /// Its phase, rad.
    pub fn phase(&self) -> (f64, Option<f64>) {
        let square = self.amplitude * self.amplitude;
        let std = self.std([-self.sine / square, self.cosine / square]);
        (libm::atan2(self.sine, self.cosine), std)
    }

    /// Standard error of what changes so much per unit of the two, by the delta method.
    fn std(&self, along: [f64; 2]) -> Option<f64> {
        let covariance = &self.spread?.covariance;
        let [first, second] = self.places;
        let variance = along[0] * along[0] * covariance[(first, first)]
            + 2.0 * along[0] * along[1] * covariance[(first, second)]
            + along[1] * along[1] * covariance[(second, second)];
        (variance >= 0.0).then(|| variance.sqrt())
    }
}
