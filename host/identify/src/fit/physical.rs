//! The six physical parameters from what the data determine and from known facts.
//!
//! The machine in coordinates that the data and the facts can each speak about:
//! `ln R`, `ln Kt`, `D = Kb + b`, `m`, `τe`, and the viscous part `p = b/D`. The data determine `D`,
//! `a1·D = m + τe·b` and `a2·D = τe·m` (and sometimes `p`), each fact one combination; a known weight gives `R/Kt`. What neither determines stays in
//! the null space of the normal equations, and every physical parameter that depends on it is reported as
//! undetermined. Gauss–Newton, since `J = m·Kt/R` and the like are products.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use servoid_io::input::Known;
use shared::motor::Machine;

/// Number of coordinates.
const N: usize = 6;
type Vector = SVector<f64, N>;
type Matrix = SMatrix<f64, N, N>;

/// A constant is a prior with this relative standard error.
const CONSTANT: f64 = 1e-6;
/// Singular values below this part of the largest are directions that nothing determines.
const FLAT: f64 = 1e-11;

/// Facts and data that stay further apart than this, in standard errors, contradict each other.
pub const CONTRADICTION: f64 = 5.0;

/// The six, in the order of `[known]`.
pub const NAMES: [(&str, &str); N] = [
    ("resistance", "ohm"),
    ("inductance", "H"),
    ("kt", "N*m/A"),
    ("kb", "V*s/rad"),
    ("inertia", "kg*m^2"),
    ("viscous", "N*m*s/rad"),
];

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Value, SI.
    pub value: f64,
    /// Standard error.
    pub std: f64,
}

/// What a measured current says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurrentEvidence {
    /// As the shaft's torque.
    Torque {
        /// Inertia over the torque constant, `J/Kt`, A·s²/rad.
        inertia: Estimate,
        /// Viscous friction over the torque constant, `f/Kt`, A·s/rad.
        friction: Estimate,
    },
    /// As the winding's.
    Winding {
        /// Resistance, Ω.
        resistance: Estimate,
        /// Back-EMF constant, V·s/rad.
        kb: Estimate,
    },
}

/// What the data determine: a machine, its covariance, and what the current says if it was measured.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// The machine that was fitted.
    pub machine: Machine<f64>,
    /// Covariance of `(D, a1·D, a2·D)`, or of these and `p` where the viscous part was fitted too.
    pub covariance: DMatrix<f64>,
    /// What the measured current says.
    pub current: Option<CurrentEvidence>,
    /// Largest torque of an unbalance as the voltage that holds it, V, where the model has one.
    pub unbalance_v: Option<Estimate>,
}

/// What data and facts say together.
#[derive(Clone, Debug)]
pub struct Reconciled {
    /// Each of [`NAMES`], where it is determined.
    pub physical: [Option<Estimate>; N],
    /// Volts at the winding per newton metre on the shaft, `R/Kt`, where it is determined.
    pub volts_per_torque: Option<Estimate>,
    /// How far data and facts stay apart, in standard errors; beyond [`CONTRADICTION`] nothing physical
    /// is reported.
    pub strain: f64,
}

/// A statement that `model(u) = value`, give or take `std`.
struct Statement {
    model: Box<dyn Fn(&Vector) -> f64>,
    value: f64,
    std: f64,
}

fn physical(u: &Vector) -> [f64; N] {
    let (r, kt, total, m, lag, part) = (libm::exp(u[0]), libm::exp(u[1]), u[2], u[3], u[4], u[5]);
    [
        r,
        r * lag,
        kt,
        total * (1.0 - part),
        m * kt / r,
        part * total * kt / r,
    ]
}

/// Combination `k` of those that the data determine, as a function of the coordinates.
fn determined(u: &Vector, k: usize) -> f64 {
    let (total, m, lag, part) = (u[2], u[3], u[4], u[5]);
    [total, m + lag * part * total, lag * m, part][k]
}

/// The combinations that the data determine, of a machine: `D` (V·s/rad), `a1·D`, `a2·D` and the viscous part.
pub fn determined_by_data(machine: &Machine<f64>) -> [f64; 4] {
    let total = machine.kb + machine.damping;
    let part = if total > 0.0 {
        machine.damping / total
    } else {
        0.0
    };
    let u = Vector::from([0.0, 0.0, total, machine.inertia, machine.electrical, part]);
    std::array::from_fn(|k| determined(&u, k))
}

