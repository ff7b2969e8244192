//! The maps of a step and of its half, quarter, … for a motor that is one rigid body.

use super::body::{Body, Increment};
use super::state::Motion;
use crate::discretise::{Discretisation, LinearMap, LinearSystem, lowered};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, abreast};

/// Lengths of parts: a step and seven halvings of it.
pub const RUNGS: usize = 8;

/// Shortest electrical time constant, as a part of the shortest part of a step: below it the
/// current follows at once.
const SHORTEST_ELECTRICAL: f64 = 1.0 / 1024.0;

/// A part of a step in numbers: its length, and how the mean current follows from its ends.
///
/// The mean of `τe·dc/dt = v − c − kb·ω` over a part of length `h` is exactly
/// `c̄ = v − kb·ω̄ − (τe/h)·Δc`.
#[derive(Clone, Copy, Debug)]
pub struct Timing<S: Scalar> {
    /// Length in intervals.
    pub length: S::Coefficient,
    /// One over that.
    pub per_length: S::Coefficient,
    /// `τe/h`.
    pub lag: S::Coefficient,
    /// Back-EMF constant.
    pub kb: S::Coefficient,
    /// Mean current per held volt.
    pub gain: S,
    /// Angle that a held torque against it takes from the travel, in base speed × interval.
    pub give: S,
}

abreast!(Timing {
    length,
    per_length,
    lag,
    kb,
    gain,
    give
});

/// Maps of one part of a step.
#[derive(Clone, Copy, Debug)]
pub struct Rung<S: Scalar> {
    /// Current, speed and angle by `[c, ω, v, τ]` with the bridge closed.
    current: [S::Coefficient; 4],
    speed: [S::Coefficient; 4],
    angle: [S::Coefficient; 4],
    /// Speed and angle by `[ω, τ]` with the bridge open: the current is cut off at once.
    coast_speed: [S::Coefficient; 2],
    coast_angle: [S::Coefficient; 2],
    /// Current by `[c, v]` of a shaft that friction holds.
    held: [S::Coefficient; 2],
    timing: Timing<S>,
}

abreast!(Rung {
    current,
    speed,
    angle,
    coast_speed,
    coast_angle,
    held,
    timing
});

/// The maps of a step in R, before they are lowered.
#[derive(Clone, Copy)]
struct Maps<R> {
    driven: LinearMap<R, 2, 2>,
    coast: LinearMap<R, 1, 1>,
    held: LinearMap<R, 1, 1>,
}

/// A motor with the bridge closed, over `length` intervals: current and speed by voltage and a torque against it.
#[inline(always)]
pub fn driven<R: Real>(machine: &Machine<R>, length: R) -> LinearSystem<R, 2, 2> {
    let zero = R::zero();
    let rate = length / machine.electrical;
    let push = length / machine.inertia;
    LinearSystem {
        states: [
            [-rate, -(machine.kb * rate)],
            [push, -(machine.damping * push)],
        ],
        inputs: [[rate, zero], [zero, -push]],
        speed: 1,
    }
}

impl<R: Real> Maps<R> {
    fn new(machine: &Machine<R>, length: R, how: Discretisation) -> Result<Self, ModelError> {
        let rate = length / machine.electrical;
        let push = length / machine.inertia;
        let drag = machine.damping * push;
        let driven = driven(machine, length);
        let coast = LinearSystem {
            states: [[-drag]],
            inputs: [[-push]],
            speed: 0,
        };
        let held = LinearSystem {
            states: [[-rate]],
            inputs: [[rate]],
            speed: 0,
        };
        Ok(Maps {
            driven: driven.step(length, how)?,
            coast: coast.step(length, how)?,
            held: held.step(length, how)?,
        })
    }

    fn twice(&self) -> Self {
        Maps {
            driven: self.driven.twice(),
            coast: self.coast.twice(),
            held: self.held.twice(),
        }
    }

