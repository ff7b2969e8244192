//! Least squares whose rows come one by one: of each of several problems side by side only the triangular factor R of
//! its QR decomposition is kept, which holds all that its rows say.
//!
//! Rows are reflected onto the triangle 64 at a time (Householder; G. H. Golub, C. F. Van Loan, *Matrix Computations*,
//! 5.2), so nothing is lost against a decomposition of the whole matrix. Sums of products would lose half the digits.

use super::dispatch::with_vectors;
use nalgebra::DMatrix;

/// Rows that are reflected at a time.
const ROWS: usize = 64;
/// Running sums of a product: a single one would wait for its own addition.
const SUMS: usize = 4;

type Column<const L: usize> = [[f64; L]; ROWS];

/// The triangles of `L` problems with the same number of columns.
#[derive(Clone, Debug)]
pub struct Triangles<const L: usize> {
    width: usize,
    /// Column by column, with zeros below.
    triangle: Vec<[f64; L]>,
    /// Rows that are not in the triangle yet, column by column.
    waiting: Vec<Column<L>>,
    /// Number of these rows.
    filled: usize,
}

impl<const L: usize> Triangles<L> {
    /// Problems with `width` columns and no rows yet.
    pub fn new(width: usize) -> Self {
        Triangles {
            width,
            triangle: vec![[0.0; L]; width * width],
            waiting: vec![[[0.0; L]; ROWS]; width],
            filled: 0,
        }
    }

    /// Takes a row of each problem: for each column, one entry a problem.
    #[inline(always)]
    pub fn push(&mut self, entries: impl IntoIterator<Item = [f64; L]>) {
        for (column, entry) in self.waiting.iter_mut().zip(entries) {
            column[self.filled] = entry;
        }
        self.filled += 1;
        if self.filled == ROWS {
            self.reflect();
        }
    }

    /// The triangle of each problem, `width × width`.
    pub fn each(mut self) -> [DMatrix<f64>; L] {
        self.reflect();
        std::array::from_fn(|lane| {
            DMatrix::from_fn(self.width, self.width, |row, column| {
                self.triangle[column * self.width + row][lane]
            })
        })
    }

    /// The triangle of all rows together, where the problems are parts of one.
    pub fn together(self) -> DMatrix<f64> {
        let width = self.width;
        let each = self.each();
        let stacked = DMatrix::from_fn(L * width, width, |row, column| {
            each[row / width][(row % width, column)]
        });
        stacked.qr().r()
    }

    fn reflect(&mut self) {
        with_vectors(
            #[inline(always)]
            || {
                for pivot in 0..self.width {
                    self.reflect_column(pivot);
                }
            },
        );
        for column in &mut self.waiting {
            column[..self.filled].fill([0.0; L]);
        }
        self.filled = 0;
    }

    /// Reflects the waiting rows of the pivot's column onto the triangle.
    #[inline(always)]
    fn reflect_column(&mut self, pivot: usize) {
        let (done, others) = self.waiting.split_at_mut(pivot + 1);
        let mirror = &done[pivot];
        let below = product(mirror, mirror);
        let corner = &mut self.triangle[pivot * self.width + pivot];
        let (mut top, mut scale) = ([0.0; L], [0.0; L]);
        for lane in 0..L {
            let length = (corner[lane] * corner[lane] + below[lane]).sqrt();
            let signed = length.copysign(corner[lane]);
            top[lane] = corner[lane] + signed;
            // A column of zeros needs no reflection.
            if below[lane] != 0.0 {
                scale[lane] = 1.0 / (length * (length + corner[lane].abs()));
                corner[lane] = -signed;
            }
        }
        for (column, other) in (pivot + 1..self.width).zip(others) {
            let right = &mut self.triangle[column * self.width + pivot];
            let mut share = product(mirror, other);
            for lane in 0..L {
                share[lane] = scale[lane] * (top[lane] * right[lane] + share[lane]);
                right[lane] -= share[lane] * top[lane];
            }
            for (other, mirror) in other.iter_mut().zip(mirror) {
                for lane in 0..L {
                    other[lane] -= share[lane] * mirror[lane];
                }
            }
        }
    }
}

