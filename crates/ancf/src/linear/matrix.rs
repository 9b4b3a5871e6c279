//! The matrix of a chain of sections with a border, stored by its pattern.

use super::block_size::{BlockSize, with_block_size};

/// Shape of a bordered (cyclic) block-tridiagonal matrix.
///
/// Unknowns are numbered section by section, then the border:
/// `[section 0 (block values), section 1, ..., border]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Cross-sections of the chain, at least 1; at least 3 if closed.
    pub sections: usize,
    /// Unknowns of a section, at least 1.
    pub block: usize,
    /// Whether the last section couples to the first.
    pub closed: bool,
    /// Unknowns that may couple to everything.
    pub border: usize,
}

impl Structure {
    /// Number of unknowns, `sections * block + border`.
    pub fn size(&self) -> usize {
        self.chain() + self.border
    }

    /// Number of unknowns of the chain, `sections * block`: the index of the first border unknown.
    pub fn chain(&self) -> usize {
        self.sections * self.block
    }

    /// The section after `section`, cyclic if closed.
    pub(super) fn successor(&self, section: usize) -> Option<usize> {
        if section + 1 < self.sections {
            Some(section + 1)
        } else {
            self.closed.then_some(0)
        }
    }

    /// The section before `section`, cyclic if closed.
    pub(super) fn predecessor(&self, section: usize) -> Option<usize> {
        if section > 0 {
            Some(section - 1)
        } else {
            self.closed.then(|| self.sections - 1)
        }
    }

    /// Refuses shapes whose neighbours are not distinct.
    pub(super) fn check(&self) {
        assert!(
            self.block >= 1,
            "a section needs at least one unknown: {self:?}"
        );
        assert!(
            self.sections >= 1,
            "a chain needs at least one section: {self:?}"
        );
        assert!(
            !self.closed || self.sections >= 3,
            "a closed chain needs at least 3 sections, or a section would be its own neighbour or \
             have the same one on both sides: {self:?}"
        );
    }
}

/// A bordered (cyclic) block-tridiagonal matrix: `sections * block + border` rows and columns.
#[derive(Clone, Debug)]
pub struct BorderedMatrix {
    structure: Structure,
    /// Row-major `block x 3 block` per section, `[previous | itself | next]`, so that the row of
    /// the chain unknown `i` starts at `3 * block * i`.
    blocks: Vec<f64>,
    /// Entry (row `i` of the chain, border unknown `k`) at `i * border + k`.
    border_columns: Vec<f64>,
    /// Entry (border unknown `k`, column `i` of the chain) at `i * border + k`.
    border_rows: Vec<f64>,
    /// Row-major `border x border`.
    corner: Vec<f64>,
}

/// Where an entry is stored.
enum Place {
    Block(usize),
    BorderColumn(usize),
    BorderRow(usize),
    Corner(usize),
}

impl BorderedMatrix {
    /// The zero matrix of this structure.
    ///
    /// # Panics
    /// If the structure has no sections, no unknowns per section, or is closed with fewer than
    /// 3 sections.
    pub fn new(structure: Structure) -> Self {
        structure.check();
        let Structure { block, border, .. } = structure;
        let chain = structure.chain();
        Self {
            structure,
            blocks: vec![0.0; chain * 3 * block],
            border_columns: vec![0.0; chain * border],
            border_rows: vec![0.0; chain * border],
            corner: vec![0.0; border * border],
        }
    }

