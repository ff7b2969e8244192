//! Two half bridges that switch: each edge with its dead time, and the diodes that carry the current meanwhile.
//!
//! Both legs are centred in one carrier wave (Mohan, Undeland, Robbins, "Power Electronics", 2003, section 8.3.2.1). While neither
//! transistor of a leg is on, its end of the winding is low where current flows out of it and high where current flows into it; a
//! current that dies stays zero until the voltage across the winding lets it flow again.

/// A bridge on a supply.
#[derive(Clone, Copy, Debug)]
pub struct Bridge {
    /// V.
    pub supply_v: f64,
    /// Period of the carrier, s.
    pub period_s: f64,
    /// Time in which both transistors of a leg are off at each edge, s.
    pub dead_s: f64,
    /// Currents below this are zero, A.
    pub no_current_a: f64,
}

/// What a leg connects its end of the winding to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Leg {
    Low,
    High,
    /// The diode that the current chooses.
    Neither,
}

/// Both legs between two edges.
pub(super) type Legs = [Leg; 2];

impl Bridge {
    /// Where the edges of a leg begin and end in a carrier wave for the part of it in which the leg is high, s. A leg that is always
    /// high, or never, has none.
    fn edges(&self, part: f64) -> [f64; 4] {
        if part <= 0.0 {
            return [f64::INFINITY; 4];
        }
        if part >= 1.0 {
            return [
                f64::NEG_INFINITY,
                f64::NEG_INFINITY,
                f64::INFINITY,
                f64::INFINITY,
            ];
        }
        let half = 0.5 * self.period_s;
        let (rise, fall) = (half * (1.0 - part), half * (1.0 + part));
        [rise, rise + self.dead_s, fall, fall + self.dead_s]
    }

    /// The legs' edges for a mean voltage: that of the first leg, that of the second.
    fn both(&self, volts: f64) -> [[f64; 4]; 2] {
        let duty = (volts / self.supply_v).clamp(-1.0, 1.0);
        [0.5 + 0.5 * duty, 0.5 - 0.5 * duty].map(|part| self.edges(part))
    }

    /// The time to the next edge after `clock` s, s, and what the legs are connected to until then, for a mean voltage.
    pub(super) fn until_edge(&self, volts: f64, clock: f64) -> (f64, Legs) {
        let phase = clock.rem_euclid(self.period_s);
        let legs = self.both(volts);
        // An edge that rounding has not quite reached is passed.
        let passed = phase + 1e-9 * self.period_s;
        let edges = legs.iter().flatten().copied();
        // The dead time of the last edge may end in the next wave.
        let next = edges
            .flat_map(|edge| [edge, edge - self.period_s])
            .filter(|edge| *edge > passed)
            .fold(self.period_s, f64::min);
        let next = next.max(passed);
        let middle = 0.5 * (phase + next);
        let leg = |edges| self.connected(&edges, middle);
        (next - phase, legs.map(leg))
    }

    /// What a leg with these edges is connected to at a time of the wave, s. A pause or a pulse that is shorter than the dead time does
    /// not come.
    fn connected(&self, &[rise, on, fall, off]: &[f64; 4], time: f64) -> Leg {
        let end = off - self.period_s;
        if on < time && time < fall {
            Leg::High
        } else if time > off || (time < rise && (time > end || end.is_infinite())) {
            Leg::Low
        } else {
            Leg::Neither
        }
    }

    /// The side that the current chooses while a leg is off: −1, 1, or 0 for a current that has died. Nothing else bends.
    pub(super) fn side(&self, legs: &Legs, current: f64) -> i8 {
        if !legs.contains(&Leg::Neither) {
            return 0;
        }
        i8::from(current > self.no_current_a) - i8::from(current < -self.no_current_a)
    }

    /// The voltage across the winding, V, for the side that the current chose when the substep began, with a back-EMF `emf` V; `still` V
    /// keep the current as it is.
    pub(super) fn volts(&self, legs: &Legs, side: i8, emf: f64, still: f64) -> f64 {
        let end = |leg: Leg, otherwise: f64| match leg {
            Leg::Low => 0.0,
            Leg::High => self.supply_v,
            Leg::Neither => otherwise,
        };
        let forward = end(legs[0], 0.0) - end(legs[1], self.supply_v);
        let backward = end(legs[0], self.supply_v) - end(legs[1], 0.0);
        match side {
            1 => forward,
            -1 => backward,
            _ if forward > emf => forward,
            _ if backward < emf => backward,
            _ => still,
        }
    }
}