/// Sum over the rows of the products of two columns.
#[inline(always)]
fn product<const L: usize>(a: &Column<L>, b: &Column<L>) -> [f64; L] {
    let mut sums = [[0.0; L]; SUMS];
    let (a, _) = a.as_chunks::<SUMS>();
    let (b, _) = b.as_chunks::<SUMS>();
    for (a, b) in a.iter().zip(b) {
        for sum in 0..SUMS {
            for lane in 0..L {
                sums[sum][lane] += a[sum][lane] * b[sum][lane];
            }
        }
    }
    std::array::from_fn(|lane| (sums[0][lane] + sums[1][lane]) + (sums[2][lane] + sums[3][lane]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng;

    const LANES: usize = 4;

    /// Columns of a drawn problem, each nearly a mix of those before: `apart` of its own.
    fn drawn(seed: u64, rows: usize, width: usize, apart: f64) -> DMatrix<f64> {
        let mut generator = rng::seeded(seed);
        let mut draw = || 2.0 * rng::uniform::<f64>(&mut generator) - 1.0;
        let mut matrix = DMatrix::from_fn(rows, width, |_, _| draw());
        for column in 1..width {
            let mix: Vec<f64> = (0..column).map(|_| draw()).collect();
            for row in 0..rows {
                let like: f64 = (0..column).map(|c| mix[c] * matrix[(row, c)]).sum();
                matrix[(row, column)] = like + apart * matrix[(row, column)];
            }
        }
        matrix
    }

    fn pushed(parts: &[DMatrix<f64>; LANES]) -> Triangles<LANES> {
        let (rows, width) = parts[0].shape();
        let mut triangles = Triangles::new(width);
        for row in 0..rows {
            triangles.push((0..width).map(|c| std::array::from_fn(|lane| parts[lane][(row, c)])));
        }
        triangles
    }

    /// The same triangle but for its rows' signs, to so many roundings of each column.
    fn same(own: &DMatrix<f64>, whole: &DMatrix<f64>, label: &str) {
        let width = own.ncols();
        for column in 0..width {
            let length = whole.column(column).norm();
            for row in 0..width {
                let off = (own[(row, column)].abs() - whole[(row, column)].abs()).abs();
                assert!(off <= 1e-13 * length, "{label}: {off:e} of {length:e}");
            }
        }
    }

    /// Whatever the number of rows, and however alike the columns are.
    #[test]
    fn rows_one_by_one_say_what_the_whole_matrix_says() {
        for (seed, rows) in [1, 7, 63, 64, 65, 500, 1000].into_iter().enumerate() {
            for width in [1, 2, 5, 9] {
                for apart in [1.0, 1e-3, 1e-6] {
                    let label = format!("{rows} rows, {width} columns, {apart} apart");
                    let parts: [DMatrix<f64>; LANES] = std::array::from_fn(|lane| {
                        drawn((seed * LANES + lane) as u64, rows.max(width), width, apart)
                    });
                    for (own, part) in pushed(&parts).each().iter().zip(&parts) {
                        same(own, &part.clone().qr().r(), &label);
                    }
                    let rows = parts[0].nrows();
                    let whole = DMatrix::from_fn(LANES * rows, width, |row, column| {
                        parts[row % LANES][(row / LANES, column)]
                    });
                    same(&pushed(&parts).together(), &whole.qr().r(), &label);
                }
            }
        }
    }

    /// Empty columns and empty rows do no harm.
    #[test]
    fn nothing_stays_nothing() {
        let mut triangles = Triangles::<LANES>::new(3);
        for row in 0..100 {
            let row = f64::from(row);
            triangles.push([[0.0; LANES], [1.0, 0.0, 1.0, 0.0], [row, row, 0.0, 0.0]]);
        }
        for triangle in triangles.each() {
            assert!(triangle.iter().all(|x| x.is_finite()));
            assert_eq!(triangle.column(0).norm(), 0.0);
        }
    }
}
