//! Small dense kernels on panels of padded rows.
//!
//! A panel of `n` rows has rows of `stride` values, a multiple of [`LANES`], so that a row is whole
//! SIMD vectors on every machine; the padding is never read as a coefficient.

use super::block_size::BlockSize;
use pulp::Simd;

/// Values in the widest SIMD vector (AVX-512).
pub(super) const LANES: usize = 8;

/// The unit matrix, to select a lane.
const UNIT_ROWS: [[f64; LANES]; LANES] = {
    let mut rows = [[0.0; LANES]; LANES];
    let mut k = 0;
    while k < LANES {
        rows[k][k] = 1.0;
        k += 1;
    }
    rows
};

/// A pivot not larger than this part of what it was computed from is rounding error.
///
/// Sums of `n` terms err by about `n` roundings, so this allows chains of blocks up to some tens
/// of rows; a chain that holds only by 1e-14 of its stiffness is beyond double precision anyway.
pub(super) const VANISHED: f64 = 64.0 * f64::EPSILON;

/// A diagonal pivot is kept unless another one is larger by this factor: elimination cannot
/// amplify errors much and rows hardly ever move.
const KEEP_DIAGONAL: f64 = 1.0 / 16.0;

/// Length of a row of `n` values with its padding.
pub(super) fn padded(n: usize) -> usize {
    n.next_multiple_of(LANES)
}

/// Numbers from a 64 byte boundary on, so that no vector crosses a cache line.
#[derive(Debug)]
pub(super) struct Aligned {
    data: Vec<f64>,
    start: usize,
    length: usize,
}

impl Aligned {
    /// `length` zeros.
    pub(super) fn new(length: usize) -> Self {
        let data = vec![0.0; length + LANES];
        // The offset may be refused by contract (usize::MAX); unaligned is slower, not wrong.
        let start = data.as_ptr().align_offset(64).min(LANES);
        Self {
            data,
            start,
            length,
        }
    }
}

impl Clone for Aligned {
    fn clone(&self) -> Self {
        let mut copy = Self::new(self.length);
        copy.copy_from_slice(self);
        copy
    }
}

impl std::ops::Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.data[self.start..][..self.length]
    }
}

impl std::ops::DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.data[self.start..][..self.length]
    }
}

/// The whole vectors of a padded slice.
#[inline(always)]
pub(super) fn vectors<S: Simd>(values: &[f64]) -> &[S::f64s] {
    S::as_simd_f64s(values).0
}

/// The whole vectors of a padded slice.
#[inline(always)]
pub(super) fn vectors_mut<S: Simd>(values: &mut [f64]) -> &mut [S::f64s] {
    S::as_mut_simd_f64s(values).0
}

/// Writes the transpose of the `rows x columns` array `source` (row length `source_stride`) to
/// `target`, whose row `c` takes the column `c`.
#[inline(always)]
pub(super) fn transpose(
    target: &mut [f64],
    target_stride: usize,
    source: &[f64],
    source_stride: usize,
    (rows, columns): (usize, usize),
) {
    for r in 0..rows {
        let row = &source[r * source_stride..][..columns];
        for c in 0..columns {
            target[c * target_stride + r] = row[c];
        }
    }
}

/// `max(most, |value|)`. The library's magnitude is a complement that compilers do not inline into code for the
/// widest registers: a call for each of them.
#[inline(always)]
pub(super) fn larger<S: Simd>(simd: S, most: S::f64s, value: S::f64s) -> S::f64s {
    simd.max_f64s(most, simd.max_f64s(value, simd.neg_f64s(value)))
}

/// `scale[r] = max(scale[r], |panel[c][r]|)` over all rows `c` of a square panel.
#[inline(always)]
pub(super) fn raise<S: Simd>(simd: S, scale: &mut [f64], panel: &[f64], size: impl BlockSize) {
    let width = size.get().next_multiple_of(LANES) / S::F64_LANES;
    let scale = &mut vectors_mut::<S>(scale)[..width];
    let rows = &vectors::<S>(panel)[..size.get() * width];
    for j in 0..width {
        let mut largest = scale[j];
        for c in 0..size.get() {
            largest = larger(simd, largest, rows[c * width + j]);
        }
        scale[j] = largest;
    }
}

