//! What a factor made by eliminating sections is stored in; [`super::cyclic`] has the equations.

use super::kernel::Aligned;

/// What the elimination works on besides the stored factor.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// The columns `F` of the section being eliminated: `t x b'`.
    pub(super) columns: Aligned,
    /// The tail `T` being formed, by columns, `t x t'`, and the largest magnitude of each entry.
    pub(super) corner: Aligned,
    pub(super) magnitude: Aligned,
    /// Row scale of the section being eliminated, and its swaps.
    pub(super) scale: Aligned,
    pub(super) swaps: Vec<usize>,
}

/// Lengths of blocks and rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Unknowns that all sections may couple to: the border, and the last section if closed.
    pub(super) tail: usize,
    pub(super) tail_stride: usize,
    /// Values of a slab.
    pub(super) slab: usize,
}

/// The stored factor of a section; panels of rows padded to `b' = padded(b)`, `t' = padded(t)`.
pub(super) struct Slab<'a> {
    /// Minus the inverse of `D`, by columns: `b x b'`.
    pub(super) inverse: &'a mut [f64],
    /// `P` of the next section, by columns: `b x b'`.
    pub(super) lower_next: &'a mut [f64],
    /// `R`, by columns: `b x t'`.
    pub(super) lower_tail: &'a mut [f64],
    /// `-D^-1 N`, by columns: `b x b'`.
    pub(super) upper_next: &'a mut [f64],
    /// `-D^-1 F`, by columns: `t x b'`.
    pub(super) upper_tail: &'a mut [f64],
}

impl<'a> Slab<'a> {
    #[inline(always)]
    pub(super) fn split(slab: &'a mut [f64], b: usize, stride: usize, sizes: Sizes) -> Self {
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
