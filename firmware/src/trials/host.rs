//! The least that a host must do: arm, start, stay alive, listen.

use core::cell::RefCell;

use shared::fit::Arithmetic;
use shared::wire::{Deframer, Job, LONGEST_FRAME, PlanDigest, ToDevice, ToHost, encode};

use super::bench::{Bench, OnBench};
use crate::app::{App, Memory, Recording};
use crate::phase::{Bridge, Phase};

/// Time between two signs of life, periods.
const ALIVE: u32 = 100;

/// A host beside a device on the bench.
#[derive(Debug)]
pub struct Host<'b, S: Arithmetic, const N: usize, const SENSES: bool = true> {
    /// The device.
    pub app: App<'b, OnBench<'b, SENSES>, S, N>,
    /// The bench that it runs on.
    pub bench: &'b RefCell<Bench>,
    /// True while the host sends its keep-alive.
    pub alive: bool,
    /// A phase in which the bridge drove though it must not.
    pub drove_in: Option<Phase>,
    inbox: Deframer,
}

impl<'b, S: Arithmetic, const N: usize, const SENSES: bool> Host<'b, S, N, SENSES> {
    /// Beside a device that has just been switched on.
    pub fn new(
        bench: &'b RefCell<Bench>,
        memory: &'b mut Memory<S>,
        recording: &'b mut Recording<N>,
    ) -> Self {
        Host {
            app: App::new(OnBench(bench), memory, recording),
            bench,
            alive: true,
            drove_in: None,
            inbox: Deframer::new(),
        }
    }

    /// Sends a message.
    pub fn send(&mut self, message: &ToDevice) {
        let mut buffer = [0; LONGEST_FRAME];
        for &byte in encode(message, &mut buffer).into_iter().flatten() {
            let _ = self.bench.borrow_mut().to_device.push_back(byte);
        }
    }

    /// One control period; `received` gets what the device says.
    pub fn period(&mut self, mut received: impl FnMut(ToHost)) {
        let period = self.bench.borrow().period;
        if self.alive && period.is_multiple_of(ALIVE) {
            self.send(&ToDevice::Alive);
        }
        self.app.period();
        let phase = self.app.phase();
        let bench = &mut *self.bench.borrow_mut();
        if bench.driven.is_some() && phase.bridge() == Bridge::Open {
            self.drove_in = Some(phase);
        }
        while let Some(byte) = bench.to_host.pop_front() {
            if let Some(message) = self.inbox.push(byte) {
                received(message);
            }
        }
    }

    /// Arms the device and starts a run; says whether it was armed.
    pub fn start(&mut self, job: Job) -> bool {
        self.start_with(job, PlanDigest::of(&[]))
    }

    /// The same with a plan that it has been sent.
    pub fn start_with(&mut self, job: Job, plan: PlanDigest) -> bool {
        self.send(&ToDevice::Arm);
        let mut armed = None;
        self.period(|message| {
            if let ToHost::Armed { nonce, .. } = message {
                armed = Some(nonce);
            }
        });
        if let Some(nonce) = armed {
            self.send(&ToDevice::Start { nonce, job, plan });
            self.period(|_| {});
        }
        armed.is_some()
    }
}
