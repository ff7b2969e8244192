//! The board around the microcontroller: its pins, read and driven through the emulator's models of the peripherals.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::chip::uart::TcpPeer;
use rigless::device::{Device, Level};
use rigless::machine::{Board, Crystal, Target, armv7m};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::st::tim::Channel;
use rigless::soc::stm32f427::Stm32f427;
use rigless::soc::stm32f427::generated::tim1;
use rigless::soc::stm32f427::peripherals::adc;
use rigless::soc::stm32f427::peripherals::gpio::{Gpio, Pin};
use rigless::soc::stm32f427::peripherals::rcc::Apb;
use rigless::time::VirtualNanos;

use crate::wiring::{FaultLine, PinAt, Sensing, Wiring};

const TIM1: usize = 0;
const ADC1: usize = 0;

/// The board.
#[derive(Debug)]
pub struct Rig {
    mcu: Stm32f427,
    wiring: Wiring,
    carrier: Carrier,
}

/// A centred carrier: a new compare value acts when it next turns round.
#[derive(Debug, Default)]
struct Carrier {
    falls: bool,
    /// Of the legs, as they act.
    compares: [u64; 2],
}

rigless::snapshot::store!(Rig {
    values: [],
    parts: [mcu],
    built: [wiring, carrier]
});

impl Rig {
    /// The board, out of reset, its serial port connected to `link`.
    pub fn new(wiring: Wiring, link: TcpPeer) -> Result<Self, rigless::soc::Error> {
        let mut mcu = Stm32f427::new()?;
        mcu.rcc.attach_crystals(wiring.crystal_hz, Crystal::NONE.0);
        mcu.set_supply(3300);
        mcu.usart[wiring.serial_port].attach(link);
        Ok(Self {
            mcu,
            wiring,
            carrier: Carrier::default(),
        })
    }

    /// Applies new compare values if the carrier has turned since the last call; returns the time until its next
    /// turn.
    pub fn take_over(&mut self, at: VirtualNanos) -> VirtualNanos {
        let (clocks, registers) = self.mcu.clocks();
        let clock = clocks.timer_clock(registers, Apb::Two).max(1);
        let (timer, registers) = self.mcu.advanced_timer(TIM1);
        let control = registers.get(tim1::Register::Cr1);
        let (centred, falls) = (control >> 5 & 3 != 0, control >> 4 & 1 == 1);
        if !centred || falls != self.carrier.falls {
            let legs = [tim1::Register::Ccr1, tim1::Register::Ccr2];
            self.carrier = Carrier {
                falls,
                compares: legs.map(|leg| registers.get(leg)),
            };
        }
        let top = registers.get(tim1::Register::Arr);
        let count = timer.peek(tim1::Register::Cnt, registers, at).unwrap_or(0);
        let left = if falls {
            count
        } else {
            top.saturating_sub(count)
        };
        // At least one, or a stop at the turn itself would be followed by another.
        VirtualNanos(((left + 1) * 1_000_000_000).div_ceil(clock))
    }

    /// The part of the supply that the firmware puts across the winding, or `None` while the bridge is open: the
    /// timer's outputs off, a pin not in the timer's hands, or the driver not enabled.
    pub fn duty(&mut self) -> Option<f64> {
        let (_, timer) = self.mcu.advanced_timer(TIM1);
        let outputs_on = timer.get(tim1::Register::Bdtr) >> 15 & 1 == 1;
        let channels_on = timer.get(tim1::Register::Ccer) & 0x55 == 0x55;
        let running = timer.get(tim1::Register::Cr1) & 1 == 1;
        if !(outputs_on && channels_on && running) {
            return None;
        }
        let centred = timer.get(tim1::Register::Cr1) >> 5 & 3 != 0;
        let steps = timer.get(tim1::Register::Arr) + u64::from(!centred);
        let [a, b] = self.carrier.compares.map(|c| c.min(steps) as f64);
        let duty = (a - b) / steps as f64;
        let enabled = self.level(self.wiring.enable) == Level::High;
        (enabled && self.connected(self.wiring.legs)).then_some(duty)
    }

    /// Sets the encoder's lines A and B.
    pub fn drive_encoder(&mut self, at: VirtualNanos, lines: [bool; 2]) {
        if !self.connected(self.wiring.encoder) {
            return;
        }
        for (number, level) in [(1, lines[0]), (2, lines[1])] {
            let channel = Channel::new(number).expect("a timer has four channels");
            let timer = self.wiring.encoder_timer;
            self.mcu
                .drive_timer(at, timer, |timer, registers, context| {
                    timer.drive_input(channel, Level::from(level), registers, context);
                });
        }
    }

