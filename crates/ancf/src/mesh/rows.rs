//! Where the nodes of elements lie: rows across the body, one behind the other.
//!
//! ```text
//!   j = 2  o-----o-----o-----o      A section is a row of nodes, here three. Element (i, j) is the
//!          | 0,1 | 1,1 | 2,1 |      number `i * across + j`, node (i, j) the number `i * row + j`,
//!   j = 1  o-----o-----o-----o      so the coordinates of a section stand together and only
//!          | 0,0 | 1,0 | 2,0 |      neighbouring sections couple.
//!   j = 0  o-----o-----o-----o
//!        i = 0     1     2     3 (or 0 again)
//! ```
//!
//! A beam has one node in a section.

use crate::element::Element;

/// Elements along and across a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rows {
    pub along: usize,
    pub across: usize,
    pub closed: bool,
}

/// Whether a section of these elements is one node.
pub(super) const fn is_chain<E: Element>() -> bool {
    let mut k = 0;
    while k < E::NODE_PLACES.len() {
        if E::NODE_PLACES[k][1] > 0 {
            return false;
        }
        k += 1;
    }
    true
}

impl Rows {
    /// Number of sections.
    pub fn sections(&self) -> usize {
        self.along + usize::from(!self.closed)
    }

    /// Nodes of a section.
    #[inline(always)]
    pub fn row<E: Element>(&self) -> usize {
        if const { is_chain::<E>() } {
            1
        } else {
            self.across + 1
        }
    }

    /// Index of the section after `section`.
    #[inline(always)]
    pub fn next(&self, section: usize) -> usize {
        if self.closed && section + 1 == self.along {
            0
        } else {
            section + 1
        }
    }

    /// Number in the body of node `k` of an element.
    #[inline(always)]
    pub fn node<E: Element>(&self, element: usize, k: usize) -> usize {
        let [ahead, beside] = E::NODE_PLACES[k];
        let place = |first: usize| if ahead == 0 { first } else { self.next(first) };
        if const { is_chain::<E>() } {
            place(element)
        } else {
            let section = place(element / self.across);
            section * self.row::<E>() + element % self.across + beside
        }
    }
}