    /// Into a rung where it stays: a device has neither the stack nor the time to hand on many of them.
    fn lower<S: Scalar>(
        &self,
        rung: &mut Rung<S>,
        machine: &Machine<R>,
        length: R,
    ) -> Result<(), ModelError> {
        let driven = &self.driven;
        let row = |k: usize| {
            let (x, u) = (driven.states[k], driven.inputs[k]);
            [x[0], x[1], u[0], u[1]]
        };
        let (x, u) = (driven.angle_by_states, driven.angle_by_inputs);
        rung.timing = Timing::new(machine, length, driven.inputs[0][0], u);
        rung.current = lowered::<S, R, 4>("current increment", row(0))?;
        rung.speed = lowered::<S, R, 4>("speed increment", row(1))?;
        rung.angle = lowered::<S, R, 4>("angle increment", [x[0], x[1], u[0], u[1]])?;
        rung.coast_speed = lowered::<S, R, 2>(
            "coasting speed increment",
            [self.coast.states[0][0], self.coast.inputs[0][0]],
        )?;
        rung.coast_angle = lowered::<S, R, 2>(
            "coasting angle increment",
            [self.coast.angle_by_states[0], self.coast.angle_by_inputs[0]],
        )?;
        rung.held = lowered::<S, R, 2>(
            "held current increment",
            [self.held.states[0][0], self.held.inputs[0][0]],
        )?;
        Ok(())
    }
}

impl<S: Scalar> Timing<S> {
    /// Of a part of `length` intervals in which a held volt raises the current by `current`, and a
    /// held volt and a held torque turn the shaft by `angle`.
    pub fn new<R: Real>(machine: &Machine<R>, length: R, current: R, angle: [R; 2]) -> Self {
        let per_length = R::from_f64(1.0) / length;
        let lag = machine.electrical * per_length;
        let gain = R::from_f64(1.0) - machine.kb * angle[0] * per_length - lag * current;
        Timing {
            length: S::coefficient(length.to_f64()),
            per_length: S::coefficient(per_length.to_f64()),
            lag: S::coefficient(lag.to_f64()),
            kb: S::coefficient(machine.kb.to_f64()),
            gain: S::from_f64(gain.to_f64()),
            give: S::from_f64(-angle[1].to_f64()),
        }
    }
}