    /// The shape of the matrix.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        for part in self.parts_mut() {
            part.fill(0.0);
        }
    }

    /// Takes the entries of `other`.
    ///
    /// # Panics
    /// If the structures differ.
    pub fn copy_from(&mut self, other: &BorderedMatrix) {
        assert_eq!(self.structure, other.structure, "matrices differ in shape");
        for (part, source) in self.parts_mut().into_iter().zip(other.parts()) {
            part.copy_from_slice(source);
        }
    }

    /// Adds `factor * other`.
    ///
    /// # Panics
    /// If the structures differ.
    pub fn add_scaled(&mut self, factor: f64, other: &BorderedMatrix) {
        assert_eq!(self.structure, other.structure, "matrices differ in shape");
        for (part, source) in self.parts_mut().into_iter().zip(other.parts()) {
            for (value, add) in part.iter_mut().zip(source) {
                *value += factor * add;
            }
        }
    }

    /// Adds `factor * local` where `section` and its successor couple.
    ///
    /// `local` is row-major `2 block x 2 block`: first the unknowns of `section`, then those of
    /// its successor, which is section 0 for the last section of a closed chain.
    ///
    /// # Panics
    /// If `section` has no successor or `local` has another length.
    #[inline(always)]
    pub fn add_pair(&mut self, section: usize, factor: f64, local: &[f64]) {
        with_block_size!(self.structure.block, size => self.add_sized_pair(size, section, factor, local));
    }

    #[inline(always)]
    fn add_sized_pair(&mut self, size: impl BlockSize, section: usize, factor: f64, local: &[f64]) {
        let b = size.get();
        assert_eq!(local.len(), 4 * b * b, "a pair is a square of two sections");
        let Some(successor) = self.structure.successor(section) else {
            panic!("section {section} has no successor in {:?}", self.structure);
        };
        let (upper, lower) = local.split_at(2 * b * b);
        // Rows of the section read [itself | next], rows of its successor [previous | itself].
        let rows = &mut self.blocks[3 * b * b * section..][..3 * b * b];
        for (row, values) in rows.chunks_exact_mut(3 * b).zip(upper.chunks_exact(2 * b)) {
            for (entry, value) in row[b..].iter_mut().zip(values) {
                *entry += factor * value;
            }
        }
        let rows = &mut self.blocks[3 * b * b * successor..][..3 * b * b];
        for (row, values) in rows.chunks_exact_mut(3 * b).zip(lower.chunks_exact(2 * b)) {
            for (entry, value) in row[..2 * b].iter_mut().zip(values) {
                *entry += factor * value;
            }
        }
    }

    /// Adds the small square `values` where the unknowns from `row` and `column` of a pair couple, counted as in
    /// [`BorderedMatrix::add_pair`].
    ///
    /// # Panics
    /// If `section` has no successor or the square leaves one of the two sections.
    #[inline(always)]
    pub fn add_pair_square<const N: usize>(
        &mut self,
        section: usize,
        [row, column]: [usize; 2],
        values: [[f64; N]; N],
    ) {
        let b = self.structure.block;
        assert!(
            row % b + N <= b && column % b + N <= b && column < 2 * b,
            "{N} unknowns from ({row}, {column}) leave their section of {b}"
        );
        let Some(successor) = self.structure.successor(section) else {
            panic!("section {section} has no successor in {:?}", self.structure);
        };
        let first = if row < b {
            3 * b * (section * b + row) + b + column
        } else {
            3 * b * (successor * b + row - b) + column
        };
        for (i, values) in values.iter().enumerate() {
            let entries = &mut self.blocks[first + 3 * b * i..][..N];
            for (entry, value) in entries.iter_mut().zip(values) {
                *entry += value;
            }
        }
    }

    /// Adds `factor` times the `size x size` values whose rows start `stride` apart where the unknowns
    /// of a section from `row` couple with those from `column`, of it or a neighbour.
    ///
    /// # Panics
    /// If the square leaves a section or the sections do not couple.
    #[inline]
    pub fn add_square(
        &mut self,
        [row, column]: [usize; 2],
        size: usize,
        factor: f64,
        values: &[f64],
        stride: usize,
    ) {
        let block = self.structure.block;
        assert!(
            row % block + size <= block && column % block + size <= block,
            "{size} unknowns from ({row}, {column}) leave their section of {block}"
        );
        let Some(Place::Block(first)) = self.place(row, column) else {
            panic!(
                "the sections of the unknowns {row} and {column} do not couple in {:?}",
                self.structure
            );
        };
        let rows = self.blocks[first..].chunks_mut(3 * block);
        for (entries, values) in rows.zip(values.chunks(stride)).take(size) {
            for (entry, value) in entries[..size].iter_mut().zip(values) {
                *entry += factor * value;
            }
        }
    }

    /// Adds `value` to the entry of global indices `row` and `column`; border unknowns are
    /// numbered from [`Structure::chain`].
    ///
    /// # Panics
    /// If the entry lies outside the pattern.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match self.place(row, column) {
            Some(Place::Block(index)) => self.blocks[index] += value,
            Some(Place::BorderColumn(index)) => self.border_columns[index] += value,
            Some(Place::BorderRow(index)) => self.border_rows[index] += value,
            Some(Place::Corner(index)) => self.corner[index] += value,
            None => panic!(
                "the entry ({row}, {column}) lies outside the pattern of {:?}: only neighbouring \
                 sections and the border couple",
                self.structure
            ),
        }
    }

    /// Adds `values` to the column of border unknown `k`, downwards from the chain row
    /// `first_row`; in a closed chain the row after the last one is row 0.
    ///
    /// # Panics
    /// If `k` is no border unknown or the values leave the chain.
    #[inline]
    pub fn add_border_column(&mut self, k: usize, first_row: usize, values: &[f64]) {
        let structure = self.structure;
        add_strided(&mut self.border_columns, structure, k, first_row, values);
    }

    /// Adds `values` to the row of border unknown `k`, rightwards from the chain column
    /// `first_column`; in a closed chain the column after the last one is column 0.
    ///
    /// # Panics
    /// If `k` is no border unknown or the values leave the chain.
    #[inline]
    pub fn add_border_row(&mut self, k: usize, first_column: usize, values: &[f64]) {
        let structure = self.structure;
        add_strided(&mut self.border_rows, structure, k, first_column, values);
    }

    /// Adds `value` where the border unknowns `k` (row) and `m` (column) couple.
    ///
    /// # Panics
    /// If `k` or `m` is no border unknown.
    #[inline]
    pub fn add_corner(&mut self, k: usize, m: usize, value: f64) {
        let border = self.structure.border;
        assert!(
            k < border && m < border,
            "({k}, {m}) is not in the border of {border}"
        );
        self.corner[k * border + m] += value;
    }

    /// Replaces the row `row` by that of the unit matrix: the unknown takes the value of the
    /// right-hand side.
    ///
    /// # Panics
    /// If `row` is no row of the matrix.
    pub fn set_unit_row(&mut self, row: usize) {
        let Structure { block, border, .. } = self.structure;
        let chain = self.structure.chain();
        if row < chain {
            self.blocks[3 * block * row..][..3 * block].fill(0.0);
            self.border_columns[border * row..][..border].fill(0.0);
        } else {
            let k = row - chain;
            assert!(k < border, "row {row} lies outside {:?}", self.structure);
            for entry in self.border_rows.iter_mut().skip(k).step_by(border) {
                *entry = 0.0;
            }
            self.corner[k * border..][..border].fill(0.0);
        }
        self.add(row, row, 1.0);
    }

    /// Adds `factor` times the row `source` to the row `target`: a row of the same section, or any row
    /// to one of the border.
    ///
    /// # Panics
    /// If the sum would leave the pattern.
    pub fn add_row(&mut self, target: usize, factor: f64, source: usize) {
        let structure = self.structure;
        let Structure { block, border, .. } = structure;
        let chain = structure.chain();
        let fits = target >= chain || (source < chain && target / block == source / block);
        assert!(
            fits && target.max(source) < structure.size(),
            "row {source} does not fit into row {target} of {structure:?}"
        );
        if target < chain {
            for j in 0..3 * block {
                self.blocks[3 * block * target + j] += factor * self.blocks[3 * block * source + j];
            }
            for k in 0..border {
                self.border_columns[border * target + k] +=
                    factor * self.border_columns[border * source + k];
            }
            return;
        }
        let into = target - chain;
        if source < chain {
            let section = source / block;
            let neighbours = [
                structure.predecessor(section),
                Some(section),
                structure.successor(section),
            ];
            for (place, neighbour) in neighbours.into_iter().enumerate() {
                for j in 0..neighbour.map_or(0, |_| block) {
                    let column = neighbour.map_or(0, |neighbour| neighbour * block + j);
                    self.border_rows[column * border + into] +=
                        factor * self.blocks[(3 * source + place) * block + j];
                }
            }
            for k in 0..border {
                self.corner[into * border + k] += factor * self.border_columns[source * border + k];
            }
        } else {
            let from = source - chain;
            for column in 0..chain {
                self.border_rows[column * border + into] +=
                    factor * self.border_rows[column * border + from];
            }
            for k in 0..border {
                self.corner[into * border + k] += factor * self.corner[from * border + k];
            }
        }
    }

    /// Writes the product with `x` to `y`, both of length [`Structure::size`].
    ///
    /// # Panics
    /// If a vector has another length.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let structure = self.structure;
        let Structure { block, border, .. } = structure;
        assert_eq!(x.len(), structure.size(), "the factor has another length");
        assert_eq!(y.len(), structure.size(), "the product has another length");
        let (x_chain, x_border) = x.split_at(structure.chain());
        let (y_chain, y_border) = y.split_at_mut(structure.chain());
        for k in 0..border {
            y_border[k] = dot(&self.corner[k * border..][..border], x_border);
        }
        for section in 0..structure.sections {
            let neighbours = [
                structure.predecessor(section),
                Some(section),
                structure.successor(section),
            ];
            for row in section * block..(section + 1) * block {
                let mut sum = dot(&self.border_columns[row * border..][..border], x_border);
                for (place, neighbour) in neighbours.iter().enumerate() {
                    if let Some(neighbour) = neighbour {
                        sum += dot(
                            &self.blocks[(3 * row + place) * block..][..block],
                            &x_chain[neighbour * block..][..block],
                        );
                    }
                }
                y_chain[row] = sum;
                for k in 0..border {
                    y_border[k] += self.border_rows[row * border + k] * x_chain[row];
                }
            }
        }
    }

    /// All entries of the pattern as `(row, column, value)`, zeros included, each once and always
    /// in the same order.
    pub fn triplets(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let structure = self.structure;
        let Structure { block, border, .. } = structure;
        let chain = structure.chain();
        let blocks = (0..chain).flat_map(move |row| {
            let section = row / block;
            let neighbours = [
                structure.predecessor(section),
                Some(section),
                structure.successor(section),
            ];
            neighbours
                .into_iter()
                .enumerate()
                .filter_map(|(place, neighbour)| neighbour.map(|neighbour| (place, neighbour)))
                .flat_map(move |(place, neighbour)| {
                    (0..block).map(move |j| {
                        let value = self.blocks[(3 * row + place) * block + j];
                        (row, neighbour * block + j, value)
                    })
                })
        });
        let pairs =
            move |rows: usize| (0..rows).flat_map(move |i| (0..border).map(move |k| (i, k)));
        let columns = (pairs(chain).zip(&self.border_columns))
            .map(move |((i, k), value)| (i, chain + k, *value));
        let rows = (pairs(chain).zip(&self.border_rows))
            .map(move |((i, k), value)| (chain + k, i, *value));
        let corner = (pairs(border).zip(&self.corner))
            .map(move |((k, m), value)| (chain + k, chain + m, *value));
        blocks.chain(columns).chain(rows).chain(corner)
    }

    /// The rows of section `section`: row-major `block x 3 block`, `[previous | itself | next]`.
    #[inline(always)]
    pub(super) fn section_rows(&self, section: usize) -> &[f64] {
        let length = 3 * self.structure.block * self.structure.block;
        &self.blocks[section * length..][..length]
    }

    /// The border columns on the rows of a section, `block x border`.
    #[inline(always)]
    pub(super) fn section_border_columns(&self, section: usize) -> &[f64] {
        let length = self.structure.block * self.structure.border;
        &self.border_columns[section * length..][..length]
    }

    /// The transposed border rows on the columns of a section, `block x border`.
    #[inline(always)]
    pub(super) fn section_border_rows(&self, section: usize) -> &[f64] {
        let length = self.structure.block * self.structure.border;
        &self.border_rows[section * length..][..length]
    }

    /// The corner, row-major `border x border`.
    #[inline(always)]
    pub(super) fn corner(&self) -> &[f64] {
        &self.corner
    }

    fn place(&self, row: usize, column: usize) -> Option<Place> {
        let structure = &self.structure;
        let Structure { block, border, .. } = *structure;
        let chain = structure.chain();
        if row >= structure.size() || column >= structure.size() {
            return None;
        }
        Some(match (row < chain, column < chain) {
            (true, true) => {
                let (from, to) = (row / block, column / block);
                let place = if from == to {
                    1
                } else if structure.successor(from) == Some(to) {
                    2
                } else if structure.predecessor(from) == Some(to) {
                    0
                } else {
                    return None;
                };
                Place::Block((3 * row + place) * block + column % block)
            }
            (true, false) => Place::BorderColumn(row * border + column - chain),
            (false, true) => Place::BorderRow(column * border + row - chain),
            (false, false) => Place::Corner((row - chain) * border + column - chain),
        })
    }

    fn parts(&self) -> [&[f64]; 4] {
        [
            &self.blocks,
            &self.border_columns,
            &self.border_rows,
            &self.corner,
        ]
    }

    fn parts_mut(&mut self) -> [&mut [f64]; 4] {
        [
            &mut self.blocks,
            &mut self.border_columns,
            &mut self.border_rows,
            &mut self.corner,
        ]
    }
}

/// Adds `values` to the entries `(first + i, k)` of a `chain x border` array.
#[inline]
fn add_strided(target: &mut [f64], structure: Structure, k: usize, first: usize, values: &[f64]) {
    let (chain, border) = (structure.chain(), structure.border);
    assert!(k < border, "{k} is not in the border of {border}");
    let room = if structure.closed {
        chain
    } else {
        chain - first.min(chain)
    };
    assert!(
        first < chain && values.len() <= room,
        "{} values from {first} leave the chain of {chain} unknowns",
        values.len()
    );
    let (inside, wrapped) = values.split_at(values.len().min(chain - first));
    for (i, value) in inside.iter().enumerate() {
        target[(first + i) * border + k] += value;
    }
    for (i, value) in wrapped.iter().enumerate() {
        target[i * border + k] += value;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
