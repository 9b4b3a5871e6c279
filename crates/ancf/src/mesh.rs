//! One flexible body: a chain of elements, or a strip of them side by side, open or closed to a loop.

pub mod kernels;
mod rows;

use self::rows::{Rows, is_chain};
use crate::element::Element;
use crate::linear::BorderedMatrix;
use crate::scalar::EightLanes;

/// Most coordinates of an element: of a thin plate.
const MOST_DOF: usize = 36;
/// Elements computed side by side.
const LANES: usize = 8;

/// Elements between cross-sections. A section is one node of a chain of beams, a row of nodes across a
/// strip of plates; element `i` of a chain joins section `i` to section `i + 1`, and in a closed body the
/// last section joins the first. Coordinates run section by section, so that only neighbours couple.
#[derive(Clone, Debug)]
pub struct Mesh<E> {
    elements: Vec<E>,
    rows: Rows,
    /// All elements equal: they are computed in lanes.
    uniform: bool,
}

impl<E: Element> Mesh<E> {
    /// An open chain.
    #[must_use]
    pub fn open(elements: Vec<E>) -> Self {
        Self::new(elements, 1, false)
    }

    /// A closed loop; it needs at least three elements.
    #[must_use]
    pub fn closed(elements: Vec<E>) -> Self {
        Self::new(elements, 1, true)
    }

    /// An open strip with `across` elements side by side: element `i * across + j` is the one in place
    /// `i` along and `j` across.
    ///
    /// # Panics
    /// If `across` is zero, does not divide the number of elements, or is not one of elements that
    /// are chains (beams).
    #[must_use]
    pub fn open_strip(elements: Vec<E>, across: usize) -> Self {
        Self::new(elements, across, false)
    }

    /// A strip closed to a loop, at least three elements long: see [`Mesh::open_strip`].
    ///
    /// # Panics
    /// As [`Mesh::open_strip`].
    #[must_use]
    pub fn closed_strip(elements: Vec<E>, across: usize) -> Self {
        Self::new(elements, across, true)
    }

    fn new(elements: Vec<E>, across: usize, closed: bool) -> Self {
        const {
            assert!(
                E::DOF <= MOST_DOF,
                "let the lane kernels below choose a larger size"
            );
            assert!(E::NODE_PLACES.len() == E::NODES, "every node has its place");
        }
        assert!(
            across > 0 && elements.len().is_multiple_of(across),
            "{} elements do not fill rows of {across}",
            elements.len()
        );
        assert!(
            across == 1 || !is_chain::<E>(),
            "beams stand in a chain, not side by side"
        );
        let uniform = elements.windows(2).all(|pair| pair[0] == pair[1]);
        let rows = Rows {
            along: elements.len() / across,
            across,
            closed,
        };
        Self {
            elements,
            rows,
            uniform,
        }
    }

    /// The elements in order.
    pub fn elements(&self) -> &[E] {
        &self.elements
    }

    /// Whether the last section joins the first.
    pub fn is_closed(&self) -> bool {
        self.rows.closed
    }

    /// Number of cross-sections.
    pub fn sections(&self) -> usize {
        self.rows.sections()
    }

    /// Coordinates of a cross-section.
    pub fn section_dof(&self) -> usize {
        self.rows.row::<E>() * E::NODE_DOF
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.sections() * self.rows.row::<E>()
    }

    /// Number of coordinates.
    pub fn dof(&self) -> usize {
        self.nodes() * E::NODE_DOF
    }

    /// Index of the section after `section`; of a chain, the node after a node.
    #[inline]
    pub fn next(&self, section: usize) -> usize {
        self.rows.next(section)
    }

    /// Number in the body of node `k` of an element.
    #[inline]
    pub fn node(&self, element: usize, k: usize) -> usize {
        self.rows.node::<E>(element, k)
    }

    /// Copies the coordinates of element `element` out of `q` (length `DOF`).
    #[inline]
    pub fn gather(&self, element: usize, q: &[f64], e: &mut [f64]) {
        let n = E::NODE_DOF;
        for k in 0..E::NODES {
            let first = self.node(element, k) * n;
            e[k * n..(k + 1) * n].copy_from_slice(&q[first..first + n]);
        }
    }

    /// Adds the element vector `local` to `f`.
    #[inline]
    pub fn scatter(&self, element: usize, local: &[f64], f: &mut [f64]) {
        let n = E::NODE_DOF;
        for k in 0..E::NODES {
            let first = self.node(element, k) * n;
            for i in 0..n {
                f[first + i] += local[k * n + i];
            }
        }
    }

    /// Adds the element vector in the lane `lane` of `stored` to `f`.
    #[inline(always)]
    fn scatter_lane(&self, element: usize, stored: &[[f64; LANES]], lane: usize, f: &mut [f64]) {
        let n = E::NODE_DOF;
        for k in 0..E::NODES {
            let first = self.node(element, k) * n;
            for (value, lanes) in f[first..first + n].iter_mut().zip(&stored[k * n..]) {
                *value += lanes[lane];
            }
        }
    }

