//! The voltage that a duty puts across the winding, by what the bridge measures and loses.
//!
//! Two half bridges that switch at a carrier lose their dead time: while both transistors of a leg are off, the current chooses the
//! side, always the one that opposes it. Over a carrier period `T` with the dead time `t_d` the two legs lose
//! `2 t_d / T` of the supply against the current's sign (Holmes and Lipo, *Pulse Width Modulation for Power Converters*, 2003,
//! section 12.2). Near zero the ripple changes the current's sign within a period, and the loss goes through zero with the mean.

use crate::trace::OPEN;

/// A bridge behind a supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bridge {
    /// Voltage that duties are parts of, mV; zero takes any supply for it.
    pub nominal_mv: u32,
    /// Loss of the dead time, as a duty.
    pub dead_time: u16,
    /// Current below which the ripple changes its sign, mA: the loss is in proportion there.
    pub ripple_ma: u16,
    /// What rounding has left over, 16 binary places: it is made good later, or it would add up to a travel.
    carry: i32,
}

impl Bridge {
    /// A bridge that has not driven yet.
    pub const fn new(nominal_mv: u32, dead_time: u16, ripple_ma: u16) -> Self {
        Bridge {
            nominal_mv,
            dead_time,
            ripple_ma,
            carry: 0,
        }
    }

    /// The duty that the winding saw, in parts of the nominal voltage: `duty` as it was given, behind `supply_mv` (none if not
    /// measured), while the current went from the first of `current_ma` to the second.
    ///
    /// A current that changes its sign is taken to do so on a straight line: the loss of the one part of the period takes from that of
    /// the other.
    pub fn at_winding(&mut self, duty: i16, supply_mv: Option<u16>, current_ma: [i32; 2]) -> i16 {
        if duty == OPEN {
            return OPEN;
        }
        let lost = i64::from(self.dead_time) << 16;
        let [from, to] = current_ma.map(|ma| i64::from(ma.clamp(-LARGEST_MA, LARGEST_MA)));
        let whole = (from.abs() + to.abs()).max(2 * i64::from(self.ripple_ma.max(1)));
        let given = (i64::from(duty) << 16) - lost * (from + to) / whole;
        let seen = match (supply_mv, self.nominal_mv) {
            (Some(supply), nominal @ 1..) => given * i64::from(supply) / i64::from(nominal),
            _ => given,
        };
        let exact = seen + i64::from(self.carry);
        let rounded = ((exact + (1 << 15)) >> 16).clamp(-LARGEST, LARGEST);
        let left = exact - (rounded << 16);
        self.carry = left.clamp(-(1 << 16), 1 << 16) as i32;
        rounded as i16
    }
}

/// Largest current that is told apart, mA.
const LARGEST_MA: i32 = 1 << 28;
/// Largest duty either way; the one below it is [`OPEN`].
const LARGEST: i64 = i16::MAX as i64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bridge_that_measures_and_loses_nothing_hands_on_every_duty() {
        let mut bridge = Bridge::new(24_000, 0, 50);
        for duty in i16::MIN..=i16::MAX {
            assert_eq!(bridge.at_winding(duty, None, [700; 2]), duty);
            assert_eq!(bridge.at_winding(duty, Some(24_000), [-700, 300]), duty);
        }
    }

    #[test]
    fn what_is_seen_adds_up_to_the_supply_and_the_loss_to_a_step() {
        for (supply, nominal) in [
            (23_117, 24_000),
            (24_000, 24_000),
            (25_999, 24_000),
            (9_001, 12_000),
        ] {
            for current in [-900, -20, 0, 7, 50, 4_000] {
                let mut bridge = Bridge::new(nominal, 273, 50);
                let (mut seen, mut exact) = (0.0, 0.0);
                for duty in (-20_000..20_000).step_by(37) {
                    seen += f64::from(bridge.at_winding(duty, Some(supply), [current; 2]));
                    let part = (f64::from(current) / 50.0).clamp(-1.0, 1.0);
                    exact +=
                        (f64::from(duty) - 273.0 * part) * f64::from(supply) / f64::from(nominal);
                    assert!((seen - exact).abs() <= 1.0, "{seen} {exact}");
                }
            }
        }
    }

    #[test]
    fn nothing_overflows() {
        for duty in [i16::MIN, -32_767, 0, i16::MAX] {
            for supply in [None, Some(0), Some(u16::MAX)] {
                for current in [i32::MIN, 0, i32::MAX] {
                    for nominal in [0, 1, u32::MAX] {
                        let mut bridge = Bridge::new(nominal, u16::MAX, 0);
                        bridge.at_winding(duty, supply, [current, current.wrapping_neg()]);
                        bridge.at_winding(duty, supply, [current; 2]);
                    }
                }
            }
        }
    }
}
