//! How two outputs of a PWM put a duty across a winding: one file of rules for the common bridges, and what each does for zero volts.
//!
//! | bridge | rule | zero volts | between the pulses |
//! |---|---|---|---|
//! | two half bridges (BTS7960, L6387, DRV8302) | [`HalfBridges`] | equal waves: a short across the winding | a short |
//! | IN1/IN2 (DRV8833, DRV8871, DRV8835) | [`SlowDecay`] | both high: a short | a short: slow decay |
//! | PWM and direction (Cytron MD10, TB6612 with its inverter) | [`PwmAndDirection`] | PWM low: a short | a short |
//! | enable as PWM (L298) | [`PwmAndDirection`] | open | **open: the diodes take the current back** |
//!
//! Where the winding is shorted between the pulses, its mean voltage is the duty of the supply whatever the current does. With an enable as
//! PWM it is not: at small duties the current dies between the pulses, and the winding sees its own back-EMF meanwhile. Do not identify a
//! motor behind an L298's enable; put the PWM on its inputs instead (IN1 and IN2 as above).

pub use super::half_bridges::HalfBridges;

/// A rule for two outputs. All rules have the steps of two half bridges: their sign and number are what a rule turns into pulses.
pub trait Modulation {
    /// A rule for a carrier that counts up to `full`, whose outputs' longest pulse is `longest`.
    fn new(full: u16, longest: u16) -> Self;
    /// Its steps.
    fn steps(&self) -> HalfBridges;
    /// Compare values of both outputs.
    fn compares(&self, duty: i16) -> (u16, u16);
    /// Compare values of an open bridge, where its enable input alone does not open it.
    fn open(&self) -> (u16, u16);

    /// See [`Board::full`](super::Board::full).
    fn full_duty(&self) -> u16 {
        self.steps().full_duty()
    }

    /// `duty` in the steps of the rule.
    fn nearest(&self, duty: i16) -> i16 {
        self.steps().nearest(duty)
    }

    /// Whether a duty drives forward, and its number of steps.
    fn forward_steps(&self, duty: i16) -> (bool, u16) {
        let (a, b) = self.steps().compares(duty);
        (a >= b, a.abs_diff(b))
    }
}

impl Modulation for HalfBridges {
    fn new(full: u16, longest: u16) -> Self {
        HalfBridges {
            full,
            refresh: full.saturating_sub(longest),
        }
    }

    fn steps(&self) -> HalfBridges {
        *self
    }

    fn compares(&self, duty: i16) -> (u16, u16) {
        HalfBridges::compares(*self, duty)
    }

    fn open(&self) -> (u16, u16) {
        self.compares(0)
    }
}

/// IN1 and IN2, of which one is high all the time and the other between the pulses: the winding is shorted there. Both low open the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlowDecay(HalfBridges);

impl Modulation for SlowDecay {
    fn new(full: u16, longest: u16) -> Self {
        SlowDecay(HalfBridges::new(full, longest))
    }

    fn steps(&self) -> HalfBridges {
        self.0
    }

    fn compares(&self, duty: i16) -> (u16, u16) {
        let full = self.0.full;
        match self.forward_steps(duty) {
            (true, steps) => (full, full - steps),
            (false, steps) => (full - steps, full),
        }
    }

    fn open(&self) -> (u16, u16) {
        (0, 0)
    }
}

/// A PWM input and a direction input, which is high forward.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PwmAndDirection(HalfBridges);

impl Modulation for PwmAndDirection {
    fn new(full: u16, longest: u16) -> Self {
        PwmAndDirection(HalfBridges::new(full, longest))
    }

    fn steps(&self) -> HalfBridges {
        self.0
    }

    fn compares(&self, duty: i16) -> (u16, u16) {
        match self.forward_steps(duty) {
            (true, steps) => (steps, self.0.full),
            (false, steps) => (steps, 0),
        }
    }

