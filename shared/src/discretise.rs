//! From linear differential equations to the map of one step.
//!
//! Over a step the inputs (voltage, torque) are held, so the step is a linear map of the states and
//! the inputs. It is computed exactly by scaling and squaring: a Taylor series over a fraction of
//! the step that is short against every time constant, then repeated doubling (Higham, *Functions
//! of Matrices*, 2008, §10.3). No eigenvalue is needed, so equal, complex, zero and very fast modes
//! all take the same path. Doubling also yields the maps of the half steps that locate the stops
//! and releases of friction.
//!
//! The map holds *increments*, so that a slow motor's small changes keep all their digits.

use crate::error::ModelError;
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

/// `dx/dt = states·x + inputs·u`; all rates multiplied by the length of the step.
#[derive(Clone, Copy, Debug)]
pub struct LinearSystem<R, const N: usize, const M: usize> {
    /// Rate of each state by the states.
    pub states: [[R; N]; N],
    /// Rate of each state by the inputs.
    pub inputs: [[R; M]; N],
    /// Which state is the speed, whose integral the map gives.
    pub speed: usize,
}

/// One step of a [`LinearSystem`]: increments of the states, and the angle that the shaft turns.
#[derive(Clone, Copy, Debug)]
pub struct LinearMap<R, const N: usize, const M: usize> {
    /// Increment of each state by the states.
    pub states: [[R; N]; N],
    /// Increment of each state by the inputs.
    pub inputs: [[R; M]; N],
    /// Angle by the states, in base speed × interval.
    pub angle_by_states: [R; N],
    /// Angle by the inputs.
    pub angle_by_inputs: [R; M],
}

/// Most doublings from the Taylor step to the whole step.
const MAX_DOUBLINGS: u32 = 60;

impl<R: Real, const N: usize, const M: usize> LinearSystem<R, N, M> {
    /// The map of a step of `length` intervals.
    ///
    /// # Errors
    /// [`ModelError::TooFast`] if a rate is beyond the format or beyond 60 doublings.
    pub fn step(&self, length: R, how: Discretisation) -> Result<LinearMap<R, N, M>, ModelError> {
        let rates = self.states.as_flattened();
        if !all_finite(rates) || !all_finite(self.inputs.as_flattened()) {
            return Err(ModelError::TooFast);
        }
        if how == Discretisation::Euler {
            let mut angle_by_states = [R::zero(); N];
            angle_by_states[self.speed] = length;
            return Ok(LinearMap {
                states: self.states,
                inputs: self.inputs,
                angle_by_states,
                angle_by_inputs: [R::zero(); M],
            });
        }
        let mut doublings = 0;
        let mut scale = R::from_f64(1.0);
        let half = R::from_f64(0.5);
        let norm = rates.iter().fold(R::zero(), |norm, x| norm.max(x.abs()));
        while norm * scale > half * half {
            scale = scale * half;
            doublings += 1;
            if doublings > MAX_DOUBLINGS {
                return Err(ModelError::TooFast);
            }
        }
        let mut map = self.taylor(length, scale);
        for _ in 0..doublings {
            map = map.twice();
        }
        Ok(map)
    }

    /// The map of the fraction `scale` of the step: `Σ aᵏ/(k+1)!` and `Σ aᵏ/(k+2)!` give all of it.
    fn taylor(&self, length: R, scale: R) -> LinearMap<R, N, M> {
        let one = R::from_f64(1.0);
        let (mut a, mut g) = (self.states, self.inputs);
        multiply(a.as_flattened_mut(), scale);
        multiply(g.as_flattened_mut(), scale);
        let mut power = [[R::zero(); N]; N]; // aᵏ/(k+1)!
        for (k, row) in power.iter_mut().enumerate() {
            row[k] = one;
        }
        let mut first = power;
        let mut second = power;
        multiply(second.as_flattened_mut(), R::from_f64(0.5));
        let mut further = one / (one + one);
        let mut next = one + one;
        for _ in 0..R::TERMS {
            power = product(&power, &a);
            multiply(power.as_flattened_mut(), further);
            next = next + one;
            further = one / next;
            let sums = first
                .as_flattened_mut()
                .iter_mut()
                .zip(second.as_flattened_mut());
            for ((first, second), &power) in sums.zip(power.as_flattened()) {
                *first = *first + power;
                *second = *second + power * further;
            }
        }
        let length = length * scale;
        let mut angle_by_states = first[self.speed];
        let mut angle_by_inputs = product(&second, &g)[self.speed];
        multiply(&mut angle_by_states, length);
        multiply(&mut angle_by_inputs, length);
        LinearMap {
            states: product(&a, &first),
            inputs: product(&first, &g),
            angle_by_states,
            angle_by_inputs,
        }
    }
}

