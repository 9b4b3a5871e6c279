//! The dense end of the elimination: the last section and the border.

use super::block_size::Dynamic;
use super::kernel::{
    Aligned, VANISHED, accumulate_vector, larger, padded, swap_rows, sweep, vectors, vectors_mut,
};
use pulp::Simd;

/// What the elimination leaves of the last section and the border, `size x size`.
///
/// Multipliers and bodies mix units here, so a pivot is judged against the largest number it was
/// computed from, entry by entry: the test does not depend on the scale of rows and columns.
#[derive(Clone, Debug)]
pub(super) struct Tail {
    size: usize,
    /// Length of a row of the panels below.
    stride: usize,
    /// The matrix by columns (row `c` of the panel is column `c`), then minus its inverse.
    entries: Aligned,
    /// The largest magnitude each entry passed through.
    magnitude: Aligned,
    swaps: Vec<usize>,
    column_scale: Vec<f64>,
}

impl Tail {
    pub(super) fn new(size: usize) -> Self {
        let stride = padded(size);
        Self {
            size,
            stride,
            entries: Aligned::new(size * stride),
            magnitude: Aligned::new(size * stride),
            swaps: vec![0; size],
            column_scale: vec![0.0; size],
        }
    }

    /// Sets an entry that came to be from terms up to `magnitude`.
    #[inline(always)]
    pub(super) fn set(&mut self, row: usize, column: usize, value: f64, magnitude: f64) {
        self.entries[column * self.stride + row] = value;
        self.magnitude[column * self.stride + row] = magnitude;
    }

    /// Replaces the matrix by minus its inverse, or names the row that has no pivot.
    #[inline(always)]
    pub(super) fn invert<S: Simd>(&mut self, simd: S) -> Result<(), usize> {
        let (n, stride) = (self.size, self.stride);
        for (scale, magnitudes) in
            (self.column_scale.iter_mut()).zip(self.magnitude.chunks_exact(stride))
        {
            *scale = magnitudes
                .iter()
                .fold(0.0, |largest: f64, m| largest.max(*m));
        }
        for k in 0..n {
            let pivot = self.pivot(k).ok_or(k)?;
            self.swaps[k] = pivot;
            if pivot != k {
                swap_rows(&mut self.entries, stride, k, pivot);
                swap_rows(&mut self.magnitude, stride, k, pivot);
                self.column_scale.swap(k, pivot);
            }
            self.raise_magnitude(simd, k);
            sweep(simd, &mut self.entries, k, Dynamic(n));
        }
        for k in (0..n).rev() {
            if self.swaps[k] != k {
                for row in self.entries.chunks_exact_mut(stride) {
                    row.swap(k, self.swaps[k]);
                }
            }
        }
        Ok(())
    }

    /// Replaces the right-hand side (padded) by the solution in `solution`.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&self, simd: S, right: &[f64], solution: &mut [f64]) {
        let solution = &mut solution[..self.stride];
        solution.fill(0.0);
        accumulate_vector(simd, solution, &self.entries, &right[..self.size]);
        for value in vectors_mut::<S>(solution) {
            *value = simd.neg_f64s(*value);
        }
    }

    /// The column to eliminate with row `k`: the largest entry relative to its column, among
    /// those that are more than rounding error.
    #[inline(always)]
    fn pivot(&self, k: usize) -> Option<usize> {
        let mut best = None;
        let mut largest = 0.0;
        for column in k..self.size {
            let place = column * self.stride + k;
            let value = self.entries[place].abs();
            let relative = value / self.column_scale[column];
            if value > VANISHED * self.magnitude[place] && relative > largest {
                largest = relative;
                best = Some(column);
            }
        }
        best
    }

    /// Notes the terms that the sweep on `k` is about to subtract.
    #[inline(always)]
    fn raise_magnitude<S: Simd>(&mut self, simd: S, k: usize) {
        let stride = self.stride;
        let inverse = 1.0 / self.entries[k * stride + k];
        for column in k + 1..self.size {
            let factor = simd.splat_f64s(self.entries[column * stride + k] * inverse);
            let pivot_row = vectors::<S>(&self.entries[k * stride..][..stride]);
            let magnitude = vectors_mut::<S>(&mut self.magnitude[column * stride..][..stride]);
            for (magnitude, value) in magnitude.iter_mut().zip(pivot_row) {
                *magnitude = larger(simd, *magnitude, simd.mul_f64s(factor, *value));
            }
        }
    }
}
