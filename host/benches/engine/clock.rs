//! CPU time of this process: on a machine that others use too, the time on the wall says little.

use rustix::time::{ClockId, clock_gettime};
use std::hint::black_box;

/// Shortest time that is measured at once, s.
const SHORTEST_S: f64 = 2e-3;
const RUNS: usize = 7;

/// CPU time so far, s, of all threads.
pub fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// CPU time of some work, s, and what it gave.
pub fn once<A>(work: impl FnOnce() -> A) -> (f64, A) {
    let began = cpu_s();
    let result = black_box(work());
    (cpu_s() - began, result)
}

/// Least CPU time of several runs, s; short work is repeated until it can be measured.
pub fn least<A>(mut work: impl FnMut() -> A) -> f64 {
    let (first, _) = once(&mut work);
    let times = ((SHORTEST_S / first.max(1e-9)) as usize).clamp(1, 100_000);
    let run = |_| {
        let (seconds, ()) = once(|| {
            for _ in 0..times {
                black_box(work());
            }
        });
        seconds / times as f64
    };
    (0..RUNS).map(run).fold(f64::INFINITY, f64::min)
}
