//! Commands arrive late.

use super::{Description, Effect, Facts, Parameter, Place};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};
use core::marker::PhantomData;

/// The bridge carries out what was commanded `τ` ago, its voltage and whether it is open alike. `τ`
/// need not be a whole number of samples; it is at most [`MAX_DELAY`](crate::model::MAX_DELAY) of
/// them, and taken as that many even where the sampling jitters.
#[derive(Clone, Copy, Debug)]
pub struct Delay<S>(PhantomData<S>);

lanes!(Delay { 0 });

impl<S: Scalar> Effect<S> for Delay<S> {
    const DESCRIPTION: Description = Description {
        name: "delay",
        place: Place::Drive,
        title: "delay between command and bridge",
        parameters: &[Parameter::amplitude(
            "time",
            Quantity::Time,
            (0.0, 0.012),
            0.002,
        )],
        equation: "v(t) = u(t - tau)",
        signature: "residual in proportion to the acceleration; phase that falls evenly with the frequency",
        exposed_by: "a chirp, steps and reversals",
        look_alikes: &["compliance", "l_sat"],
        source: "Ljung, System Identification, 1999, ch. 4",
        facts: Facts {
            series_parallel: false,
            ..Facts::PLAIN
        },
    };

    fn lower<R: Real>(_values: &[R], _units: &PerUnit<R>) -> Self {
        Delay(PhantomData)
    }

    fn delay<R: Real>(values: &[R], units: &PerUnit<R>) -> R {
        units.lower(values[0], Quantity::Time)
    }
}
