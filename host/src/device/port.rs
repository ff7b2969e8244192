//! Address of a device: a serial port, a TCP or a Unix socket.

use super::DeviceError;
use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// Baud rate of our firmware.
const BAUD: u32 = 921_600;
/// A read returns after this long with nothing.
const PATIENCE: Duration = Duration::from_millis(5);

/// An address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial port and its baud rate.
    Serial(String, u32),
    /// Host and port.
    Tcp(String),
    /// A path.
    Unix(String),
}

/// A byte stream. A read waits for a few milliseconds at most, and then fails with a time-out.
pub trait Link: Read + Write + Send {}
impl<T: Read + Write + Send> Link for T {}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Port::Serial(name, BAUD) => write!(f, "{name}"),
            Port::Serial(name, baud) => write!(f, "{name}:{baud}"),
            Port::Tcp(address) => write!(f, "tcp:{address}"),
            Port::Unix(path) => write!(f, "unix:{path}"),
        }
    }
}

impl Port {
    /// Reads an address.
    ///
    /// # Errors
    /// A text that is none.
    pub fn parse(text: &str) -> Result<Self, DeviceError> {
        let wrong = || DeviceError::Address(text.to_owned());
        if let Some(address) = text.strip_prefix("tcp:") {
            let (host, port) = address.rsplit_once(':').ok_or_else(wrong)?;
            port.parse::<u16>().map_err(|_| wrong())?;
            return if host.is_empty() {
                Err(wrong())
            } else {
                Ok(Port::Tcp(address.to_owned()))
            };
        }
        if let Some(path) = text.strip_prefix("unix:") {
            return if path.is_empty() {
                Err(wrong())
            } else {
                Ok(Port::Unix(path.to_owned()))
            };
        }
        let (name, baud) = match text.rsplit_once(':') {
            None => (text, BAUD),
            Some((name, baud)) => (name, baud.parse().map_err(|_| wrong())?),
        };
        if name.is_empty() || baud == 0 {
            return Err(wrong());
        }
        Ok(Port::Serial(name.to_owned(), baud))
    }

    /// Opens it.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn open(&self) -> Result<Box<dyn Link>, DeviceError> {
        self.try_open().map_err(|reason| DeviceError::Open {
            port: self.to_string(),
            reason,
        })
    }

    fn try_open(&self) -> Result<Box<dyn Link>, String> {
        let said = |error: io::Error| error.to_string();
        match self {
            Port::Serial(name, baud) => {
                let port = serialport::new(name, *baud).timeout(PATIENCE).open();
                let port = port.map_err(|error| error.to_string())?;
                Ok(Box::new(Serial(port)))
            }
            Port::Tcp(address) => {
                let stream = TcpStream::connect(address).map_err(said)?;
                stream.set_read_timeout(Some(PATIENCE)).map_err(said)?;
                stream.set_nodelay(true).map_err(said)?;
                Ok(Box::new(stream))
            }
            #[cfg(unix)]
            Port::Unix(path) => {
                let stream = std::os::unix::net::UnixStream::connect(path).map_err(said)?;
                stream.set_read_timeout(Some(PATIENCE)).map_err(said)?;
                Ok(Box::new(stream))
            }
            #[cfg(not(unix))]
            Port::Unix(_) => Err("there are no Unix sockets on this system".to_owned()),
        }
    }
}

struct Serial(Box<dyn serialport::SerialPort>);

impl Read for Serial {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.0.read(buffer) {
            // A serial port has no end: nothing read is nothing there yet.
            Ok(0) => Err(ErrorKind::TimedOut.into()),
            read => read,
        }
    }
}

impl Write for Serial {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.0.write(buffer)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The serial ports of this machine, each with what is known of it.
///
/// # Errors
/// Errors of the operating system.
pub fn serial_ports() -> Result<Vec<(String, String)>, DeviceError> {
    let ports = serialport::available_ports().map_err(io::Error::from)?;
    let described = |kind: serialport::SerialPortType| match kind {
        serialport::SerialPortType::UsbPort(usb) => {
            let product = usb.product.unwrap_or_else(|| "USB".to_owned());
            format!("{product} ({:04x}:{:04x})", usb.vid, usb.pid)
        }
        serialport::SerialPortType::BluetoothPort => "Bluetooth".to_owned(),
        serialport::SerialPortType::PciPort => "built in".to_owned(),
        serialport::SerialPortType::Unknown => String::new(),
    };
    Ok(ports
        .into_iter()
        .map(|port| (port.port_name, described(port.port_type)))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_read_back_as_they_print() {
        for text in [
            "/dev/ttyACM0",
            "COM3",
            "/dev/ttyUSB1:115200",
            "tcp:127.0.0.1:4000",
            "tcp:[::1]:4000",
            "unix:/run/servo",
        ] {
            assert_eq!(Port::parse(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_no_address_says_what_one_looks_like() {
        for text in [
            "",
            "tcp:",
            "tcp:host",
            "tcp::4000",
            "tcp:host:99999",
            "unix:",
            "/dev/ttyACM0:fast",
            ":9600",
            "/dev/x:0",
        ] {
            let error = Port::parse(text).unwrap_err().to_string();
            assert!(error.contains("servoid device list"), "{text}: {error}");
        }
    }
}
