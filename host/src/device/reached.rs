//! A device that can be talked to: a real one, or an emulated one.

use super::{Emulation, Port};

/// Where a device answers; dropping this ends an emulated one.
pub struct Reached {
    /// Its port.
    pub port: Port,
    /// Supply (V) and counts per revolution of an emulated bench.
    pub bench: Option<(f64, u32)>,
    _emulation: Option<Emulation>,
}

impl Reached {
    /// A real device.
    pub fn at(port: Port) -> Self {
        Reached {
            port,
            bench: None,
            _emulation: None,
        }
    }

    /// An emulated device with a motor at `supply_v` and an encoder of so many counts.
    pub fn emulated(emulation: Emulation, supply_v: f64, counts_per_rev: u32) -> Self {
        Reached {
            port: emulation.port().clone(),
            bench: Some((supply_v, counts_per_rev)),
            _emulation: Some(emulation),
        }
    }
}
