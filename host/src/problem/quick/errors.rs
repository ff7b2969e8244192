//! The errors of a block of samples, a stride at a time.

use super::Piece;
use crate::lanes::with_vectors;
use crate::problem::held::{Held, Path, STRIDE};

/// Model minus reading at each of the samples of a block, counts.
pub(super) fn errors(held: &Held, piece: &Piece, readings: &[f64], errors: &mut [f64]) {
    with_vectors(
        #[inline(always)]
        || of_block(held, piece, readings, errors),
    );
}

#[inline(always)]
fn of_block(held: &Held, piece: &Piece, readings: &[f64], errors: &mut [f64]) {
    let Path { level, slope, .. } = piece.path;
    let begin = level + slope * piece.after as f64;
    let mut line: [f64; STRIDE] = std::array::from_fn(|k| begin + slope * k as f64);
    let rise = slope * STRIDE as f64;
    let mut now = held.transients(piece.off);
    let mut next = held.transients(held.on(piece.off, STRIDE));
    let (strides, rest) = errors.as_chunks_mut::<STRIDE>();
    let (read, last) = readings.as_chunks::<STRIDE>();
    for (errors, readings) in strides.iter_mut().zip(read) {
        for k in 0..STRIDE {
            errors[k] = (line[k] - readings[k]) + now[k];
            let later = next[k] * held.trace - now[k] * held.determinant;
            (now[k], next[k]) = (next[k], later);
            line[k] += rise;
        }
    }
    for (k, (error, reading)) in rest.iter_mut().zip(last).enumerate() {
        *error = (line[k] - reading) + now[k];
    }
}