/// Typical size of each coordinate, so that information is relative.
fn sizes(start: &Vector) -> Vector {
    let lag = start[4]
        .abs()
        .max(1e-3 * start[3].abs() / start[2].abs().max(f64::MIN_POSITIVE));
    Vector::from([1.0, 1.0, start[2].abs(), start[3].abs(), lag, 1.0])
        .map(|x| x.max(f64::MIN_POSITIVE))
}

fn gradient(model: &dyn Fn(&Vector) -> f64, u: &Vector, sizes: &Vector) -> Vector {
    Vector::from_fn(|k, _| {
        let step = 1e-6 * sizes[k];
        let (mut up, mut down) = (*u, *u);
        up[k] += step;
        down[k] -= step;
        (model(&up) - model(&down)) / 2e-6
    })
}

/// Statements of the facts.
fn facts(known: &Known, evidence: &Evidence, start: &Vector) -> Vec<Statement> {
    // A fact may be zero (no inductance, no viscous friction): then the size of what it is compared
    // with counts.
    let size = |value: f64, k: usize| {
        let (r, kt, total, lag) = (
            libm::exp(start[0]),
            libm::exp(start[1]),
            start[2].abs(),
            start[4],
        );
        let usual = [r, r * lag, kt, total, value, total * kt / r][k].abs();
        if value == 0.0 {
            usual.max(f64::MIN_POSITIVE)
        } else {
            value.abs()
        }
    };
    let mut statements = Vec::new();
    for (k, (_, fact)) in known.facts().into_iter().enumerate() {
        if let Some(fact) = fact {
            statements.push(Statement {
                model: Box::new(move |u| physical(u)[k]),
                value: fact.value,
                std: fact.tolerance.unwrap_or(0.0).max(CONSTANT) * size(fact.value, k),
            });
        }
    }
    // The voltage that holds a known torque is R/Kt times it.
    if let (Some(fact), Some(held)) = (known.unbalance_n_m, evidence.unbalance_v) {
        let tolerance = fact.tolerance.unwrap_or(0.0).max(CONSTANT);
        statements.push(Statement {
            model: Box::new(|u| u[0] - u[1]),
            value: libm::log(held.value / fact.value),
            std: libm::hypot(held.std / held.value, tolerance),
        });
    }
    match evidence.current {
        Some(CurrentEvidence::Torque { inertia, friction }) => {
            let exact = CONSTANT * inertia.value;
            // m/R and b/R, with the coordinates that they are made of.
            statements.push(Statement {
                model: Box::new(|u| u[3] / libm::exp(u[0])),
                value: inertia.value,
                std: inertia.std.max(exact),
            });
            let per_time = start[2].abs() / start[3].abs().max(f64::MIN_POSITIVE);
            statements.push(Statement {
                model: Box::new(|u| u[5] * u[2] / libm::exp(u[0])),
                value: friction.value,
                std: friction.std.max(exact * per_time),
            });
        }
        Some(CurrentEvidence::Winding { resistance, kb }) => {
            for (k, estimate) in [(0, resistance), (3, kb)] {
                statements.push(Statement {
                    model: Box::new(move |u| physical(u)[k]),
                    value: estimate.value,
                    std: estimate.std.max(CONSTANT * estimate.value),
                });
            }
        }
        None => {}
    }
    if known.kt_equals_kb {
        statements.push(Statement {
            model: Box::new(|u| {
                let p = physical(u);
                libm::log(p[2] / p[3].max(f64::MIN_POSITIVE))
            }),
            value: 0.0,
            std: CONSTANT,
        });
    }
    statements
}