impl<R: Real, const N: usize, const M: usize> LinearMap<R, N, M> {
    /// The map of two such steps in a row.
    #[must_use]
    pub fn twice(&self) -> Self {
        // The second step starts from the first one's end: row · (x + Δx) = row·x + row·Δx.
        let by_states = |row: &[R; N]| {
            core::array::from_fn(|column| {
                (0..N).fold(row[column] + row[column], |sum, k| {
                    sum + row[k] * self.states[k][column]
                })
            })
        };
        let by_inputs = |states: &[R; N], inputs: &[R; M]| {
            core::array::from_fn(|column| {
                (0..N).fold(inputs[column] + inputs[column], |sum, k| {
                    sum + states[k] * self.inputs[k][column]
                })
            })
        };
        LinearMap {
            states: core::array::from_fn(|row| by_states(&self.states[row])),
            inputs: core::array::from_fn(|row| by_inputs(&self.states[row], &self.inputs[row])),
            angle_by_states: by_states(&self.angle_by_states),
            angle_by_inputs: by_inputs(&self.angle_by_states, &self.angle_by_inputs),
        }
    }
}

fn all_finite<R: Real>(numbers: &[R]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

/// Multiplies all numbers by a factor. On slices: a compiler that optimises for size would copy a `map` for each shape.
fn multiply<R: Real>(numbers: &mut [R], factor: R) {
    for number in numbers {
        *number = *number * factor;
    }
}

/// Multipliers in another number format, checked against its range.
///
/// # Errors
/// [`ModelError::Range`] for one that is beyond a quarter of the format's limit.
// Inlined around a routine: a caller that ignores the error is spared the code that makes it.
#[inline(always)]
pub fn lower<S: Scalar, R: Real>(
    name: &'static str,
    lowered: &mut [S::Coefficient],
    row: &[R],
) -> Result<(), ModelError> {
    match lower_within::<S, R>(lowered, row) {
        Some(k) => Err(ModelError::Range {
            name,
            value: k.to_f64(),
            limit: S::LIMIT / 4.0,
        }),
        None => Ok(()),
    }
}

/// Lowers the numbers up to the first one beyond a quarter of the limit, and returns that one.
fn lower_within<S: Scalar, R: Real>(lowered: &mut [S::Coefficient], row: &[R]) -> Option<R> {
    let limit = R::from_f64(S::LIMIT / 4.0);
    for (lowered, &k) in lowered.iter_mut().zip(row) {
        if k.abs() > limit || !k.is_finite() {
            return Some(k);
        }
        *lowered = S::coefficient_of(k);
    }
    None
}

/// Multipliers, as by [`lower`], in other measures: the row times `row_scale`, and each entry times its own of
/// `column_scales`.
///
/// # Errors
/// As [`lower`], before the scaling: a large multiplier then meets a small factor.
pub fn scaled<S: Scalar, R: Real, const K: usize>(
    name: &'static str,
    row: [R; K],
    row_scale: R,
    column_scales: [R; K],
) -> Result<[S::Coefficient; K], ModelError> {
    lower::<S, R>(name, &mut [S::Coefficient::default(); K], &row)?;
    Ok(core::array::from_fn(|k| {
        S::coefficient_of(row[k] * row_scale * column_scales[k])
    }))
}

fn product<R: Real, const A: usize, const B: usize, const C: usize>(
    a: &[[R; B]; A],
    b: &[[R; C]; B],
) -> [[R; C]; A] {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..B).fold(R::zero(), |sum, k| sum + a[i][k] * b[k][j]))
    })
}