/// `target[c] += sum_k coefficient(k, c) * rows[k]` for the rows `c < columns` of `target`;
/// `depth` rows of the same padded length `stride`.
#[inline(always)]
pub(super) fn accumulate<S: Simd>(
    simd: S,
    target: &mut [f64],
    columns: usize,
    rows: &[f64],
    stride: usize,
    depth: impl BlockSize,
    coefficient: impl Fn(usize, usize) -> f64 + Copy,
) {
    let width = stride / S::F64_LANES;
    let rows = &vectors::<S>(rows)[..depth.get() * width];
    let target = &mut vectors_mut::<S>(target)[..columns * width];
    let mut first = 0;
    while first + 4 <= columns {
        tile::<S, 4>(simd, target, first, rows, width, depth, coefficient);
        first += 4;
    }
    if first + 2 <= columns {
        tile::<S, 2>(simd, target, first, rows, width, depth, coefficient);
        first += 2;
    }
    if first < columns {
        tile::<S, 1>(simd, target, first, rows, width, depth, coefficient);
    }
}

/// `TILE` rows of [`accumulate`], whose sums stay in registers.
#[inline(always)]
fn tile<S: Simd, const TILE: usize>(
    simd: S,
    target: &mut [S::f64s],
    first: usize,
    rows: &[S::f64s],
    width: usize,
    depth: impl BlockSize,
    coefficient: impl Fn(usize, usize) -> f64 + Copy,
) {
    let target = &mut target[first * width..][..TILE * width];
    for j in 0..width {
        let mut sums = [simd.splat_f64s(0.0); TILE];
        for c in 0..TILE {
            sums[c] = target[c * width + j];
        }
        for k in 0..depth.get() {
            let row = rows[k * width + j];
            for c in 0..TILE {
                let factor = simd.splat_f64s(coefficient(k, first + c));
                sums[c] = simd.mul_add_e_f64s(factor, row, sums[c]);
            }
        }
        for c in 0..TILE {
            target[c * width + j] = sums[c];
        }
    }
}

/// `target = sum_k coefficients[k] * rows[k]`, one padded row as target.
#[inline(always)]
pub(super) fn multiply_vector<S: Simd>(
    simd: S,
    target: &mut [f64],
    rows: &[f64],
    coefficients: &[f64],
) {
    for value in vectors_mut::<S>(target) {
        *value = simd.splat_f64s(0.0);
    }
    accumulate_vector(simd, target, rows, coefficients);
}

/// `target += sum_k coefficients[k] * rows[k]`, one padded row as target.
#[inline(always)]
pub(super) fn accumulate_vector<S: Simd>(
    simd: S,
    target: &mut [f64],
    rows: &[f64],
    coefficients: &[f64],
) {
    let target = vectors_mut::<S>(target);
    let width = target.len();
    let rows = vectors::<S>(rows);
    for j in 0..width {
        // Several sums shorten the wait for the previous multiplication.
        let zero = simd.splat_f64s(0.0);
        let mut sums = [target[j], zero, zero, zero];
        let quadruples = coefficients.chunks_exact(4);
        let rest = quadruples.remainder();
        let done = coefficients.len() - rest.len();
        for (quadruple, coefficients) in quadruples.enumerate() {
            for (k, coefficient) in coefficients.iter().enumerate() {
                let row = rows[(4 * quadruple + k) * width + j];
                sums[k] = simd.mul_add_e_f64s(simd.splat_f64s(*coefficient), row, sums[k]);
            }
        }
        for (k, coefficient) in rest.iter().enumerate() {
            let row = rows[(done + k) * width + j];
            sums[k] = simd.mul_add_e_f64s(simd.splat_f64s(*coefficient), row, sums[k]);
        }
        let [first, second, third, fourth] = sums;
        target[j] = simd.add_f64s(simd.add_f64s(second, third), simd.add_f64s(first, fourth));
    }
}