    /// Adds `factor` times the element matrix `local` (row-major, `DOF x DOF`) to `matrix`.
    #[inline(always)]
    fn scatter_matrix(
        &self,
        element: usize,
        factor: f64,
        local: &[f64],
        matrix: &mut BorderedMatrix,
    ) {
        if const { is_chain::<E>() } {
            matrix.add_pair(element, factor, local);
            return;
        }
        let n = E::NODE_DOF;
        for row in 0..E::NODES {
            for column in 0..E::NODES {
                let places = [row, column].map(|k| self.node(element, k) * n);
                let values = &local[(row * E::DOF + column) * n..];
                matrix.add_square(places, n, factor, values, E::DOF);
            }
        }
    }

    /// Strain energy [J] of the configuration `q`.
    pub fn energy(&self, q: &[f64]) -> f64 {
        E::body_energy(self, q)
    }

    /// Power [W] that internal damping takes in the state `(q, v)`.
    pub fn damping_power(&self, q: &[f64], v: &[f64]) -> f64 {
        let [mut e, mut rate, mut force] = [[0.0; MOST_DOF]; 3];
        let (e, rate, force) = (&mut e[..E::DOF], &mut rate[..E::DOF], &mut force[..E::DOF]);
        let mut power = 0.0;
        for (i, element) in self.elements.iter().enumerate() {
            self.gather(i, q, e);
            self.gather(i, v, rate);
            force.fill(0.0);
            element.add_damping_force(e, rate, force);
            power -= rate.iter().zip(&*force).map(|(a, b)| a * b).sum::<f64>();
        }
        power
    }

    /// Adds elastic and internal damping forces of the state `(q, v)` to `f`.
    pub fn add_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        E::add_body_force(self, q, v, f);
    }

    /// Adds `position_factor * K + velocity_factor * C` of elastic and damping forces to `matrix`,
    /// with `K = -dF/dq`, `C = -dF/dv`.
    pub fn add_tangent(
        &self,
        q: &[f64],
        v: &[f64],
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        E::add_body_tangent(self, q, v, position_factor, velocity_factor, matrix);
    }

    /// The batches of equal elements.
    fn batches(&self) -> impl Iterator<Item = Batch> {
        let width = if self.uniform { LANES } else { 1 };
        let elements = self.elements.len();
        (0..elements.div_ceil(width)).map(move |i| Batch {
            first: i * width,
            count: width.min(elements - i * width),
        })
    }

    /// The values of `x` at the coordinates of a batch, element by element in lanes; lanes without an
    /// element repeat the last one.
    #[inline(always)]
    fn load<S: EightLanes, const N: usize>(&self, batch: Batch, x: &[f64]) -> [S; N] {
        let n = E::NODE_DOF;
        let mut lanes = [[0.0; LANES]; N];
        for lane in 0..LANES {
            let element = batch.first + lane.min(batch.count - 1);
            for k in 0..E::NODES {
                let first = self.node(element, k) * n;
                for i in 0..n {
                    lanes[k * n + i][lane] = x[first + i];
                }
            }
        }
        let mut loaded = [S::zero(); N];
        for (value, lanes) in loaded.iter_mut().zip(&lanes) {
            *value = S::load(lanes);
        }
        loaded
    }

    /// Adds the constant mass matrix to `matrix`.
    pub fn add_mass(&self, matrix: &mut BorderedMatrix) {
        let vectors = E::NODES * E::NODE_VECTORS;
        let mut scalar = vec![0.0; vectors * vectors];
        let mut local = vec![0.0; E::DOF * E::DOF];
        for (i, element) in self.elements.iter().enumerate() {
            element.vector_mass(&mut scalar);
            local.fill(0.0);
            for row in 0..vectors {
                for column in 0..vectors {
                    for axis in 0..E::DIMENSION {
                        local
                            [(row * E::DIMENSION + axis) * E::DOF + column * E::DIMENSION + axis] =
                            scalar[row * vectors + column];
                    }
                }
            }
            self.scatter_matrix(i, 1.0, &local, matrix);
        }
    }

    /// Length scales [m] that make the coordinates comparable: 1 for positions, a quarter of the
    /// element's length for slopes along the body, `thickness` for slopes across it (for plates take a
    /// quarter of the element's width).
    pub fn scales(&self, length: f64, thickness: f64) -> Vec<f64> {
        let mut node = vec![thickness; E::NODE_DOF];
        node[..E::DIMENSION].fill(1.0);
        if E::NODE_VECTORS > E::DIMENSION || !is_chain::<E>() {
            node[E::DIMENSION..2 * E::DIMENSION].fill(0.25 * length);
        }
        node.repeat(self.nodes())
    }
}

/// Consecutive equal elements computed together.
#[derive(Clone, Copy)]
struct Batch {
    first: usize,
    count: usize,
}
