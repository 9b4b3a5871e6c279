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
use super::elimination::Elimination;
use super::factor::{Front, Sizes, Slab};
use super::kernel::{Aligned, LANES, accumulate_vector, multiply_vector, padded, vectors_mut};
use super::tail::Tail;
use super::{BorderedMatrix, Singular, Solver, Structure};
use pulp::{Arch, Simd, WithSimd};

/// Direct solver for [`BorderedMatrix`], linear in the number of sections, without allocation
/// after [`CyclicSolver::new`].
///
/// Factor: about `sections * (3 b³ + 3 b² t + b t²)` fused multiplications for blocks of `b` and a
/// tail of `t = border` (open) or `t = b + border` (closed) unknowns; solve: `sections * (3 b² + 2 b t)`.
#[derive(Clone, Debug)]
pub struct CyclicSolver {
    structure: Structure,
    sizes: Sizes,
    /// Whether the last factorisation succeeded.
    factored: bool,
    /// One slab per section, see [`Slab`].
    factors: Aligned,
    front: Front,
    dense: Tail,
    /// Sections of a right-hand side, padded, and its tail.
    chain_right: Aligned,
    tail_right: Aligned,
    /// Its solution likewise.
    chain_solution: Aligned,
    tail_solution: Aligned,
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
            factored: false,
            factors: Aligned::new(sections * slab),
            front: Front {
                columns: Aligned::new(tail * stride),
                corner: Aligned::new(tail * tail_stride),
                magnitude: Aligned::new(tail * tail_stride),
                scale: Aligned::new(stride),
                swaps: vec![0; block],
            },
            dense: Tail::new(block + border),
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
        self.factored = false;
        let Self {
            structure,
            sizes,
            factors,
            front,
            dense,
            ..
        } = self;
        with_block_size!(structure.block, size => Arch::new().dispatch(Elimination {
            matrix, size, sizes: *sizes, factors, front, dense,
        }))
        .map_err(|row| Singular {
            row: first_bad_row(matrix).unwrap_or(row),
        })?;
        self.factored = true;
        Ok(())
    }

    fn solve(&mut self, x: &mut [f64]) {
        assert_eq!(
            x.len(),
            self.structure.size(),
            "the right-hand side has another length"
        );
        assert!(self.factored, "solve needs a successful factor before");
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

#[cfg(test)]
mod tests {
    use super::super::block_size::{Dynamic, Fixed};
    use super::*;

    /// The same matrix through every vector width this machine has: the paths differ in the order
    /// of no sum, only in fused roundings, and the matrix is well conditioned (diagonal 60 against
    /// rows of 11 entries below 3), so they agree within a few roundings.
    #[test]
    fn every_instruction_set_gives_the_same_solution() {
        let structure = Structure {
            sections: 5,
            block: 3,
            closed: true,
            border: 2,
        };
        let mut matrix = BorderedMatrix::new(structure);
        let local: Vec<f64> = (0..36).map(|i| f64::from(i * i % 7) - 3.0).collect();
        for section in 0..5 {
            matrix.add_pair(section, 0.5, &local);
        }
        for row in 0..structure.chain() {
            matrix.add_border_column(row % 2, row, &[1.0]);
            matrix.add_border_row(row % 2, row, &[-2.0]);
        }
        for row in 0..structure.size() {
            matrix.add(row, row, 60.0);
        }
        let right: Vec<f64> = (0..structure.size()).map(|i| i as f64 - 7.5).collect();
        let mut usual = right.clone();
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&matrix).unwrap();
        solver.solve(&mut usual);

        let mut solutions = vec![with(pulp::Scalar, &matrix, Dynamic(3), &right)];
        solutions.push(with(pulp::Scalar, &matrix, Fixed::<3>, &right));
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            solutions.push(simd.vectorize(|| with(simd, &matrix, Dynamic(3), &right)));
        }
        for solution in solutions {
            for (value, usual) in solution.iter().zip(&usual) {
                assert!(
                    (value - usual).abs() < 16.0 * f64::EPSILON,
                    "{value} {usual}"
                );
            }
        }
    }

    fn with<S: Simd>(
        simd: S,
        matrix: &BorderedMatrix,
        size: impl BlockSize,
        right: &[f64],
    ) -> Vec<f64> {
        let mut solver = CyclicSolver::new(matrix.structure());
        let CyclicSolver {
            sizes,
            factors,
            front,
            dense,
            ..
        } = &mut solver;
        Elimination {
            matrix,
            size,
            sizes: *sizes,
            factors,
            front,
            dense,
        }
        .with_simd(simd)
        .unwrap();
        let mut x = right.to_vec();
        Solve {
            solver: &mut solver,
            x: &mut x,
            size,
        }
        .with_simd(simd);
        x
    }
}
