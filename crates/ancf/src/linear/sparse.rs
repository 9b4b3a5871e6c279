//! The general path: sparse LU with pivots across sections, by `faer`.

use super::kernel::VANISHED;
use super::{BorderedMatrix, Singular, Solver, Structure};
use faer::MatMut;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};

/// Weak beside scaled entries of 1, strong beside rounding errors.
const FOUNDATION: f64 = 1e-8;

/// Sparse direct solver: slower than [`super::CyclicSolver`] by a large factor, but it pivots
/// freely. The pattern is analysed once, in [`SparseSolver::new`].
///
/// Rows and columns are scaled to a largest entry of 1 before the factorisation, so that units
/// matter little. Sparse LU does not tell where a pivot vanished; the row named in an error is that
/// of the unknown which answers most to a fixed right-hand side, hence one that nothing holds.
pub struct SparseSolver {
    structure: Structure,
    pattern: SymbolicSparseColMat<usize>,
    order: Argsort<usize>,
    symbolic: SymbolicLu<usize>,
    factor: Option<Lu<usize, f64>>,
    /// The scaled entries in the order of [`BorderedMatrix::triplets`].
    values: Vec<f64>,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
}

impl SparseSolver {
    /// Analyses the pattern of this structure.
    ///
    /// # Panics
    /// If the structure has no sections, no unknowns per section, or is closed with fewer than
    /// 3 sections; or if memory runs out.
    pub fn new(structure: Structure) -> Self {
        let size = structure.size();
        let places: Vec<_> = (BorderedMatrix::new(structure).triplets())
            .map(|(row, column, _)| Pair::new(row, column))
            .collect();
        // Every index is below `size`, so only memory can fail, as for any vector.
        let (pattern, order) = SymbolicSparseColMat::try_new_from_indices(size, size, &places)
            .expect("the entries of the pattern lie inside the matrix");
        let symbolic = SymbolicLu::try_new(pattern.as_ref())
            .expect("the pattern holds its diagonal, and its indices fit");
        Self {
            structure,
            pattern,
            order,
            symbolic,
            factor: None,
            values: vec![0.0; places.len()],
            row_scale: vec![0.0; size],
            column_scale: vec![0.0; size],
        }
    }

    /// Fills the values, scaled so that the largest entry of each row and column is about 1.
    fn equilibrate(&mut self, matrix: &BorderedMatrix) -> Result<(), Singular> {
        self.row_scale.fill(0.0);
        self.column_scale.fill(0.0);
        for (row, _, value) in matrix.triplets() {
            if !value.is_finite() {
                return Err(Singular { row });
            }
            self.row_scale[row] = self.row_scale[row].max(value.abs());
        }
        reciprocals(&mut self.row_scale)?;
        for (row, column, value) in matrix.triplets() {
            let value = (value * self.row_scale[row]).abs();
            self.column_scale[column] = self.column_scale[column].max(value);
        }
        reciprocals(&mut self.column_scale)?;
        for (target, (row, column, value)) in self.values.iter_mut().zip(matrix.triplets()) {
            *target = value * self.row_scale[row] * self.column_scale[column];
        }
        Ok(())
    }

    /// Factors the scaled entries.
    fn factor_scaled(&mut self) -> Result<(), Singular> {
        // Out of memory and index overflow aside, which `new` would have met, faer fails where the
        // pattern has no pivot; but the pattern holds the diagonal.
        let unknown = Singular { row: 0 };
        let scaled =
            SparseColMat::new_from_argsort(self.pattern.clone(), &self.order, &self.values)
                .map_err(|_| unknown)?;
        let factor = Lu::try_new_with_symbolic(self.symbolic.clone(), scaled.as_ref());
        self.factor = Some(factor.map_err(|_| unknown)?);
        Ok(())
    }

    /// The unknown that answers most to a right-hand side of +-1 in all scaled rows, and its
    /// answer, infinite if any value is not finite.
    fn probe(&self) -> (usize, f64) {
        // The signs follow the bits of the multiples of the golden ratio: no regular pattern.
        let mut answer: Vec<f64> = (1..=self.structure.size() as u64)
            .map(|i| i.wrapping_mul(0x9E37_79B9_7F4A_7C15))
            .map(|bits| if bits >> 63 == 0 { 1.0 } else { -1.0 })
            .collect();
        self.solve_scaled(&mut answer);
        let mut largest = (0, 0.0);
        for (row, value) in answer.iter().enumerate() {
            if !value.is_finite() {
                return (row, f64::INFINITY);
            }
            if value.abs() > largest.1 {
                largest = (row, value.abs());
            }
        }
        largest
    }

    /// The unknown that is free in a singular matrix: with a weak foundation under everything it
    /// moves most.
    fn free_unknown(&mut self, matrix: &BorderedMatrix) -> Result<Singular, Singular> {
        for (target, (row, column, _)) in self.values.iter_mut().zip(matrix.triplets()) {
            if row == column {
                *target += FOUNDATION;
            }
        }
        self.factor_scaled()?;
        let (row, _) = self.probe();
        Ok(Singular { row })
    }

    fn solve_scaled(&self, x: &mut [f64]) {
        let Some(factor) = &self.factor else {
            panic!("solve needs a successful factor before");
        };
        let rows = x.len();
        factor.solve_in_place(MatMut::from_column_major_slice_mut(x, rows, 1));
    }
}

/// Replaces the largest entries by the factors that make them about 1: powers of two, which
/// round nothing.
fn reciprocals(scales: &mut [f64]) -> Result<(), Singular> {
    for (row, scale) in scales.iter_mut().enumerate() {
        if *scale == 0.0 {
            return Err(Singular { row });
        }
        *scale = (-scale.log2().floor()).exp2();
    }
    Ok(())
}

impl Solver for SparseSolver {
    fn factor(&mut self, matrix: &BorderedMatrix) -> Result<(), Singular> {
        assert_eq!(
            matrix.structure(),
            self.structure,
            "the solver was made for another structure"
        );
        self.factor = None;
        self.equilibrate(matrix)?;
        self.factor_scaled()?;
        let (_, answer) = self.probe();
        if answer * VANISHED > 1.0 {
            let singular = self.free_unknown(matrix);
            self.factor = None;
            return Err(singular.unwrap_or_else(|singular| singular));
        }
        Ok(())
    }

    fn solve(&mut self, x: &mut [f64]) {
        assert_eq!(
            x.len(),
            self.structure.size(),
            "the right-hand side has another length"
        );
        for (value, scale) in x.iter_mut().zip(&self.row_scale) {
            *value *= scale;
        }
        self.solve_scaled(x);
        for (value, scale) in x.iter_mut().zip(&self.column_scale) {
            *value *= scale;
        }
    }
}