    fn open(&self) -> (u16, u16) {
        (0, 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: u16 = 1000;
    /// Steps of a carrier's period.
    const PARTS: u16 = 1000;
    const SUPPLY: f64 = 24.0;
    const RESISTANCE: f64 = 2.0;
    const TIME_CONSTANT_S: f64 = 5e-4;
    const CARRIER_S: f64 = 50e-6;

    /// What the transistors make of the inputs' levels: volts, or an open bridge.
    type Transistors = fn(bool, bool) -> Option<f64>;

    fn legs(a: bool, b: bool) -> Option<f64> {
        Some(SUPPLY * (f64::from(u8::from(a)) - f64::from(u8::from(b))))
    }

    fn in_in(a: bool, b: bool) -> Option<f64> {
        if a || b { legs(a, b) } else { None }
    }

    fn pwm_and_direction(pwm: bool, forward: bool) -> Option<f64> {
        let driven = if forward { SUPPLY } else { -SUPPLY };
        Some(if pwm { driven } else { 0.0 })
    }

    fn enable(pwm: bool, forward: bool) -> Option<f64> {
        pwm.then_some(if forward { SUPPLY } else { -SUPPLY })
    }

    /// Mean current of a winding behind a switched bridge, with a back-EMF, once it has settled. A centred carrier.
    fn mean_current(compares: (u16, u16), transistors: Transistors, emf: f64) -> f64 {
        let high = |compare: u16, part: u16| {
            let place = (2 * part + 1).abs_diff(PARTS);
            u32::from(place) * u32::from(FULL) < u32::from(compare) * u32::from(PARTS)
        };
        let decay = (-CARRIER_S / f64::from(PARTS) / TIME_CONSTANT_S).exp();
        let (mut current, mut sum) = (0.0_f64, 0.0);
        for cycle in 0..80 {
            for part in 0..PARTS {
                let volts = transistors(high(compares.0, part), high(compares.1, part));
                // The diodes lead the current back into the supply until it has died.
                let driven = volts.unwrap_or(-(SUPPLY + 1.4).copysign(current));
                let end = (driven - emf) / RESISTANCE;
                let next = end + (current - end) * decay;
                let dies = volts.is_none() && (current == 0.0 || next * current < 0.0);
                current = if dies { 0.0 } else { next };
                if cycle >= 60 {
                    sum += current;
                }
            }
        }
        sum / (20.0 * f64::from(PARTS))
    }

    /// Largest departure of the mean current from that of the ideal voltage, A.
    fn departs<M: Modulation>(transistors: Transistors) -> f64 {
        let rule = M::new(FULL, FULL);
        let full = f64::from(Modulation::full_duty(&rule));
        let mut worst = 0.0_f64;
        for part in [-0.9, -0.5, -0.1, -0.02, 0.0, 0.02, 0.1, 0.5, 0.9] {
            for emf in [-6.0, 0.0, 2.0] {
                let duty = Modulation::nearest(&rule, (part * full) as i16);
                let ideal = (f64::from(duty) / full * SUPPLY - emf) / RESISTANCE;
                let seen = mean_current(rule.compares(duty), transistors, emf);
                worst = worst.max((seen - ideal).abs());
            }
        }
        worst
    }

    #[test]
    fn where_the_pulses_leave_a_short_the_mean_current_is_that_of_the_duty() {
        let departures = [
            ("two half bridges", departs::<HalfBridges>(legs)),
            ("IN1/IN2", departs::<SlowDecay>(in_in)),
            (
                "PWM and direction",
                departs::<PwmAndDirection>(pwm_and_direction),
            ),
        ];
        for (name, departure) in departures {
            println!("{name}: {departure:.4} A");
            // A step of the simulated carrier is 24 mV.
            assert!(departure < 0.03, "{name}: {departure} A");
        }
        let open = departs::<PwmAndDirection>(enable);
        println!("an enable as PWM: {open:.2} A");
        assert!(open > 1.0, "fast decay departs: {open} A");
    }

    #[test]
    fn zero_volts_short_the_winding_and_an_open_bridge_is_open() {
        // With a short a back-EMF of 2 V drives 1 A.
        let slow = SlowDecay::new(FULL, FULL);
        let short = mean_current(slow.compares(0), in_in, 2.0);
        assert!((short + 1.0).abs() < 1e-2, "{short}");
        assert_eq!(mean_current(slow.open(), in_in, 2.0), 0.0);
        let direction = PwmAndDirection::new(FULL, FULL);
        let short = mean_current(direction.compares(0), pwm_and_direction, 2.0);
        assert!((short + 1.0).abs() < 1e-2, "{short}");
        assert_eq!(mean_current(direction.open(), enable, 2.0), 0.0);
    }
}