/// Reconciles the evidence of the data with the known facts.
pub fn reconcile(evidence: &Evidence, known: &Known) -> Reconciled {
    let machine = &evidence.machine;
    let total = machine.kb + machine.damping;
    // Where the data do not tell it, the part is where a search happened to end. A viscous friction and a resistance that are known
    // leave two motors, one with little friction and one with little back-EMF: the first is what motors are.
    let told = evidence.covariance.nrows() > 3 && total > 0.0;
    let part = if told { machine.damping / total } else { 0.0 };
    let resistance = known
        .resistance_ohm
        .map(|f| f.value)
        .or(evidence.current.map(|current| match current {
            CurrentEvidence::Torque { inertia, .. } => machine.inertia / inertia.value,
            CurrentEvidence::Winding { resistance, .. } => resistance.value,
        }));
    let kt = known.kt_n_m_a.map_or(total, |f| f.value);
    let start = Vector::from([
        libm::log(resistance.unwrap_or(1.0).max(1e-12)),
        libm::log(kt.abs().max(1e-12)),
        total,
        machine.inertia,
        machine.electrical,
        part,
    ]);
    let sizes = sizes(&start);
    let measured = determined_by_data(machine);
    let whitening = whitening(&evidence.covariance, &measured);
    let statements = facts(known, evidence, &start);
    // All that is stated, as rows of unit variance: slope, and what is still missing.
    let rows_at = |u: &Vector| {
        let mut rows: Vec<(Vector, f64)> = statements
            .iter()
            .map(|s| {
                let slope = gradient(&*s.model, u, &sizes) / s.std;
                (slope, (s.value - (s.model)(u)) / s.std)
            })
            .collect();
        for weights in &whitening {
            let mut row = (Vector::zeros(), 0.0);
            for (k, weight) in weights.iter().enumerate() {
                row.0 += gradient(&|u| determined(u, k), u, &sizes) * *weight;
                row.1 += (measured[k] - determined(u, k)) * weight;
            }
            rows.push(row);
        }
        rows
    };

    let mut u = start;
    let mut solved = Solved::default();
    for _ in 0..30 {
        solved = Solved::new(&rows_at(&u));
        // Logarithms may be far off at the start: one unit a step at most.
        let step = solved.step.map(|x| x.clamp(-1.0, 1.0));
        u += step.component_mul(&sizes);
        if step.norm() < 1e-13 {
            break;
        }
    }
    let Solved { inverse, null, .. } = solved;
    let strain = rows_at(&u)
        .iter()
        .map(|(_, rest)| rest * rest)
        .sum::<f64>()
        .sqrt();
    let estimate = |model: &dyn Fn(&Vector) -> f64| {
        let slope = gradient(model, &u, &sizes);
        let leans = null
            .iter()
            .any(|v: &Vector| slope.dot(v).abs() > 1e-6 * slope.norm());
        let variance = slope.dot(&(inverse * slope));
        let value = model(&u);
        let determined = !leans && value.is_finite() && variance.is_finite();
        determined.then(|| Estimate {
            value,
            std: variance.max(0.0).sqrt(),
        })
    };
    if strain > CONTRADICTION {
        // A compromise between contradicting facts would be numbers without meaning.
        return Reconciled {
            physical: [None; N],
            volts_per_torque: None,
            strain,
        };
    }
    let facts = known.facts();
    let volts_per_torque = estimate(&|u| libm::exp(u[0] - u[1]));
    // A product that is zero leans on nothing, and its error is still known in the units of its other factor only.
    let factor = |k: usize| match NAMES[k].0 {
        "inductance" => estimate(&|u| libm::exp(u[0])),
        "viscous" => volts_per_torque,
        _ => Some(Estimate {
            value: 1.0,
            std: 0.0,
        }),
    };
    Reconciled {
        physical: std::array::from_fn(|k| match facts[k].1 {
            Some(fact) if fact.tolerance.is_none() => Some(Estimate {
                value: fact.value,
                std: 0.0,
            }),
            Some(_) => estimate(&move |u| physical(u)[k]),
            None => factor(k).and_then(|_| estimate(&move |u| physical(u)[k])),
        }),
        volts_per_torque,
        strain,
    }
}

/// Rows that turn what the data say into independent statements of unit variance.
fn whitening(covariance: &DMatrix<f64>, measured: &[f64; 4]) -> Vec<Vec<f64>> {
    let rows = covariance.nrows().min(4);
    let size = |k: usize| {
        if k == 3 {
            1.0
        } else {
            // What is zero is as large as its error.
            let error = covariance[(k, k)].max(0.0).sqrt();
            measured[k].abs().max(error).max(f64::MIN_POSITIVE)
        }
    };
    let relative = DMatrix::from_fn(rows, rows, |i, k| {
        let floor = if i == k { CONSTANT * CONSTANT } else { 0.0 };
        covariance[(i, k)] / (size(i) * size(k)) + floor
    });
    // With covariance L·Lᵀ, the rows of L⁻¹ are statements of unit variance.
    if !relative.iter().all(|x| x.is_finite()) {
        return Vec::new();
    }
    let Some(inverse) = relative.cholesky().and_then(|c| c.l().try_inverse()) else {
        return Vec::new();
    };
    (0..rows)
        .map(|i| (0..rows).map(|k| inverse[(i, k)] / size(k)).collect())
        .collect()
}

