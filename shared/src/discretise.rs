//! From the machine's differential equations to the map of one step.
//!
//! Over a step the voltage `v` and the load torque `τ` are held, so the step is a linear map of
//! `(c, ω)` and `(v, τ)`. It is computed exactly by scaling and squaring: a Taylor series over a
//! fraction of the step that is short against every time constant, then repeated doubling (Higham,
//! *Functions of Matrices*, 2008, §10.3). No eigenvalue is needed, so equal, complex, zero and very
//! fast modes all take the same path. Doubling also yields the maps of the half steps that locate
//! stops and releases of friction.
//!
//! The map holds *increments*, so that a slow motor's small changes keep all their digits.

use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar};

/// How a step is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Discretisation {
    /// Exactly, for held inputs.
    #[default]
    Exact,
    /// The paper's explicit Euler step. Unstable where the step is longer than about twice the
    /// shortest time constant.
    Euler,
}

/// One step: increments of the current voltage `c`, the speed and the angle. Per unit.
#[derive(Clone, Copy, Debug)]
pub struct StepMap<K> {
    /// Increment of `c` by `[c, ω, v, τ]`.
    pub current: [K; 4],
    /// Increment of `ω` by `[c, ω, v, τ]`.
    pub speed: [K; 4],
    /// Increment of the angle by `[c, ω, v, τ]`, in base speed × interval.
    pub angle: [K; 4],
}

/// How the shaft and the winding are connected during a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connection {
    /// The bridge drives the winding.
    Driven,
    /// The bridge is open: no current flows, the motor coasts.
    Open,
    /// Friction holds the shaft: only the current changes.
    Held,
}

/// Shortest electrical time constant, as a part of the step: below it the current follows at once.
const SHORTEST_ELECTRICAL: f64 = 1.0 / 1024.0;
/// Most doublings from the Taylor step to the whole step.
const MAX_DOUBLINGS: u32 = 60;
/// Terms of the Taylor series; with a scaled norm below ½ the rest is below 1e-17.
const TERMS: u32 = 13;

impl<R: Real> StepMap<R> {
    /// The map of a step of length `step` (in intervals) of `machine` (per unit).
    pub fn new(
        machine: &Machine<R>,
        connection: Connection,
        step: R,
        how: Discretisation,
    ) -> Result<Self, ModelError> {
        let one = R::from_f64(1.0);
        let zero = R::zero();
        let shortest = step * R::from_f64(SHORTEST_ELECTRICAL);
        let electrical = if how == Discretisation::Exact && machine.electrical < shortest {
            shortest
        } else {
            machine.electrical
        };
        let rate = step / electrical;
        let push = step / machine.inertia;
        let drag = machine.damping * push;
        // Rates over the whole step: dx/ds = a·x + g·(v, τ).
        let (a, g) = match connection {
            Connection::Driven => (
                [[-rate, -(machine.kb * rate)], [push, -drag]],
                [[rate, zero], [zero, -push]],
            ),
            Connection::Open => ([[zero, zero], [zero, -drag]], [[zero, zero], [zero, -push]]),
            Connection::Held => ([[-rate, zero], [zero, zero]], [[rate, zero], [zero, zero]]),
        };
        let finite = a.iter().chain(&g).flatten().all(|x| x.is_finite());
        if !finite {
            return Err(ModelError::TooFast);
        }
        let mut map = match how {
            Discretisation::Euler => StepMap::euler(a, g, step),
            Discretisation::Exact => {
                let mut doublings = 0;
                let mut scale = one;
                let half = R::from_f64(0.5);
                let norm = a.iter().flatten().fold(zero, |n, x| n.max(x.abs()));
                while norm * scale > half * half {
                    scale = scale * half;
                    doublings += 1;
                    if doublings > MAX_DOUBLINGS {
                        return Err(ModelError::TooFast);
                    }
                }
                let mut map = StepMap::taylor(
                    a.map(|row| row.map(|x| x * scale)),
                    g.map(|row| row.map(|x| x * scale)),
                    step * scale,
                );
                for _ in 0..doublings {
                    map = map.twice();
                }
                map
            }
        };
        if connection == Connection::Open {
            // The current is cut off at once.
            map.current = [-one, zero, zero, zero];
        }
        Ok(map)
    }

    fn euler(a: [[R; 2]; 2], g: [[R; 2]; 2], step: R) -> Self {
        let zero = R::zero();
        StepMap {
            current: [a[0][0], a[0][1], g[0][0], g[0][1]],
            speed: [a[1][0], a[1][1], g[1][0], g[1][1]],
            angle: [zero, step, zero, zero],
        }
    }

    /// `Σ aᵏ/(k+1)!` and `Σ aᵏ/(k+2)!` give all parts of the map.
    fn taylor(a: [[R; 2]; 2], g: [[R; 2]; 2], step: R) -> Self {
        let zero = R::zero();
        let one = R::from_f64(1.0);
        let identity = [[one, zero], [zero, one]];
        let half = R::from_f64(0.5);
        let mut power = identity; // aᵏ/(k+1)!
        let mut first = identity;
        let mut second = identity.map(|row| row.map(|x| x * half));
        for k in 1..=TERMS {
            let down = one / R::from_f64(k as f64 + 1.0);
            power = product(power, a).map(|row| row.map(|x| x * down));
            let further = one / R::from_f64(k as f64 + 2.0);
            for row in 0..2 {
                for column in 0..2 {
                    first[row][column] = first[row][column] + power[row][column];
                    second[row][column] = second[row][column] + power[row][column] * further;
                }
            }
        }
        let e = product(a, first);
        let input = product(first, g);
        let travelled = product(second, g);
        StepMap {
            current: [e[0][0], e[0][1], input[0][0], input[0][1]],
            speed: [e[1][0], e[1][1], input[1][0], input[1][1]],
            angle: [
                step * first[1][0],
                step * first[1][1],
                step * travelled[1][0],
                step * travelled[1][1],
            ],
        }
    }

    /// The map of two such steps in a row.
    #[must_use]
    pub fn twice(&self) -> Self {
        let follow = |row: &[R; 4], column: usize| {
            // The second step starts from the first one's end: row · (x + Δx) = row·x + row·Δx.
            row[column] + row[column] + row[0] * self.current[column] + row[1] * self.speed[column]
        };
        let rows = |row: &[R; 4]| [0, 1, 2, 3].map(|column| follow(row, column));
        StepMap {
            current: rows(&self.current),
            speed: rows(&self.speed),
            angle: rows(&self.angle),
        }
    }

    /// The map in another number format, checked against its range.
    pub fn lower<S: Scalar>(&self) -> Result<StepMap<S::Coefficient>, ModelError> {
        let lowered = |name: &'static str, row: &[R; 4]| {
            for k in row {
                let value = k.to_f64();
                if !value.is_finite() || value.abs() > S::LIMIT / 4.0 {
                    return Err(ModelError::Range {
                        name,
                        value,
                        limit: S::LIMIT / 4.0,
                    });
                }
            }
            Ok(row.map(|k| S::coefficient(k.to_f64())))
        };
        Ok(StepMap {
            current: lowered("current increment", &self.current)?,
            speed: lowered("speed increment", &self.speed)?,
            angle: lowered("angle increment", &self.angle)?,
        })
    }
}

fn product<R: Real>(a: [[R; 2]; 2], b: [[R; 2]; 2]) -> [[R; 2]; 2] {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}
