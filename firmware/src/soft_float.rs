//! The routines by which a compiler adds, multiplies, divides, compares and makes f32 on a core that cannot, in place of those of its library: the
//! same bits from a third of the flash.
//!
//! Unsafe, because whoever takes a name that the compiler calls by must do what it promises: `shared::scalar::soft` is held to
//! that by its tests, on every kind of number.

use core::cmp::Ordering;
use shared::scalar::soft;

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fadd(a: u32, b: u32) -> u32 {
    soft::sum(a, b)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fsub(a: u32, b: u32) -> u32 {
    soft::sum(a, b ^ 1 << 31)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fmul(a: u32, b: u32) -> u32 {
    soft::product(a, b)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fdiv(a: u32, b: u32) -> u32 {
    soft::quotient(a, b)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmpeq(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_some_and(Ordering::is_eq).into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmplt(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_some_and(Ordering::is_lt).into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmple(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_some_and(Ordering::is_le).into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmpgt(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_some_and(Ordering::is_gt).into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmpge(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_some_and(Ordering::is_ge).into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_fcmpun(a: u32, b: u32) -> u32 {
    soft::order(a, b).is_none().into()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_ui2f(x: u32) -> u32 {
    soft::from_whole(x.into())
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_i2f(x: i32) -> u32 {
    soft::from_signed(x.into())
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_ul2f(x: u64) -> u32 {
    soft::from_whole(x)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_l2f(x: i64) -> u32 {
    soft::from_signed(x)
}

#[unsafe(no_mangle)]
extern "aapcs" fn fminimum_numf(a: u32, b: u32) -> u32 {
    soft::least(a, b)
}

#[unsafe(no_mangle)]
extern "aapcs" fn fmaximum_numf(a: u32, b: u32) -> u32 {
    soft::greatest(a, b)
}
