//! Block elimination along the chain.
//!
//! Section after section is eliminated; the last section and the border stay to the end and form
//! the dense tail. With `P, D, N` the blocks of a section (see [`super`]), `F` its columns and `R`
//! the rows of the tail on it, `T` the tail itself, eliminating section `i` gives
//!
//! ```text
//! U_i = D_i^-1 [N_i F_i],    L_i = [P_i+1; R_i]
//! | D_i+1 F_i+1 |    | D_i+1 F_i+1 |
//! | R_i+1 T     | <- | R_i+1 T     | - L_i U_i
//! ```
//!
//! In a closed chain the first and the last but one section couple to the last one, hence `F` and
//! `R` hold its block too. Keeping the last section for the tail in open chains as well costs
//! nothing and lets multipliers of the border hold a chain that is otherwise free: the others are
//! eliminated as if the last were held.
//!
//! Blocks pivot within themselves only, which suits mass-shifted and constrained stiffness
//! matrices. Everything is stored by columns, so that the inner loops run along rows of padded
//! panels, and with the sign of `U` turned so that every loop is a sum of products. Inverses of
//! the diagonal blocks are stored: a solve is products only.

use super::block_size::{BlockSize, with_block_size};
use super::kernel::{
    Aligned, LANES, accumulate, accumulate_vector, multiply_vector, negative_inverse, padded,
    raise, transpose, vectors, vectors_mut,
};
use super::tail::Tail;
use super::{BorderedMatrix, Singular, Solver, Structure};
use pulp::{Arch, Simd, WithSimd};

/// Direct solver for [`BorderedMatrix`], linear in the number of sections, without allocation
/// after [`CyclicSolver::new`].
///
/// Factor: about `sections * (7 b³ + 6 b² t + b t²)` fused multiplications for blocks of `b` and a
/// tail of `t = border` (open) or `t = b + border` (closed) unknowns; solve: `sections * (3 b² + 2 b t)`.
#[derive(Clone, Debug)]
pub struct CyclicSolver {
    structure: Structure,
    sizes: Sizes,
    /// One slab per section, see [`Slab`].
    factors: Aligned,
    /// Minus the columns `F` of the section being eliminated: `tail` rows of a padded block.
    columns: Aligned,
    /// The tail `T` being formed by columns, and the largest magnitude of each of its entries.
    corner: Aligned,
    magnitude: Aligned,
    dense: Tail,
    /// Row scale of the section being eliminated, and its row swaps.
    scale: Aligned,
    swaps: Vec<usize>,
    /// Sections of a right-hand side, padded, and its tail.
    chain_right: Aligned,
    tail_right: Aligned,
    /// Its solution likewise.
    chain_solution: Aligned,
    tail_solution: Aligned,
}

/// Lengths of blocks and rows.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    /// Unknowns that all sections may couple to: the border, and the last section if closed.
    tail: usize,
    tail_stride: usize,
    /// Values of a slab.
    slab: usize,
}

/// The stored factor of a section; panels of rows padded to `b' = padded(b)`, `t' = padded(t)`.
struct Slab<'a> {
    /// Minus the inverse of `D`, by columns: `b x b'`.
    inverse: &'a mut [f64],
    /// `P` of the next section, by columns: `b x b'`.
    lower_next: &'a mut [f64],
    /// `R`, by columns: `b x t'`.
    lower_tail: &'a mut [f64],
    /// `-D^-1 N`, by columns: `b x b'`.
    upper_next: &'a mut [f64],
    /// `-D^-1 F`, by columns: `t x b'`.
    upper_tail: &'a mut [f64],
}

impl<'a> Slab<'a> {
    #[inline(always)]
    fn split(slab: &'a mut [f64], b: usize, stride: usize, sizes: Sizes) -> Self {
        let (inverse, rest) = slab.split_at_mut(b * stride);
        let (lower_next, rest) = rest.split_at_mut(b * stride);
        let (upper_next, rest) = rest.split_at_mut(b * stride);
        let (lower_tail, rest) = rest.split_at_mut(b * sizes.tail_stride);
        let (upper_tail, _) = rest.split_at_mut(sizes.tail * stride);
        Self {
            inverse,
            lower_next,
            lower_tail,
            upper_next,
            upper_tail,
        }
    }
}

