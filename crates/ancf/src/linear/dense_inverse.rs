//! The whole inverse of a small constant matrix.

use super::Solver;
use super::kernel::{Aligned, accumulate_vector, padded};
use pulp::{Arch, Simd, WithSimd};

/// Most unknowns for which the product with the whole inverse costs less than block elimination: that walks from
/// section to section, each waiting for the one before, where the product of `n²` terms waits for nothing.
const MOST: usize = 64;

/// The inverse of a matrix, by columns.
///
/// For constant linear constraints this is the projected inverse mass of Kerkkänen (2006, 3.28), computed once.
#[derive(Clone, Debug)]
pub struct DenseInverse {
    size: usize,
    stride: usize,
    columns: Aligned,
    product: Aligned,
}

impl DenseInverse {
    /// The inverse of the matrix of `size` unknowns that `solver` has factored; nothing where a factor is quicker.
    pub fn new(solver: &mut impl Solver, size: usize) -> Option<Self> {
        if size > MOST {
            return None;
        }
        let stride = padded(size);
        let mut columns = Aligned::new(size * stride);
        for (k, column) in columns.chunks_exact_mut(stride).enumerate() {
            column[k] = 1.0;
            solver.solve(&mut column[..size]);
        }
        Some(Self {
            size,
            stride,
            columns,
            product: Aligned::new(stride),
        })
    }

    /// Writes the solution for the right-hand side `right` to `solution`.
    pub fn solve(&mut self, right: &[f64], solution: &mut [f64]) {
        self.product.fill(0.0);
        Arch::new().dispatch(Product {
            columns: &self.columns,
            x: &right[..self.size],
            sum: &mut self.product[..self.stride],
        });
        solution.copy_from_slice(&self.product[..self.size]);
    }
}

struct Product<'a> {
    columns: &'a [f64],
    x: &'a [f64],
    sum: &'a mut [f64],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        accumulate_vector(simd, self.sum, self.columns, self.x);
    }
}
