//! A formula along the shaft.

use super::interpret::{At, result};
use super::lower::{MAX_NUMBERS, Numbers};
use super::number::{Dual, Number};
use super::{Formula, Op, Output, Program, Variable};
use crate::effects::{Budget, Needs, Shaft, Stiff, Winding};
use crate::scalar::{FromLanes, Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// A formula with the values of its parameters, in a number format.
#[derive(Clone, Copy, Debug)]
pub struct Stated<S: Scalar> {
    program: &'static Program,
    numbers: [S::Coefficient; MAX_NUMBERS],
    rate_from: usize,
    /// From the law's last result to the output per unit.
    law: S::Coefficient,
    /// From the rate's last result to that of the state by the interval.
    rate: S::Coefficient,
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

/// Part of a torque of inertia that is doubted, of the part of the mass that has grown meanwhile.
const GROWN: f64 = 1.0 / 12.0;

lanes!(Stated {
    program,
    numbers,
    rate_from,
    law,
    rate,
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
        let time = self.looks_at(Variable::Time);
        let varies =
            current || time || self.looks_at(Variable::Speed) || self.looks_at(Variable::Angle);
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
            rate_from: numbers.rate_from,
            law: S::coefficient(numbers.law),
            rate: S::coefficient(numbers.rate),
            per_turn: S::coefficient_of(turn),
        }
    }

    /// Runs one of its programs. A routine of its own in every format: inlined into each place that asks for it, the operations
    /// would make the model many times as large.
    #[inline(never)]
    fn run<N: Number<S>>(&self, ops: &[Op], from: usize, at: &At<N>) -> N {
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
            state: S::zero(),
        }
    }

    /// Mean over the part, which began at a time in intervals.
    #[inline(always)]
    fn mean(&self, shaft: &Shaft<S>, began: S) -> S {
        self.mean_of(&|reach| self.law(&self.seen(shaft, reach, began)))
    }

    /// Mean over the part of what is `at` a part `reach` of it after its middle.
    #[inline(always)]
    fn mean_of(&self, at: &impl Fn(f64) -> S) -> S {
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

    /// A voltage that goes with the motion or has a state, as its mean over the part.
    #[inline(never)]
    pub(in crate::effects) fn winding(&self, shaft: &Shaft<S>, memory: S) -> Winding<S> {
        if !self.program.acts_within_a_part() {
            return Winding::default();
        }
        S::routine(
            #[inline(always)]
            || {
                if !self.program.has_state() {
                    return Winding::volts(self.mean(shaft, memory), S::zero());
                }
                let moved = self.moved(shaft, memory);
                let at = At {
                    state: moved.mean,
                    ..self.seen(shaft, 0.0, S::zero())
                };
                let volts = self.law(&at);
                // Where the rate bends, as at a limit, it is another one at the end than its slope at the beginning said.
                let end = At {
                    state: moved.end,
                    ..at
                };
                let bent = (self.run(self.program.rate, self.rate_from, &end)).scaled(self.rate);
                let bent = (bent.scaled(shaft.length) - moved.rate_at_end).abs();
                let further = At {
                    state: moved.mean + bent * S::from_f64(0.5),
                    ..at
                };
                Winding::volts(volts, (self.law(&further) - volts).abs())
            },
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn torque(&self, shaft: &Shaft<S>, memory: S) -> S {
        if self.program.output != Output::Torque || self.program.has_state() {
            return S::zero();
        }
        S::routine(
            #[inline(always)]
            || -self.mean(shaft, memory),
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn lost_torque(&self, shaft: &Shaft<S>, memory: S) -> S {
        if self.program.output != Output::TorqueConstant {
            return S::zero();
        }
        S::routine(
            #[inline(always)]
            || shaft.current * (S::one() - self.mean(shaft, memory)),
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
    pub(in crate::effects) fn stiff(&self, shaft: &Shaft<S>, memory: S) -> Stiff<S> {
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
                let zero = S::zero();
                let half = S::from_f64(0.5);
                let at = |reach: f64| self.law(&self.seen(shaft, reach, zero)).max(zero);
                let mean = self.mean_of(&at);
                let grown = at(0.5) - at(-0.5);
                let gathered = mean * shaft.speed_change + half * shaft.speed * grown;
                let torque = gathered.times(shaft.inertia);
                // A friction may stop the shaft within the part, whose speed then changes by less; and the mass that has grown gathers
                // less speed at the end than at the beginning.
                let turn = half * shaft.speed_change;
                let reverses = ((shaft.speed - turn) * (shaft.speed + turn)).less(zero);
                let part = S::select(reverses, S::one(), grown.abs() * S::from_f64(GROWN));
                Stiff {
                    torque,
                    // As far as a torque changes the speed, the mass takes its part of it.
                    slope: mean,
                    doubt: torque.abs() * part,
                }
            },
        )
    }

    #[inline(always)]
    fn stiff_by_state(&self, shaft: &Shaft<S>, memory: S) -> Stiff<S> {
        S::routine(
            #[inline(always)]
            || {
                let moved = self.moved(shaft, memory);
                let mut at = self.differentiated(shaft, memory);
                at.state.value = moved.mean;
                let torque = self.law(&at);
                // Against the motion, by the speed: as the state follows it, and at once.
                let drag = -(torque.by_speed + torque.by_state * moved.mean_by_speed);
                let slower = shaft
                    .compliance
                    .times(self.per_turn)
                    .times(shaft.per_length);
                Stiff {
                    torque: -torque.value,
                    slope: (drag * slower).max(S::zero()),
                    doubt: S::zero(),
                }
            },
        )
    }

    #[inline(never)]
    pub(in crate::effects) fn remember(&self, memory: S, shaft: &Shaft<S>) -> S {
        if !self.program.remembers() {
            return memory;
        }
        if !self.program.has_state() {
            return memory + S::one().times(shaft.length);
        }
        S::routine(
            #[inline(always)]
            || self.moved(shaft, memory).end,
        )
    }

    #[inline(always)]
    fn differentiated(&self, shaft: &Shaft<S>, state: S) -> At<Dual<S>> {
        let own = |value| Dual::constant(value);
        At {
            speed: Dual {
                by_speed: S::one(),
                ..own(shaft.speed)
            },
            turns: own(shaft.turns),
            current: own(shaft.current),
            transmitted: own(shaft.transmitted),
            command: own(shaft.volts),
            time: own(S::zero()),
            state: Dual {
                by_state: S::one(),
                ..own(state)
            },
        }
    }

    /// The state over a part, whose rate is taken as linear in it: exact where it is and the speed is steady (the exponential
    /// Rosenbrock–Euler method: Hochbruck, Ostermann, *Acta Numerica* 19, 2010, 2.3).
    #[inline(always)]
    fn moved(&self, shaft: &Shaft<S>, state: S) -> Moved<S> {
        let at = self.differentiated(shaft, state);
        let rate = self
            .run(self.program.rate, self.rate_from, &at)
            .scaled(self.rate);
        let rate = rate.scaled(shaft.length);
        let one = S::one();
        // How often the state is renewed within the part; not negative.
        let x = (-rate.by_state).max(S::zero()).min(S::from_f64(600.0));
        let half = S::from_f64(0.5);
        let sixth = S::from_f64(1.0 / 6.0);
        let small = x.less(S::from_f64(1.0 / 64.0));
        // (1 − e^−x)/x and (x − 1 + e^−x)/x², by their series where a difference would lose digits.
        let twelfth = S::from_f64(1.0 / 24.0);
        let series = one - x * (half - x * (sixth - x * twelfth));
        let first = S::select(small, series, (one - (-x).exp_decay()).part_of(x));
        let series = half - x * (sixth - x * (twelfth - x * S::from_f64(1.0 / 120.0)));
        let quotient = (one - first).part_of(x);
        let second = S::select(small, series, quotient);
        let gone = rate.value * first;
        Moved {
            mean: state + rate.value * second,
            end: state + gone,
            rate_at_end: rate.value - x * gone,
            mean_by_speed: rate.by_speed * second,
        }
    }
}

impl Stated<f64> {
    /// The law in its unit, without a state, at a speed, an angle and a current or command in SI.
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

/// The state over a part, in its range.
struct Moved<S> {
    mean: S,
    end: S,
    /// As its slope at the beginning has it, of the whole part.
    rate_at_end: S,
    mean_by_speed: S,
}