impl CyclicSolver {
    /// Allocates everything for matrices of this structure.
    ///
    /// # Panics
    /// If the structure has no sections, no unknowns per section, or is closed with fewer than
    /// 3 sections.
    pub fn new(structure: Structure) -> Self {
        structure.check();
        let Structure {
            sections,
            block,
            closed,
            border,
        } = structure;
        let stride = padded(block);
        let tail = if closed { block + border } else { border };
        let tail_stride = padded(tail);
        let slab = (3 * block + tail) * stride + block * tail_stride;
        let dense_stride = padded(block + border);
        Self {
            structure,
            sizes: Sizes {
                tail,
                tail_stride,
                slab,
            },
            factors: Aligned::new(sections * slab),
            columns: Aligned::new(tail * stride),
            corner: Aligned::new(tail * tail_stride),
            magnitude: Aligned::new(tail * tail_stride),
            dense: Tail::new(block + border),
            scale: Aligned::new(stride),
            swaps: vec![0; block],
            chain_right: Aligned::new(sections * stride),
            tail_right: Aligned::new(dense_stride),
            chain_solution: Aligned::new(sections * stride),
            tail_solution: Aligned::new(dense_stride),
        }
    }
}

impl Solver for CyclicSolver {
    fn factor(&mut self, matrix: &BorderedMatrix) -> Result<(), Singular> {
        assert_eq!(
            matrix.structure(),
            self.structure,
            "the solver was made for another structure"
        );
        with_block_size!(self.structure.block, size => Arch::new().dispatch(Factor { solver: self, matrix, size }))
            .map_err(|row| Singular {
                row: first_bad_row(matrix).unwrap_or(row),
            })
    }

    fn solve(&mut self, x: &mut [f64]) {
        assert_eq!(
            x.len(),
            self.structure.size(),
            "the right-hand side has another length"
        );
        with_block_size!(self.structure.block, size => Arch::new().dispatch(Solve { solver: self, x, size }));
    }
}

/// The first row with a value that is not finite.
#[cold]
fn first_bad_row(matrix: &BorderedMatrix) -> Option<usize> {
    (matrix.triplets())
        .filter(|(_, _, value)| !value.is_finite())
        .map(|(row, _, _)| row)
        .min()
}

struct Factor<'a, B> {
    solver: &'a mut CyclicSolver,
    matrix: &'a BorderedMatrix,
    size: B,
}

