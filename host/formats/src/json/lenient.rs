//! JSON as Python writes it: `NaN` and `Infinity` stand where JSON knows no number.

use std::io::{self, BufRead, BufReader, Read};

/// The numbers that JSON cannot write.
const WORDS: [&[u8]; 3] = [b"NaN", b"Infinity", b"-Infinity"];
/// What stands for them, and for which a row has no value.
const MISSING: &[u8] = b"null";
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A reader of JSON that turns the numbers that JSON cannot write into `null`.
pub(crate) struct Lenient<R> {
    inner: R,
    ready: Vec<u8>,
    given: usize,
    is_begun: bool,
    state: State,
}

/// Where in a text of JSON a reader is.
#[derive(Default)]
struct State {
    /// What may become one of the words.
    word: Vec<u8>,
    is_text: bool,
    is_escaped: bool,
}

impl<R: BufRead> Lenient<R> {
    /// A reader of what `inner` reads.
    pub(crate) fn new(inner: R) -> BufReader<Self> {
        BufReader::new(Lenient {
            inner,
            ready: Vec::new(),
            given: 0,
            is_begun: false,
            state: State::default(),
        })
    }

    fn fill(&mut self) -> io::Result<()> {
        self.ready.clear();
        self.given = 0;
        while self.ready.is_empty() {
            let mut bytes = self.inner.fill_buf()?;
            let all = bytes.len();
            if all == 0 {
                self.state.end_word(&mut self.ready);
                return Ok(());
            }
            if !std::mem::replace(&mut self.is_begun, true) {
                bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
            }
            self.state.go_on(bytes, &mut self.ready);
            self.inner.consume(all);
        }
        Ok(())
    }
}

impl State {
    fn go_on(&mut self, mut bytes: &[u8], to: &mut Vec<u8>) {
        while let Some(&byte) = bytes.first() {
            let plain = match (self.is_text, self.word.is_empty()) {
                (true, _) if self.is_escaped => 1,
                (true, _) => length(bytes, |byte| matches!(byte, b'"' | b'\\')),
                (false, true) => length(bytes, |byte| matches!(byte, b'"' | b'N' | b'I' | b'-')),
                (false, false) => 0,
            };
            let (before, rest) = bytes.split_at_checked(plain).unwrap_or((bytes, &[]));
            to.extend_from_slice(before);
            if plain > 0 {
                self.is_escaped = false;
                bytes = rest;
                continue;
            }
            self.special(byte, to);
            bytes = bytes.get(1..).unwrap_or(&[]);
        }
    }

    /// Takes a byte that may be the beginning or end of something.
    fn special(&mut self, byte: u8, to: &mut Vec<u8>) {
        if self.is_text {
            to.push(byte);
            self.is_escaped = byte == b'\\';
            self.is_text = byte != b'"';
            return;
        }
        self.word.push(byte);
        if self.may_be_word() {
            return;
        }
        self.word.pop();
        self.end_word(to);
        self.word.push(byte);
        if !self.may_be_word() {
            self.end_word(to);
        }
        self.is_text = byte == b'"';
    }

    fn may_be_word(&self) -> bool {
        WORDS.iter().any(|word| word.starts_with(&self.word))
    }

    fn end_word(&mut self, to: &mut Vec<u8>) {
        if WORDS.contains(&self.word.as_slice()) {
            to.extend_from_slice(MISSING);
        } else {
            to.extend_from_slice(&self.word);
        }
        self.word.clear();
    }
}

/// Bytes before the first one that is special.
fn length(bytes: &[u8], is_special: impl Fn(u8) -> bool) -> usize {
    let special = bytes.iter().position(|byte| is_special(*byte));
    special.unwrap_or(bytes.len())
}

impl<R: BufRead> Read for Lenient<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.given >= self.ready.len() {
            self.fill()?;
        }
        let mut ready = self.ready.get(self.given..).unwrap_or(&[]);
        let read = ready.read(buffer)?;
        self.given += read;
        Ok(read)
    }
}