/// Weighted least squares over rows, and what the rows leave open.
#[derive(Default)]
struct Solved {
    step: Vector,
    /// Covariance on the determined directions.
    inverse: Matrix,
    /// Directions of unit length that no row determines.
    null: Vec<Vector>,
}

impl Solved {
    fn new(rows: &[(Vector, f64)]) -> Self {
        // Columns are balanced first: constants weigh a million times what a weak prior does.
        let balance = Vector::from_fn(|k, _| {
            let norm = rows
                .iter()
                .map(|(row, _)| row[k] * row[k])
                .sum::<f64>()
                .sqrt();
            if norm > 0.0 { 1.0 / norm } else { 1.0 }
        });
        let count = rows.len().max(N);
        let entry = |i: usize, k: usize| rows.get(i).map_or(0.0, |(row, _)| row[k] * balance[k]);
        let right = DVector::from_fn(count, |i, _| rows.get(i).map_or(0.0, |(_, value)| *value));
        let svd = DMatrix::from_fn(count, N, entry).svd(true, true);
        let (Some(left), Some(directions)) = (&svd.u, &svd.v_t) else {
            return Solved::default();
        };
        let mut solved = Solved::default();
        for (k, &size) in svd.singular_values.iter().enumerate() {
            let direction = Vector::from_fn(|j, _| directions[(k, j)] * balance[j]);
            if size > FLAT * svd.singular_values.max() {
                solved.inverse += direction * direction.transpose() / (size * size);
                solved.step += direction * (left.column(k).dot(&right) / size);
            } else {
                solved.null.push(direction.normalize());
            }
        }
        solved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::input::Fact;

    /// Resistance and viscous friction leave a motor with little friction and one with little back-EMF. A search ends anywhere
    /// between them where the data do not tell the part.
    #[test]
    fn of_two_motors_the_one_with_little_friction_is_meant() {
        let (r, k, inertia, viscous) = (2.3, 0.017, 3.2e-6, 1e-6);
        let response = Machine {
            kb: k,
            damping: viscous * r / k,
            inertia: inertia * r / k,
            electrical: 2.6e-4,
        }
        .response();
        let fact = |value| {
            Some(Fact {
                value,
                tolerance: None,
            })
        };
        let known = Known {
            resistance_ohm: fact(r),
            viscous_n_m_s: fact(viscous),
            kt_equals_kb: true,
            ..Known::default()
        };
        for part in [0.0, 0.1, 0.5, 0.9, 0.99] {
            let machine = response.machine_with_damping(part / response.gain);
            let values = determined_by_data(&machine);
            let covariance = DMatrix::from_fn(3, 3, |i, k| {
                if i == k {
                    (1e-4 * values[i]).powi(2)
                } else {
                    0.0
                }
            });
            let found = reconcile(
                &Evidence {
                    machine,
                    covariance,
                    current: None,
                    unbalance_v: None,
                },
                &known,
            );
            let kt = found.physical[2].expect("the facts tell it").value;
            assert!((kt / k - 1.0).abs() < 1e-3, "from a part of {part}: {kt}");
        }
    }

    /// What is zero seems to lean on nothing; in ohms and newton metres its error is unknown all the same.
    #[test]
    fn a_bound_in_physical_units_needs_the_fact_that_gives_the_unit() {
        let machine = Machine {
            kb: 0.05,
            damping: 0.0,
            inertia: 1e-3,
            electrical: 0.0,
        };
        let relative = [1e-4, 1e-3, 1e-2, 1e-2];
        let values = determined_by_data(&machine);
        let covariance = DMatrix::from_fn(4, 4, |i, k| {
            let size = if i == 3 {
                1.0
            } else {
                values[i].abs().max(1e-6)
            };
            if i == k {
                (relative[i] * size).powi(2)
            } else {
                0.0
            }
        });
        let evidence = Evidence {
            machine,
            covariance,
            current: None,
            unbalance_v: None,
        };
        let fact = |value: f64| {
            Some(Fact {
                value,
                tolerance: None,
            })
        };
        for (resistance, kt) in [(false, false), (true, false), (false, true), (true, true)] {
            let known = Known {
                resistance_ohm: fact(2.0).filter(|_| resistance),
                kt_n_m_a: fact(0.05).filter(|_| kt),
                ..Known::default()
            };
            let found = reconcile(&evidence, &known).physical;
            assert_eq!(found[5].is_some(), resistance && kt, "viscous");
            assert_eq!(found[1].is_some(), resistance, "inductance");
        }
    }
}