/// Lengths of the rungs of a ladder whose whole step is `step` intervals long and is halved `depth`
/// times, and the machine with an electrical time constant that the shortest part can follow.
pub fn shortest<R: Real>(
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> (Machine<R>, [R; RUNGS]) {
    let mut lengths = [step; RUNGS];
    for level in 1..RUNGS {
        lengths[level] = lengths[level - 1] * R::from_f64(0.5);
    }
    let fastest = lengths[depth] * R::from_f64(SHORTEST_ELECTRICAL);
    let mut machine = *machine;
    if how == Discretisation::Exact {
        machine.electrical = machine.electrical.max(fastest);
    }
    (machine, lengths)
}

/// The maps of a step of `step` intervals and of its halvings down to `depth` (the rest repeats the
/// last one).
pub fn ladder<S: Scalar, R: Real>(
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> Result<[Rung<S>; RUNGS], ModelError> {
    let mut rungs = [Rung::zero(); RUNGS];
    climb(&mut rungs, machine, step, depth, how)?;
    let last = rungs[depth];
    rungs[depth..].fill(last);
    Ok(rungs)
}

/// Fills the ladder down to `depth`. The shortest is computed, the others follow by doubling.
pub fn climb<S: Scalar, R: Real>(
    rungs: &mut [Rung<S>; RUNGS],
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> Result<(), ModelError> {
    let (machine, lengths) = shortest(machine, step, depth, how);
    let mut maps = Maps::new(&machine, lengths[depth], how)?;
    for level in (0..=depth).rev() {
        if level < depth {
            maps = match how {
                Discretisation::Exact => maps.twice(),
                // Euler's step is what it is at each length: two half steps are not one whole step.
                Discretisation::Euler => Maps::new(&machine, lengths[level], how)?,
            };
        }
        maps.lower(&mut rungs[level], &machine, lengths[level])?;
    }
    Ok(())
}

impl<S: Scalar> Rung<S> {
    /// A rung on which nothing moves.
    pub fn zero() -> Self {
        let none = S::coefficient(0.0);
        Rung {
            current: [none; 4],
            speed: [none; 4],
            angle: [none; 4],
            coast_speed: [none; 2],
            coast_angle: [none; 2],
            held: [none; 2],
            timing: Timing {
                length: none,
                per_length: none,
                lag: none,
                kb: none,
                gain: S::zero(),
                give: S::zero(),
            },
        }
    }

    /// Its length, and how the mean current follows from its ends.
    #[inline(always)]
    pub fn timing(&self) -> &Timing<S> {
        &self.timing
    }

    /// Multipliers of current, speed and voltage for the increments of current, speed and angle, with the bridge closed.
    pub fn increments(&self) -> [[S::Coefficient; 3]; 3] {
        [self.current, self.speed, self.angle]
            .map(|[current, speed, volts, _]| [current, speed, volts])
    }

    /// What a held torque adds to current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_torque(&self, torque: S) -> [S; 3] {
        [
            torque.times(self.current[3]),
            torque.times(self.speed[3]),
            torque.times(self.angle[3]),
        ]
    }

    /// What a held voltage adds to current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_volts(&self, volts: S) -> [S; 3] {
        [
            volts.times(self.current[2]),
            volts.times(self.speed[2]),
            volts.times(self.angle[2]),
        ]
    }

    /// What current and speed add to current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_state(&self, from: &Motion<S>) -> [S; 3] {
        let (current, speed) = (from.current, from.speed);
        [
            current.times(self.current[0]) + speed.times(self.current[1]),
            current.times(self.speed[0]) + speed.times(self.speed[1]),
            current.times(self.angle[0]) + speed.times(self.angle[1]),
        ]
    }

    /// What a held voltage adds to the current of a shaft that friction holds, with the bridge closed.
    #[inline(always)]
    pub fn held_by_volts(&self, volts: S) -> S {
        volts.times(self.held[1])
    }

    /// What the current adds to itself there.
    #[inline(always)]
    pub fn held_by_current(&self, current: S) -> S {
        current.times(self.held[0])
    }

    /// Everything that one held voltage and one held torque (against positive rotation) do. A routine where each product is
    /// one already: it is called from three places.
    #[cfg_attr(short_multiplier, inline(never))]
    #[cfg_attr(not(short_multiplier), inline(always))]
    pub fn slide(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> Increment<S> {
        let speed = self.slide_speed(from, volts, torque, open);
        let (current, angle) = self.slide_rest(from, volts, torque, open);
        Increment {
            current,
            speed,
            angle,
            ..Increment::default()
        }
    }

    /// Of that, what the speed gains.
    #[inline(always)]
    pub fn slide_speed(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> S {
        if open {
            weighed([from.speed, torque], &self.coast_speed)
        } else {
            weighed([from.current, from.speed, volts, torque], &self.speed)
        }
    }

    /// Of that, what current and angle gain.
    #[inline(always)]
    pub fn slide_rest(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> (S, S) {
        if open {
            let angle = weighed([from.speed, torque], &self.coast_angle);
            return (-from.current, angle);
        }
        let by = [from.current, from.speed, volts, torque];
        (weighed(by, &self.current), weighed(by, &self.angle))
    }

    /// What the current gains while friction holds the shaft.
    #[inline(always)]
    pub fn settle(&self, current: S, volts: S, open: bool) -> S {
        if open {
            -current
        } else {
            current.times(self.held[0]) + volts.times(self.held[1])
        }
    }
}

/// The sum of numbers, each times its own multiplier.
#[inline(always)]
pub fn weighed<S: Scalar, const K: usize>(numbers: [S; K], by: &[S::Coefficient; K]) -> S {
    let mut sum = numbers[0].times(by[0]);
    for k in 1..K {
        sum = sum + numbers[k].times(by[k]);
    }
    sum
}

impl<S: Scalar> Body<S> for [Rung<S>; RUNGS] {
    const COUPLED: bool = false;

    #[inline(always)]
    fn timing(&self, level: usize) -> &Timing<S> {
        &self[level].timing
    }

    #[inline(always)]
    fn slide(
        &self,
        level: usize,
        from: &Motion<S>,
        _side: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S> {
        self[level].slide(from, volts, torque, open)
    }

    #[inline(always)]
    fn settle(
        &self,
        level: usize,
        from: &Motion<S>,
        _side: S,
        volts: S,
        open: bool,
    ) -> Increment<S> {
        Increment {
            current: self[level].settle(from.current, volts, open),
            ..Increment::default()
        }
    }

    #[inline(always)]
    fn yields(&self, level: usize, torque: S) -> S {
        torque.times(self[level].speed[3])
    }
}
