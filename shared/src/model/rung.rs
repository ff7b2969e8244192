//! The maps of a step and of its half, quarter, … for a motor that is one rigid body.

use super::body::{Body, Increment};
use super::state::Motion;
use crate::discretise::{Discretisation, LinearMap, LinearSystem, lower};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};

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

lanes!(Timing {
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
}

lanes!(Rung {
    current,
    speed,
    angle,
    coast_speed,
    coast_angle,
    held
});

/// A rung with what effects ask of it. Apart, because a small device has neither the room nor the time for that.
#[derive(Clone, Copy, Debug)]
pub struct Timed<S: Scalar> {
    rung: Rung<S>,
    timing: Timing<S>,
}

lanes!(Timed { rung, timing });

/// The maps of a step in R, before they are lowered.
#[derive(Clone, Copy)]
struct Maps<R> {
    driven: LinearMap<R, 2, 2>,
    coast: LinearMap<R, ALONE, ALONE>,
    held: LinearMap<R, ALONE, ALONE>,
}

/// States and inputs of a system that has one of each. On a small core another of each, that stays zero: so its maps are made
/// by the code for two, to the same bits.
const ALONE: usize = if cfg!(short_multiplier) { 2 } else { 1 };

/// One state, by itself and by one input.
fn alone<R: Real>(state: R, input: R) -> LinearSystem<R, ALONE, ALONE> {
    let none = [[R::zero(); ALONE]; ALONE];
    let mut system = LinearSystem {
        states: none,
        inputs: none,
        speed: 0,
    };
    system.states[0][0] = state;
    system.inputs[0][0] = input;
    system
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
        Ok(Maps {
            driven: driven.step(length, how)?,
            coast: alone(-drag, -push).step(length, how)?,
            held: alone(-rate, rate).step(length, how)?,
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
    fn lower<S: Scalar>(&self, rung: &mut Rung<S>) -> Result<(), ModelError> {
        let driven = &self.driven;
        let row = |k: usize| {
            let (x, u) = (driven.states[k], driven.inputs[k]);
            [x[0], x[1], u[0], u[1]]
        };
        let (x, u) = (driven.angle_by_states, driven.angle_by_inputs);
        let (coast, held) = (&self.coast, &self.held);
        lower::<S, R>("current increment", &mut rung.current, &row(0))?;
        lower::<S, R>("speed increment", &mut rung.speed, &row(1))?;
        lower::<S, R>(
            "angle increment",
            &mut rung.angle,
            &[x[0], x[1], u[0], u[1]],
        )?;
        let speed = [coast.states[0][0], coast.inputs[0][0]];
        lower::<S, R>("coasting speed increment", &mut rung.coast_speed, &speed)?;
        let angle = [coast.angle_by_states[0], coast.angle_by_inputs[0]];
        lower::<S, R>("coasting angle increment", &mut rung.coast_angle, &angle)?;
        let held = [held.states[0][0], held.inputs[0][0]];
        lower::<S, R>("held current increment", &mut rung.held, &held)
    }

    /// The same with its timing.
    fn lower_timed<S: Scalar>(
        &self,
        machine: &Machine<R>,
        length: R,
    ) -> Result<Timed<S>, ModelError> {
        let driven = &self.driven;
        let mut rung = Rung::of(S::Coefficient::default());
        self.lower(&mut rung)?;
        let timing = Timing::new(machine, length, driven.inputs[0][0], driven.angle_by_inputs);
        Ok(Timed { rung, timing })
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
) -> Result<[Timed<S>; RUNGS], ModelError> {
    let mut rungs = [None; RUNGS];
    climb(machine, step, depth, how, |level, maps, machine, length| {
        rungs[level] = Some(maps.lower_timed(machine, length)?);
        Ok(())
    })?;
    let last = rungs[depth].unwrap_or(Timed::zero());
    Ok(rungs.map(|rung| rung.unwrap_or(last)))
}

/// The same without timing, where the rungs stay; those beyond the `depth` stay as they are.
pub fn bare_ladder<S: Scalar, R: Real>(
    rungs: &mut [Rung<S>; RUNGS],
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
) -> Result<(), ModelError> {
    climb(machine, step, depth, how, |level, maps, _, _| {
        maps.lower(&mut rungs[level])
    })
}

/// Hands on the maps from the shortest part to the whole step. The shortest is computed, the others follow by doubling.
fn climb<R: Real>(
    machine: &Machine<R>,
    step: R,
    depth: usize,
    how: Discretisation,
    mut take: impl FnMut(usize, &Maps<R>, &Machine<R>, R) -> Result<(), ModelError>,
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
        take(level, &maps, &machine, lengths[level])?;
    }
    Ok(())
}

impl<S: Scalar> Timed<S> {
    fn zero() -> Self {
        let none = S::Coefficient::default();
        Timed {
            rung: Rung::of(none),
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
}

impl<S: Scalar> core::ops::Deref for Timed<S> {
    type Target = Rung<S>;

    #[inline(always)]
    fn deref(&self) -> &Rung<S> {
        &self.rung
    }
}

impl<S: Scalar> Rung<S> {
    /// A rung on which nothing moves, of zeros.
    pub const fn of(none: S::Coefficient) -> Self {
        Rung {
            current: [none; 4],
            speed: [none; 4],
            angle: [none; 4],
            coast_speed: [none; 2],
            coast_angle: [none; 2],
            held: [none; 2],
        }
    }

    /// Multipliers of current, speed, voltage and torque for the increments of current, speed and angle, with the bridge
    /// closed.
    pub fn increments(&self) -> [&[S::Coefficient; 4]; 3] {
        [&self.current, &self.speed, &self.angle]
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
            weighed(&[from.speed, torque], &self.coast_speed)
        } else {
            weighed(&[from.current, from.speed, volts, torque], &self.speed)
        }
    }

    /// Of that, what current and angle gain.
    #[inline(always)]
    pub fn slide_rest(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> (S, S) {
        if open {
            let angle = weighed(&[from.speed, torque], &self.coast_angle);
            return (-from.current, angle);
        }
        let by = [from.current, from.speed, volts, torque];
        (weighed(&by, &self.current), weighed(&by, &self.angle))
    }

    /// Speed that a torque against positive rotation adds, with the bridge closed.
    #[inline(always)]
    pub fn yields(&self, torque: S) -> S {
        torque.times(self.speed[3])
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
#[cfg(not(short_multiplier))]
pub fn weighed<S: Scalar, const K: usize>(numbers: &[S; K], by: &[S::Coefficient; K]) -> S {
    let mut sum = numbers[0].times(by[0]);
    for k in 1..K {
        sum = sum + numbers[k].times(by[k]);
    }
    sum
}

/// The same as a loop and a routine, where each product is one already.
#[inline(never)]
#[cfg(short_multiplier)]
pub fn weighed<S: Scalar>(numbers: &[S], by: &[S::Coefficient]) -> S {
    let products = numbers.iter().zip(by).map(|(x, &k)| x.times(k));
    products.reduce(S::add).unwrap_or(S::zero())
}

impl<S: Scalar> Body<S> for [Timed<S>; RUNGS] {
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
        self[level].yields(torque)
    }
}