    /// Sets the fault output of the bridge's driver.
    pub fn drive_fault(&mut self, at: VirtualNanos, fault: bool) {
        let level = Level::from(!fault);
        match self.wiring.fault {
            FaultLine::Break(_) => {
                self.mcu
                    .drive_advanced_timer(at, TIM1, |timer, registers, context| {
                        timer.drive_break(level, registers, context);
                    })
            }
            FaultLine::Read(line) => {
                self.mcu
                    .drive_port(at, line.port, |port, registers, context| {
                        port.drive(number(line), Some(level), registers, context);
                    })
            }
        }
    }

    /// Stops the crystal. The emulator tells the clock security system, if that watches, and nobody else.
    pub fn stop_crystal(&mut self, at: VirtualNanos) {
        self.mcu.drive_clocks(at, |clocks, registers, context| {
            clocks.fail_hse(registers, context);
        });
    }

    /// Sets what the board's sensors show of an armature current and of a supply voltage, clipped to their ranges.
    pub fn sense(&mut self, amperes: f64, supply: f64) {
        match self.wiring.sensing {
            Sensing::Nothing => {}
            Sensing::Armature(channel) => self.show(channel, 1650.0 + 100.0 * amperes),
            Sensing::Legs {
                shunts: [a, b],
                supply: channel,
                thermistor,
            } => {
                self.show(a, 1650.0 + 10.0 * amperes);
                self.show(b, 1650.0 - 10.0 * amperes);
                self.show(channel, supply * 1000.0 * 22.0 / 412.0);
                self.show(thermistor, 1650.0);
            }
        }
    }

    fn show(&mut self, channel: u8, millivolts: f64) {
        let channel = adc::Channel::new(channel).expect("an input on a pin");
        let millivolts = millivolts.clamp(0.0, 3300.0);
        self.mcu.adc[ADC1].set_input(channel, millivolts.round() as u32);
    }

    /// Pins that the firmware has not connected to the peripheral that the board needs there.
    pub fn unconnected(&mut self) -> Vec<String> {
        let w = self.wiring;
        let mut pins = [&w.legs[..], &w.encoder, &w.link].concat();
        if let FaultLine::Break(pin) = w.fault {
            pins.push(pin);
        }
        pins.retain(|&pin| !self.connected([pin]));
        let name = |pin: PinAt| format!("P{}{}", char::from(b'A' + pin.port as u8), pin.pin);
        pins.into_iter().map(name).collect()
    }

    fn connected<const N: usize>(&mut self, pins: [PinAt; N]) -> bool {
        pins.into_iter().all(|pin| {
            let (_, registers) = self.mcu.port(pin.port);
            Gpio::function(number(pin), registers) == Some(pin.function)
        })
    }

    fn level(&mut self, pin: PinAt) -> Level {
        let (port, registers) = self.mcu.port(pin.port);
        port.level(number(pin), registers)
    }
}

fn number(pin: PinAt) -> Pin {
    Pin::new(pin.pin).expect("a port has sixteen pins")
}

impl Board for Rig {
    fn name(&self) -> &'static str {
        "servoid"
    }

    fn target_names(&self) -> Vec<&'static str> {
        vec!["stm32f427"]
    }

    fn mcu(&mut self, target: usize) -> Option<&mut dyn Mcu> {
        (target == 0).then_some(&mut self.mcu)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let lines = u32::from(Operate::cpu(&self.mcu).interrupt_lines);
        let core = armv7m::Core {
            variant: armv7m::Variant::M4,
            clock_hz: NonZeroU64::new(self.wiring.core_hz).expect("it runs"),
            interrupt_lines: NonZeroU32::new(lines).expect("it has interrupts"),
            priority_bits: 4,
            refclk_divider: NonZeroU32::new(8).expect("not zero"),
            instructions_per_second: NonZeroU64::new(self.wiring.core_hz / CYCLES_PER_INSTRUCTION)
                .expect("it runs"),
            boot: "flash",
        }
        .spec_with_parts(
            &rigless::cpu::armv7m::windows(Mcu::bus(&self.mcu)),
            armv7m::Fpu::FpV4Sp,
            armv7m::MpuRegions::Eight,
        );
        vec![Target::new("stm32f427", &mut self.mcu, core)]
    }
}

/// What an M4 takes of mixed code from flash. The emulator counts no cycles; faster code on the real part only gets more done.
const CYCLES_PER_INSTRUCTION: u64 = 2;
