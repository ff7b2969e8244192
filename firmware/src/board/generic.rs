//! A board out of any chip's HAL: the traits of `embedded-hal` and `embedded-io` where they have what it takes, and three small
//! ones of ours where they have not.
//!
//! | part | trait |
//! |---|---|
//! | two half bridges | [`SetDutyCycle`] each |
//! | the bridge's enable, its fault line | [`OutputPin`], [`InputPin`] |
//! | the link | `embedded-io`'s, see [`Link`](super::link::Link); another one's [`Port`] |
//! | position counter | [`Position`]: `embedded-hal` counts nothing |
//! | when a new duty acts | [`Turn`], or [`DelayNs`] by [`AfterDelay`] |
//! | control period | [`Tick`] |
//!
//! The bridge makes its own dead time. A timer that drives four transistors by itself, with dead time between complementary
//! outputs and a break input, has no trait: so the STM32s' boards stay with their HAL (`board/stm32.rs`).

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

use super::Board;
use super::entropy::Entropy;
pub use super::h_bridge::HBridge;
use super::modulation::Modulation;
use super::port::Port;
use super::sensors::Sensors;
use super::store::{LONGEST, LONGEST_SAVE_S, Store};
use crate::phase::Fault;
use shared::wire::Reset;

/// A counter of the encoder's edges.
pub trait Position {
    /// See [`Board::count`]. Of a reading that failed, the last one.
    fn count(&mut self) -> i32;

    /// True if readings have failed for so long that the count is not to be trusted.
    fn failed(&self) -> bool {
        false
    }

    /// How long a count is late, µs; [`SampledLate`](crate::encoder::SampledLate) makes that good.
    fn latency_us(&self) -> u32 {
        0
    }
}

/// The carrier's turn, at which the legs take a new duty over. The first one comes some 20 µs after a control period's end.
pub trait Turn {
    /// A control period has begun.
    fn begin(&mut self);
    /// Waits until the carrier has turned in this control period.
    fn wait(&mut self);
}

/// The turn of a carrier that tells nobody: it has passed after a delay.
#[derive(Debug)]
pub struct AfterDelay<D> {
    /// The delay source.
    pub delay: D,
    /// From when the duty was given to the latest turn.
    pub ns: u32,
}

impl<D: DelayNs> Turn for AfterDelay<D> {
    fn begin(&mut self) {}

    fn wait(&mut self) {
        self.delay.delay_ns(self.ns);
    }
}

/// Control periods, by a timer of the chip's.
pub trait Tick {
    /// See [`Board::tick`]. A chip's watchdog is fed here, late or not.
    ///
    /// # Errors
    /// [`Fault::Overrun`] if the period had ended before.
    fn end(&mut self) -> Result<(), Fault>;
    /// A number that differs between two events that nobody synchronised.
    fn time(&self) -> u32;
    /// The next end comes only after a flash was written, which may take this long. A chip's watchdog waits for it.
    fn pause(&mut self, seconds: u32) {
        let _ = seconds;
    }
}

/// The control period of an application that is called once in each, by a task of somebody else's firmware: nothing waits here, and a
/// period that comes late is not noticed here.
#[derive(Debug, Default)]
pub struct CallersClock {
    periods: u32,
}

impl Tick for CallersClock {
    fn end(&mut self) -> Result<(), Fault> {
        self.periods = self.periods.wrapping_add(1);
        Ok(())
    }

    fn time(&self) -> u32 {
        self.periods
    }
}

/// The parts of one board.
pub trait Parts {
    /// See [`Board::NAME`].
    const NAME: &'static str;
    /// See [`Board::PERIOD_US`].
    const PERIOD_US: u32;
    /// See [`Board::SLICE`].
    const SLICE: u32;
    /// See [`Board::carriers`].
    const CARRIERS: u16 = 0;
    /// Half bridge of motor lead +.
    type LegA: SetDutyCycle;
    /// Half bridge of motor lead −.
    type LegB: SetDutyCycle;
    /// Enables both half bridges.
    type Enable: OutputPin;
    /// Their fault output.
    type Fault: InputPin;
    /// How the bridge makes a duty: [`HalfBridges`](super::modulation::HalfBridges), or another rule of [`modulation`](super::modulation).
    type Modulation: Modulation;
    /// The link, mostly [`Link`](super::link::Link) over a serial port.
    type Port: Port;
    /// The encoder.
    type Position: Position;
    /// The carrier's turn.
    type Turn: Turn;
    /// The control period.
    type Tick: Tick;
    /// What it measures beside: [`NoSensors`](super::sensors::NoSensors), or the board's own.
    type Sensors: Sensors;
    /// What it keeps over a power cut: a [`FlashStore`](super::store::FlashStore), or [`NoStore`](super::store::NoStore).
    type Store: Store;
}

/// The bridge of a board's parts.
pub type BridgeOf<P> = HBridge<
    <P as Parts>::LegA,
    <P as Parts>::LegB,
    <P as Parts>::Enable,
    <P as Parts>::Fault,
    <P as Parts>::Modulation,
>;

