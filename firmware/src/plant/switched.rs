//! A winding behind two half bridges that switch: every edge with its dead time, the diodes that carry the current meanwhile, and the
//! current that dies. From the circuit, edge by edge; nothing of it is a mean.

/// The circuit over a carrier wave.
#[derive(Clone, Copy, Debug)]
pub struct Wave {
    /// V.
    pub bus: f32,
    /// Part of the bus that the winding is given, from -1 to 1.
    pub duty: f32,
    /// s.
    pub length: f32,
    /// Time in which both transistors of a leg are off at each edge, s.
    pub dead: f32,
    /// Back-EMF, V.
    pub emf: f32,
    /// Ω.
    pub resistance: f32,
    /// H.
    pub inductance: f32,
}

/// What a leg connects its end of the winding to.
#[derive(Clone, Copy, PartialEq)]
enum Leg {
    Low,
    High,
    /// The diode that the current chooses.
    Neither,
}

/// The edges of a leg, s from the begin of the wave: both legs are centred in it.
#[derive(Clone, Copy)]
struct Edges {
    rise: f32,
    fall: f32,
    dead: f32,
}

impl Edges {
    fn of(part: f32, wave: &Wave) -> Self {
        let half = 0.5 * wave.length;
        Edges {
            rise: half * (1.0 - part),
            fall: half * (1.0 + part),
            dead: wave.dead,
        }
    }

    fn times(&self) -> [f32; 4] {
        [
            self.rise,
            self.rise + self.dead,
            self.fall,
            self.fall + self.dead,
        ]
    }

    fn at(&self, time: f32) -> Leg {
        let [rise, on, fall, off] = self.times();
        if time < rise || time > off {
            Leg::Low
        } else if on < time && time < fall {
            Leg::High
        } else {
            Leg::Neither
        }
    }
}

impl Wave {
    /// The current at the end of the wave that begins with `current`, A, its mean and its largest size.
    pub fn pass(&self, current: f32) -> (f32, f32, f32) {
        let legs = [0.5 + 0.5 * self.duty, 0.5 - 0.5 * self.duty].map(|part| Edges::of(part, self));
        let mut times = [self.length; 9];
        times[..4].copy_from_slice(&legs[0].times());
        times[4..8].copy_from_slice(&legs[1].times());
        times.sort_unstable_by(f32::total_cmp);
        let (mut current, mut charge, mut peak, mut at) = (current, 0.0, current.abs(), 0.0);
        for time in times {
            let time = time.min(self.length);
            if time > at {
                let middle = 0.5 * (at + time);
                let ends = legs.map(|leg| leg.at(middle));
                let (next, passed) = self.stretch(ends, current, time - at);
                (current, charge, at) = (next, charge + passed, time);
                peak = current.abs().max(peak);
            }
        }
        (current, charge / self.length, peak)
    }

    /// A stretch between two edges: the current at its end, and the charge that it carried.
    fn stretch(&self, [a, b]: [Leg; 2], from: f32, seconds: f32) -> (f32, f32) {
        // An end that neither transistor holds is low where current flows out of it, and high where it flows in.
        let end = |leg: Leg, otherwise: f32| match leg {
            Leg::Low => 0.0,
            Leg::High => self.bus,
            Leg::Neither => otherwise,
        };
        let forward = end(a, 0.0) - end(b, self.bus) - self.emf;
        let backward = end(a, self.bus) - end(b, 0.0) - self.emf;
        let (mut current, mut charge, mut left) = (from, 0.0, seconds);
        // It may die once, and rise the other way.
        for _ in 0..2 {
            let drive = if current > 0.0 || (current == 0.0 && forward > 0.0) {
                forward
            } else if current < 0.0 || backward < 0.0 {
                backward
            } else {
                return (0.0, charge);
            };
            let (next, passed) = self.decay(drive, current, left);
            if next * current >= 0.0 {
                return (next, charge + passed);
            }
            let to_zero = self.time_to_zero(drive, current).min(left);
            charge += self.decay(drive, current, to_zero).1;
            (current, left) = (0.0, left - to_zero);
        }
        (current, charge)
    }

    /// The first-order equation of the winding over some time: the current, and the charge.
    fn decay(&self, drive: f32, from: f32, seconds: f32) -> (f32, f32) {
        let steady = drive / self.resistance;
        let x = seconds * self.resistance / self.inductance;
        let gone = -libm::expm1f(-x);
        let current = from + (steady - from) * gone;
        let charge = steady * seconds + (from - steady) * gone * self.inductance / self.resistance;
        (current, charge)
    }

    fn time_to_zero(&self, drive: f32, from: f32) -> f32 {
        let steady = drive / self.resistance;
        self.inductance / self.resistance * libm::log1pf(-from / steady)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAVE: Wave = Wave {
        bus: 24.0,
        duty: 0.0,
        length: 50e-6,
        dead: 0.0,
        emf: 0.0,
        resistance: 2.0,
        inductance: 1e-3,
    };

    /// The mean voltage across the winding once the current's mean is steady, and that mean.
    fn settled(wave: Wave) -> (f32, f32) {
        let (mut current, mut mean) = ((wave.duty * wave.bus - wave.emf) / wave.resistance, 0.0);
        for _ in 0..400 {
            (current, mean, _) = wave.pass(current);
        }
        (mean * wave.resistance + wave.emf, mean)
    }

    #[test]
    fn without_dead_time_the_winding_has_the_mean() {
        for duty in [-0.97, -0.4, -0.01, 0.0, 0.2, 0.9] {
            for emf in [-10.0, 0.0, 3.0] {
                let (volts, _) = settled(Wave { duty, emf, ..WAVE });
                assert!((volts - 24.0 * duty).abs() < 1e-3, "{duty}: {volts}");
            }
        }
    }

    #[test]
    fn a_large_current_loses_two_dead_times_a_wave() {
        for (duty, emf) in [(0.6, 0.0), (0.3, -6.0), (-0.5, 0.0), (0.2, 12.0)] {
            let dead = 1e-6;
            let (volts, mean) = settled(Wave {
                duty,
                emf,
                dead,
                ..WAVE
            });
            let lost = 2.0 * dead / WAVE.length * WAVE.bus;
            let seen = (WAVE.bus * duty - volts) * mean.signum();
            assert!((seen / lost - 1.0).abs() < 1e-2, "{duty}: {seen} of {lost}");
        }
    }

    #[test]
    fn a_current_that_the_ripple_turns_loses_nothing() {
        // On the average a current of 20 mA, in a ripple of 75 mA either way.
        let wave = Wave {
            duty: 0.5,
            emf: 11.96,
            dead: 0.2e-6,
            ..WAVE
        };
        let (volts, mean) = settled(wave);
        assert!((volts - 12.0).abs() < 0.01, "{volts} at {mean}");
    }

    #[test]
    fn a_current_dies_in_the_dead_time_and_stays_dead() {
        let wave = Wave {
            dead: 25e-6,
            emf: 1.0,
            ..WAVE
        };
        let (current, mean, _) = wave.pass(0.01);
        assert_eq!(current, 0.0, "{mean}");
    }
}
