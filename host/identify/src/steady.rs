//! A motor's steady speed against its voltage: no recording in time, and still enough to see a constant drop.
//! Whether friction, the brushes or the power stage take it, such a curve cannot say.

use crate::diagnose::Verdict;
use servoid_io::input::SteadyCurve;
use shared::effects::Kind;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Fewest points for a line with a constant and an error left to judge it by.
const FEWEST: usize = 5;
/// An error above this part of the voltage is no straight line.
const CROOKED: f64 = 0.05;
/// A drop is believed if so large a gain has at most this chance without one.
const BELIEVED: f64 = 1e-3;

/// Why a curve cannot be diagnosed.
#[derive(Debug, thiserror::Error)]
pub enum SteadyError {
    /// Too few points.
    #[error(
        "{file}: {points} points of a turning motor are too few; measure at least {FEWEST} voltages"
    )]
    Few {
        /// The file.
        file: String,
        /// Points with a speed.
        points: usize,
    },
    /// The speed does not grow with the voltage.
    #[error(
        "{file}: the speed does not grow with the voltage, or either is beyond all reason: check the columns, their \
         signs, their order and their units"
    )]
    NoMotor {
        /// The file.
        file: String,
    },
}

/// `V = b·ω + c·sign ω`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyFit {
    /// `b`, V·s/rad: back-EMF constant and viscous friction together.
    pub slope: f64,
    /// `c`, V.
    pub drop_v: f64,
    /// RMS error as a part of the voltage's RMS.
    pub relative: f64,
    squares: f64,
}

/// What a steady curve says.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyDiagnosis {
    /// Without a drop.
    pub linear: SteadyFit,
    /// With one.
    pub with_drop: SteadyFit,
    /// Chance of so large a gain without a drop, by the F test.
    pub p_value: f64,
    /// [`Verdict::Complete`] where no drop is seen, [`Verdict::Inconclusive`] where one is, and
    /// [`Verdict::Unexplained`] where the curve is not straight.
    pub verdict: Verdict,
    /// Effects that make such a drop, none before the other.
    pub indistinguishable: Vec<Kind>,
    /// What to record next.
    pub advice: Option<&'static str>,
}

/// Fits the curve without and with a drop. Points at rest say nothing of either.
///
/// # Errors
/// [`SteadyError::Few`], [`SteadyError::NoMotor`].
pub fn fit_curve(curve: &SteadyCurve) -> Result<SteadyDiagnosis, SteadyError> {
    let turning: Vec<(f64, f64)> = curve
        .points
        .iter()
        .copied()
        .filter(|p| p.1 != 0.0)
        .collect();
    if turning.len() < FEWEST {
        return Err(SteadyError::Few {
            file: curve.source.clone(),
            points: turning.len(),
        });
    }
    let (linear, with_drop) = fits(&turning).ok_or_else(|| SteadyError::NoMotor {
        file: curve.source.clone(),
    })?;
    let freedom = (turning.len() - 2) as f64;
    let gain = (linear.squares - with_drop.squares).max(0.0);
    let ratio = gain / (with_drop.squares / freedom).max(f64::MIN_POSITIVE);
    let law = FisherSnedecor::new(1.0, freedom).ok();
    let law = law.filter(|_| ratio.is_finite());
    let p_value = law.map_or(1.0, |law| law.sf(ratio));
    let mut diagnosis = SteadyDiagnosis {
        linear,
        with_drop,
        p_value,
        verdict: Verdict::Complete,
        indistinguishable: Vec::new(),
        advice: None,
    };
    if with_drop.relative > CROOKED || (p_value < BELIEVED && with_drop.drop_v < 0.0) {
        diagnosis.verdict = Verdict::Unexplained;
        diagnosis.advice = Some(
            "the curve bends: check that the voltage column is what the motor really got (a driver with a dead \
             zone or a curve of its own, or a supply that gives way), and fit each straight part by itself",
        );
    } else if p_value < BELIEVED {
        diagnosis.verdict = Verdict::Inconclusive;
        diagnosis.indistinguishable = vec![Kind::Coulomb, Kind::BrushDrop, Kind::DeadZone];
        let one_way = turning.iter().all(|p| p.1 > 0.0) || turning.iter().all(|p| p.1 < 0.0);
        if one_way {
            diagnosis
                .indistinguishable
                .extend([Kind::OffsetVoltage, Kind::LoadTorque]);
        }
        diagnosis.advice = Some(
            "a constant part of the voltage is lost: record voltage and angle in time, with steps of both \
             signs and coasting with the bridge open, to say where",
        );
    }
    Ok(diagnosis)
}

