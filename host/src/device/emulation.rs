//! The firmware without hardware: its image in QEMU, or the same program natively, with the virtual bench as its motor.

use super::lockstep::plant;
use super::{DeviceError, Port};
use servoid_plant::Bench;
use std::fs::File;
use std::io::Read;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Time that an image may take to start.
const PATIENCE: Duration = Duration::from_secs(10);

/// Kind of image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Image {
    /// An ARM image, in QEMU.
    Qemu(PathBuf),
    /// A native program.
    Native(PathBuf),
}

impl Image {
    /// Looks at a file's first bytes.
    ///
    /// # Errors
    /// A file that cannot be read or run.
    pub fn at(path: &Path) -> Result<Self, DeviceError> {
        let mut header = [0u8; 20];
        let read = File::open(path).and_then(|mut file| file.read_exact(&mut header));
        read.map_err(|error| {
            DeviceError::Emulation(format!(
                "{}: {error}; build the image first: `scripts/emulated` does, or give --image FILE",
                path.display()
            ))
        })?;
        const ARM: [u8; 2] = 40u16.to_le_bytes();
        let elf = header.starts_with(b"\x7fELF");
        Ok(if elf && header[18..20] == ARM {
            Image::Qemu(path.to_owned())
        } else {
            Image::Native(path.to_owned())
        })
    }
}

/// A device that runs on this machine; it ends with this value.
#[derive(Debug)]
pub struct Emulation {
    child: Child,
    port: Port,
}

impl Emulation {
    /// Starts an image with a bench as its motor.
    ///
    /// # Errors
    /// QEMU is not there; the image does not start.
    pub fn start(image: &Image, bench: Bench, pace: f64) -> Result<Self, DeviceError> {
        let failed =
            |what: &str, error: std::io::Error| DeviceError::Emulation(format!("{what}: {error}"));
        let (plant, arrived) =
            plant(bench, pace).map_err(|e| failed("no port for the plant", e))?;
        // Free now, and with luck still free when the image listens there in a moment.
        let free =
            TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|listener| listener.local_addr());
        let link = free.map_err(|e| failed("no port for the link", e))?;
        let mut command = match image {
            Image::Native(path) => {
                let mut command = Command::new(path);
                command.args([link.to_string(), plant.to_string()]);
                command
            }
            Image::Qemu(path) => {
                let mut command = Command::new("qemu-system-arm");
                command.args([
                    "-machine",
                    "netduinoplus2",
                    "-display",
                    "none",
                    "-monitor",
                    "none",
                ]);
                command.args(["-semihosting-config", "enable=on,target=native"]);
                command
                    .arg("-serial")
                    .arg(format!("tcp:{link},server=on,wait=off,nodelay=on"));
                command
                    .arg("-serial")
                    .arg(format!("tcp:{plant},nodelay=on"));
                command.arg("-kernel").arg(path);
                command
            }
        };
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| match image {
            Image::Qemu(_) => DeviceError::Emulation(format!(
                "qemu-system-arm: {error}; install QEMU (Debian: qemu-system-arm), or use the native image (`scripts/emulated --native`)"
            )),
            Image::Native(path) => failed(&path.display().to_string(), error),
        })?;
        let begun = Instant::now();
        loop {
            if arrived.recv_timeout(Duration::from_millis(20)).is_ok() {
                break;
            }
            let ended = child.try_wait().ok().flatten();
            if ended.is_some() || begun.elapsed() > PATIENCE {
                let _ = child.kill();
                let mut said = String::new();
                if let Some(mut stderr) = child.stderr.take() {
                    let _ = stderr.read_to_string(&mut said);
                }
                return Err(DeviceError::Emulation(format!(
                    "the image did not start: {}",
                    said.trim()
                )));
            }
        }
        Ok(Emulation {
            child,
            port: Port::Tcp(link.to_string()),
        })
    }

    /// Where the device answers.
    pub fn port(&self) -> &Port {
        &self.port
    }

    /// True while it runs.
    pub fn runs(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }
}

impl Drop for Emulation {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
