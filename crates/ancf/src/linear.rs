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
//! proportional to the number of sections, a general sparse solver is the path for matrices that need pivots across sections.

mod block_size;
mod cyclic;
#[allow(dead_code)] // The elimination, next, reads the sections.
mod matrix;

pub use cyclic::CyclicSolver;
pub use matrix::{BorderedMatrix, Structure};

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
    /// If `x` has another length.
    fn solve(&mut self, x: &mut [f64]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed chain with a border, diagonally dominant: the solution reproduces the right-hand
    /// side within a few roundings.
    #[test]
    fn solves_a_closed_chain() {
        let structure = Structure {
            sections: 4,
            block: 2,
            closed: true,
            border: 1,
        };
        let mut matrix = BorderedMatrix::new(structure);
        let local: Vec<f64> = (0..16).map(|i| f64::from(i * i % 7) - 3.0).collect();
        for section in 0..4 {
            matrix.add_pair(section, 0.5, &local);
        }
        matrix.add_border_column(0, 6, &[1.0, 2.0, 3.0]);
        matrix.add_border_row(0, 1, &[1.0, -2.0]);
        for i in 0..structure.size() {
            matrix.add(i, i, 30.0);
        }
        let exact: Vec<f64> = (0..structure.size()).map(|i| i as f64 - 3.5).collect();
        let mut x = vec![0.0; structure.size()];
        matrix.multiply(&exact, &mut x);
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&matrix).unwrap();
        solver.solve(&mut x);
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-14 * 8.0, "{x} {exact}");
        }
    }
}
