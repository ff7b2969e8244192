//! Boots an unmodified image of the Pico 2 and closes the loop around it: its PWM drives a motor, the motor's encoder turns the lines
//! that its state machine watches, its serial port is a TCP socket. See README.md beside this crate.

mod bus;
mod carrier;
mod chip;
mod decode;
mod rom;
mod uart;
mod watchdog;

use std::f64::consts::TAU;
use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use clap::Parser;
use elf::ElfBytes;
use elf::abi::PT_LOAD;
use elf::endian::LittleEndian;
use servoid_rigless::plant::{Motor, State, Terminal};
use servoid_rigless::switch::PowerSwitch;

use crate::chip::{Chip, HZ, Stop};

/// Runs an unmodified image of the Pico 2 against a motor of ten watts.
#[derive(Debug, Parser)]
struct Cli {
    /// The image, an ELF file.
    image: PathBuf,
    /// TCP port on the loopback interface that is the board's serial port; 0 for any free one, which is printed.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Virtual time after which the run ends, s.
    #[arg(long = "for", value_name = "SECONDS", default_value_t = 3600.0)]
    duration: f64,
    /// Counts of the encoder in a revolution.
    #[arg(long, default_value_t = 2000)]
    counts_per_rev: u32,
    /// Swaps the lines of the encoder.
    #[arg(long)]
    encoder_reversed: bool,
    /// The bridge reports a fault from then on, s.
    #[arg(long, value_name = "SECONDS", default_value_t = f64::INFINITY)]
    bridge_fault_at: f64,
    /// The program does not come back from then on, s.
    #[arg(long, value_name = "SECONDS", default_value_t = f64::INFINITY)]
    wedged_at: f64,
}

/// Ten watts at 12 V.
const MOTOR: Motor = Motor {
    resistance: 2.4,
    inductance: 0.6e-3,
    torque_constant: 0.017,
    back_emf: 0.017,
    inertia: 3.2e-6,
    viscous: 1e-6,
    coulomb: 6e-4,
    holding: 6e-4,
};
const SUPPLY: f64 = 12.0;
const FLASH: u64 = 0x1000_0000;
/// Virtual time between two looks at the socket and the clock on the wall, cycles.
const LOOK: u64 = 300_000;

/// The motor around the chip.
struct Bench {
    cli: Cli,
    chip: Chip,
    motor: State,
    /// The count that the encoder's lines show.
    shown: i64,
    /// When the motor was last moved, cycles.
    last: u64,
}

impl Bench {
    fn run(&mut self, end: u64) {
        loop {
            match self.chip.run(end) {
                Stop::Turn => {
                    self.advance();
                    self.chip.own.carrier.turn();
                }
                Stop::Reset => {
                    self.advance();
                    println!("restarted at {:.4} s", self.chip.now as f64 / HZ);
                }
                Stop::Time => return,
            }
        }
    }

    /// Moves the motor to this instant, under what has acted until now, and shows where it is.
    fn advance(&mut self) {
        let [before, now] = [self.last, self.chip.now].map(|cycles| cycles as f64 / HZ);
        let terminal = match self.chip.duty() {
            Some(duty) => Terminal::Driven(duty * SUPPLY),
            None => Terminal::Open(SUPPLY),
        };
        self.motor.advance(&MOTOR, terminal, false, now - before);
        let count = (self.motor.angle / TAU * f64::from(self.cli.counts_per_rev)).floor() as i64;
        while self.shown != count {
            self.shown += (count - self.shown).signum();
            self.chip.encoder(self.lines());
        }
        self.chip.fault(now > self.cli.bridge_fault_at);
        self.chip.wedged |= before <= self.cli.wedged_at && self.cli.wedged_at < now;
        self.last = self.chip.now;
    }

    fn lines(&self) -> [bool; 2] {
        let [a, b] = match self.shown.rem_euclid(4) {
            0 => [false, false],
            1 => [true, false],
            2 => [true, true],
            _ => [false, true],
        };
        if self.cli.encoder_reversed {
            [b, a]
        } else {
            [a, b]
        }
    }
}

/// What the file loads into the flash.
fn flash(path: &PathBuf) -> Result<Vec<u8>> {
    let file = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let image = ElfBytes::<LittleEndian>::minimal_parse(&file)?;
    let mut flash = Vec::new();
    for segment in image.segments().context("it loads nothing")? {
        let bytes = image.segment_data(&segment)?;
        if segment.p_type == PT_LOAD && !bytes.is_empty() {
            ensure!(
                segment.p_paddr >= FLASH,
                "it loads something below the flash"
            );
            let at = (segment.p_paddr - FLASH) as usize;
            flash.resize(flash.len().max(at + bytes.len()), 0xff);
            flash[at..at + bytes.len()].copy_from_slice(bytes);
        }
    }
    ensure!(flash.len() > 8, "it loads nothing into the flash");
    Ok(flash)
}

/// Carries bytes between the line and whoever is connected, one at a time; nobody waits.
fn talk(listener: &TcpListener, peer: &mut Option<TcpStream>, chip: &mut Chip) -> Result<()> {
    if let Ok((stream, _)) = listener.accept() {
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        *peer = Some(stream);
    }
    let sent = std::mem::take(&mut chip.own.uart.from_chip);
    if let Some(stream) = peer {
        let mut buffer = [0; 4096];
        let gone = match stream.read(&mut buffer) {
            Ok(0) => true,
            Ok(count) => {
                chip.own.uart.to_chip.extend(&buffer[..count]);
                false
            }
            Err(error) => error.kind() != ErrorKind::WouldBlock,
        };
        if gone || stream.write_all(&sent).is_err() {
            *peer = None;
        }
    }
    Ok(())
}

fn main() -> Result<()> {
    let cli = Cli::parse();
    let flash = flash(&cli.image).context("not an image for a Pico 2")?;
    let listener = TcpListener::bind(("127.0.0.1", cli.port))?;
    listener.set_nonblocking(true)?;
    println!("link: {}", listener.local_addr()?);
    let end = (cli.duration * HZ) as u64;
    let mut bench = Bench {
        cli,
        chip: Chip::new(flash),
        motor: State::default(),
        shown: 0,
        last: 0,
    };
    bench.chip.encoder(bench.lines());
    let switch = PowerSwitch::watch();
    let mut peer = None;
    let started = Instant::now();
    while bench.chip.now < end {
        bench.run(bench.chip.now + LOOK);
        if switch.was_cut() {
            bench.chip.cut_power();
            bench.advance();
            println!("restarted at {:.4} s", bench.chip.now as f64 / HZ);
        }
        talk(&listener, &mut peer, &mut bench.chip)?;
        // No faster than the clock on the wall: a host waits in real time.
        let due = Duration::from_secs_f64(bench.chip.now as f64 / HZ);
        thread::sleep(due.saturating_sub(started.elapsed()));
    }
    println!(
        "virtual time {:.3} s in {:.3} s",
        end as f64 / HZ,
        started.elapsed().as_secs_f64()
    );
    Ok(())
}
