//! Transposition of eight rows of eight numbers in registers: the lanes' values at eight samples become eight samples of
//! each lane. By single loads and stores it took as long as half a step of the model.

use bytemuck::cast;

/// Candidates that run side by side.
pub const LANES: usize = 8;

/// Eight rows of eight numbers.
pub type Tile = [[f64; LANES]; LANES];

/// Instructions that transpose a [`Tile`].
pub trait Transpose: Copy {
    /// The columns of these rows.
    #[inline(always)]
    fn transposed(self, rows: Tile) -> Tile {
        let mut columns = [[0.0; LANES]; LANES];
        for (k, row) in rows.iter().enumerate() {
            for (column, x) in columns.iter_mut().zip(row) {
                column[k] = *x;
            }
        }
        columns
    }
}

impl Transpose for pulp::Scalar {}

#[cfg(target_arch = "x86_64")]
impl Transpose for pulp::x86::V4 {
    #[inline(always)]
    fn transposed(self, rows: Tile) -> Tile {
        use core::arch::x86_64::__m512d;
        // The even or the odd pairs of two registers.
        const FIRST: i32 = 0b10_00_10_00;
        const SECOND: i32 = 0b11_01_11_01;
        let vectors = self.avx512f;
        let r: [__m512d; LANES] = cast(rows);
        let mut columns = r;
        for odd in 0..2 {
            // The pairs (row 2k, row 2k + 1) of the even columns, or of the odd ones.
            let mut pairs = [r[0]; 4];
            for (k, pair) in pairs.iter_mut().enumerate() {
                let (a, b) = (r[2 * k], r[2 * k + 1]);
                *pair = if odd == 0 {
                    vectors._mm512_unpacklo_pd(a, b)
                } else {
                    vectors._mm512_unpackhi_pd(a, b)
                };
            }
            let [p, q, s, t] = pairs;
            let (low, high) = (
                vectors._mm512_shuffle_f64x2::<FIRST>(p, q),
                vectors._mm512_shuffle_f64x2::<FIRST>(s, t),
            );
            columns[odd] = vectors._mm512_shuffle_f64x2::<FIRST>(low, high);
            columns[odd + 4] = vectors._mm512_shuffle_f64x2::<SECOND>(low, high);
            let (low, high) = (
                vectors._mm512_shuffle_f64x2::<SECOND>(p, q),
                vectors._mm512_shuffle_f64x2::<SECOND>(s, t),
            );
            columns[odd + 2] = vectors._mm512_shuffle_f64x2::<FIRST>(low, high);
            columns[odd + 6] = vectors._mm512_shuffle_f64x2::<SECOND>(low, high);
        }
        cast(columns)
    }
}

#[cfg(target_arch = "x86_64")]
impl Transpose for pulp::x86::V3 {
    #[inline(always)]
    fn transposed(self, rows: Tile) -> Tile {
        use core::arch::x86_64::__m256d;
        const LOW: i32 = 0x20;
        const HIGH: i32 = 0x31;
        let vectors = self.avx;
        let r: [[__m256d; 2]; LANES] = cast(rows);
        let mut columns = r;
        // Four rows of four at a time; the two off-diagonal quarters exchange places.
        for (row, half) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let from = 4 * row;
            let (a, b) = (r[from][half], r[from + 1][half]);
            let (c, d) = (r[from + 2][half], r[from + 3][half]);
            let even = [
                vectors._mm256_unpacklo_pd(a, b),
                vectors._mm256_unpacklo_pd(c, d),
            ];
            let odd = [
                vectors._mm256_unpackhi_pd(a, b),
                vectors._mm256_unpackhi_pd(c, d),
            ];
            let to = 4 * half;
            columns[to][row] = vectors._mm256_permute2f128_pd::<LOW>(even[0], even[1]);
            columns[to + 1][row] = vectors._mm256_permute2f128_pd::<LOW>(odd[0], odd[1]);
            columns[to + 2][row] = vectors._mm256_permute2f128_pd::<HIGH>(even[0], even[1]);
            columns[to + 3][row] = vectors._mm256_permute2f128_pd::<HIGH>(odd[0], odd[1]);
        }
        cast(columns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile() -> Tile {
        std::array::from_fn(|row| std::array::from_fn(|column| (10 * row + column) as f64))
    }

    fn transposes(processor: impl Transpose) {
        let rows = tile();
        let columns = processor.transposed(rows);
        for row in 0..LANES {
            for column in 0..LANES {
                assert_eq!(columns[column][row], rows[row][column]);
            }
        }
        assert_eq!(processor.transposed(columns), rows);
    }

    #[test]
    fn rows_become_columns_with_every_kind_of_register() {
        transposes(pulp::Scalar::new());
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(v3) = pulp::x86::V3::try_new() {
                transposes(v3);
            }
            if let Some(v4) = pulp::x86::V4::try_new() {
                transposes(v4);
            }
        }
    }
}
