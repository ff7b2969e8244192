//! Prints what the device's arithmetic costs in instructions, see `firmware::count`. In QEMU with `-icount shift=0` and its
//! mps2 machines only, where an instruction takes a nanosecond and a tick of the system timer forty; `scripts/instructions`
//! runs it.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod counter {
    use cortex_m::peripheral::SYST;
    use cortex_m::peripheral::syst::SystClkSource;

    /// Instructions in a tick of the timer.
    pub const TICK: u32 = 40;
    /// Ticks after which the timer begins anew.
    const LAP: u32 = 1 << 24;

    /// Counts with the system timer.
    pub struct Counter(SYST);

    impl Counter {
        pub fn new(mut timer: SYST) -> Self {
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload(LAP - 1);
            timer.clear_current();
            timer.enable_counter();
            Counter(timer)
        }

        /// Instructions that `work` takes, to a tick; it must take less than a lap.
        pub fn count(&mut self, work: &mut dyn FnMut()) -> u32 {
            self.0.clear_current();
            let _ = self.0.has_wrapped();
            let before = SYST::get_current();
            work();
            let after = SYST::get_current();
            before.wrapping_sub(after) % LAP * TICK
        }
    }
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use core::fmt::Write;
    let timer = cortex_m::Peripherals::take().map(|p| p.SYST);
    let run = || {
        let mut counter = counter::Counter::new(timer?);
        let mut out = cortex_m_semihosting::hio::hstdout().ok()?;
        // Two instructions a round: what must come out, or the emulator does not count as we think.
        let known = counter.count(&mut || cortex_m::asm::delay(500_000));
        writeln!(out, "a-million {known}").ok()?;
        #[cfg(target_abi = "eabihf")]
        {
            let count = |work: &mut dyn FnMut()| counter.count(work);
            firmware::count::count::<f32>(&mut out, count, true).ok()
        }
        #[cfg(not(target_abi = "eabihf"))]
        {
            let count = |work: &mut dyn FnMut()| counter.count(work);
            firmware::count::count::<shared::scalar::Fixed>(&mut out, count, false).ok()
        }
    };
    firmware::emulator::end(run().is_some())
}

/// There is nothing to count on a PC.
#[cfg(not(target_os = "none"))]
fn main() {}
