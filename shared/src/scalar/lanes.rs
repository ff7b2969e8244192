//! Packs what was built for several candidates into SIMD lanes: each number becomes one number with a lane for
//! each candidate. So there is one way to lower a model, and one way to run it.

use super::Scalar;
use core::marker::PhantomData;

/// A value whose lanes are `N` values of type `T`.
pub trait FromLanes<T, const N: usize>: Sized {
    /// Packs the values; `None` where they differ in more than their numbers.
    fn from_lanes(each: [&T; N]) -> Option<Self>;
}

/// A part of each value. As an array's own `map` would, but with a pointer to the function: a build makes hundreds of these, and each closure
/// would make several functions of its own.
pub fn parts<'v, T, P, const N: usize>(each: [&'v T; N], part: fn(&'v T) -> &'v P) -> [&'v P; N] {
    // There is at least one lane.
    let mut parts = [part(each[0]); N];
    for (part_of, one) in parts.iter_mut().zip(each) {
        *part_of = part(one);
    }
    parts
}

impl<W: From<[f64; N]>, const N: usize> FromLanes<f64, N> for W {
    fn from_lanes(each: [&f64; N]) -> Option<Self> {
        let mut values = [0.0; N];
        for (value, one) in values.iter_mut().zip(each) {
            *value = *one;
        }
        Some(W::from(values))
    }
}

impl<W: Scalar, const N: usize> FromLanes<PhantomData<f64>, N> for PhantomData<W> {
    fn from_lanes(_: [&PhantomData<f64>; N]) -> Option<Self> {
        Some(PhantomData)
    }
}

impl<A, B: FromLanes<A, N> + Copy, const K: usize, const N: usize> FromLanes<[A; K], N> for [B; K] {
    fn from_lanes(each: [&[A; K]; N]) -> Option<Self> {
        let entry = |k: usize| {
            let mut entries = [each[0].get(k)?; N];
            for (entry, one) in entries.iter_mut().zip(each) {
                *entry = one.get(k)?;
            }
            B::from_lanes(entries)
        };
        let mut entries = [entry(0)?; K];
        for (k, own) in entries.iter_mut().enumerate() {
            *own = entry(k)?;
        }
        Some(entries)
    }
}

impl<A, B: FromLanes<A, N>, const N: usize> FromLanes<Option<A>, N> for Option<B> {
    fn from_lanes(each: [&Option<A>; N]) -> Option<Self> {
        let Some(first) = each[0] else {
            return each.iter().all(|one| one.is_none()).then_some(None);
        };
        let all = each.iter().all(|one| one.is_some());
        let mut entries = [first; N];
        for (entry, one) in entries.iter_mut().zip(each) {
            *entry = one.as_ref().unwrap_or(first);
        }
        all.then(|| B::from_lanes(entries)).flatten().map(Some)
    }
}

/// Types that have no lanes: the value must be the same for all candidates.
macro_rules! common {
    ($($type:ty),*) => {$(
        impl<const N: usize> FromLanes<$type, N> for $type {
            fn from_lanes(each: [&$type; N]) -> Option<Self> {
                each.iter().all(|one| *one == each[0]).then_some(*each[0])
            }
        }
    )*};
}

common!(bool, u16, u32, usize, crate::effects::Needs);

/// Implements [`FromLanes`] for a struct, field by field.
macro_rules! lanes {
    ($type:ident { $($field:tt),* $(,)? }) => {
        impl<W, const N: usize> $crate::scalar::FromLanes<$type<f64>, N> for $type<W>
        where
            W: $crate::scalar::Scalar<Coefficient = W, Angle = W> + From<[f64; N]>,
        {
            fn from_lanes(each: [&$type<f64>; N]) -> Option<Self> {
                Some($type {
                    $($field: $crate::scalar::FromLanes::from_lanes($crate::scalar::parts(each, |one| &one.$field))?),*
                })
            }
        }
    };
}

pub(crate) use lanes;
