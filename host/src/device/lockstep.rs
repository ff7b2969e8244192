//! The virtual bench as the plant of an emulated board, in lock step.
//!
//! ```text
//! board → plant   a5  duty (i16)                    check
//! plant → board   5a  count (i32)  current (i16)    check
//! ```

use servoid_plant::{Bench, BenchError, DriveSample, Reading};
use shared::trace::{DUTY, OPEN};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// Waits on its own port for a board and serves as its plant until it disconnects; reports the connection.
///
/// # Errors
/// Errors of the operating system.
pub fn plant(bench: Bench, pace: f64) -> io::Result<(SocketAddr, mpsc::Receiver<()>)> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    let address = listener.local_addr()?;
    let (sender, arrived) = mpsc::channel();
    thread::spawn(move || {
        if let Ok((stream, _)) = listener.accept() {
            let _ = stream.set_nodelay(true);
            let _ = sender.send(());
            if let Err(error) = serve(&bench, stream, pace) {
                eprintln!("the virtual bench gave up: {error}");
            }
        }
    });
    Ok((address, arrived))
}

/// Runs the bench behind a stream until that ends. Time passes at most `pace` times as fast as on a real bench, so that
/// what a host does in real time is in time.
///
/// # Errors
/// Errors of the bench.
fn serve(bench: &Bench, mut stream: impl Read + Write, pace: f64) -> Result<(), BenchError> {
    let mut clock = Clock::new(pace);
    let mut first = true;
    bench.follow(|reading| {
        if !std::mem::take(&mut first) {
            clock.wait_until(reading.time_s);
            stream.write_all(&answer(reading)).ok()?;
        }
        let duty = asked(&mut stream).ok()?;
        Some(DriveSample {
            volts: if duty == OPEN {
                0.0
            } else {
                f64::from(duty) * DUTY * bench.machine.supply_v
            },
            enabled: duty != OPEN,
        })
    })
}

/// Lets simulated time pass no faster than its pace. Where the board was slow (it computes), the lost time is not made up
/// for: the host would suddenly have less time than before.
struct Clock {
    pace: f64,
    since: Instant,
    from_s: f64,
}

impl Clock {
    fn new(pace: f64) -> Self {
        Clock {
            pace,
            since: Instant::now(),
            from_s: 0.0,
        }
    }

    fn wait_until(&mut self, time_s: f64) {
        let due = Duration::from_secs_f64(((time_s - self.from_s) / self.pace).max(0.0));
        let passed = self.since.elapsed();
        if due > passed + TICK {
            std::thread::sleep(due - passed);
        } else if passed > due + LATE {
            self.since = Instant::now();
            self.from_s = time_s;
        }
    }
}

/// Shorter waits than this are not worth a sleep.
const TICK: Duration = Duration::from_millis(2);
/// Later than this is slow.
const LATE: Duration = Duration::from_millis(20);

fn answer(reading: &Reading) -> [u8; 8] {
    // The board's counter wraps.
    let [a, b, c, d] = (reading.counts as i32).to_le_bytes();
    let current = (reading.current_a * 1e3).clamp(i16::MIN.into(), i16::MAX.into());
    let [low, high] = (current as i16).to_le_bytes();
    let check = [a, b, c, d, low, high]
        .iter()
        .fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    [0x5a, a, b, c, d, low, high, check]
}

/// The next duty; skips invalid bytes.
fn asked(stream: &mut impl Read) -> io::Result<i16> {
    let mut window = [0; 4];
    stream.read_exact(&mut window)?;
    while !(window[0] == 0xa5 && window[1].wrapping_add(window[2]) == window[3]) {
        window.rotate_left(1);
        stream.read_exact(&mut window[3..])?;
    }
    Ok(i16::from_le_bytes([window[1], window[2]]))
}
