//! Differences in the scale of a quantity, as users read them.

use crate::quantity::{Quantity, Scale};

/// A difference `by` in the quantity's scale with its unit: per cent of a positive quantity, else its own unit.
pub(crate) fn difference(quantity: &Quantity, by: f64) -> (f64, String) {
    match quantity.scale {
        Scale::Log => (100.0 * libm::expm1(by), "%".to_owned()),
        Scale::Linear => (by, quantity.unit.clone()),
    }
}