/// A board that is put together of parts.
pub struct Generic<P: Parts> {
    /// The bridge, open.
    pub bridge: BridgeOf<P>,
    /// The link.
    pub link: P::Port,
    /// The encoder.
    pub position: P::Position,
    /// The carrier's turn.
    pub turn: P::Turn,
    /// The control period.
    pub tick: P::Tick,
    /// What it measures beside.
    pub sensors: P::Sensors,
    /// What it keeps over a power cut.
    pub store: P::Store,
    /// Noise of the board's.
    pub entropy: Entropy,
    /// What made it start.
    pub reset: Reset,
}

impl<P: Parts> Board for Generic<P> {
    const NAME: &'static str = P::NAME;
    const PERIOD_US: u32 = P::PERIOD_US;
    const SLICE: u32 = P::SLICE;
    const SENSES_CURRENT: bool = P::Sensors::CURRENT;
    const CURRENT_LIMIT_MA: u32 = P::Sensors::CURRENT_LIMIT_MA;
    const CURRENT_RESOLUTION_MA: u16 = P::Sensors::CURRENT_RESOLUTION_MA;
    const SAVES: bool = P::Store::KEEPS;

    fn drive(&mut self, duty: i16) {
        self.bridge.drive(duty);
    }

    fn carriers(&self) -> u16 {
        P::CARRIERS
    }

    fn full(&self) -> u16 {
        self.bridge.legs().full_duty()
    }

    fn nearest(&self, duty: i16) -> i16 {
        self.bridge.legs().nearest(duty)
    }

    fn coast(&mut self) {
        self.bridge.open();
    }

    fn count(&mut self) -> i32 {
        self.turn.wait();
        self.bridge.close();
        self.position.count()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        self.tick.end()?;
        self.turn.begin();
        if self.bridge.tripped() {
            return Err(Fault::Bridge);
        }
        if self.bridge.is_closed() && self.position.failed() {
            return Err(Fault::Encoder);
        }
        if self.bridge.is_closed() && self.sensors.is_hot() {
            return Err(Fault::BridgeHot);
        }
        Ok(())
    }

    fn current_ma(&mut self) -> i32 {
        self.sensors.current_ma()
    }

    fn supply_mv(&mut self) -> Option<u16> {
        self.sensors.supply_mv()
    }

    fn encoder_latency_us(&self) -> u32 {
        self.position.latency_us()
    }

    fn receive(&mut self) -> Option<u8> {
        self.link.receive()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        self.link.send(bytes)
    }

