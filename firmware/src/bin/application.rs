//! The application on whatever board the build was told of: see `firmware::board` for what is connected where.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use firmware::app::{App, Memory, Recording};
    use firmware::board::{Board, CAPACITY, Fitted, Number};
    use firmware::log;
    use static_cell::ConstStaticCell;

    static MEMORY: ConstStaticCell<Memory<Number>> = ConstStaticCell::new(Memory::new());
    static RECORDING: ConstStaticCell<Recording<CAPACITY>> = ConstStaticCell::new(Recording::new());

    #[cfg_attr(feature = "esp32c6", esp_hal::main)]
    #[cfg_attr(not(feature = "esp32c6"), cortex_m_rt::entry)]
    fn main() -> ! {
        let board = Fitted::start();
        log::woke(board.reset());
        let mut app = App::new(board, MEMORY.take(), RECORDING.take());
        loop {
            app.period();
        }
    }
}

/// There is nothing to run on a PC: `scripts/boards` builds the image.
#[cfg(not(target_os = "none"))]
fn main() {}
