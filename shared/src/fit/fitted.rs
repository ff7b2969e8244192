//! What follows from a fitted motor: what it predicts, what it is good for, and the servo that it makes.

use super::evaluation::build;
use super::stage::Stage;
use super::{Arithmetic, Fit, Predicted, Predictors, Unknown, Verdict};
use crate::servo::Gains;

impl<S: Arithmetic> Fit<S> {
    /// What was fitted, in the order of the outcome's estimates.
    pub fn unknowns(&self) -> &[Unknown] {
        self.now.space.unknowns()
    }

    /// What predicts after the fit of the `fitted` periods.
    // Out of line, for the sake of the stack.
    #[inline(never)]
    pub fn predictors(&self, fitted: usize) -> Predictors {
        let now = &self.now;
        Predictors::of(&now.space, &now.best, &now.covariance, now.least, fitted)
    }

    /// Gets the best motor ready to predict about so many periods, judged over windows of `window` periods; the fit of the `fitted` periods is
    /// over. Returns false if no motor was fitted.
    pub fn predict(&mut self, fitted: usize, periods: u32, window: u32) -> bool {
        let predictors = self.predictors(fitted);
        self.predict_by(&predictors, periods, window)
    }

    /// The same by motors of an earlier fit. Ends a fit under way.
    pub fn predict_by(&mut self, predictors: &Predictors, periods: u32, window: u32) -> bool {
        self.asked = false;
        self.stage.clear_prediction();
        let Stage::Predict(prediction) = &mut self.stage else {
            return false;
        };
        prediction.begin(&mut self.runs, predictors, periods, window)
    }

    /// One period of what the motor predicts: the duty acted, and the reading is `step` counts further. The models run along it in
    /// [`catch_up`](Self::catch_up); what they are too slow for is not predicted.
    pub fn observe(&mut self, duty: i16, step: i16) {
        if let Stage::Predict(prediction) = &mut self.stage {
            prediction.observe(duty, step);
        }
    }

    /// Runs models along at most about `samples` of the periods that were observed; says whether all have run along all of them.
    pub fn catch_up(&mut self, samples: u32) -> bool {
        match &mut self.stage {
            Stage::Predict(prediction) => prediction.catch_up(&mut self.runs, samples),
            _ => true,
        }
    }

    /// How well it predicted the periods that the models have run along; `None` if it does not.
    // Out of line, for the sake of the stack.
    #[inline(never)]
    pub fn predicted(&mut self) -> Option<Predicted> {
        match &self.stage {
            Stage::Predict(prediction) => Some(prediction.so_far(&mut self.runs)),
            _ => None,
        }
    }

    /// Gains by the fitted motor, whose gain over time constant may be off by the part `off`.
    pub fn gains(&self, off: f32) -> Gains {
        let motor = self.now.space.motor(&self.now.best);
        let time_constants = [motor.first_order, motor.electrical];
        Gains::of(motor.gain, time_constants, motor.coulomb, off)
    }

    /// Puts the fitted motor to rest, to be [`moved`](Self::moved). Returns false if no motor was fitted.
    pub fn rest(&mut self) -> bool {
        let motor = self.now.space.motor(&self.now.best);
        build(&mut self.runs[0], &motor, f32::INFINITY)
    }

    /// Moves the fitted motor for a period; gives its angle then, counts from where it rested.
    pub fn moved(&mut self, duty: i16) -> f32 {
        let Some(model) = self.runs[0].model() else {
            return 0.0;
        };
        model.step(duty, 0);
        model.error()
    }

    /// What the motor is good for, by how well it `predicted`; `within` is the largest error of an encoder, counts RMS.
    #[inline(never)]
    pub fn verdict(&self, predicted: &Predicted, within: f32) -> Verdict {
        let gradients = [0, 1].map(|k| {
            let gradient = self.now.space.gradient(k, &self.now.best);
            let value = self.now.space.value(k, &self.now.best);
            gradient.map(|x| x / value)
        });
        let [gain, time_constant] = gradients.map(|gradient| self.now.covariance.std(&gradient));
        let [g, m] = gradients;
        let mut ratio = g;
        for (x, m) in ratio.iter_mut().zip(m) {
            *x -= m;
        }
        let stds = [gain, time_constant, self.now.covariance.std(&ratio)];
        Verdict::of(stds, self.now.least, predicted, within)
    }
}
