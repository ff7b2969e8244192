//! The application on a Nucleo-F446RE; see `firmware::board::stm32f446` for what is connected where.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let board = firmware::board::stm32f446::Stm32f446::start();
    let mut app = firmware::app::App::new(board, MEMORY.take(), LOG.take());
    loop {
        app.period();
    }
}

#[cfg(target_os = "none")]
static MEMORY: static_cell::ConstStaticCell<firmware::app::Memory<f32>> =
    static_cell::ConstStaticCell::new(firmware::app::Memory::new());
#[cfg(target_os = "none")]
static LOG: static_cell::ConstStaticCell<firmware::app::Log<2000>> =
    static_cell::ConstStaticCell::new(firmware::app::Log::new());

/// There is nothing to run on a PC: `scripts/boards` builds the image.
#[cfg(not(target_os = "none"))]
fn main() {}
