//! A formula along the shaft.

use super::interpret::{At, result};
use super::lower::{MAX_NUMBERS, Numbers};
use super::number::{Dual, Number};
use super::states::Moved;
use super::{Formula, MAX_STATES, Op, Output, Program, Variable};
use crate::effects::{Budget, Memory, Needs, Shaft, Stiff, Winding};
use crate::scalar::{FromLanes, Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// A formula with the values of its parameters, in a number format.
#[derive(Clone, Copy, Debug)]
pub struct Stated<S: Scalar> {
    pub(super) program: &'static Program,
    numbers: [S::Coefficient; MAX_NUMBERS],
    /// From the law's last result to the output per unit.
    law: S::Coefficient,
    /// Where the numbers of each state's rate begin.
    pub(super) rates_from: [usize; MAX_STATES],
    /// From each rate's last result to that of the state by the interval.
    pub(super) rates: [S::Coefficient; MAX_STATES],
    /// Speed by travel in turns, of one interval.
    per_turn: S::Coefficient,
    /// How many pairs of points its mean over a part takes.
    pairs: usize,
}

/// Gauss's rules over a part, by their points' reach from the middle and their weights: of two points, and of four.
const TWO: [(f64, f64); 1] = [(0.288_675_134_594_812_9, 0.5)];
const FOUR: [(f64, f64); 2] = [
    (0.169_990_521_792_428_13, 0.326_072_577_431_273_07),
    (0.430_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Least resistance that a voltage adds to the winding's own, as a part of it.
const LEAST_RESISTANCE: f64 = -0.9;
/// Part of a torque of inertia that is doubted, of the part of the mass that has grown meanwhile.
const GROWN: f64 = 1.0 / 12.0;

lanes!(Stated {
    program,
    numbers,
    law,
    rates_from,
    rates,
    per_turn,
    pairs
});

impl<const N: usize> FromLanes<&'static Program, N> for &'static Program {
    fn from_lanes(each: [&&'static Program; N]) -> Option<Self> {
        let same = each.iter().all(|one| core::ptr::eq(**one, *each[0]));
        same.then_some(*each[0])
    }
}

impl Program {
    /// What it needs of the model.
    pub(in crate::effects) fn needs(&self) -> Needs {
        let torque = self.output == Output::Torque;
        let lost = self.output == Output::TorqueConstant;
        let inertia = self.output == Output::Inertia;
        let current = self.looks_at(Variable::Current) || self.looks_at(Variable::Transmitted);
        let sensed = self.output == Output::Angle;
        let winding = self.acts_within_a_part();
        // A voltage that depends on the command alone is the drive's.
        let by_command = self.output != Output::Voltage && self.looks_at(Variable::Command);
        let varies = current || by_command || self.goes_with_the_run();
        Needs {
            mean: (varies && !sensed) || lost || inertia || self.has_state(),
            current: current || lost,
            angle: self.looks_at(Variable::Angle) && !sensed,
            friction: self.output == Output::Friction,
            torque: torque && !self.has_state(),
            winding,
            stiff: (torque && self.has_state()) || inertia,
            lost_torque: lost,
            memory: self.remembers(),
            sensed,
            temperature: self.looks_at(Variable::Temperature),
        }
    }
}

impl<S: Scalar> Stated<S> {
    pub(in crate::effects) fn lower<R: Real>(
        formula: &'static Formula,
        values: &[R],
        units: &PerUnit<R>,
    ) -> Self {
        let numbers = Numbers::new(formula, values, units);
        let turn = units.lower(units.base(Quantity::Angle), Quantity::Speed) / units.interval;
        // Several waves along the angle may pass within a part.
        let waves = formula.program.looks_at(Variable::Angle);
        Stated {
            pairs: if waves { FOUR.len() } else { TWO.len() },
            program: &formula.program,
            numbers: numbers.lowered::<S>(),
            law: S::coefficient(numbers.law),
            rates_from: numbers.rates.map(|rate| rate.from),
            rates: numbers.rates.map(|rate| S::coefficient(rate.by_interval)),
            per_turn: S::coefficient_of(turn),
        }
    }

    /// Runs one of its programs. A routine of its own in every format: inlined into each place that asks for it, the operations
    /// would make the model many times as large.
    #[inline(never)]
    pub(super) fn run<N: Number<S>>(&self, ops: &[Op], from: usize, at: &At<N>) -> N {
        S::routine(
            #[inline(always)]
            || result(ops, &self.numbers[from..], at),
        )
    }

    #[inline(always)]
    fn law<N: Number<S>>(&self, at: &At<N>) -> N {
        self.run(self.program.law, 0, at).scaled(self.law)
    }

    /// What it sees a part `reach` of the changes after the middle.
    #[inline(always)]
    fn seen(&self, shaft: &Shaft<S>, reach: f64, began: S) -> At<S> {
        let reach = S::from_f64(reach);
        let gone = (S::from_f64(0.5) + reach).times(shaft.length);
        At {
            speed: shaft.speed + shaft.speed_change * reach,
            turns: shaft.turns + shaft.travel * reach,
            current: shaft.current + shaft.current_change * reach,
            transmitted: shaft.transmitted + shaft.current_change * reach,
            command: shaft.volts,
            time: began + gone,
            temperature: shaft.temperature,
            states: [S::zero(); MAX_STATES],
        }
    }

    /// Mean over the part, which began at a time in intervals.
    #[inline(always)]
    fn mean(&self, shaft: &Shaft<S>, began: S) -> S {
        self.mean_of(
            #[inline(always)]
            |reach| self.law(&self.seen(shaft, reach, began)),
        )
    }

    /// Mean over the part of what is `at` a part `reach` of it after its middle. A closure that is not inlined would be computed without
    /// the instructions of its routine, each operation of lanes by a call.
    #[inline(always)]
    fn mean_of(&self, at: impl Fn(f64) -> S) -> S {
        let nodes = if self.pairs == FOUR.len() {
            &FOUR[..]
        } else {
            &TWO[..]
        };
        let mut sum = S::zero();
        for (reach, weight) in nodes {
            sum = sum + (at(-reach) + at(*reach)) * S::from_f64(*weight);
        }
        sum
    }

    #[inline(never)]
    pub(in crate::effects) fn drive(&self, volts: S) -> S {
        if self.program.output != Output::Voltage || self.program.acts_within_a_part() {
            return volts;
        }
        S::routine(
            #[inline(always)]
            || {
                let at = At {
                    command: volts,
                    ..At::all(S::zero())
                };
                volts + self.law(&at)
            },
        )
    }

    /// A voltage at a current, V, as a voltage and a resistance: the current follows it within the part, so that the winding is solved
    /// with both. Never a resistance that takes most of the winding's own away.
    #[inline(always)]
    fn with_resistance(&self, volts: S, slope: S, current: S) -> Winding<S> {
        let resistance = (-slope).max(S::from_f64(LEAST_RESISTANCE));
        Winding {
            resistance,
            ..Winding::volts(volts + resistance * current, S::zero())
        }
    }

    /// Slope of a voltage by the current, for states that are known.
    #[inline(always)]
    fn by_current(&self, at: &At<S>) -> S {
        let at = At {
            speed: Dual::constant(at.speed),
            turns: Dual::constant(at.turns),
            current: Dual {
                by_state: S::one(),
                ..Dual::constant(at.current)
            },
            transmitted: Dual::constant(at.transmitted),
            command: Dual::constant(at.command),
            time: Dual::constant(at.time),
            temperature: Dual::constant(at.temperature),
            states: at.states.map(Dual::constant),
        };
        self.law(&at).by_state
    }

    /// A voltage that depends on the motion or the current or has a state, as its mean over the part.
    #[inline(never)]
    pub(in crate::effects) fn winding(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Winding<S> {
        if !self.program.acts_within_a_part() {
            return Winding::default();
        }
        S::routine(
            #[inline(always)]
            || {
                let resists = self.program.is_a_resistance();
                if !self.program.has_state() {
                    let volts = self.mean(shaft, memory[0]);
                    if !resists {
                        return Winding::volts(volts, S::zero());
                    }
                    let slope = self.mean_of(
                        #[inline(always)]
                        |reach| self.by_current(&self.seen(shaft, reach, memory[0])),
                    );
                    return self.with_resistance(volts, slope, shaft.current);
                }
                let moved = self.moved(shaft, memory);
                let at = At {
                    states: moved.each.map(|state| state.mean.value),
                    ..self.seen(shaft, 0.0, S::zero())
                };
                let volts = self.law(&at);
                // Where a rate bends, as at a limit, it is another one at the end than its slope at the beginning said.
                let end = At {
                    states: moved.each.map(|state| state.end),
                    ..at
                };
                let mut further = at;
                let coupled = [moved.coupled, S::zero()].into_iter().enumerate();
                for (place, coupled) in coupled.take(self.program.states.len()) {
                    let rate = self.rate(place, &end).scaled(shaft.length);
                    let bent = (rate - moved.each[place].rate_at_end).abs();
                    let bent = bent.max(coupled);
                    further.states[place] = at.states[place] + bent * S::from_f64(0.5);
                }
                let doubt = (self.law(&further) - volts).abs();
                if !resists {
                    return Winding::volts(volts, doubt);
                }
                let slope = self.by_current(&at);
                Winding {
                    doubt,
                    ..self.with_resistance(volts, slope, shaft.current)
                }
            },
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn torque(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> S {
        if self.program.output != Output::Torque || self.program.has_state() {
            return S::zero();
        }
        S::routine(
            #[inline(always)]
            || -self.mean(shaft, memory[0]),
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn lost_torque(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> S {
        if self.program.output != Output::TorqueConstant {
            return S::zero();
        }
        S::routine(
            #[inline(always)]
            || shaft.current * (S::one() - self.mean(shaft, memory[0])),
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        if self.program.output != Output::Friction {
            return Budget::default();
        }
        S::routine(
            #[inline(always)]
            || Budget::even(self.law(&self.seen(shaft, 0.0, S::zero())).max(S::zero())),
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn sensed(&self, turns: S) -> S {
        if self.program.output != Output::Angle {
            return S::zero();
        }
        S::routine(
            #[inline(always)]
            || {
                self.law(&At {
                    turns,
                    ..At::all(S::zero())
                })
            },
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn stiff(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Stiff<S> {
        match self.program.output {
            Output::Torque if self.program.has_state() => self.stiff_by_state(shaft, memory),
            Output::Inertia => self.inertia(shaft),
            _ => Stiff::default(),
        }
    }

    /// Torque that takes the mass `m·g(θ)` along: `d/dt ∂L/∂ω − ∂L/∂θ = m·(g·dω/dt + ω²/2·dg/dθ)` of `L = m·g·ω²/2` (Goldstein, Poole,
    /// Safko, *Classical Mechanics*, 1.4), as a mean over the part.
    #[inline(always)]
    fn inertia(&self, shaft: &Shaft<S>) -> Stiff<S> {
        S::routine(
            #[inline(always)]
            || {
                let half = S::from_f64(0.5);
                let mean = self.mean_of(
                    #[inline(always)]
                    |reach| self.mass(shaft, reach),
                );
                let grown = self.mass(shaft, 0.5) - self.mass(shaft, -0.5);
                let gathered = mean * shaft.speed_change + half * shaft.speed * grown;
                let torque = gathered.times(shaft.inertia);
                // A friction may stop the shaft within the part, whose speed then changes by less; and the mass that has grown gathers
                // less speed at the end than at the beginning.
                let part = S::select(reverses(shaft), S::one(), grown.abs() * S::from_f64(GROWN));
                Stiff {
                    torque,
                    // As far as a torque changes the speed, the mass takes its part of it.
                    slope: mean,
                    doubt: torque.abs() * part,
                }
            },
        )
    }

    /// An inertia a part `reach` of the part after its middle.
    #[inline(always)]
    fn mass(&self, shaft: &Shaft<S>, reach: f64) -> S {
        self.law(&self.seen(shaft, reach, S::zero())).max(S::zero())
    }

    #[inline(always)]
    fn stiff_by_state(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Stiff<S> {
        S::routine(
            #[inline(always)]
            || {
                let moved = self.moved(shaft, memory);
                let at = At {
                    states: moved.each.map(|state| state.mean),
                    ..self.differentiated(shaft)
                };
                let torque = self.law(&at);
                // Against the motion, by the speed: as the states follow it, and at once.
                let slower = shaft
                    .compliance
                    .times(self.per_turn)
                    .times(shaft.per_length);
                Stiff {
                    torque: -torque.value,
                    slope: (-torque.by_speed * slower).max(S::zero()),
                    doubt: self.doubt(&at, &moved),
                }
            },
        )
    }

    /// What a torque would be more or less by where two states go on with each other for the whole part.
    #[inline(always)]
    fn doubt(&self, at: &At<Dual<S>>, moved: &Moved<S>) -> S {
        if self.program.states.len() < 2 {
            return S::zero();
        }
        let mut further = *at;
        further.states[0].value = further.states[0].value + moved.coupled;
        (self.law(&further).value - self.law(at).value).abs()
    }

    #[inline(never)]
    pub(in crate::effects) fn remember(&self, memory: &Memory<S>, shaft: &Shaft<S>) -> Memory<S> {
        if !self.program.remembers() {
            return *memory;
        }
        S::routine(
            #[inline(always)]
            || {
                if self.program.has_state() {
                    let [first, second] = self.moved(shaft, memory).each;
                    return [first.end, second.end];
                }
                [memory[0] + S::one().times(shaft.length), memory[1]]
            },
        )
    }
}

impl Stated<f64> {
    /// The law in its unit, without states, at a speed, an angle and a current or command in SI.
    pub(super) fn value(&self, units: &PerUnit<f64>, [speed, angle, volts]: [f64; 3]) -> f64 {
        let volts = units.lower(volts, Quantity::Voltage);
        let at = At {
            speed: units.lower(speed, Quantity::Speed),
            turns: units.lower(angle, Quantity::Angle),
            current: volts,
            transmitted: volts,
            command: volts,
            ..At::all(0.0)
        };
        units.raise(self.law(&at), self.program.output.quantity())
    }
}

/// Whether the speed passes zero within the part.
#[inline(always)]
pub(super) fn reverses<S: Scalar>(shaft: &Shaft<S>) -> S::Mask {
    let turn = shaft.speed_change * S::from_f64(0.5);
    ((shaft.speed - turn) * (shaft.speed + turn)).less(S::zero())
}
