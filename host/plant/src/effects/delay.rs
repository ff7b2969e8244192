//! Transport delay between the command and the bridge.

use super::{Effect, Kind, Param, only_its_size};

/// The bridge carries out at time t what was commanded at t − τ, its voltage and whether it is
/// enabled alike, as a bus or a queue of commands does. τ need not be a multiple of the sample.
struct Delay {
    time_s: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "delay",
    about: "the command reaches the bridge late",
    electrical: None,
    params: &[Param {
        name: "time",
        unit: "s",
        about: "delay τ",
        scales: true,
        range: (0.0, 10.0),
        typical: |_| 2e-3,
    }],
    other_laws: &[],
    build: |values, _| Box::new(Delay { time_s: values[0] }),
    draw: only_its_size,
    truth: |values, _, _| vec![values[0]],
};

impl Effect for Delay {
    fn latency_s(&self) -> f64 {
        self.time_s
    }
}
