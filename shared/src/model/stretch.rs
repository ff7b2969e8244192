//! A stretch of a step under one command: all of it, or what lies before or after a late command arrives.

use super::Plan;
use super::coupled::Coupled;
use super::dyadic::{DyadicMaps, LEVELS};
use crate::effects::Lowered;
use crate::error::ModelError;
use crate::scalar::{FromLanes, Mask, Real, Scalar, parts};

/// A stretch of a step: its maps and its substeps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<S: Scalar> {
    pub(super) motor: DyadicMaps<S>,
    pub(super) coupled: Option<Coupled<S>>,
    /// Equal substeps.
    pub(super) substeps: u16,
    /// Most halvings of the first substep after a jump of the voltage.
    pub(super) grade: usize,
}

impl<W, const N: usize> FromLanes<Stretch<f64>, N> for Stretch<W>
where
    W: Scalar<Coefficient = W, Angle = W> + From<[f64; N]>,
{
    fn from_lanes(each: [&Stretch<f64>; N]) -> Option<Self> {
        Some(Stretch {
            motor: FromLanes::from_lanes(parts(each, |one| &one.motor))?,
            coupled: FromLanes::from_lanes(parts(each, |one| &one.coupled))?,
            substeps: FromLanes::from_lanes(parts(each, |one| &one.substeps))?,
            // More halvings are only finer.
            grade: each.iter().fold(0, |most, one| most.max(one.grade)),
        })
    }
}

/// The first substep after a jump of the voltage is at most this fraction of the electrical time
/// constant, if eight levels suffice for that.
const FIRST_SUBSTEP: f64 = 0.25;

/// Largest jump of the voltage, per unit, that needs no graded substeps.
const SMALL_JUMP: f64 = 0.004;

impl<S: Scalar> Stretch<S> {
    /// Halvings of the first substep after a jump of the voltage: one for each doubling beyond the
    /// largest jump that needs none.
    #[inline(always)]
    pub(super) fn grade_after(&self, jump: S) -> usize {
        let mut tame = S::from_f64(SMALL_JUMP);
        let mut grade = 0;
        while grade < self.grade && tame.less(jump).any() {
            tame = tame + tame;
            grade += 1;
        }
        grade
    }

    /// A stretch of `length` intervals.
    ///
    /// # Errors
    /// A coefficient beyond the range of `S`, or a load that is not physical.
    pub(super) fn new<R: Real>(
        plan: &Plan<R>,
        effects: &Lowered<S>,
        length: R,
    ) -> Result<Self, ModelError> {
        let machine = plan.machine.lower(&plan.units);
        let how = plan.discretisation;
        let needs = effects.needs;
        let coupling = plan.effects.coupling(&plan.units, &machine);
        // Under a held voltage and torque one exact map is enough; events of friction are located
        // wherever they are.
        let straight = !(needs.mean || coupling.is_some());
        let substeps = if straight { 1 } else { plan.substeps.max(1) };
        let step = length / R::from_f64(substeps as f64);
        let mut grade = 0;
        if needs.current {
            let longest = machine.electrical * R::from_f64(FIRST_SUBSTEP);
            let mut first = step;
            while first > longest && grade < LEVELS - 1 {
                first = first * R::from_f64(0.5);
                grade += 1;
            }
        }
        let depth = if straight && !needs.friction {
            0
        } else {
            LEVELS - 1
        };
        let (coupled, machine) = match coupling {
            None => (None, machine),
            Some(coupling) => {
                let (coupled, motor) = Coupled::new(&machine, &coupling, step, how)?;
                (Some(coupled), motor)
            }
        };
        Ok(Stretch {
            motor: DyadicMaps::build(&machine, step, depth, how)?,
            coupled,
            substeps,
            grade,
        })
    }
}