/// Least squares without and with a drop; `None` where the slope is not positive.
fn fits(points: &[(f64, f64)]) -> Option<(SteadyFit, SteadyFit)> {
    let n = points.len() as f64;
    let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|&(v, w)| f(v, w)).sum::<f64>();
    // Of speeds and voltages turned to the positive side.
    let (ww, wv) = (sum(&|_, w| w * w), sum(&|v, w| w * v));
    let (w, v) = (sum(&|_, w| w.abs()), sum(&|v, w| v * w.signum()));
    let fit = |slope: f64, drop_v: f64| {
        let squares = sum(&|v, w| (v - slope * w - drop_v * w.signum()).powi(2));
        SteadyFit {
            slope,
            drop_v,
            relative: (squares / sum(&|v, _| v * v)).sqrt(),
            squares,
        }
    };
    let slope = (wv - w * v / n) / (ww - w * w / n);
    let fits = (fit(wv / ww, 0.0), fit(slope, (v - slope * w) / n));
    (fits.0.slope > 0.0 && slope > 0.0 && slope.is_finite()).then_some(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_complete_and_a_drop_is_not_named() {
        for (slope, drop_v) in [(0.5, 0.0), (0.5, 0.2), (2.0, 0.0), (0.05, 1.0)] {
            for signs in [&[1.0][..], &[1.0, -1.0]] {
                let points = signs.iter().flat_map(|sign| {
                    (1..=8).map(move |k| {
                        // Reading errors with no trend.
                        let error = 1e-3 * f64::from([1, -1, -1, 1, 1, -1, -1, 1][k - 1]);
                        let speed = k as f64;
                        (sign * (slope * speed + drop_v + error), sign * speed)
                    })
                });
                let curve = SteadyCurve {
                    source: "test".to_owned(),
                    points: points.collect(),
                };
                let diagnosis = fit_curve(&curve).unwrap();
                assert!((diagnosis.with_drop.drop_v - drop_v).abs() < 2e-3);
                if drop_v == 0.0 {
                    assert_eq!(diagnosis.verdict, Verdict::Complete);
                } else {
                    assert_eq!(diagnosis.verdict, Verdict::Inconclusive);
                    assert!(diagnosis.indistinguishable.len() >= 3);
                }
            }
        }
    }

    #[test]
    fn a_bent_curve_is_unexplained() {
        let saturated = |k: i32| (f64::from(k), libm::tanh(0.4 * f64::from(k)));
        let curve = SteadyCurve {
            source: "test".to_owned(),
            points: (-9..10).map(saturated).collect(),
        };
        let diagnosis = fit_curve(&curve).unwrap();
        assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{diagnosis:?}");
        assert!(diagnosis.indistinguishable.is_empty());
    }

    #[test]
    fn curves_that_say_nothing_are_refused() {
        let still = SteadyCurve {
            source: "test".to_owned(),
            points: vec![(1.0, 0.0); 9],
        };
        assert!(matches!(
            fit_curve(&still),
            Err(SteadyError::Few { points: 0, .. })
        ));
        let backward = SteadyCurve {
            source: "test".to_owned(),
            points: (1..9).map(|k| (f64::from(k), -f64::from(k))).collect(),
        };
        assert!(matches!(
            fit_curve(&backward),
            Err(SteadyError::NoMotor { .. })
        ));
    }
}