/// Replaces a square panel by minus its inverse (sweep operator, one row at a time).
///
/// The columns of the panel carry the names in the error: column `k` fails if all its candidates
/// for a pivot are below [`VANISHED`] times `scale[k]`. `swaps` is scratch.
#[inline(always)]
pub(super) fn negative_inverse<S: Simd>(
    simd: S,
    panel: &mut [f64],
    size: impl BlockSize,
    scale: &[f64],
    swaps: &mut [usize],
) -> Result<(), usize> {
    let n = size.get();
    let stride = n.next_multiple_of(LANES);
    let panel = &mut panel[..n * stride];
    let swaps = &mut swaps[..n];
    let mut swapped = false;
    for k in 0..n {
        let mut largest = 0.0;
        for i in k + 1..n {
            let candidate = panel[i * stride + k].abs();
            largest = if candidate > largest {
                candidate
            } else {
                largest
            };
        }
        swaps[k] = k;
        // A branch that is hardly ever taken keeps the search out of the way of the sweep.
        if panel[k * stride + k].abs() < KEEP_DIAGONAL * largest {
            swapped = true;
            swaps[k] = bring_up_largest(panel, stride, k);
        }
        let pivot = panel[k * stride + k];
        if pivot.is_nan() || pivot.abs() <= VANISHED * scale[k] {
            return Err(k);
        }
        sweep(simd, panel, k, size);
    }
    if swapped {
        // The inverse of a matrix with swapped rows has swapped columns.
        for k in (0..n).rev() {
            if swaps[k] != k {
                for row in panel.chunks_exact_mut(stride) {
                    row.swap(k, swaps[k]);
                }
            }
        }
    }
    Ok(())
}

/// Swaps the row with the largest entry of column `k` below the diagonal with row `k`.
#[cold]
#[inline(never)]
fn bring_up_largest(panel: &mut [f64], stride: usize, k: usize) -> usize {
    let mut largest = k;
    for i in k + 1..panel.len() / stride {
        if panel[i * stride + k].abs() > panel[largest * stride + k].abs() {
            largest = i;
        }
    }
    if largest != k {
        swap_rows(panel, stride, k, largest);
    }
    largest
}

/// Swaps two rows of a panel.
pub(super) fn swap_rows(panel: &mut [f64], stride: usize, first: usize, second: usize) {
    let (upper, lower) = panel.split_at_mut(second * stride);
    upper[first * stride..][..stride].swap_with_slice(&mut lower[..stride]);
}

/// Sweeps a square panel on its diagonal entry `k`:
/// `a_kk -> -1/a_kk, a_kj -> a_kj/a_kk, a_ik -> a_ik/a_kk, a_ij -> a_ij - a_ik a_kj/a_kk`.
#[inline(always)]
pub(super) fn sweep<S: Simd>(simd: S, panel: &mut [f64], k: usize, size: impl BlockSize) {
    let n = size.get();
    let stride = n.next_multiple_of(LANES);
    let width = stride / S::F64_LANES;
    let inverse = simd.splat_f64s(1.0 / panel[k * stride + k]);
    // The lane of column k in its vector: a scalar store there would delay the next vector load.
    let vector = k / S::F64_LANES;
    let lanes = vectors::<S>(&UNIT_ROWS[k % LANES])[k % LANES / S::F64_LANES];
    let lane = simd.equal_f64s(lanes, simd.splat_f64s(1.0));
    let replace = |j: usize, value: f64, row: S::f64s| {
        if j == vector {
            simd.select_f64s(lane, simd.splat_f64s(value), row)
        } else {
            row
        }
    };
    let (before, rest) = panel.split_at_mut(k * stride);
    let (pivot_row, after) = rest.split_at_mut(stride);
    let pivot_row = vectors_mut::<S>(pivot_row);
    for j in 0..width {
        pivot_row[j] = simd.mul_f64s(replace(j, -1.0, pivot_row[j]), inverse);
    }
    for row in (before.chunks_exact_mut(stride)).chain(after.chunks_exact_mut(stride)) {
        let factor = simd.splat_f64s(-row[k]);
        let row = vectors_mut::<S>(row);
        for j in 0..width {
            row[j] = simd.mul_add_e_f64s(factor, pivot_row[j], replace(j, 0.0, row[j]));
        }
    }
}
