//! Linear systems of a belt: a chain of cross-sections that couple to their neighbours, plus a
//! thin border of unknowns that may couple to everything (rigid bodies, multipliers).
//!
//! ```text
//! | D0 N0          P0 | B0 |      P: previous section, D: the section itself, N: next section
//! | P1 D1 N1          | B1 |      B: border columns, C: border rows, E: corner
//! |    P2 D2 N2       | B2 |      the entries P0 and Nn exist in closed chains only
//! |       ..  ..  ..  |    |
//! | Nn          Pn Dn | Bn |
//! | C0 C1 C2  ..   Cn | E  |
//! ```
//!
//! [`BorderedMatrix`] stores exactly this pattern, [`CyclicSolver`] factors it in a time
//! proportional to the number of sections, [`SparseSolver`] is the general path through `faer` for matrices that need pivots across sections.

mod block_size;
mod cyclic;
mod dense_inverse;
mod elimination;
mod factor;
mod kernel;
mod matrix;
mod panels;
mod sparse;
mod tail;

pub use cyclic::CyclicSolver;
pub use dense_inverse::DenseInverse;
pub use matrix::{BorderedMatrix, Structure};
pub use panels::SectionPanels;
pub use sparse::SparseSolver;

/// The matrix has no inverse within rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the matrix is singular: the pivot of row {row} vanished; nothing holds this coordinate (or a \
     value is not a number)"
)]
pub struct Singular {
    /// Global row whose pivot vanished: the rows above it determine it, or it holds a value that
    /// is not finite.
    pub row: usize,
}

/// Factors a [`BorderedMatrix`] and solves with the stored factor.
pub trait Solver {
    /// Replaces the stored factor by that of `matrix`.
    ///
    /// After an error the solver holds no usable factor until the next success.
    ///
    /// # Errors
    /// [`Singular`] when a pivot vanishes within rounding or is not a number.
    ///
    /// # Panics
    /// If `matrix` has another structure than the solver was made for.
    fn factor(&mut self, matrix: &BorderedMatrix) -> Result<(), Singular>;

    /// Replaces the right-hand side `x` (length [`Structure::size`]) by the solution.
    ///
    /// # Panics
    /// If `x` has another length or the last [`Solver::factor`] did not succeed.
    fn solve(&mut self, x: &mut [f64]);
}
