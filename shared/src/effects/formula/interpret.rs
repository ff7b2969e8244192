//! The operations on a stack, one after the other.

use super::lower::TANH_ENDS;
use super::number::Number;
use super::{MAX_DEPTH, MAX_STATES, Op, Variable, power};
use crate::effects::tangent::tanh;
use crate::scalar::Scalar;

/// What a formula may look at.
#[derive(Clone, Copy)]
pub(super) struct At<N> {
    pub(super) speed: N,
    pub(super) turns: N,
    pub(super) current: N,
    pub(super) transmitted: N,
    pub(super) command: N,
    /// In intervals.
    pub(super) time: N,
    pub(super) temperature: N,
    pub(super) states: [N; MAX_STATES],
}

impl<N: Copy> At<N> {
    /// Everything the same.
    #[inline(always)]
    pub(super) fn all(value: N) -> Self {
        At {
            speed: value,
            turns: value,
            current: value,
            transmitted: value,
            command: value,
            time: value,
            temperature: value,
            states: [value; MAX_STATES],
        }
    }
}

/// What a program leaves on the stack, with its `numbers`.
#[inline(always)]
pub(super) fn result<S: Scalar, N: Number<S>>(
    ops: &[Op],
    numbers: &[S::Coefficient],
    at: &At<N>,
) -> N {
    let mut numbers = Taken { left: numbers };
    let mut stack = [N::constant(S::zero()); MAX_DEPTH];
    let mut depth = 0;
    for op in ops {
        depth = step(op, &mut stack, depth, &mut numbers, at);
    }
    stack[0]
}

/// Numbers that operations take one after the other.
struct Taken<'a, S: Scalar> {
    left: &'a [S::Coefficient],
}

impl<'a, S: Scalar> Taken<'a, S> {
    #[inline(always)]
    fn take<const K: usize>(&mut self) -> [S::Coefficient; K] {
        let Some((taken, left)) = self.left.split_first_chunk::<K>() else {
            return [S::Coefficient::default(); K];
        };
        self.left = left;
        *taken
    }
}

/// One operation; gives the new depth of the stack.
#[inline(always)]
fn step<S: Scalar, N: Number<S>>(
    op: &Op,
    stack: &mut [N; MAX_DEPTH],
    depth: usize,
    numbers: &mut Taken<'_, S>,
    at: &At<N>,
) -> usize {
    // What is put on the stack.
    let pushed = match *op {
        Op::Variable(variable) => {
            let value = match variable {
                Variable::Speed => at.speed,
                Variable::Angle => at.turns,
                Variable::Current => at.current,
                Variable::Transmitted => at.transmitted,
                Variable::Command => at.command,
                Variable::Time => at.time,
                Variable::Temperature => at.temperature,
            };
            let [k] = numbers.take();
            Some(value.scaled(k))
        }
        Op::State(place) => at.states.get(usize::from(place)).copied(),
        Op::Constant(_) => Some(N::constant(S::one())),
        _ => None,
    };
    if let Some(value) = pushed {
        if let Some(place) = stack.get_mut(depth) {
            *place = value;
        }
        return (depth + 1).min(MAX_DEPTH);
    }
    let top = depth.saturating_sub(1);
    let under = depth.saturating_sub(2);
    let (a, b) = (stack[under], stack[top]);
    let zero = S::zero();
    let less = |a: N, b: N| a.value().less(b.value());
    let two = match *op {
        Op::Add | Op::Sub | Op::Min | Op::Max => {
            let [j, k] = numbers.take();
            let (a, b) = (a.scaled(j), b.scaled(k));
            Some(match *op {
                Op::Min => N::choose(less(b, a), b, a),
                Op::Max => N::choose(less(a, b), b, a),
                _ => a.plus(b),
            })
        }
        Op::Mul => Some(a.by(b)),
        Op::Div => {
            let [least, inverse] = numbers.take();
            let divisor = {
                let negative = b.value().less(zero);
                N::choose(negative, b.negated(), b)
            };
            // Its inverse, as a part of the largest that there is.
            let over = S::one().times(least).part_of(divisor.value());
            let over = divisor.map(over, || -(over * over).times(inverse));
            Some(a.by(over))
        }
        _ => None,
    };
    if let Some(value) = two {
        stack[under] = value;
        return depth.saturating_sub(1);
    }
    let x = b;
    let value = x.value();
    stack[top] = match *op {
        Op::Abs => N::choose(value.less(zero), x.negated(), x),
        Op::Sign => N::constant(value.signum()),
        Op::Square => x.by(x),
        Op::Exp => {
            let [scale, shift, floor, most, base] = numbers.take();
            // How far below its largest value it lies, as far as the format can say.
            let mut below = value.times(scale) - S::one().times(shift);
            if S::LIMIT.is_finite() {
                below = below.max(-S::one().times(floor));
            }
            let below = below.times(most);
            let result = below.min(zero).exp_decay();
            x.map(result, || result.times(base))
        }
        Op::Raise(_) => {
            let [exponent] = numbers.take();
            let terms: [S::Coefficient; power::NUMBERS] = numbers.take();
            let size = N::choose(value.less(zero), x.negated(), x);
            power::raised(size, exponent, &terms)
        }
        Op::Sin | Op::Cos => {
            let [turns, base] = numbers.take();
            let (sine, cosine) = value.times(turns).sin_cos_turns();
            match *op {
                Op::Sin => x.map(sine, || cosine.times(base)),
                _ => x.map(cosine, || -sine.times(base)),
            }
        }
        Op::Tanh => {
            let [end, base] = numbers.take();
            let size = value.abs().min(S::one().times(end)).times(base);
            let size = tanh(size.min(S::from_f64(TANH_ENDS)));
            let result = S::select(value.less(zero), -size, size);
            x.map(result, || (S::one() - size * size).times(base))
        }
        // A factor or a sign is in the base.
        _ => x,
    };
    depth
}
