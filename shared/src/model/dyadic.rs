//! Maps of a step and of its half, quarter, … down to the shortest substep.
//!
//! The shortest map is computed and the others follow by doubling, so they agree: two substeps of one level are one
//! substep of the level above. Level `k` is `2⁻ᵏ` of a step.

use super::mechanics::{Increment, Mechanics};
use super::state::Motion;
use super::step_map::{RealMaps, StepMap};
use super::substep_map::{SubstepMap, SubstepTiming};
use crate::discretise::Discretisation;
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};

/// Lengths of substeps: a step and seven halvings of it.
pub const LEVELS: usize = 8;

/// Shortest electrical time constant, as a fraction of the shortest substep: below it the current
/// follows at once.
const SHORTEST_ELECTRICAL: f64 = 1.0 / 1024.0;

/// The maps of a rigid motor's step and of its halvings.
#[derive(Clone, Copy, Debug)]
pub struct DyadicMaps<S: Scalar> {
    levels: [SubstepMap<S>; LEVELS],
}

lanes!(DyadicMaps { levels });

impl<S: Scalar> DyadicMaps<S> {
    /// The maps of a step of `step` intervals and of its halvings down to `depth`; the levels below
    /// repeat the last one.
    ///
    /// # Errors
    /// A machine too fast for its format, or a multiplier beyond the range of `S`.
    pub fn build<R: Real>(
        machine: &Machine<R>,
        step: R,
        depth: usize,
        how: Discretisation,
    ) -> Result<Self, ModelError> {
        let mut levels = [SubstepMap::zero(); LEVELS];
        for_each_level(machine, step, depth, how, |level, maps, machine, length| {
            levels[level] = SubstepMap::new(maps, machine, length)?;
            Ok(())
        })?;
        for level in depth + 1..LEVELS {
            levels[level] = levels[depth];
        }
        Ok(DyadicMaps { levels })
    }

    /// The map of the whole step.
    #[inline(always)]
    pub fn whole(&self) -> &SubstepMap<S> {
        &self.levels[0]
    }

    /// The map of a step halved `level` times.
    #[inline(always)]
    pub fn level(&self, level: usize) -> &SubstepMap<S> {
        &self.levels[level]
    }
}

/// Builds the maps without timing, in place: a device has no room to move them. Levels below `depth` stay as they are.
///
/// # Errors
/// Those of [`DyadicMaps::build`].
pub fn build_step_maps<S: Scalar, R: Real>(
    levels: &mut [StepMap<S>; LEVELS],
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> Result<(), ModelError> {
    for_each_level(machine, step, depth, how, |level, maps, _, _| {
        maps.lower(&mut levels[level])
    })
}

/// Lengths of the levels of a step of `step` intervals that is halved `depth` times, and the machine with an
/// electrical time constant that the shortest substep can follow.
pub fn shortest<R: Real>(
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> (Machine<R>, [R; LEVELS]) {
    let mut lengths = [step; LEVELS];
    for level in 1..LEVELS {
        lengths[level] = lengths[level - 1] * R::from_f64(0.5);
    }
    let fastest = lengths[depth] * R::from_f64(SHORTEST_ELECTRICAL);
    let mut machine = *machine;
    if how == Discretisation::Exact {
        machine.electrical = machine.electrical.max(fastest);
    }
    (machine, lengths)
}

/// Hands on the maps, the machine and the length of each level, from the shortest substep to the whole step.
fn for_each_level<R: Real>(
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
    mut take: impl FnMut(usize, &RealMaps<R>, &Machine<R>, R) -> Result<(), ModelError>,
) -> Result<(), ModelError> {
    let (machine, lengths) = shortest(machine, step, depth, how);
    let mut maps = RealMaps::new(&machine, lengths[depth], how)?;
    for level in (0..=depth).rev() {
        if level < depth {
            maps = match how {
                Discretisation::Exact => maps.twice(),
                // Two Euler steps of half the length are not one of the whole length.
                Discretisation::Euler => RealMaps::new(&machine, lengths[level], how)?,
            };
        }
        take(level, &maps, &machine, lengths[level])?;
    }
    Ok(())
}

impl<S: Scalar> Mechanics<S> for DyadicMaps<S> {
    const COUPLED: bool = false;

    #[inline(always)]
    fn timing(&self, level: usize) -> &SubstepTiming<S> {
        self.levels[level].timing()
    }

    #[inline(always)]
    fn step_free(
        &self,
        level: usize,
        from: &Motion<S>,
        _side: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S> {
        self.levels[level].step_free(from, volts, torque, open)
    }

    #[inline(always)]
    fn step_stuck(
        &self,
        level: usize,
        from: &Motion<S>,
        _side: S,
        volts: S,
        open: bool,
    ) -> Increment<S> {
        Increment {
            current: self.levels[level].step_stuck(from.current, volts, open),
            ..Increment::default()
        }
    }

    #[inline(always)]
    fn speed_per_torque(&self, level: usize) -> S::Coefficient {
        self.levels[level].speed_per_torque()
    }
}
