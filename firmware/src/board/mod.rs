//! The few things that a board must do. Everything above this trait runs on any board, and on none.
//!
//! A board keeps its own electrical limits (shoot-through, dead time, over-current); it does not know the motor, and
//! nothing above it names a pin. To add one, write a file here and name it below.

pub mod current;
pub mod entropy;
#[cfg(all(target_os = "none", feature = "esp32c6"))]
pub mod esp32c6;
pub mod generic;
pub mod h_bridge;
pub mod half_bridges;
pub mod link;
#[cfg(any(feature = "emulated", not(target_os = "none")))]
pub mod lockstep;
pub mod modulation;
pub mod note;
#[cfg(not(target_os = "none"))]
pub mod pc;
#[cfg(all(target_os = "none", any(feature = "pico", feature = "stm32")))]
mod period;
#[cfg(all(target_os = "none", feature = "pico"))]
pub mod pico;
#[cfg(all(target_os = "none", feature = "rp-parts"))]
pub mod pio_encoder;
pub mod port;
#[cfg(all(target_os = "none", feature = "emulated"))]
pub mod qemu;
pub mod sensors;
pub mod shunts;
#[cfg(all(target_os = "none", feature = "stm32"))]
mod stm32;
#[cfg(all(target_os = "none", feature = "stm32f103"))]
pub mod stm32f103;
#[cfg(all(
    target_os = "none",
    any(
        feature = "stm32f405",
        feature = "stm32f411",
        feature = "stm32f427",
        feature = "stm32f446"
    )
))]
mod stm32f4;
#[cfg(all(target_os = "none", feature = "stm32f405"))]
pub mod stm32f405;
#[cfg(all(target_os = "none", feature = "stm32f411"))]
pub mod stm32f411;
#[cfg(all(target_os = "none", feature = "stm32f427"))]
pub mod stm32f427;
#[cfg(all(target_os = "none", feature = "stm32f446"))]
pub mod stm32f446;
#[cfg(all(target_os = "none", feature = "stm32g431"))]
pub mod stm32g431;
pub mod store;

// The board that this build is for, the number that its application fits in, and the periods that it can.
#[cfg(all(target_os = "none", feature = "esp32c6"))]
pub use esp32c6::{CAPACITY, Esp32c6 as Fitted, Number, open_bridge, restart};
#[cfg(all(target_os = "none", feature = "pico"))]
pub use pico::{CAPACITY, Number, PicoBoard as Fitted, open_bridge, restart};
#[cfg(all(target_os = "none", feature = "stm32"))]
pub use stm32::{CAPACITY, Number, open_bridge, restart};
#[cfg(all(target_os = "none", feature = "stm32f103"))]
pub use stm32f103::Stm32f103 as Fitted;
#[cfg(all(target_os = "none", feature = "stm32f405"))]
pub use stm32f405::Stm32f405 as Fitted;
#[cfg(all(target_os = "none", feature = "stm32f411"))]
pub use stm32f411::Stm32f411 as Fitted;
#[cfg(all(target_os = "none", feature = "stm32f427"))]
pub use stm32f427::Stm32f427 as Fitted;
#[cfg(all(target_os = "none", feature = "stm32f446"))]
pub use stm32f446::Stm32f446 as Fitted;
#[cfg(all(target_os = "none", feature = "stm32g431"))]
pub use stm32g431::Stm32g431 as Fitted;

use crate::phase::Fault;
use shared::wire::Reset;

/// Speed of the link, baud: the fastest of the usual ones, which every adapter and debugger offers.
pub const BAUD: u32 = 921_600;

/// An H bridge, a quadrature encoder, a control period and a link to the host.
pub trait Board {
    /// Name of the board, as the host shows it.
    const NAME: &'static str;
    /// Length of a control period, µs.
    const PERIOD_US: u32;
    /// Samples of a model that fit into what a control period leaves free, with a margin of two.
    const SLICE: u32;
    /// True if [`current_ma`](Self::current_ma) measures.
    const SENSES_CURRENT: bool = false;
    /// Current that the bridge bears, mA: the limit of every run on a board that measures it. Zero for a bridge that protects
    /// itself.
    const CURRENT_LIMIT_MA: u32 = 0;
    /// Whether it [saves](Self::save) what is to outlive a power cut.
    const SAVES: bool = false;
    /// Step of the current's measurement, mA.
    const CURRENT_RESOLUTION_MA: u16 = 1;

