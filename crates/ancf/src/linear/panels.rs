//! The product with a constant matrix whose sections are mostly alike.

use super::block_size::{BlockSize, with_block_size};
use super::kernel::{Aligned, LANES, accumulate_vector, multiply_vector, padded};
use super::{BorderedMatrix, Structure};
use pulp::{Arch, Simd, WithSimd};

/// A constant matrix for products, the mass matrix: rows of the chain as panels by columns, each kept once however
/// many sections have the same, so that the product of a uniform chain reads one panel all along.
#[derive(Clone, Debug)]
pub struct SectionPanels {
    structure: Structure,
    /// Columns `[previous | itself | next]` of a section's rows, each padded: `3 b x b'`.
    panels: Vec<Aligned>,
    /// Panel of each section.
    kind: Vec<usize>,
    /// The section's result, padded.
    row: Aligned,
    /// Entries of the border that are not zero: row, column and value.
    border: Vec<(usize, usize, f64)>,
}

impl SectionPanels {
    /// The entries of `matrix`.
    #[must_use]
    pub fn new(matrix: &BorderedMatrix) -> Self {
        let structure = matrix.structure();
        let Structure {
            sections, block, ..
        } = structure;
        let stride = padded(block);
        let mut panels: Vec<Aligned> = Vec::new();
        let kind = (0..sections)
            .map(|section| {
                let rows = matrix.section_rows(section);
                let mut panel = Aligned::new(3 * block * stride);
                for (i, row) in rows.chunks_exact(3 * block).enumerate() {
                    for (column, value) in row.iter().enumerate() {
                        panel[column * stride + i] = *value;
                    }
                }
                let known = panels.iter().rposition(|other| other[..] == panel[..]);
                known.unwrap_or_else(|| {
                    panels.push(panel);
                    panels.len() - 1
                })
            })
            .collect();
        let chain = structure.chain();
        let border = matrix
            .triplets()
            .filter(|(row, column, value)| *row.max(column) >= chain && *value != 0.0)
            .collect();
        Self {
            structure,
            panels,
            kind,
            row: Aligned::new(stride),
            border,
        }
    }

    /// Writes the product with `x`, less `known`, to `y`.
    ///
    /// # Panics
    /// If a vector is not as long as the matrix has rows.
    pub fn residual(&mut self, x: &[f64], known: &[f64], y: &mut [f64]) {
        let size = self.structure.size();
        assert_eq!(x.len(), size, "the factor has another length");
        assert_eq!(known.len(), size, "what is known has another length");
        assert_eq!(y.len(), size, "the residual has another length");
        let b = self.structure.block;
        let chain = self.structure.chain();
        for (y, known) in y[chain..].iter_mut().zip(&known[chain..]) {
            *y = -known;
        }
        let Self {
            structure,
            panels,
            kind,
            row,
            ..
        } = self;
        with_block_size!(b, size => Arch::new().dispatch(Sections {
            structure: *structure,
            size,
            panels,
            kind,
            x,
            row,
            take: |section: usize, row: &[f64]| {
                let b = size.get();
                let known = &known[section * b..][..b];
                let values = y[section * b..][..b].iter_mut().zip(row);
                for ((y, product), known) in values.zip(known) {
                    *y = product - known;
                }
            },
        }));
        for (row, column, value) in &self.border {
            y[*row] += value * x[*column];
        }
    }

    /// The quadratic form `x . A x`.
    ///
    /// # Panics
    /// If `x` is not as long as the matrix has rows.
    #[must_use]
    pub fn quadratic(&self, x: &[f64]) -> f64 {
        let b = self.structure.block;
        assert_eq!(
            x.len(),
            self.structure.size(),
            "the factor has another length"
        );
        let mut sum = 0.0;
        with_block_size!(b, size => Arch::new().dispatch(Sections {
            structure: self.structure,
            size,
            panels: &self.panels,
            kind: &self.kind,
            x,
            row: &mut Aligned::new(padded(b)),
            take: |section: usize, row: &[f64]| {
                let b = size.get();
                let own = &x[section * b..][..b];
                sum += own.iter().zip(row).map(|(x, y)| x * y).sum::<f64>();
            },
        }));
        for (row, column, value) in &self.border {
            sum += x[*row] * value * x[*column];
        }
        sum
    }
}

/// Gives the product of the rows of each section with `x`, without the border, to `take`.
struct Sections<'a, B, F> {
    structure: Structure,
    size: B,
    panels: &'a [Aligned],
    kind: &'a [usize],
    x: &'a [f64],
    row: &'a mut Aligned,
    take: F,
}

impl<B: BlockSize, F: FnMut(usize, &[f64])> WithSimd for Sections<'_, B, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            structure,
            size,
            panels,
            kind,
            x,
            row,
            mut take,
        } = self;
        let b = size.get();
        let stride = b.next_multiple_of(LANES);
        let row = &mut row[..stride];
        for section in 0..structure.sections {
            let panel = &panels[kind[section]][..3 * b * stride];
            if section > 0 && section + 1 < structure.sections {
                // All three sections stand together.
                multiply_vector(simd, row, panel, &x[(section - 1) * b..][..3 * b]);
            } else {
                row.fill(0.0);
                let neighbours = [
                    structure.predecessor(section),
                    Some(section),
                    structure.successor(section),
                ];
                for (columns, neighbour) in panel.chunks_exact(b * stride).zip(neighbours) {
                    if let Some(neighbour) = neighbour {
                        accumulate_vector(simd, row, columns, &x[neighbour * b..][..b]);
                    }
                }
            }
            take(section, &row[..b]);
        }
    }
}
