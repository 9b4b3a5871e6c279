//! Compressed rows: the product with a constant matrix of few entries.

use super::BorderedMatrix;

/// The entries of a constant matrix that are not zero, row by row: the mass matrix couples a third of
/// the pattern of a tangent, so its product is that much cheaper.
#[derive(Clone, Debug)]
pub struct CompressedRows {
    /// Where each row starts in `entries`; one more at the end.
    starts: Vec<usize>,
    /// Column and value.
    entries: Vec<(usize, f64)>,
}

impl CompressedRows {
    /// The entries of `matrix`.
    #[must_use]
    pub fn new(matrix: &BorderedMatrix) -> Self {
        let mut triplets: Vec<(usize, usize, f64)> = matrix
            .triplets()
            .filter(|(_, _, value)| *value != 0.0)
            .collect();
        triplets.sort_by_key(|(row, column, _)| (*row, *column));
        let size = matrix.structure().size();
        let mut starts = vec![0; size + 1];
        for (row, _, _) in &triplets {
            starts[row + 1] += 1;
        }
        for row in 0..size {
            starts[row + 1] += starts[row];
        }
        let entries = triplets
            .into_iter()
            .map(|(_, column, value)| (column, value))
            .collect();
        Self { starts, entries }
    }

    /// The quadratic form `x . A x`.
    pub fn quadratic(&self, x: &[f64]) -> f64 {
        x.iter()
            .zip(self.starts.windows(2))
            .map(|(value, range)| {
                let row = &self.entries[range[0]..range[1]];
                value * row.iter().map(|(column, a)| a * x[*column]).sum::<f64>()
            })
            .sum()
    }

    /// Writes the product with `x` to `y`; both have as many entries as the matrix has rows.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (value, range) in y.iter_mut().zip(self.starts.windows(2)) {
            let mut sum = 0.0;
            for (column, entry) in &self.entries[range[0]..range[1]] {
                sum += entry * x[*column];
            }
            *value = sum;
        }
    }
}
