//! The application without hardware: in QEMU on a microcontroller's instructions, or natively on the PC.
//!
//! On the PC: `emulated LINK PLANT`, two addresses, the first to listen at and the second to connect to.
//! `servoid device emulate` starts either.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let board = firmware::board::qemu::Qemu::start();
    let mut app = firmware::app::App::new(board, MEMORY.take(), RECORDING.take());
    loop {
        app.period();
    }
}

#[cfg(target_os = "none")]
static MEMORY: static_cell::ConstStaticCell<firmware::app::Memory<f32>> =
    static_cell::ConstStaticCell::new(firmware::app::Memory::new());
#[cfg(target_os = "none")]
static RECORDING: static_cell::ConstStaticCell<firmware::app::Recording<2000>> =
    static_cell::ConstStaticCell::new(firmware::app::Recording::new());

#[cfg(not(target_os = "none"))]
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [link, plant] = arguments.as_slice() else {
        eprintln!(
            "usage: emulated LINK PLANT (addresses such as 127.0.0.1:4000); `servoid device emulate` starts it"
        );
        std::process::exit(2);
    };
    let board = firmware::board::pc::Pc::start(link, plant).unwrap_or_else(|error| {
        eprintln!("emulated: {link}, {plant}: {error}");
        std::process::exit(1);
    });
    let mut memory = firmware::app::Memory::<f32>::new();
    let mut recording = firmware::app::Recording::<2000>::new();
    let mut app = firmware::app::App::new(board, &mut memory, &mut recording);
    while !app.board().is_gone() {
        app.period();
    }
}
