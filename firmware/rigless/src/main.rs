//! Boots an unmodified STM32F427 image and closes the loop around it: its PWM drives a motor, the motor's encoder turns
//! its timer, its serial port is a TCP socket. See README.md beside this crate.

mod bench;
mod faults;
mod rig;
mod stack;
mod unkind;
mod wiring;

use std::error::Error;
use std::fs::File;
use std::path::PathBuf;

use clap::Parser;
use rigless::chip::uart::TcpPeer;
use rigless::emulator::{self, Start};
use rigless::image::Image;
use rigless::session::Session;
use rigless::time::VirtualNanos;
use servoid_rigless::plant::Motor;

use bench::{Bench, Settings};
use rig::Rig;
use wiring::Model;

/// Runs an unmodified STM32F427 image against a motor.
#[derive(Debug, Parser)]
struct Cli {
    /// The image, an ELF file.
    image: PathBuf,
    /// The board that it is for.
    #[arg(long, value_enum, default_value_t = Model::Stm32f427)]
    board: Model,
    /// TCP port on the loopback interface that is the board's serial port; 0 for any free one, which is printed.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Virtual time after which the run ends, s.
    #[arg(long = "for", value_name = "SECONDS", default_value_t = 3600.0)]
    duration: f64,
    /// Virtual seconds that may pass in a second; 0 for as fast as it goes. A host that talks to the image waits in real
    /// time, so that a run faster than that would look like a host that has fallen silent.
    #[arg(long, default_value_t = 1.0)]
    pace: f64,
    /// Time between two looks at the bridge and two moves of the encoder, µs.
    #[arg(long, value_name = "MICROSECONDS", default_value_t = 50)]
    step_us: u64,
    /// Counts the stack that the image has used by the end.
    #[arg(long)]
    stack: bool,
    /// Writes the motor's trajectory to this CSV file, a line a millisecond.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    #[command(flatten)]
    bench: BenchFlags,
    #[command(flatten)]
    unkind: unkind::Unkind,
    #[command(flatten)]
    faults: faults::Faults,
}

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Motor")]
struct BenchFlags {
    /// Supply, V.
    #[arg(long, default_value_t = 24.0)]
    supply: f64,
    /// Armature resistance, Ω.
    #[arg(long, default_value_t = 1.2)]
    resistance: f64,
    /// Armature inductance, H.
    #[arg(long, default_value_t = 0.5e-3)]
    inductance: f64,
    /// Torque constant, N·m/A.
    #[arg(long, default_value_t = 0.06)]
    torque_constant: f64,
    /// Back-EMF constant, V·s/rad; the torque constant unless given.
    #[arg(long)]
    back_emf: Option<f64>,
    /// Inertia, kg·m².
    #[arg(long, default_value_t = 6.2e-5)]
    inertia: f64,
    /// Viscous friction, N·m·s/rad.
    #[arg(long, default_value_t = 2.0e-5)]
    viscous: f64,
    /// Dry friction while the rotor turns, N·m.
    #[arg(long, default_value_t = 5.0e-3)]
    coulomb: f64,
    /// Dry friction that holds it at rest, N·m; that while it turns unless given.
    #[arg(long)]
    holding: Option<f64>,
    /// Counts of the encoder in a revolution.
    #[arg(long, default_value_t = 4096)]
    counts_per_rev: u32,
}

impl Cli {
    fn settings(&self) -> Settings {
        let flags = &self.bench;
        Settings {
            motor: Motor {
                resistance: flags.resistance,
                inductance: flags.inductance,
                torque_constant: flags.torque_constant,
                back_emf: flags.back_emf.unwrap_or(flags.torque_constant),
                inertia: flags.inertia,
                viscous: flags.viscous,
                coulomb: flags.coulomb,
                holding: flags.holding.unwrap_or(flags.coulomb).max(flags.coulomb),
            },
            supply: flags.supply,
            counts_per_rev: flags.counts_per_rev,
            step_ns: self.step_us * 1000,
            end_ns: (self.duration * 1e9) as u64,
            pace: if self.pace > 0.0 {
                self.pace
            } else {
                f64::INFINITY
            },
            unkind: self.unkind,
            faults: self.faults.clone(),
            measure_stack: self.stack,
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let cli = Cli::parse();
    let link = TcpPeer::listen(cli.port)?;
    println!("link: 127.0.0.1:{}", link.port()?);
    let log = cli.log.as_ref().map(File::create).transpose()?;
    let settings = cli.settings();
    let bench = Bench::new(settings, log);
    // The first stop comes before the image has done anything.
    let session = Session::new(
        Box::new(Rig::new(cli.board.wiring(), link)?),
        0,
        VirtualNanos(1),
    )?;
    let images = [Image::read(&cli.image, None)?];
    let mut start = Start::new(&images);
    start.semihosting = true;
    let mut finished = emulator::run(session, &start, bench)?;
    let unconnected = finished.session.board_mut().unconnected();
    let (session, bench) = (&finished.session, &finished.driver);
    let (at, instructions) = finished.stop.map_or((0.0, 0), |stop| {
        (stop.at.0 as f64 * 1e-9, stop.instruction_count)
    });
    let elapsed = bench.elapsed().as_secs_f64();
    println!(
        "virtual time {at:.3} s in {elapsed:.3} s: {:.2} times real time",
        at / elapsed
    );
    println!(
        "count {} speed {:.3} rad/s",
        bench.count(),
        bench.state().speed
    );
    println!("instructions {instructions}");
    println!("restarts {}", session.resets().len());
    match bench.stack() {
        Ok(Some(bytes)) => println!("stack {bytes} bytes"),
        Ok(None) => {}
        Err(error) => println!("stack unknown: {error}"),
    }
    for pin in unconnected {
        println!("the image has not connected {pin} as the board needs it");
    }
    for gap in session.unmapped() {
        println!("the emulator has nothing at: {gap}");
    }
    for (address, gap) in session.unimplemented() {
        println!(
            "the emulator only stores: {}.{} at {address:#010x}",
            gap.instance, gap.register
        );
    }
    Ok(())
}
