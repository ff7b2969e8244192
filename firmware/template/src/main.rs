//! Self-commissioning as a task of your own firmware, beside your other tasks, on an embassy executor.
#![no_std]
#![no_main]

mod your_board;

use embassy_executor::Spawner;
use embassy_time::{Duration, Ticker, Timer};
use firmware::app::{App, Memory, Recording};
use firmware::board::generic::{Generic, Parts};
use shared::scalar::Fixed;
use static_cell::ConstStaticCell;
use your_board::Yours;

static MEMORY: ConstStaticCell<Memory<Fixed>> = ConstStaticCell::new(Memory::new());
static RECORDING: ConstStaticCell<Recording<1000>> = ConstStaticCell::new(Recording::new());

/// A control period at a time. Nothing may keep the executor for longer than a fraction of one: put this on an executor of higher
/// priority (`InterruptExecutor`) if your other tasks do.
#[embassy_executor::task]
async fn commission(board: Generic<Yours>) {
    let mut app = App::new(board, MEMORY.take(), RECORDING.take());
    let mut ticker = Ticker::every(Duration::from_micros(Yours::PERIOD_US.into()));
    loop {
        ticker.next().await;
        app.period();
    }
}

/// Whatever else your firmware does.
#[embassy_executor::task]
async fn yours() {
    loop {
        Timer::after_millis(500).await;
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let board = your_board::start();
    if let (Ok(commission), Ok(yours)) = (commission(board), yours()) {
        spawner.spawn(commission);
        spawner.spawn(yours);
    }
}
