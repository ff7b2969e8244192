//! What an ordinary bench has and a kind one has not: dead time, a supply that gives way and ripples, an encoder whose edges are off,
//! glitches on its lines, a current sensor that is off.

use clap::Args;

/// Carrier of all boards here, Hz.
const CARRIER_HZ: f64 = 20_000.0;
/// A full-wave rectifier's ripple, Hz.
const RIPPLE_HZ: f64 = 100.0;

/// How unkind the bench is; nothing of it unless asked for.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "An ordinary bench")]
pub struct Unkind {
    /// Dead time of each leg, ns: the current chooses the side, against itself.
    #[arg(long, value_name = "NANOSECONDS", default_value_t = 0.0)]
    pub dead_time_ns: f64,
    /// Resistance of the supply and its leads, Ω.
    #[arg(long, value_name = "OHM", default_value_t = 0.0)]
    pub supply_resistance: f64,
    /// Ripple of the supply, V from its mean to its peak, at twice the frequency of a mains of 50 Hz.
    #[arg(long, value_name = "VOLT", default_value_t = 0.0)]
    pub ripple: f64,
    /// How far the encoder's edges are off, counts either way, each always by as much.
    #[arg(long, value_name = "COUNTS", default_value_t = 0.0)]
    pub edge_error: f64,
    /// Short pulses on the encoder's line A, a second.
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0)]
    pub glitches: f64,
    /// Error of the current sensor, A.
    #[arg(long, value_name = "AMPERE", default_value_t = 0.0)]
    pub sensor_offset: f64,
}

impl Unkind {
    /// Voltage of the supply at the bridge at `now`, s, V.
    pub fn bus(&self, supply: f64, now: f64, duty: Option<f64>, current: f64) -> f64 {
        let ripple = self.ripple * (std::f64::consts::TAU * RIPPLE_HZ * now).sin();
        supply + ripple - self.supply_resistance * duty.unwrap_or(0.0) * current
    }

    /// Voltage across the winding, V.
    pub fn volts(&self, bus: f64, duty: f64, current: f64) -> f64 {
        let lost = 2.0 * self.dead_time_ns * 1e-9 * CARRIER_HZ * bus;
        let driven = duty * bus;
        if current == 0.0 {
            // Nothing flows until there is more drive than the dead time takes.
            return driven - driven.clamp(-lost, lost);
        }
        driven - lost.copysign(current)
    }

    /// The count of an encoder at `counts`, of `per_rev`.
    pub fn count(&self, counts: f64, per_rev: u32) -> i64 {
        let below = counts.floor();
        let edge = (below as i64).rem_euclid(i64::from(per_rev.max(1))) as u64;
        // The edge at the lower end of this count may come late.
        let late = self.edge_error * chance(edge);
        below as i64 - i64::from(counts - below < late)
    }

    /// Glitches from `before` to `now`, s.
    pub fn glitches_between(&self, before: f64, now: f64) -> u32 {
        ((now * self.glitches).floor() - (before * self.glitches).floor()).max(0.0) as u32
    }
}

/// A number from -1 to 1 that an edge always has.
fn chance(edge: u64) -> f64 {
    // SplitMix64 (Steele, Lea, Flood 2014).
    let mut z = edge.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_bench_is_ideal() {
        let kind = Unkind::default();
        for duty in [-1.0, -0.3, 0.0, 0.7] {
            for current in [-3.0, 0.0, 5.0] {
                let bus = kind.bus(24.0, 1.234, Some(duty), current);
                assert_eq!(kind.volts(bus, duty, current), 24.0 * duty);
            }
        }
        for k in -5_000..5_000 {
            let counts = f64::from(k) * 0.37;
            assert_eq!(kind.count(counts, 2_000), counts.floor() as i64);
        }
    }

    #[test]
    fn dead_time_opposes_the_current_and_edges_stay_where_they_are() {
        let unkind = Unkind {
            dead_time_ns: 400.0,
            edge_error: 0.3,
            ..Unkind::default()
        };
        assert!((unkind.volts(24.0, 0.5, 2.0) - (12.0 - 0.384)).abs() < 1e-9);
        assert!((unkind.volts(24.0, 0.5, -2.0) - (12.0 + 0.384)).abs() < 1e-9);
        assert_eq!(unkind.volts(24.0, 0.01, 0.0), 0.0);
        for k in -20_000..20_000 {
            let counts = f64::from(k) * 0.05;
            let count = unkind.count(counts, 400);
            assert_eq!(count + 400, unkind.count(counts + 400.0, 400));
            assert!((count as f64 - counts.floor()).abs() <= 1.0);
        }
    }
}