impl<B: BlockSize> WithSimd for Factor<'_, B> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<(), usize> {
        let Self {
            solver,
            matrix,
            size,
        } = self;
        let b = size.get();
        let stride = b.next_multiple_of(LANES);
        let Structure {
            sections,
            closed,
            border,
            ..
        } = solver.structure;
        let sizes = solver.sizes;
        let last = sections - 1;
        let fill = if closed { b } else { 0 };
        solver.start_corner(matrix, size);

        for section in 0..sections {
            let (before, rest) = solver.factors.split_at_mut(section * sizes.slab);
            if section == last && closed {
                break;
            }
            let slab = Slab::split(&mut rest[..sizes.slab], b, stride, sizes);
            let rows = matrix.section_rows(section);
            // The section as the matrix has it.
            transpose(slab.inverse, stride, &rows[b..], 3 * b, (b, b));
            solver.columns.fill(0.0);
            let border_columns = matrix.section_border_columns(section);
            transpose(
                &mut solver.columns[fill * stride..],
                stride,
                border_columns,
                border,
                (b, border),
            );
            slab.lower_tail.fill(0.0);
            let border_rows = matrix.section_border_rows(section);
            for k in 0..b {
                slab.lower_tail[k * sizes.tail_stride + fill..][..border]
                    .copy_from_slice(&border_rows[k * border..][..border]);
            }
            if closed && section == 0 {
                transpose(&mut solver.columns, stride, rows, 3 * b, (b, b));
                let next_of_last = &matrix.section_rows(last)[2 * b..];
                transpose(
                    slab.lower_tail,
                    sizes.tail_stride,
                    next_of_last,
                    3 * b,
                    (b, b),
                );
            }
            solver.scale.fill(0.0);
            raise(simd, &mut solver.scale, slab.inverse);
            // What the elimination of the section before adds.
            if section > 0 {
                let start = before.len() - sizes.slab;
                let previous = Slab::split(&mut before[start..], b, stride, sizes);
                let (next, tail) = (&*previous.upper_next, &*previous.upper_tail);
                let lower = &*previous.lower_next;
                accumulate(simd, slab.inverse, b, lower, stride, size, |k, c| {
                    next[c * stride + k]
                });
                accumulate(
                    simd,
                    &mut solver.columns,
                    sizes.tail,
                    lower,
                    stride,
                    size,
                    |k, c| tail[c * stride + k],
                );
                let lower = &*previous.lower_tail;
                accumulate(
                    simd,
                    slab.lower_tail,
                    b,
                    lower,
                    sizes.tail_stride,
                    size,
                    |k, c| next[c * stride + k],
                );
                raise(simd, &mut solver.scale, slab.inverse);
            }
            if section == last {
                solver.take_last_section(matrix, size);
                break;
            }
            let coupled = section + 1 < last || !closed;
            let next_rows = matrix.section_rows(section + 1);
            if coupled {
                transpose(slab.lower_next, stride, next_rows, 3 * b, (b, b));
            } else {
                // The next section belongs to the tail.
                slab.lower_next.fill(0.0);
                for r in 0..b {
                    for c in 0..b {
                        slab.lower_tail[c * sizes.tail_stride + r] += next_rows[r * 3 * b + c];
                        solver.columns[c * stride + r] += rows[r * 3 * b + 2 * b + c];
                    }
                }
            }
            negative_inverse(simd, slab.inverse, size, &solver.scale, &mut solver.swaps)
                .map_err(|row| section * b + row)?;
            slab.upper_next.fill(0.0);
            let inverse = &*slab.inverse;
            if coupled {
                accumulate(simd, slab.upper_next, b, inverse, stride, size, |k, c| {
                    rows[k * 3 * b + 2 * b + c]
                });
            }
            slab.upper_tail.fill(0.0);
            let columns = &*solver.columns;
            accumulate(
                simd,
                slab.upper_tail,
                sizes.tail,
                inverse,
                stride,
                size,
                |k, c| columns[c * stride + k],
            );
            let tail = &*slab.upper_tail;
            accumulate(
                simd,
                &mut solver.corner,
                sizes.tail,
                slab.lower_tail,
                sizes.tail_stride,
                size,
                |k, c| tail[c * stride + k],
            );
            for (magnitude, value) in vectors_mut::<S>(&mut solver.magnitude)
                .iter_mut()
                .zip(vectors::<S>(&solver.corner))
            {
                *magnitude = simd.max_f64s(*magnitude, simd.abs_f64s(*value));
            }
        }
        solver.take_corner(size);
        solver.dense.invert(simd).map_err(|row| last * b + row)
    }
}

impl CyclicSolver {
    /// The tail as the matrix has it.
    #[inline(always)]
    fn start_corner(&mut self, matrix: &BorderedMatrix, size: impl BlockSize) {
        let b = size.get();
        let Structure {
            sections,
            closed,
            border,
            ..
        } = self.structure;
        let stride = self.sizes.tail_stride;
        let fill = if closed { b } else { 0 };
        if closed {
            let last = sections - 1;
            let rows = matrix.section_rows(last);
            transpose(&mut self.corner, stride, &rows[b..], 3 * b, (b, b));
            let columns = matrix.section_border_columns(last);
            transpose(
                &mut self.corner[b * stride..],
                stride,
                columns,
                border,
                (b, border),
            );
            let rows = matrix.section_border_rows(last);
            for c in 0..b {
                self.corner[c * stride + b..][..border]
                    .copy_from_slice(&rows[c * border..][..border]);
            }
        }
        for c in 0..border {
            for r in 0..border {
                self.corner[(fill + c) * stride + fill + r] = matrix.corner()[r * border + c];
            }
        }
        for (magnitude, value) in self.magnitude.iter_mut().zip(&*self.corner) {
            *magnitude = value.abs();
        }
    }

