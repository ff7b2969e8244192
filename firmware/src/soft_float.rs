//! The routines by which a compiler adds, multiplies and divides f32 on a core that cannot, in place of those of its library: the
//! same bits from a third of the flash.
//!
//! Unsafe, because whoever takes a name that the compiler calls by must do what it promises: `shared::scalar::soft` is held to
//! that by its tests, on every kind of number.

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