    /// Duty that puts the whole supply across the winding. A bridge that does things in steps chooses it so that each step
    /// is a whole number: a recording then holds exactly what the winding saw. (With steps rounded to Q15, an encoder of
    /// 8,192 lines at full speed was three counts off in a few seconds.)
    fn full(&self) -> u16 {
        32_768
    }

    /// Applies `duty` to the winding until the next call: `duty / full` of the supply voltage, at most all of it. Zero puts
    /// zero volts across the winding, which brakes the motor; for no drive at all see [`coast`](Self::coast). It acts when
    /// [`count`](Self::count) reads, and an open bridge closes then.
    fn drive(&mut self, duty: i16);

    /// `duty` quantised to the bridge's steps: the recording holds the duty applied, not the one requested. A
    /// bridge of 4,000 steps is off by up to an eighth of a percent of the speed at a tenth of the supply.
    fn nearest(&self, duty: i16) -> i16 {
        duty
    }

    /// Opens the bridge: no current path, the motor coasts. The state after reset and after every fault, so it must
    /// work at any time, any number of times, and cannot fail.
    fn coast(&mut self);

    /// The encoder's position in counts, floor-quantised and cumulative, from wherever it started. It wraps around at
    /// the ends of `i32`: only differences taken with `wrapping_sub` mean anything. A board whose timer is 16 bits wide
    /// extends it here.
    ///
    /// It is the position at the instant at which a duty that was given at the start of the control period acts. A carrier takes
    /// a new duty over at its next peak or valley: the board waits for that. A shaft that were read before then would seem to
    /// answer so much later, and its time constant would be longer by as much.
    fn count(&mut self) -> i32;

    /// Armature current in mA, positive as it flows when a positive duty drives a motor at rest; zero without a sensor.
    fn current_ma(&mut self) -> i32 {
        0
    }

    /// How long [`count`](Self::count) is late, µs: the latency of an encoder behind a bus and a filter.
    fn encoder_latency_us(&self) -> u32 {
        0
    }

    /// Supply voltage of the bridge, mV, if the board measures it.
    fn supply_mv(&mut self) -> Option<u16> {
        None
    }

    /// Waves of the bridge's carrier in a control period, where its transistors switch with a dead time that the fit is to find; zero
    /// otherwise.
    fn carriers(&self) -> u16 {
        0
    }

    /// What the bridge's dead time takes from a duty, against the current, as the board sets it: twice the dead time by the carrier's
    /// period, of [`full`](Self::full). The fit begins there, and finds its own. Zero if the board does not know it.
    fn dead_time(&self) -> u16 {
        0
    }

    /// Waits for the end of the control period. The next duty is given, and count, current and supply are read, right after it, in
    /// that order.
    ///
    /// Nothing but this feeds the board's watchdog, if it has one: a program that does not come back here opens the bridge.
    ///
    /// # Errors
    ///
    /// [`Fault::Overrun`] if that end had already passed, so that the last duty lasted longer than a period;
    /// [`Fault::Bridge`] if the bridge's own protection switched it off; [`Fault::BridgeHot`] if it would get too hot.
    fn tick(&mut self) -> Result<(), Fault>;

    /// Takes a byte that the host has sent, if there is one. Never waits.
    fn receive(&mut self) -> Option<u8>;

    /// Hands bytes to the link, as many as it takes without waiting; returns how many that were.
    fn send(&mut self, bytes: &[u8]) -> usize;

    /// A number that differs from one power-up to the next as well as the board can make it (noise of an ADC, a cycle
    /// counter, a unique identity): it seeds the nonces of the arming command.
    fn entropy(&mut self) -> u32;

    /// See [`Store::load`](store::Store::load).
    fn load(&mut self, key: u8, into: &mut [u8; store::LONGEST]) -> Option<usize> {
        let _ = (key, into);
        None
    }

    /// See [`Store::save`](store::Store::save). The bridge is open. The board's watchdog waits for as long as it may take.
    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        let _ = (key, value);
        false
    }

    /// What made the board start.
    fn reset(&self) -> Reset {
        Reset::Unknown
    }
}
