//! Errors of a device, each with its remedy.

use servoid_results::device_run::FolderError;
use shared::wire::Refusal;
use std::io;

/// Error of a device.
#[derive(Debug, thiserror::Error)]
pub enum DeviceError {
    /// The address names no port.
    #[error(
        "port `{0}`: give a serial port (/dev/ttyACM0, COM3, with :baud after it if it is not 921600), tcp:HOST:PORT or \
         unix:PATH; `servoid device list` shows the serial ports"
    )]
    Address(String),
    /// The port cannot be opened.
    #[error("port {port}: {reason}; is the device plugged in, and is no other program using it?")]
    Open {
        /// As given.
        port: String,
        /// Error of the operating system.
        reason: String,
    },
    /// The port broke.
    #[error("the link broke: {0}; a device that drives stops by itself within half a second")]
    Link(#[from] io::Error),
    /// No valid answer.
    #[error(
        "no answer from {port} within {seconds} s{noise}; check power, cable and baud rate, and that the firmware is \
         flashed"
    )]
    Silent {
        /// As given.
        port: String,
        /// Time waited.
        seconds: f64,
        /// Bytes received instead.
        noise: String,
    },
    /// The device speaks another version.
    #[error(
        "the device speaks version {theirs} of the link, this program {ours}: use the servoid that belongs to its firmware, or flash the one that belongs to this"
    )]
    Version {
        /// The device's.
        theirs: u16,
        /// This program's.
        ours: u16,
    },
    /// The device refused.
    #[error("the device refused: {}", reason(.0))]
    Refused(Refusal),
    /// The device restarted in the middle.
    #[error(
        "the device restarted in the middle of the run (its supply may have broken down); its bridge is off since then"
    )]
    Restarted,
    /// The device goes on for ever.
    #[error(
        "the device {} {seconds:.0} s: it was told to stop; restart it, and flash the firmware that belongs to this servoid",
        if *.still { "has brought nothing new for" } else { "has not come to its end after" }
    )]
    Endless {
        /// Time waited.
        seconds: f64,
        /// Nothing new came for so long.
        still: bool,
    },
    /// The device says what cannot be.
    #[error(
        "the device says {what}, which cannot be: its numbers are not used; flash the firmware that belongs to this servoid"
    )]
    Nonsense {
        /// What it says.
        what: String,
    },
    /// A flag does not fit the device.
    #[error("{0}")]
    Order(String),
    /// The emulation cannot be started.
    #[error("{0}")]
    Emulation(String),
    /// A folder of a run cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

fn reason(refusal: &Refusal) -> &'static str {
    match refusal {
        Refusal::Busy => "a run is under way; wait for it, or `servoid device stop`",
        Refusal::NotArmed => "the arming was used up or too old; try again",
        Refusal::BadJob => {
            "a length or a limit is zero or beyond what it can do; see `servoid device info`"
        }
        Refusal::NotTuned => {
            "it has no servo: tune it first, by `servoid device tune`; of a board that keeps none in its flash, leave it powered"
        }
        Refusal::BadPlan => {
            "the plan has too many segments for it, or is not the one that it holds; try again, or use a shorter plan"
        }
    }
}
