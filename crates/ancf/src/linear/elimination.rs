//! The elimination of the sections one after the other; [`super::cyclic`] has the equations.

use super::block_size::BlockSize;
use super::factor::{Front, Sizes, Slab};
use super::kernel::{
    Aligned, LANES, accumulate, larger, negative_inverse, raise, transpose, vectors, vectors_mut,
};
use super::tail::Tail;
use super::{BorderedMatrix, Structure};
use pulp::{Simd, WithSimd};

/// Factors `matrix` into `factors` and `dense`; fails with the row that has no pivot.
pub(super) struct Elimination<'a, B> {
    pub(super) matrix: &'a BorderedMatrix,
    pub(super) size: B,
    pub(super) sizes: Sizes,
    pub(super) factors: &'a mut Aligned,
    pub(super) front: &'a mut Front,
    pub(super) dense: &'a mut Tail,
}

impl<B: BlockSize> WithSimd for Elimination<'_, B> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<(), usize> {
        let Self {
            matrix,
            size,
            sizes,
            factors,
            front,
            dense,
        } = self;
        let b = size.get();
        let structure = matrix.structure();
        let last = structure.sections - 1;
        let step = Step {
            simd,
            matrix,
            structure,
            size,
            sizes,
        };
        step.start_corner(front);
        let mut slabs = (factors.chunks_exact_mut(sizes.slab).take(last))
            .map(|slab| Slab::split(slab, b, step.stride(), sizes));
        let mut next = slabs.next();
        if let Some(slab) = &mut next {
            step.load(0, slab);
        }
        let mut done: Option<Slab> = None;
        let mut section = 0;
        while let Some(mut slab) = next.take() {
            // The next section is loaded now: vector loads soon after its scalar stores would wait.
            next = slabs.next();
            if let Some(slab) = &mut next {
                step.load(section + 1, slab);
            }
            front.scale.fill(0.0);
            raise(simd, &mut front.scale, slab.inverse, size);
            if let Some(previous) = &done {
                step.add_update(previous, &mut slab);
                raise(simd, &mut front.scale, slab.inverse, size);
            }
            negative_inverse(simd, slab.inverse, size, &front.scale, &mut front.swaps)
                .map_err(|row| section * b + row)?;
            step.eliminate(section, &mut slab, front);
            done = Some(slab);
            section += 1;
        }
        if !structure.closed {
            // The last section is no part of the tail so far.
            step.take_last_section(done.as_ref(), dense);
        }
        step.take_corner(front, dense);
        dense.invert(simd).map_err(|row| last * b + row)
    }
}

/// The parts of a step, for one matrix on one kind of machine.
struct Step<'a, S, B> {
    simd: S,
    matrix: &'a BorderedMatrix,
    structure: Structure,
    size: B,
    sizes: Sizes,
}

