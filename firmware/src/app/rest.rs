//! The periods in which the bridge is open: fit a slice, get the prediction ready, tell how the run ended.

use super::{App, Memory, Work};
use crate::board::Board;
use crate::guard::Tripped;
use crate::phase::{Fault, Phase};
use shared::fit::{Arithmetic, Outcome};
use shared::wire::{Failure, ToHost};

/// A report is sent again after this long, until the host says something that shows that it has it.
const REPEAT_US: u32 = 500_000;
/// A prediction is judged by what grows in this time.
const PREDICTED_US: u32 = 50_000;
/// The fit's progress is sent this often.
const PROGRESS_US: u32 = 200_000;

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// A period with the bridge open.
    pub(super) fn rest(&mut self, punctual: bool) {
        match (&self.work, self.phase) {
            (Work::Fit, Phase::Fit) => self.fit(),
            (Work::Simulate, Phase::Simulate) => self.simulate(),
            (&Work::Keep(left), Phase::Keep) if B::SAVES => self.save_servo(left),
            (Work::Fitted, Phase::Fit | Phase::Simulate) if punctual => {
                // The next phase drives: only for a host that has spoken since.
                match self.check_link() {
                    Ok(()) if self.silence <= 1 => self.done(),
                    Ok(()) => {}
                    Err(fault) => self.fail(fault),
                }
            }
            (_, Phase::Report(outcome)) if self.repeat >= Self::periods(REPEAT_US) => {
                self.repeat = 0;
                let message = match outcome {
                    Ok(()) => ToHost::Report(self.report.clone()),
                    Err(fault) => ToHost::Failed(self.failed(fault)),
                };
                self.memory.outbox.post(&message);
            }
            _ => {}
        }
    }

    #[inline(never)]
    pub(super) fn fit(&mut self) {
        let Memory { fit, outbox, .. } = &mut *self.memory;
        if let Some(outcome) = fit.work(&self.recording.trace(), B::SLICE) {
            return self.fitted_to(outcome);
        }
        if self.repeat >= Self::periods(PROGRESS_US) {
            self.repeat = 0;
            let (done, of) = fit.progress();
            let least = fit.least();
            outbox.post(&ToHost::Fitting { done, of, least });
        }
    }

    pub(super) fn fitted_to(&mut self, outcome: Outcome) {
        self.report.outcome = Some(outcome);
        self.predict();
        // The next phase drives: it waits for a period that begins in time.
        self.work = Work::Fitted;
    }

    /// Builds the fitted motor to predict with. That takes longer than a period may, so it is done while the bridge is open.
    #[inline(never)]
    pub(super) fn predict(&mut self) {
        let Some(job) = self.job.filter(|job| job.verify > 0) else {
            return;
        };
        let fitted = self.recording.trace().len();
        let window = Self::periods(PREDICTED_US);
        self.predicts = self.memory.fit.predict(fitted, job.verify, window);
    }

    #[inline(never)]
    pub(super) fn failed(&self, fault: Fault) -> Failure {
        let (phase, at) = self.failed_in;
        let tripped = self.failure.unwrap_or(Tripped::by(fault));
        Failure {
            run: self.report.run,
            fault,
            stage: phase.stage(),
            at,
            seen: tripped.seen,
            limit: tripped.limit,
            report: (self.report.periods > 0).then(|| self.report.clone()),
        }
    }
}
