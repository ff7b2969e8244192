//! The Gauss-Newton step within the unit cube.

use nalgebra::{DMatrix, DVector};

/// The step that solves `matrix · step = pull` within the `room` of each coordinate. One that would leave it
/// goes to the wall, and the others are solved for again beside it: merely cut off, a step along a valley
/// that slants across a wall would climb the valley's side.
pub fn within(
    matrix: &DMatrix<f64>,
    pull: &DVector<f64>,
    room: &[(f64, f64)],
) -> Option<DVector<f64>> {
    let mut step = DVector::zeros(pull.len());
    let mut free: Vec<usize> = (0..pull.len()).collect();
    loop {
        let walled = pull - matrix * &step;
        let rest = DVector::from_iterator(free.len(), free.iter().map(|&i| walled[i]));
        let part = DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])]);
        let solved = part.cholesky()?.solve(&rest);
        let outside = |&i: &usize, &s: &f64| s < room[i].0 || s > room[i].1;
        if !free.iter().zip(solved.iter()).any(|(i, s)| outside(i, s)) {
            for (&i, s) in free.iter().zip(solved.iter()) {
                step[i] = *s;
            }
            return Some(step);
        }
        let mut inside = Vec::with_capacity(free.len());
        for (&i, s) in free.iter().zip(solved.iter()) {
            if outside(&i, s) {
                step[i] = s.clamp(room[i].0, room[i].1);
            } else {
                inside.push(i);
            }
        }
        free = inside;
    }
}