    fn entropy(&mut self) -> u32 {
        self.entropy.draw(self.tick.time())
    }

    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        self.store.load(key, into)
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        self.tick.pause(LONGEST_SAVE_S);
        self.store.save(key, value)
    }

    fn reset(&self) -> Reset {
        self.reset
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::link::Link;
    use crate::board::modulation::HalfBridges;
    use crate::board::store::NoStore;
    use core::convert::Infallible;
    use core::future::{pending, ready};
    use embedded_hal_mock::eh1::MockError;
    use embedded_hal_mock::eh1::delay::{CheckedDelay, Transaction as Wait};
    use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
    use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Duty};
    use embedded_io_async::{Read, Write};
    use std::collections::VecDeque;

    /// Counts up to 1,000, and no HAL's duty cycle is all of it.
    const FULL: u16 = 1000;
    const MOST: u16 = 999;

    /// A serial port that takes three bytes and then waits.
    #[derive(Default)]
    struct Serial {
        received: VecDeque<u8>,
        sent: Vec<u8>,
    }

    impl embedded_io_async::ErrorType for Serial {
        type Error = Infallible;
    }

    impl Read for Serial {
        async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Infallible> {
            let Some(byte) = self.received.pop_front() else {
                return pending().await;
            };
            buffer[0] = byte;
            ready(Ok(1)).await
        }
    }

    impl Write for Serial {
        async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
            if self.sent.len() == 3 {
                return pending().await;
            }
            self.sent.push(bytes[0]);
            ready(Ok(1)).await
        }

        async fn flush(&mut self) -> Result<(), Infallible> {
            Ok(())
        }
    }

    struct Counter(i32);

    impl Position for Counter {
        fn count(&mut self) -> i32 {
            self.0 += 1;
            self.0
        }
    }

    struct Periods;

    impl Tick for Periods {
        fn end(&mut self) -> Result<(), Fault> {
            Ok(())
        }
        fn time(&self) -> u32 {
            7
        }
    }

    struct Bench;

    impl Parts for Bench {
        const NAME: &'static str = "bench";
        const PERIOD_US: u32 = 1000;
        const SLICE: u32 = 1;
        type LegA = Pwm;
        type LegB = Pwm;
        type Enable = Pin;
        type Fault = Pin;
        type Modulation = HalfBridges;
        type Port = Link<Serial>;
        type Position = Counter;
        type Turn = AfterDelay<CheckedDelay>;
        type Tick = Periods;
        type Sensors = Shunt;
        type Store = NoStore;
    }

    /// A shunt, a divider and a thermometer.
    struct Shunt {
        hot: bool,
    }

    impl Sensors for Shunt {
        const CURRENT: bool = true;
        const CURRENT_LIMIT_MA: u32 = 3_000;

        fn current_ma(&mut self) -> i32 {
            -1_200
        }

        fn supply_mv(&mut self) -> Option<u16> {
            Some(11_900)
        }

        fn is_hot(&mut self) -> bool {
            self.hot
        }
    }

    /// A board whose mocked parts expect exactly these calls, after the bridge was opened once.
    fn board(a: &[Duty], b: &[Duty], enable: &[Level], fault: &[Level]) -> Generic<Bench> {
        let leg = |duties: &[Duty]| {
            let opened = [Duty::max_duty_cycle(MOST), Duty::set_duty_cycle(500)];
            Pwm::new(opened.iter().chain(duties))
        };
        let enable = [Level::set(State::Low)]
            .into_iter()
            .chain(enable.iter().cloned())
            .collect::<Vec<_>>();
        let bridge = HBridge::new(leg(a), leg(b), Pin::new(&enable), Pin::new(fault), FULL);
        Generic {
            bridge,
            link: Link::new(Serial::default()),
            position: Counter(0),
            turn: AfterDelay {
                delay: CheckedDelay::new(&[]),
                ns: 30_000,
            },
            tick: Periods,
            sensors: Shunt { hot: false },
            store: NoStore,
            entropy: Entropy::default(),
            reset: Reset::Unknown,
        }
    }

    fn ended(mut board: Generic<Bench>) {
        board.bridge.a.done();
        board.bridge.b.done();
        board.bridge.enable.done();
        board.bridge.fault.done();
        board.turn.delay.done();
    }

    #[test]
    fn the_bridge_closes_where_the_duty_acts_and_opens_at_once() {
        let duty = Duty::set_duty_cycle;
        let mut board = board(
            &[duty(625), duty(500)],
            &[duty(375), duty(500)],
            &[Level::set(State::High), Level::set(State::Low)],
            &[Level::get(State::High)],
        );
        assert_eq!(board.full(), 32_000);
        board
            .turn
            .delay
            .update_expectations(&[Wait::delay_ns(30_000), Wait::delay_ns(30_000)]);
        board.drive(8_000);
        assert!(!board.bridge.is_closed());
        assert_eq!(board.count(), 1);
        assert!(board.bridge.is_closed());
        assert_eq!(board.tick(), Ok(()));
        assert_eq!(board.count(), 2);
        board.coast();
        // Open, the fault line is not asked.
        assert_eq!(board.tick(), Ok(()));
        ended(board);
    }

    #[test]
    fn the_largest_duty_leaves_a_leg_what_its_hal_cannot_reach() {
        let duty = Duty::set_duty_cycle;
        let mut board = board(&[duty(MOST), duty(0)], &[duty(0), duty(MOST)], &[], &[]);
        assert_eq!(board.nearest(i16::MAX), 999 * 32);
        board.drive(i16::MAX);
        board.drive(i16::MIN);
        ended(board);
    }

    #[test]
    fn a_fault_of_the_bridge_or_of_a_part_is_seen_while_it_drives() {
        let duty = Duty::set_duty_cycle;
        let failed = duty(500).with_error(MockError::Io(std::io::ErrorKind::Other));
        let mut board = board(
            &[duty(500), failed],
            &[duty(500), duty(500)],
            &[Level::set(State::High)],
            &[Level::get(State::Low), Level::get(State::High)],
        );
        board
            .turn
            .delay
            .update_expectations(&[Wait::delay_ns(30_000)]);
        board.drive(0);
        board.count();
        assert_eq!(board.tick(), Err(Fault::Bridge));
        assert_eq!(board.tick(), Ok(()));
        board.drive(0);
        assert_eq!(board.tick(), Err(Fault::Bridge));
        ended(board);
    }

    #[test]
    fn what_its_sensors_measure_is_the_board_s_and_heat_is_a_fault_while_it_drives() {
        let duty = Duty::set_duty_cycle;
        let mut board = board(
            &[duty(500)],
            &[duty(500)],
            &[Level::set(State::High)],
            &[Level::get(State::High)],
        );
        board
            .turn
            .delay
            .update_expectations(&[Wait::delay_ns(30_000)]);
        const {
            assert!(Generic::<Bench>::SENSES_CURRENT && Generic::<Bench>::CURRENT_LIMIT_MA == 3_000)
        };
        assert_eq!(
            (board.current_ma(), board.supply_mv()),
            (-1_200, Some(11_900))
        );
        board.sensors.hot = true;
        assert_eq!(board.tick(), Ok(()));
        board.drive(0);
        board.count();
        assert_eq!(board.tick(), Err(Fault::BridgeHot));
        ended(board);
    }

    #[test]
    fn the_link_never_waits() {
        let mut board = board(&[], &[], &[], &[]);
        assert_eq!(board.receive(), None);
        assert_eq!(board.send(b"hello"), 3);
        assert_eq!(board.send(b"lo"), 0);
        ended(board);
    }
}
