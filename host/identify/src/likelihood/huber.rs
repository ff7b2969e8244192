//! Huber's loss of innovations (P. J. Huber, *Robust Statistics*, 1981).

/// Standard deviations from which an innovation counts by its size, no longer by its square.
pub const HUBER: f64 = 4.0;

/// The squared standardised innovation, or less where it is far out.
pub fn huber(square: f64) -> f64 {
    if square < HUBER * HUBER {
        square
    } else {
        2.0 * HUBER * square.sqrt() - HUBER * HUBER
    }
}