    /// Open chains: the last section, as the elimination left it, joins the dense tail.
    #[inline(always)]
    fn take_last_section(&mut self, matrix: &BorderedMatrix, size: impl BlockSize) {
        let b = size.get();
        let stride = b.next_multiple_of(LANES);
        let Structure {
            sections, border, ..
        } = self.structure;
        let sizes = self.sizes;
        let last = sections - 1;
        let slab = Slab::split(&mut self.factors[last * sizes.slab..], b, stride, sizes);
        let rows = matrix.section_rows(last);
        let border_columns = matrix.section_border_columns(last);
        let border_rows = matrix.section_border_rows(last);
        for c in 0..b {
            for r in 0..b {
                let value = slab.inverse[c * stride + r];
                let start = rows[r * 3 * b + b + c];
                self.dense.set(r, c, value, value.abs().max(start.abs()));
            }
            for k in 0..border {
                let value = slab.lower_tail[c * sizes.tail_stride + k];
                let start = border_rows[c * border + k];
                self.dense
                    .set(b + k, c, value, value.abs().max(start.abs()));
                let value = self.columns[k * stride + c];
                let start = border_columns[c * border + k];
                self.dense
                    .set(c, b + k, value, value.abs().max(start.abs()));
            }
        }
    }

    /// The tail, as the elimination left it, becomes the end of the dense one.
    #[inline(always)]
    fn take_corner(&mut self, size: impl BlockSize) {
        let Sizes {
            tail, tail_stride, ..
        } = self.sizes;
        let first = size.get() + self.structure.border - tail;
        for c in 0..tail {
            for r in 0..tail {
                let place = c * tail_stride + r;
                self.dense.set(
                    first + r,
                    first + c,
                    self.corner[place],
                    self.magnitude[place],
                );
            }
        }
    }
}

struct Solve<'a, B> {
    solver: &'a mut CyclicSolver,
    x: &'a mut [f64],
    size: B,
}

impl<B: BlockSize> WithSimd for Solve<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { solver, x, size } = self;
        let b = size.get();
        let stride = b.next_multiple_of(LANES);
        let CyclicSolver {
            structure,
            sizes,
            factors,
            dense,
            chain_right: right,
            chain_solution: solution,
            tail_right,
            tail_solution,
            ..
        } = solver;
        let sizes = *sizes;
        let last = structure.sections - 1;
        for (section, values) in right.chunks_exact_mut(stride).zip(x.chunks_exact(b)) {
            section[..b].copy_from_slice(values);
        }
        // The right-hand side of what stays in the tail all along: in open chains the border.
        let first = b + structure.border - sizes.tail;
        let tail = &mut tail_right[..sizes.tail_stride];
        tail[..sizes.tail].copy_from_slice(&x[last * b + first..]);
        for (section, slab) in factors.chunks_exact_mut(sizes.slab).take(last).enumerate() {
            let slab = Slab::split(slab, b, stride, sizes);
            let (here, next) = right[section * stride..][..2 * stride].split_at_mut(stride);
            let here = &here[..b];
            let solved = &mut solution[section * stride..][..stride];
            multiply_vector(simd, solved, slab.inverse, here);
            accumulate_vector(simd, next, slab.lower_next, &solved[..b]);
            accumulate_vector(simd, tail, slab.lower_tail, &solved[..b]);
        }

        // The dense tail: [last section, border].
        if !structure.closed {
            tail_right.copy_within(..structure.border, b);
            tail_right[..b].copy_from_slice(&right[last * stride..][..b]);
        }
        dense.solve(simd, tail_right, tail_solution);
        x[last * b..].copy_from_slice(&tail_solution[..b + structure.border]);
        let tail = &tail_solution[first..][..sizes.tail];
        solution[last * stride..][..b].copy_from_slice(&tail_solution[..b]);

        for (section, slab) in factors
            .chunks_exact_mut(sizes.slab)
            .take(last)
            .enumerate()
            .rev()
        {
            let slab = Slab::split(slab, b, stride, sizes);
            let (here, next) = solution[section * stride..][..2 * stride].split_at_mut(stride);
            for value in vectors_mut::<S>(here) {
                *value = simd.neg_f64s(*value);
            }
            accumulate_vector(simd, here, slab.upper_tail, tail);
            accumulate_vector(simd, here, slab.upper_next, &next[..b]);
            x[section * b..][..b].copy_from_slice(&here[..b]);
        }
    }
}
