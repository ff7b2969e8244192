//! From whatever ran before to 125 MHz off the Pico's crystal of 12 MHz, with the peripherals that the board uses as after power-up.

use rp_pac::clocks::vals::{ClkPeriCtrlAuxsrc, ClkRefCtrlSrc, ClkSysCtrlAuxsrc, ClkSysCtrlSrc};
use rp_pac::resets::regs::Peripherals;
use rp_pac::xosc::vals::{CtrlFreqRange, Enable};
use rp_pac::{CLOCKS, PLL_SYS, RESETS, XOSC};

/// Core clock.
pub const CORE_HZ: u32 = 125_000_000;

/// Every peripheral.
const ALL: u32 = 0x01ff_ffff;
/// Time for the crystal to start, in 256 of its periods: 128 ms, for slow ones.
const START_UP: u16 = 6000;

/// Sets the clocks, and releases what the board uses.
pub fn start() {
    // The flash runs this program, and the loops must stay where they are for as long as they may clock the core. What
    // went on before a reset of the core goes on after it: channels of the DMA, say.
    let mut kept = Peripherals(0);
    kept.set_io_qspi(true);
    kept.set_pads_qspi(true);
    kept.set_pll_sys(true);
    kept.set_pll_usb(true);
    kept.set_usbctrl(true);
    kept.set_syscfg(true);
    RESETS.reset().write_value(Peripherals(ALL & !kept.0));

    // Away from the loop, to the oscillator that always runs.
    CLOCKS.clk_sys_resus_ctrl().write(|_| {});
    CLOCKS
        .clk_sys_ctrl()
        .modify(|w| w.set_src(ClkSysCtrlSrc::CLK_REF));
    while CLOCKS.clk_sys_selected().read() != 1 << ClkSysCtrlSrc::CLK_REF as u32 {}
    reference(ClkRefCtrlSrc::ROSC_CLKSRC_PH);

    XOSC.startup().write(|w| w.set_delay(START_UP));
    XOSC.ctrl().write(|w| {
        w.set_freq_range(CtrlFreqRange::_1_15MHZ);
        w.set_enable(Enable::ENABLE);
    });
    while !XOSC.status().read().stable() {}

    // 12 MHz · 125 / (6 · 2).
    let mut pll = Peripherals(0);
    pll.set_pll_sys(true);
    RESETS.reset().modify(|w| w.set_pll_sys(true));
    release(pll);
    PLL_SYS.cs().write(|w| w.set_refdiv(1));
    PLL_SYS.fbdiv_int().write(|w| w.set_fbdiv_int(125));
    PLL_SYS.pwr().write(|w| {
        w.set_dsmpd(true);
        w.set_postdivpd(true);
    });
    while !PLL_SYS.cs().read().lock() {}
    PLL_SYS.prim().write(|w| {
        w.set_postdiv1(6);
        w.set_postdiv2(2);
    });
    PLL_SYS.pwr().write(|w| w.set_dsmpd(true));

    reference(ClkRefCtrlSrc::XOSC_CLKSRC);
    // The source first, and then over to it.
    CLOCKS
        .clk_sys_ctrl()
        .write(|w| w.set_auxsrc(ClkSysCtrlAuxsrc::CLKSRC_PLL_SYS));
    CLOCKS.clk_sys_ctrl().write(|w| {
        w.set_auxsrc(ClkSysCtrlAuxsrc::CLKSRC_PLL_SYS);
        w.set_src(ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX);
    });
    while CLOCKS.clk_sys_selected().read() != 1 << ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX as u32 {}
    CLOCKS.clk_peri_ctrl().write(|w| {
        w.set_enable(true);
        w.set_auxsrc(ClkPeriCtrlAuxsrc::CLK_SYS);
    });

    let mut used = Peripherals(0);
    used.set_dma(true);
    used.set_io_bank0(true);
    used.set_pads_bank0(true);
    used.set_pio0(true);
    used.set_pwm(true);
    used.set_uart0(true);
    release(used);
}

/// Switches the reference clock over.
fn reference(source: ClkRefCtrlSrc) {
    CLOCKS.clk_ref_ctrl().write(|w| w.set_src(source));
    while CLOCKS.clk_ref_selected().read() != 1 << source as u32 {}
}

/// Takes peripherals out of their reset, and waits until they are.
fn release(peripherals: Peripherals) {
    RESETS
        .reset()
        .modify(|w| *w = Peripherals(w.0 & !peripherals.0));
    while !RESETS.reset_done().read().0 & peripherals.0 != 0 {}
}