impl<S: Simd, B: BlockSize> Step<'_, S, B> {
    /// Length of a padded row of a block.
    #[inline(always)]
    fn stride(&self) -> usize {
        self.size.get().next_multiple_of(LANES)
    }

    /// Where the border begins in the tail.
    #[inline(always)]
    fn border_start(&self) -> usize {
        self.sizes.tail - self.structure.border
    }

    /// The tail as the matrix has it.
    #[inline(always)]
    fn start_corner(&self, front: &mut Front) {
        let (b, border) = (self.size.get(), self.structure.border);
        let stride = self.sizes.tail_stride;
        let corner = &mut *front.corner;
        if self.structure.closed {
            let last = self.structure.sections - 1;
            let rows = self.matrix.section_rows(last);
            transpose(corner, stride, &rows[b..], 3 * b, (b, b));
            let columns = self.matrix.section_border_columns(last);
            transpose(
                &mut corner[b * stride..],
                stride,
                columns,
                border,
                (b, border),
            );
            let rows = self.matrix.section_border_rows(last);
            for c in 0..b {
                corner[c * stride + b..][..border].copy_from_slice(&rows[c * border..][..border]);
            }
        }
        let start = self.border_start();
        for c in 0..border {
            for r in 0..border {
                corner[(start + c) * stride + start + r] = self.matrix.corner()[r * border + c];
            }
        }
        for (magnitude, value) in front.magnitude.iter_mut().zip(&*front.corner) {
            *magnitude = value.abs();
        }
    }

    /// `D`, `F` (in the place of `U`), `R` of a section and `P` of the next as the matrix has them.
    #[inline(always)]
    fn load(&self, section: usize, slab: &mut Slab) {
        let (b, border) = (self.size.get(), self.structure.border);
        let (stride, tail_stride) = (self.stride(), self.sizes.tail_stride);
        let start = self.border_start();
        let rows = self.matrix.section_rows(section);
        transpose(slab.inverse, stride, &rows[b..], 3 * b, (b, b));
        slab.upper_tail[..start * stride].fill(0.0);
        let border_columns = self.matrix.section_border_columns(section);
        transpose(
            &mut slab.upper_tail[start * stride..],
            stride,
            border_columns,
            border,
            (b, border),
        );
        let border_rows = self.matrix.section_border_rows(section);
        for c in 0..b {
            let row = &mut slab.lower_tail[c * tail_stride..][..tail_stride];
            row[..start].fill(0.0);
            row[start..][..border].copy_from_slice(&border_rows[c * border..][..border]);
        }
        if self.structure.closed && section == 0 {
            transpose(slab.upper_tail, stride, rows, 3 * b, (b, b));
            let rows = self.matrix.section_rows(self.structure.sections - 1);
            transpose(slab.lower_tail, tail_stride, &rows[2 * b..], 3 * b, (b, b));
        }
        let next_rows = self.matrix.section_rows(section + 1);
        if self.has_next(section) {
            transpose(slab.lower_next, stride, next_rows, 3 * b, (b, b));
        } else {
            // The next section is the last one of a closed chain and belongs to the tail.
            slab.lower_next.fill(0.0);
            transpose(slab.lower_tail, tail_stride, next_rows, 3 * b, (b, b));
            transpose(slab.upper_tail, stride, &rows[2 * b..], 3 * b, (b, b));
        }
    }

    /// Adds what the elimination of the section before does to `D`, `F`, `R`.
    #[inline(always)]
    fn add_update(&self, previous: &Slab, slab: &mut Slab) {
        let (b, tail) = (self.size.get(), self.sizes.tail);
        let (stride, tail_stride) = (self.stride(), self.sizes.tail_stride);
        let next = |k: usize, c: usize| previous.upper_next[c * stride + k];
        let far = |k: usize, c: usize| previous.upper_tail[c * stride + k];
        let (rows, tail_rows) = (&*previous.lower_next, &*previous.lower_tail);
        accumulate(self.simd, slab.inverse, b, rows, stride, self.size, next);
        accumulate(
            self.simd,
            slab.upper_tail,
            tail,
            rows,
            stride,
            self.size,
            far,
        );
        accumulate(
            self.simd,
            slab.lower_tail,
            b,
            tail_rows,
            tail_stride,
            self.size,
            next,
        );
    }

    /// `U` of a section and the update of the tail.
    #[inline(always)]
    fn eliminate(&self, section: usize, slab: &mut Slab, front: &mut Front) {
        let simd = self.simd;
        let (b, tail) = (self.size.get(), self.sizes.tail);
        let (stride, tail_stride) = (self.stride(), self.sizes.tail_stride);
        let inverse = &*slab.inverse;
        slab.upper_next.fill(0.0);
        if self.has_next(section) {
            let rows = self.matrix.section_rows(section);
            accumulate(
                simd,
                slab.upper_next,
                b,
                inverse,
                stride,
                self.size,
                |k, c| rows[k * 3 * b + 2 * b + c],
            );
        }
        front.columns.copy_from_slice(slab.upper_tail);
        slab.upper_tail.fill(0.0);
        accumulate(
            simd,
            slab.upper_tail,
            tail,
            inverse,
            stride,
            self.size,
            |k, c| front.columns[c * stride + k],
        );
        let far = |k: usize, c: usize| slab.upper_tail[c * stride + k];
        accumulate(
            simd,
            &mut front.corner,
            tail,
            slab.lower_tail,
            tail_stride,
            self.size,
            far,
        );
        let magnitudes = vectors_mut::<S>(&mut front.magnitude);
        for (magnitude, value) in magnitudes.iter_mut().zip(vectors::<S>(&front.corner)) {
            *magnitude = larger(simd, *magnitude, *value);
        }
    }

    /// Whether the section after is a section of its own, not the one in the tail.
    #[inline(always)]
    fn has_next(&self, section: usize) -> bool {
        !self.structure.closed || section + 2 < self.structure.sections
    }

    /// Open chains: the last section with what the elimination of the one before does to it.
    #[inline(always)]
    fn take_last_section(&self, previous: Option<&Slab>, dense: &mut Tail) {
        let (b, border) = (self.size.get(), self.structure.border);
        let last = self.structure.sections - 1;
        let rows = self.matrix.section_rows(last);
        let border_columns = self.matrix.section_border_columns(last);
        let border_rows = self.matrix.section_border_rows(last);
        // Once a factorisation: plain sums, no panels.
        let (stride, tail_stride) = (self.stride(), self.sizes.tail_stride);
        let product = |lower: &[f64], lower_stride: usize, r: usize, upper: &[f64], c: usize| {
            (0..b)
                .map(|k| lower[k * lower_stride + r] * upper[c * stride + k])
                .sum::<f64>()
        };
        let mut set = |r: usize, c: usize, start: f64, update: f64| {
            dense.set(r, c, start + update, start.abs().max(update.abs()));
        };
        for r in 0..b {
            for c in 0..b {
                let update = previous.map_or(0.0, |previous| {
                    product(previous.lower_next, stride, r, previous.upper_next, c)
                });
                set(r, c, rows[r * 3 * b + b + c], update);
            }
            for k in 0..border {
                let (column, row) = previous.map_or((0.0, 0.0), |previous| {
                    (
                        product(previous.lower_next, stride, r, previous.upper_tail, k),
                        product(previous.lower_tail, tail_stride, k, previous.upper_next, r),
                    )
                });
                set(r, b + k, border_columns[r * border + k], column);
                set(b + k, r, border_rows[r * border + k], row);
            }
        }
    }

    /// The tail, as the elimination left it, becomes the end of the dense one.
    #[inline(always)]
    fn take_corner(&self, front: &Front, dense: &mut Tail) {
        let Sizes {
            tail, tail_stride, ..
        } = self.sizes;
        let first = self.size.get() + self.structure.border - tail;
        for c in 0..tail {
            for r in 0..tail {
                let place = c * tail_stride + r;
                dense.set(
                    first + r,
                    first + c,
                    front.corner[place],
                    front.magnitude[place],
                );
            }
        }
    }
}
