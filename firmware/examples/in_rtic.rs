//! Self-commissioning as a task of your own RTIC firmware: bound to the timer that is the control period.
//!
//! `scripts/mcu build -p firmware --features rp2040-parts --example in_rtic --target thumbv6m-none-eabi`
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../template/src/your_board.rs"]
mod your_board;

#[cfg(target_os = "none")]
#[rtic::app(device = embassy_rp::pac, peripherals = false)]
mod image {
    use crate::your_board::{self, Yours};
    use cortex_m::peripheral::syst::SystClkSource;
    use firmware::app::{App, Memory, Recording};
    use firmware::board::generic::Generic;
    use shared::scalar::Fixed;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        app: App<'static, Generic<Yours>, Fixed, 1000>,
    }

    #[init(local = [memory: Memory<Fixed> = Memory::new(), recording: Recording<1000> = Recording::new()])]
    fn init(mut cx: init::Context) -> (Shared, Local) {
        let app = App::new(your_board::start(), cx.local.memory, cx.local.recording);
        cx.core.SYST.set_clock_source(SystClkSource::Core);
        cx.core.SYST.set_reload(125_000 - 1);
        cx.core.SYST.clear_current();
        cx.core.SYST.enable_interrupt();
        cx.core.SYST.enable_counter();
        (Shared {}, Local { app })
    }

    /// A control period. Give it the highest priority but for what must not wait for it.
    #[task(binds = SysTick, local = [app], priority = 2)]
    fn period(cx: period::Context) {
        cx.local.app.period();
    }
}

/// There is nothing to run on a PC.
#[cfg(not(target_os = "none"))]
fn main() {}
