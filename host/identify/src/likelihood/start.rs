//! Where scoring starts: regression of the equation of motion, integrated over windows, at each delay of a grid.
//!
//! ```text
//! a·Δω + b·Δθ + c·sign(Δθ)·Δt − offset·Δt = ∫ u(t − T) dt        V·s
//! ```
//!
//! The likelihood has many maxima in the delay where the angle is used often, hundreds of nats apart; hence the grid.

use super::observed::Observed;
use super::parameters::Parameters;
use super::terms::Terms;
use nalgebra::{DMatrix, DVector};
use servoid_engine::data::local_parabola;

/// Delays, s.
const DELAYS_S: [f64; 8] = [0.0, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3, 32e-3, 64e-3];
/// Length of a window, s.
const WINDOW_S: f64 = 0.05;
/// Time to each side from which a speed is taken, s.
const HALF_S: f64 = 0.01;
/// Least windows.
const LEAST_WINDOWS: usize = 8;
/// Weights of the ridges of the unknowns, so that one-way motion has a solution: there Coulomb friction takes all of the offset.
const RIDGES: [f64; 7] = [1e-12, 1e-12, 1e-4, 1e-2, 1e-2, 1e-4, 1e-4];

/// A window of a recording.
struct Window {
    from: usize,
    to: usize,
    speed: f64,
    angle: f64,
    sign: f64,
    sine: f64,
    cosine: f64,
}

/// Models to start from, one for each delay at which regression gives a motor; none where none does.
pub(super) fn starts(recordings: &[&Observed], terms: Terms) -> Vec<Parameters> {
    let windows: Vec<Vec<Window>> = recordings.iter().map(|r| windows(r)).collect();
    if windows.iter().map(Vec::len).sum::<usize>() < LEAST_WINDOWS {
        return Vec::new();
    }
    let delays = if terms.delay {
        &DELAYS_S[..]
    } else {
        &DELAYS_S[..1]
    };
    (delays.iter())
        .filter_map(|&delay| regression(recordings, &windows, terms, delay))
        .collect()
}

fn windows(observed: &Observed) -> Vec<Window> {
    let fresh: Vec<usize> = (0..observed.angle.len())
        .filter(|&k| observed.angle[k].is_finite())
        .collect();
    let window = (observed.duration_s() / (4.0 * LEAST_WINDOWS as f64))
        .min(WINDOW_S)
        .max(4.0 * observed.interval_s);
    let half = HALF_S.max(2.0 * observed.interval_s);
    let time = |at: usize| observed.time_s[at];
    let speed = |at: usize| {
        let from = fresh.partition_point(|&k| time(k) < time(at) - half);
        let to = fresh.partition_point(|&k| time(k) <= time(at) + half);
        let points = fresh[from..to].iter();
        local_parabola(
            points.map(|&k| (time(k) - time(at), observed.angle[k] - observed.angle[at])),
        )
        .1
    };
    let mut ends = Vec::new();
    let mut next = 0.0;
    for &k in &fresh {
        if time(k) >= next {
            ends.push((k, speed(k)));
            next = time(k) + window;
        }
    }
    (ends.windows(2))
        .filter_map(|pair| {
            let ((from, before), (to, after)) = (pair[0], pair[1]);
            let angle = observed.angle[to] - observed.angle[from];
            let middle = 0.5 * (observed.angle[to] + observed.angle[from]);
            // Rest says nothing: friction there is anything up to Coulomb's.
            let moves = angle.abs() > 2.0 * observed.lsb;
            let elapsed = time(to) - time(from);
            moves.then(|| Window {
                from,
                to,
                speed: after - before,
                angle,
                sign: angle.signum(),
                sine: libm::sin(middle) * elapsed,
                cosine: libm::cos(middle) * elapsed,
            })
        })
        .collect()
}

fn regression(
    recordings: &[&Observed],
    windows: &[Vec<Window>],
    terms: Terms,
    delay: f64,
) -> Option<Parameters> {
    let wanted = [
        true,
        true,
        terms.coulomb,
        terms.offset,
        terms.asymmetric_viscous,
        terms.gravity,
        terms.gravity,
    ];
    let columns: Vec<usize> = (0..wanted.len()).filter(|&k| wanted[k]).collect();
    let (mut rows, mut right, mut time) = (Vec::new(), Vec::new(), 0.0);
    for (observed, windows) in recordings.iter().zip(windows) {
        let means = observed.command.means(&observed.time_s, delay);
        for w in windows {
            let steps = w.from + 1..=w.to;
            let drive: f64 = steps
                .map(|k| means[k] * (observed.time_s[k] - observed.time_s[k - 1]))
                .sum();
            let elapsed = observed.time_s[w.to] - observed.time_s[w.from];
            let all = [
                w.speed,
                w.angle,
                w.sign * elapsed,
                -elapsed,
                w.angle.abs(),
                w.sine,
                w.cosine,
            ];
            rows.extend(columns.iter().map(|&k| all[k]));
            right.push(drive);
            time += elapsed;
        }
    }
    let count = right.len();
    let matrix = DMatrix::from_row_slice(count, columns.len(), &rows);
    let right = DVector::from_vec(right);
    let mut square = matrix.transpose() * &matrix;
    for k in 0..columns.len() {
        square[(k, k)] *= 1.0 + RIDGES[columns[k]];
    }
    let solution = square.cholesky()?.solve(&(matrix.transpose() * &right));
    let residual = &right - &matrix * &solution;
    let mean_window = time / count as f64;
    let value = |k: usize| {
        columns
            .iter()
            .position(|&c| c == k)
            .map_or(0.0, |at| solution[at])
    };
    let largest = recordings
        .iter()
        .fold(0.0f64, |most, r| most.max(r.largest));
    let lsb = recordings
        .iter()
        .fold(f64::INFINITY, |least, r| least.min(r.lsb));
    let noise = residual.norm() / (count as f64 * mean_window).sqrt();
    let damping = value(1);
    let p = Parameters {
        inertia: if value(0) > 0.0 {
            value(0)
        } else {
            damping * HALF_S
        },
        damping,
        asymmetry: value(4).clamp(-0.5 * damping.abs(), 0.5 * damping.abs()),
        coulomb: value(2).clamp(0.0, 0.5 * largest),
        offset: value(3).clamp(-0.2 * largest, 0.2 * largest),
        gravity: [value(5), value(6)],
        delays: vec![delay; recordings.len()],
        process_noise: noise.max(1e-4 * largest),
        reading_noise: 0.3 * lsb,
    };
    (p.inertia > 0.0 && p.damping > 0.0 && p.process_noise.is_finite()).then_some(p)
}
