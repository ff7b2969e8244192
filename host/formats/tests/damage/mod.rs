//! Damage to files, from bits that a line turned to lengths that lie. Each case has a seed of its own.

/// A sequence of numbers that is the same for the same seed (SplitMix64).
pub struct Sequence(u64);

impl Sequence {
    pub fn new(seed: u64) -> Self {
        Sequence(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A place, half of them near an end: there files say how long the rest is.
    fn place(&mut self, length: usize) -> usize {
        let near = length.min(200);
        match self.below(4) {
            0 => self.below(near),
            1 => length - 1 - self.below(near),
            _ => self.below(length),
        }
    }

    /// A short stretch, seldom a long one.
    fn stretch(&mut self, length: usize) -> std::ops::Range<usize> {
        let from = self.place(length);
        let most = self.one(&[4, 16, 64, length]);
        from..(from + 1 + self.below(most)).min(length)
    }
}

/// Words that numbers, names and brackets of a text are replaced by.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "-0.0",
    "1e999",
    "1e-999",
    "NaN",
    "-Infinity",
    "null",
    "true",
    "4294967296",
    "18446744073709551616",
    "99999999999999999999999999999999999999999",
    "\"\"",
    "\"\\ud800\"",
    "[]",
    "{}",
    "{\"t\":",
    "[[[[[[[[[[[[[[[[",
    "]",
    "}",
    ",",
    ":",
    "\\",
    "\n",
];

/// Damages a file once or a few times; `other` is a file of its format, of which a part may come into it.
pub fn damage(sequence: &mut Sequence, bytes: &mut Vec<u8>, other: &[u8], is_text: bool) {
    for _ in 0..=sequence.below(4) {
        if bytes.is_empty() {
            return;
        }
        if is_text && sequence.below(2) == 0 {
            word(sequence, bytes);
        } else {
            once(sequence, bytes, other);
        }
    }
}

fn once(sequence: &mut Sequence, bytes: &mut Vec<u8>, other: &[u8]) {
    let length = bytes.len();
    let at = sequence.place(length);
    match sequence.below(12) {
        0 => bytes[at] ^= 1 << sequence.below(8),
        1 => bytes[at] = sequence.one(&[0, 1, 0x7f, 0x80, 0xff]),
        2 => bytes[at] = sequence.next() as u8,
        3 => bytes.truncate(at),
        4 => drop(bytes.drain(sequence.stretch(length))),
        5 => {
            let again = bytes[sequence.stretch(length)].to_vec();
            bytes.splice(at..at, again);
        }
        6 => {
            let from = sequence.stretch(length);
            let to = sequence.below(length - from.len() + 1);
            bytes.copy_within(from, to);
        }
        7 => {
            let stretch = sequence.stretch(length);
            let with = sequence.one(&[0, 0xff]);
            bytes[stretch].fill(with);
        }
        8 => {
            // The begin of this one and the end of the other.
            bytes.truncate(at);
            bytes.extend_from_slice(&other[sequence.below(other.len())..]);
        }
        9 => varint(sequence, bytes, at),
        _ => number(sequence, bytes, at),
    }
}

/// A whole number of one to eight bytes becomes one that is off by a little, or huge.
fn number(sequence: &mut Sequence, bytes: &mut [u8], at: usize) {
    let size = sequence.one(&[1, 2, 4, 4, 8, 8]);
    // Numbers mostly stand at multiples of their size, from one end of a file or the other.
    let at = match sequence.below(3) {
        0 => at,
        1 => at / size * size,
        _ => bytes
            .len()
            .saturating_sub((bytes.len() - at).next_multiple_of(size)),
    };
    let Some(cell) = bytes.get_mut(at..at + size) else {
        return;
    };
    let big = sequence.below(3) == 0;
    let mut wide = [0; 8];
    wide[..size].copy_from_slice(cell);
    if big {
        wide[..size].reverse();
    }
    let old = u64::from_le_bytes(wide);
    let new = match sequence.below(10) {
        0 => 0,
        1 => u64::MAX,
        2 => u64::MAX >> 1,
        3 => 1 << sequence.below(64),
        4 => (1 << sequence.below(64)) - 1,
        5 => old.wrapping_mul(1 + sequence.below(300) as u64),
        6 => sequence.below(1 << 16) as u64,
        7 => !old,
        _ => old.wrapping_add(sequence.below(33) as u64).wrapping_sub(16),
    };
    let mut wide = new.to_le_bytes();
    if big {
        wide[..size].reverse();
    }
    cell.copy_from_slice(&wide[..size]);
}

/// A number in sevenths of bytes, as Parquet and protobuf have them, becomes a long one.
fn varint(sequence: &mut Sequence, bytes: &mut Vec<u8>, at: usize) {
    let end = bytes[at..].iter().take(9).take_while(|byte| **byte >= 0x80);
    let end = (at + end.count() + 1).min(bytes.len());
    let mut new = vec![0x80 | sequence.next() as u8; sequence.below(10)];
    new.push(sequence.next() as u8 & 0x7f);
    if sequence.below(3) == 0 {
        new.fill(0xff);
    }
    bytes.splice(at..end, new);
}

/// A number or a word of a text becomes another one, or one is put in.
fn word(sequence: &mut Sequence, bytes: &mut Vec<u8>) {
    let at = sequence.place(bytes.len());
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || b".+-_".contains(byte);
    let before = bytes[..at].iter().rev().take(40).take_while(|b| is_word(b));
    let after = bytes[at..].iter().take(40).take_while(|b| is_word(b));
    let whole = at - before.count()..at + after.count();
    let new = sequence.one(WORDS).as_bytes();
    // Seldom so deep that a reader by recursion would not come back.
    let times = if sequence.below(50) == 0 { 20_000 } else { 1 };
    let replaced = if sequence.below(4) == 0 {
        at..at
    } else {
        whole
    };
    bytes.splice(replaced, new.repeat(times));
}

/// The same file with less about it that tells damage: without sums over its bytes, or unpacked. What is damaged then gets further.
pub fn laid_bare(bytes: &[u8]) -> Option<Vec<u8>> {
    if bytes.starts_with(b"\x89MCAP0\r\n") {
        return without_sums(bytes);
    }
    if bytes.starts_with(b"MATLAB 5.0") {
        return unpacked(bytes);
    }
    None
}

/// An MCAP file whose chunks and ends state no sum.
fn without_sums(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = bytes.to_vec();
    let mut at = 8;
    while at + 9 <= bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().ok()?) as usize;
        let from = at + 9;
        match bytes[at] {
            // Start, end and size come before it.
            0x06 => bytes.get_mut(from + 24..from + 28)?.fill(0),
            0x0f => bytes.get_mut(from..from + 4)?.fill(0),
            0x02 => bytes.get_mut(from + 16..from + 20)?.fill(0),
            _ => {}
        }
        at = from.checked_add(length)?;
    }
    Some(bytes)
}

/// A MATLAB file whose packed variables are plain.
fn unpacked(bytes: &[u8]) -> Option<Vec<u8>> {
    use std::io::Read;
    const PACKED: [u8; 4] = 15u32.to_le_bytes();
    let mut out = bytes.get(..128)?.to_vec();
    let mut rest = bytes.get(128..)?;
    let mut any = false;
    while let Some((head, after)) = rest.split_at_checked(8) {
        let length = u32::from_le_bytes(head[4..].try_into().ok()?) as usize;
        let content = after.get(..length)?;
        if head[..4] == PACKED {
            any = true;
            let mut plain = Vec::new();
            flate2::read::ZlibDecoder::new(content)
                .read_to_end(&mut plain)
                .ok()?;
            out.extend_from_slice(&plain);
            rest = &after[length..];
        } else {
            let padded = length.next_multiple_of(8).min(after.len());
            out.extend_from_slice(head);
            out.extend_from_slice(&after[..padded]);
            rest = &after[padded..];
        }
    }
    any.then_some(out)
}
