//! Block elimination along the chain (first version: dense, replaced by the elimination).

use super::{BorderedMatrix, Singular, Solver, Structure};

/// Dense Gauss-Jordan inverse.
#[derive(Clone, Debug)]
pub struct CyclicSolver {
    structure: Structure,
    inverse: Vec<f64>,
    scratch: Vec<f64>,
}

impl CyclicSolver {
    /// Allocates for matrices of this structure.
    pub fn new(structure: Structure) -> Self {
        structure.check();
        let n = structure.size();
        Self {
            structure,
            inverse: vec![0.0; n * n],
            scratch: vec![0.0; n],
        }
    }
}

impl Solver for CyclicSolver {
    fn factor(&mut self, matrix: &BorderedMatrix) -> Result<(), Singular> {
        assert_eq!(matrix.structure(), self.structure, "another structure");
        let n = self.structure.size();
        let a = &mut self.inverse;
        a.fill(0.0);
        for (i, j, v) in matrix.triplets() {
            a[i * n + j] += v;
        }
        let scale: Vec<f64> = a
            .chunks(n)
            .map(|r| r.iter().fold(0.0, |m: f64, v| m.max(v.abs())))
            .collect();
        let mut swaps = vec![0; n];
        // Rows keep their names in `order`.
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let mut p = k;
            for r in k..n {
                if a[r * n + k].abs() > a[p * n + k].abs() {
                    p = r;
                }
            }
            swaps[k] = p;
            order.swap(k, p);
            if p != k {
                for c in 0..n {
                    a.swap(k * n + c, p * n + c);
                }
            }
            let pivot = a[k * n + k];
            let vanished = pivot.is_nan() || pivot.abs() <= 1e-14 * scale[order[k]];
            if vanished {
                return Err(Singular { row: k });
            }
            a[k * n + k] = 1.0;
            for c in 0..n {
                a[k * n + c] /= pivot;
            }
            for r in 0..n {
                if r != k {
                    let f = a[r * n + k];
                    a[r * n + k] = 0.0;
                    for c in 0..n {
                        a[r * n + c] -= f * a[k * n + c];
                    }
                }
            }
        }
        for k in (0..n).rev() {
            if swaps[k] != k {
                for r in 0..n {
                    a.swap(r * n + k, r * n + swaps[k]);
                }
            }
        }
        Ok(())
    }

    fn solve(&mut self, x: &mut [f64]) {
        let n = self.structure.size();
        assert_eq!(x.len(), n, "another length");
        self.scratch.copy_from_slice(x);
        for (value, row) in x.iter_mut().zip(self.inverse.chunks(n)) {
            *value = row.iter().zip(&self.scratch).map(|(a, b)| a * b).sum();
        }
    }
}
