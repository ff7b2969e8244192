//! Count, mean and sum of squares about the mean of many numbers, taken some at a time without the loss of digits of a
//! plain sum of squares (T. F. Chan, G. H. Golub, R. J. LeVeque, *The American Statistician* 37, 242, 1983).

/// Moments of the numbers so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: f64,
    mean: f64,
    squares: f64,
}

/// Running sums, which the compiler keeps in vector registers.
const SUMS: usize = 16;

impl Moments {
    /// Takes more numbers.
    pub fn add(&mut self, some: &[f64]) {
        if some.is_empty() {
            return;
        }
        let count = some.len() as f64;
        let mean = sum(some, |x| x) / count;
        let squares = sum(some, |x| (x - mean) * (x - mean));
        let all = self.count + count;
        let apart = mean - self.mean;
        self.mean += apart * count / all;
        self.squares += squares + apart * apart * self.count * count / all;
        self.count = all;
    }

    /// Sum of the squares about the mean.
    pub fn squares_about_mean(&self) -> f64 {
        self.squares
    }

    /// Sum of the squares about a number.
    pub fn squares_about(&self, middle: f64) -> f64 {
        let apart = self.mean - middle;
        self.squares + apart * apart * self.count
    }
}

fn sum(values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let (rows, rest) = values.as_chunks::<SUMS>();
    let mut sums = [0.0; SUMS];
    for row in rows {
        for (sum, &value) in sums.iter_mut().zip(row) {
            *sum += of(value);
        }
    }
    sums.iter().sum::<f64>() + rest.iter().map(|&value| of(value)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng;

    /// However far from zero they lie, and in whatever parts they come.
    #[test]
    fn it_is_that_of_all_numbers_together() {
        let mut generator = rng::seeded(3);
        for far in [0.0, 1.0, 1e6] {
            for parts in [1, 7, 64, 1000] {
                let values: Vec<f64> = (0..5000)
                    .map(|_| far + rng::uniform::<f64>(&mut generator))
                    .collect();
                let mut moments = Moments::default();
                values.chunks(parts).for_each(|some| moments.add(some));
                let mean = values.iter().map(|x| x - far).sum::<f64>() / 5000.0 + far;
                for (own, middle) in [
                    (moments.squares_about_mean(), mean),
                    (moments.squares_about(0.5), 0.5),
                ] {
                    let squares: f64 = values.iter().map(|x| (x - middle).powi(2)).sum();
                    let off = (own / squares - 1.0).abs();
                    assert!(off < 1e-9, "{far} far, {parts} at a time: {off:e}");
                }
            }
        }
    }
}
