//! temporary
use super::{Evaluator, Solver};
use nalgebra::{DMatrix, DVector};

/// LM
#[derive(Default)]
pub struct LmQuick;

impl Solver for LmQuick {
    fn name(&self) -> &'static str {
        "lm"
    }
    fn search(&self, ev: &mut Evaluator<'_>, _seed: u64) {
        let n = ev.dim();
        let mut x = ev.objective().start().unwrap_or_else(|| vec![0.5; n]);
        let mut eval = |x: &[f64]| -> Option<DVector<f64>> {
            if ev.left() == 0 {
                return None;
            }
            let (r, c) = ev.objective().residuals_and_cost(x)?;
            ev.record(x, c);
            Some(DVector::from_vec(r))
        };
        let Some(mut r) = eval(&x) else { return };
        let mut lambda = 1e-3;
        for _ in 0..50 {
            let mut jac = DMatrix::zeros(r.len(), n);
            for k in 0..n {
                let h = if x[k] < 0.5 { 1e-6 } else { -1e-6 };
                let mut y = x.clone();
                y[k] += h;
                let Some(s) = eval(&y) else { return };
                jac.set_column(k, &((s - &r) / h));
            }
            let g = jac.tr_mul(&r);
            let hess = jac.tr_mul(&jac);
            let mut improved = false;
            for _ in 0..12 {
                let mut a = hess.clone();
                for k in 0..n {
                    a[(k, k)] *= 1.0 + lambda;
                    a[(k, k)] += 1e-300;
                }
                let Some(ch) = a.cholesky() else {
                    lambda *= 10.0;
                    continue;
                };
                let d = ch.solve(&g);
                let y: Vec<f64> = (0..n).map(|k| (x[k] - d[k]).clamp(0.0, 1.0)).collect();
                let Some(s) = eval(&y) else { return };
                if s.norm_squared() < r.norm_squared() {
                    let gain = 1.0 - s.norm_squared() / r.norm_squared();
                    x = y;
                    r = s;
                    lambda = (lambda * 0.1f64).max(1e-12);
                    improved = true;
                    if gain < 1e-9 {
                        return;
                    }
                    break;
                }
                lambda *= 10.0;
            }
            if !improved {
                return;
            }
        }
    }
}
