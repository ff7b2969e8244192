//! What was built for several candidates, abreast: each of its numbers becomes one number with a lane for each
//! candidate. So there is one way to lower a model, and one way to run it.

use super::Scalar;
use core::array::from_fn;
use core::marker::PhantomData;

/// A value that `N` values of type `T` make side by side.
pub trait Abreast<T, const N: usize>: Sized {
    /// `None` where they differ in more than their numbers.
    fn abreast(each: [&T; N]) -> Option<Self>;
}

impl<W: From<[f64; N]>, const N: usize> Abreast<f64, N> for W {
    fn abreast(each: [&f64; N]) -> Option<Self> {
        Some(W::from(each.map(|x| *x)))
    }
}

impl<W: Scalar, const N: usize> Abreast<PhantomData<f64>, N> for PhantomData<W> {
    fn abreast(_: [&PhantomData<f64>; N]) -> Option<Self> {
        Some(PhantomData)
    }
}

impl<A, B: Abreast<A, N> + Copy, const K: usize, const N: usize> Abreast<[A; K], N> for [B; K] {
    fn abreast(each: [&[A; K]; N]) -> Option<Self> {
        let entries: [Option<B>; K] = from_fn(|k| B::abreast(each.map(|one| &one[k])));
        let first = (*entries.first()?)?;
        let all = entries.iter().all(Option::is_some);
        all.then(|| entries.map(|entry| entry.unwrap_or(first)))
    }
}

impl<A, B: Abreast<A, N>, const N: usize> Abreast<Option<A>, N> for Option<B> {
    fn abreast(each: [&Option<A>; N]) -> Option<Self> {
        let Some(first) = each[0] else {
            return each.iter().all(|one| one.is_none()).then_some(None);
        };
        let all = each.iter().all(|one| one.is_some());
        let entries = each.map(|one| one.as_ref().unwrap_or(first));
        all.then(|| B::abreast(entries)).flatten().map(Some)
    }
}

/// What must be the same for all.
macro_rules! common {
    ($($type:ty),*) => {$(
        impl<const N: usize> Abreast<$type, N> for $type {
            fn abreast(each: [&$type; N]) -> Option<Self> {
                each.iter().all(|one| *one == each[0]).then_some(*each[0])
            }
        }
    )*};
}

common!(bool, u16, u32, usize, crate::effects::Needs);

/// Puts a struct abreast field by field.
macro_rules! abreast {
    ($type:ident { $($field:tt),* $(,)? }) => {
        impl<W, const N: usize> $crate::scalar::Abreast<$type<f64>, N> for $type<W>
        where
            W: $crate::scalar::Scalar<Coefficient = W, Angle = W> + From<[f64; N]>,
        {
            fn abreast(each: [&$type<f64>; N]) -> Option<Self> {
                Some($type {
                    $($field: $crate::scalar::Abreast::abreast(each.map(|one| &one.$field))?),*
                })
            }
        }
    };
}

pub(crate) use abreast;
