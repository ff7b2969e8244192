//! The PC itself as a board: the same application as a native program, with the link and the plant on TCP ports. For
//! users without QEMU, and for tests that interrupt everything.

use super::Board;
use super::lockstep::{Answer, Reading, ask};
use super::store::LONGEST;
use crate::phase::Fault;
use std::fs;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

/// The PC as a board.
#[derive(Debug)]
pub struct Pc {
    listener: TcpListener,
    link: Option<TcpStream>,
    received: Vec<u8>,
    taken: usize,
    plant: TcpStream,
    duty: Option<i16>,
    reading: Reading,
    answer: Answer,
    gone: bool,
    flash: Option<PathBuf>,
}

impl Pc {
    /// Listens for the host at `link`, and asks the plant at `plant`.
    ///
    /// # Errors
    /// An address that cannot be bound or reached.
    pub fn start(link: &str, plant: &str) -> io::Result<Self> {
        let listener = TcpListener::bind(link)?;
        listener.set_nonblocking(true)?;
        let plant = TcpStream::connect(plant)?;
        plant.set_nodelay(true)?;
        Ok(Pc {
            listener,
            link: None,
            received: Vec::new(),
            taken: 0,
            plant,
            duty: None,
            reading: Reading::default(),
            answer: Answer::default(),
            gone: false,
            flash: None,
        })
    }

    /// With a file for what outlives a power cut.
    #[must_use]
    pub fn with_flash(mut self, file: PathBuf) -> Self {
        self.flash = Some(file);
        self
    }

    /// True once the plant has disconnected: the program then ends.
    pub fn is_gone(&self) -> bool {
        self.gone
    }

    fn exchange(&mut self) -> io::Result<()> {
        self.plant.write_all(&ask(self.duty))?;
        loop {
            let mut byte = [0];
            self.plant.read_exact(&mut byte)?;
            if let Some(reading) = self.answer.push(byte[0]) {
                self.reading = reading;
                return Ok(());
            }
        }
    }

    /// Accepts the newest connection and reads from it.
    fn pump(&mut self) {
        if let Ok((link, _)) = self.listener.accept() {
            let ready = link
                .set_nonblocking(true)
                .and_then(|()| link.set_nodelay(true));
            self.link = ready.is_ok().then_some(link);
        }
        let mut buffer = [0; 256];
        let Some(link) = &mut self.link else {
            return;
        };
        match link.read(&mut buffer) {
            Ok(0) => self.link = None,
            Ok(read) => {
                self.received.clear();
                self.taken = 0;
                self.received.extend_from_slice(&buffer[..read]);
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(_) => self.link = None,
        }
    }
}

impl Board for Pc {
    const NAME: &'static str = "PC";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 100_000;
    const SENSES_CURRENT: bool = true;
    const SAVES: bool = true;

    fn drive(&mut self, duty: i16) {
        self.duty = Some(duty);
    }

    fn coast(&mut self) {
        self.duty = None;
    }

    fn count(&mut self) -> i32 {
        self.reading.count
    }

    fn current_ma(&mut self) -> i32 {
        self.reading.current_ma.into()
    }

    fn tick(&mut self) -> Result<(), Fault> {
        self.gone |= self.exchange().is_err();
        if self.gone {
            Err(Fault::Bridge)
        } else {
            Ok(())
        }
    }

    fn receive(&mut self) -> Option<u8> {
        if self.taken == self.received.len() {
            self.received.clear();
            self.taken = 0;
            self.pump();
        }
        let byte = self.received.get(self.taken).copied()?;
        self.taken += 1;
        Some(byte)
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        let Some(link) = &mut self.link else {
            // No host is connected: the bytes are lost, as on a wire.
            return bytes.len();
        };
        match link.write(bytes) {
            Ok(written) => written,
            Err(error) if error.kind() == ErrorKind::WouldBlock => 0,
            Err(_) => {
                self.link = None;
                bytes.len()
            }
        }
    }

    fn load(&mut self, key: u8, into: &mut [u8; LONGEST]) -> Option<usize> {
        let bytes = fs::read(self.flash.as_ref()?).ok()?;
        let value = bytes.strip_prefix(&[key])?;
        into.get_mut(..value.len())?.copy_from_slice(value);
        Some(value.len())
    }

    fn save(&mut self, key: u8, value: &[u8]) -> bool {
        let bytes = [&[key], value].concat();
        self.flash
            .as_ref()
            .is_some_and(|file| fs::write(file, bytes).is_ok())
    }

    fn entropy(&mut self) -> u32 {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        now.map_or(0, |now| now.subsec_nanos() ^ now.as_secs() as u32) ^ std::process::id()
    }
}
