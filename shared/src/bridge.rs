//! The voltage that a duty puts across the winding, by the supply that the bridge measures. What its dead time takes is fitted, see
//! [`Unknown::DeadTime`](crate::fit::Unknown::DeadTime): a current that is read once a period does not tell when it changes its sign.

use crate::trace::OPEN;

/// A bridge behind a supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bridge {
    /// Voltage that duties are parts of, mV; zero takes any supply for it.
    pub nominal_mv: u32,
    /// What rounding has left over, 16 binary places: it is made good later, or it would add up to a travel.
    carry: i32,
}

impl Bridge {
    /// A bridge that has not driven yet.
    pub const fn new(nominal_mv: u32) -> Self {
        Bridge {
            nominal_mv,
            carry: 0,
        }
    }

    /// The duty that the winding saw, in parts of the nominal voltage: `duty` as it was given, behind `supply_mv` (none if not
    /// measured).
    pub fn at_winding(&mut self, duty: i16, supply_mv: Option<u16>) -> i16 {
        if duty == OPEN {
            return OPEN;
        }
        let given = i64::from(duty) << 16;
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

/// Largest duty either way; the one below it is [`OPEN`].
const LARGEST: i64 = i16::MAX as i64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bridge_that_measures_nothing_hands_on_every_duty() {
        let mut bridge = Bridge::new(24_000);
        for duty in i16::MIN..=i16::MAX {
            assert_eq!(bridge.at_winding(duty, None), duty);
            assert_eq!(bridge.at_winding(duty, Some(24_000)), duty);
        }
    }

    #[test]
    fn what_is_seen_adds_up_to_the_supply() {
        for (supply, nominal) in [
            (23_117, 24_000),
            (24_000, 24_000),
            (25_999, 24_000),
            (9_001, 12_000),
        ] {
            let mut bridge = Bridge::new(nominal);
            let (mut seen, mut exact) = (0.0, 0.0);
            for duty in (-20_000..20_000).step_by(37) {
                seen += f64::from(bridge.at_winding(duty, Some(supply)));
                exact += f64::from(duty) * f64::from(supply) / f64::from(nominal);
                assert!((seen - exact).abs() <= 1.0, "{seen} {exact}");
            }
        }
    }

    #[test]
    fn nothing_overflows() {
        for duty in [i16::MIN, -32_767, 0, i16::MAX] {
            for supply in [None, Some(0), Some(u16::MAX)] {
                for nominal in [0, 1, u32::MAX] {
                    Bridge::new(nominal).at_winding(duty, supply);
                }
            }
        }
    }
}
