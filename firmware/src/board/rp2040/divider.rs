//! The chip divides by itself: what the compiler calls to divide asks it, instead of doing that bit by bit.
//!
//! Unsafe, because whoever takes a name that the compiler calls by must do what it promises: quotient in the first register,
//! remainder in the second. The divider is one of the core's own, and no interrupt of this program divides.

use rp_pac::SIO;

/// Quotient and remainder of what the divider was given.
fn result() -> u64 {
    let divider = SIO.div();
    while !divider.csr().read().ready() {}
    // The quotient last: with it the divider takes the division as done.
    let remainder = divider.remainder().read();
    let quotient = divider.quotient().read();
    u64::from(remainder) << 32 | u64::from(quotient)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_uidivmod(dividend: u32, divisor: u32) -> u64 {
    SIO.div().udividend().write_value(dividend);
    SIO.div().udivisor().write_value(divisor);
    result()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_idivmod(dividend: u32, divisor: u32) -> u64 {
    SIO.div().sdividend().write_value(dividend);
    SIO.div().sdivisor().write_value(divisor);
    result()
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_uidiv(dividend: u32, divisor: u32) -> u64 {
    __aeabi_uidivmod(dividend, divisor)
}

#[unsafe(no_mangle)]
extern "aapcs" fn __aeabi_idiv(dividend: u32, divisor: u32) -> u64 {
    __aeabi_idivmod(dividend, divisor)
}
