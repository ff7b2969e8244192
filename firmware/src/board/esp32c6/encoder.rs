//! Counts every edge of both lines of the encoder, in a unit of the chip's pulse counter.

use esp_hal::gpio::Input;
use esp_hal::pcnt::Pcnt;
use esp_hal::pcnt::channel::{CtrlMode, EdgeMode};
use esp_hal::pcnt::unit::Unit;
use esp_hal::peripherals::PCNT;
use shared::encoder::Extended;

use crate::board::generic::Position;

/// The encoder.
pub struct Encoder {
    unit: Unit<'static, 0>,
    position: Extended,
}

impl Encoder {
    /// Takes the counter, and the lines A and B.
    pub fn new(pcnt: PCNT<'static>, [a, b]: &[Input<'static>; 2]) -> Self {
        // Without limits it wraps around at the ends of 16 bits.
        let unit = Pcnt::new(pcnt).unit0;
        let (a, b) = (a.peripheral_input(), b.peripheral_input());
        // Each line counts its edges one way while the other is low, the other way while it is high: up where A rises while B is low.
        let (first, second) = (&unit.channel0, &unit.channel1);
        first.set_edge_signal(a.clone());
        first.set_ctrl_signal(b.clone());
        first.set_input_mode(EdgeMode::Decrement, EdgeMode::Increment);
        second.set_edge_signal(b);
        second.set_ctrl_signal(a);
        second.set_input_mode(EdgeMode::Increment, EdgeMode::Decrement);
        first.set_ctrl_mode(CtrlMode::Keep, CtrlMode::Reverse);
        second.set_ctrl_mode(CtrlMode::Keep, CtrlMode::Reverse);
        unit.clear();
        unit.resume();
        Self {
            unit,
            position: Extended::default(),
        }
    }
}

impl Position for Encoder {
    fn count(&mut self) -> i32 {
        self.position.read(self.unit.value().cast_unsigned())
    }
}
