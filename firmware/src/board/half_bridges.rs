//! Compare values of two half bridges that put a duty across the winding between them.
//!
//! Both legs switch, around a common half of the supply: leg A is high for the part `a / full` of a carrier period, leg B
//! for `b / full`, centred on each other, and the winding sees the difference. Zero duty is then two equal waves and no
//! voltage, the current's ripple has twice the carrier's frequency, and a small duty is the difference of two long
//! pulses. If one leg stood still instead, a duty shorter than the dead time would vanish, and with it the motor's
//! answer to small voltages, which is what an identification looks at.

/// Two half bridges with one carrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HalfBridges {
    /// Compare value of a leg that is high all the time.
    pub full: u16,
    /// Compare steps of a carrier period in which a leg must be low, to recharge the bootstrap capacitor of its high
    /// side; zero for drivers with a charge pump. Costs as much of the largest duty, and nothing below it.
    pub refresh: u16,
}

impl HalfBridges {
    /// Duty that is one step: the largest power of two with which all steps fit into 15 bits.
    fn unit(self) -> i32 {
        let most = i32::from(i16::MAX) / i32::from(self.full).max(1);
        1 << most.max(1).ilog2()
    }

    /// Duty that is the whole supply, see [`Board::full`](super::Board::full).
    pub fn full_duty(self) -> u16 {
        (i32::from(self.full) * self.unit()) as u16
    }

    /// Compare values of the legs A and B for `duty`. Their difference is the duty to the nearest step, or the largest one
    /// that leaves each leg its time to recharge.
    pub fn compares(self, duty: i16) -> (u16, u16) {
        let (full, unit) = (i32::from(self.full), self.unit());
        let longest = full - i32::from(self.refresh);
        let difference = (i32::from(duty) + unit / 2)
            .div_euclid(unit)
            .clamp(-longest, longest);
        let high = ((full + difference.abs() + 1) / 2).min(longest);
        let low = high - difference.abs();
        let (a, b) = if difference >= 0 {
            (high, low)
        } else {
            (low, high)
        };
        (a as u16, b as u16)
    }
}

impl HalfBridges {
    /// `duty` quantised to the carrier's steps.
    pub fn nearest(self, duty: i16) -> i16 {
        let (a, b) = self.compares(duty);
        ((i32::from(a) - i32::from(b)) * self.unit()) as i16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BRIDGES: [HalfBridges; 4] = [
        HalfBridges {
            full: 4200,
            refresh: 0,
        },
        HalfBridges {
            full: 4250,
            refresh: 85,
        },
        HalfBridges {
            full: 3125,
            refresh: 63,
        },
        HalfBridges {
            full: 1,
            refresh: 0,
        },
    ];

    #[test]
    fn the_winding_sees_the_duty_to_half_a_step_unless_a_leg_must_recharge() {
        for bridge in BRIDGES {
            let longest = i32::from(bridge.full - bridge.refresh);
            for duty in i16::MIN..=i16::MAX {
                let (a, b) = bridge.compares(duty);
                let wanted =
                    f64::from(duty) * f64::from(bridge.full) / f64::from(bridge.full_duty());
                let seen = i32::from(a) - i32::from(b);
                assert!(
                    (f64::from(seen) - wanted).abs() <= 0.5
                        || (seen.abs() == longest && wanted.abs() > f64::from(longest)),
                    "{bridge:?} gives {seen} steps for duty {duty}"
                );
            }
        }
    }

    #[test]
    fn the_nearest_duty_is_done_as_it_is() {
        for bridge in BRIDGES {
            for duty in -32_767..=i16::MAX {
                let nearest = bridge.nearest(duty);
                assert_eq!(
                    bridge.compares(nearest),
                    bridge.compares(duty),
                    "{bridge:?}, {duty}"
                );
                assert_eq!(bridge.nearest(nearest), nearest, "{bridge:?}, {duty}");
                let (a, b) = bridge.compares(duty);
                let part = f64::from(nearest) / f64::from(bridge.full_duty());
                let seen = (f64::from(a) - f64::from(b)) / f64::from(bridge.full);
                assert_eq!(part, seen, "{bridge:?}, {duty}");
            }
        }
    }

    #[test]
    fn each_leg_is_low_for_its_recharge_and_the_legs_are_centred_on_half_the_supply() {
        for bridge in BRIDGES {
            for duty in i16::MIN..=i16::MAX {
                let (a, b) = bridge.compares(duty);
                assert!(
                    a.max(b) <= bridge.full - bridge.refresh,
                    "{bridge:?} duty {duty}"
                );
                let off_centre = i32::from(a) + i32::from(b) - i32::from(bridge.full);
                assert!(
                    (-i32::from(bridge.refresh)..=1).contains(&off_centre),
                    "{bridge:?} duty {duty}"
                );
            }
        }
    }

    #[test]
    fn forward_and_reverse_mirror_each_other_and_zero_brakes() {
        for bridge in BRIDGES {
            let (a, b) = bridge.compares(0);
            assert_eq!(a, b);
            for duty in 1..=i16::MAX {
                let (a, b) = bridge.compares(duty);
                let (c, d) = bridge.compares(-duty);
                let rounds_up = i32::from(a) - i32::from(b) - (i32::from(d) - i32::from(c));
                assert!((0..=1).contains(&rounds_up), "{bridge:?} duty {duty}");
            }
        }
    }
}
