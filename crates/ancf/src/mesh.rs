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
        self.scatter_entries(element, |i| local[i], f);
    }

    /// Adds the element vector of entries `entry` to `f`.
    #[inline(always)]
    fn scatter_entries(&self, element: usize, entry: impl Fn(usize) -> f64, f: &mut [f64]) {
        let n = E::NODE_DOF;
        for k in 0..E::NODES {
            let first = self.node(element, k) * n;
            for (i, value) in f[first..first + n].iter_mut().enumerate() {
                *value += entry(k * n + i);
            }
        }
    }

    /// Adds the element vectors of a batch, in lanes, to `f`.
    #[inline(always)]
    fn scatter_batch<S: EightLanes, const N: usize>(
        &self,
        batch: Batch,
        force: &[S; N],
        f: &mut [f64],
    ) {
        if const { is_chain::<E>() && E::NODES == 2 && E::NODE_DOF <= LANES } {
            self.scatter_chain(batch, force, f);
            return;
        }
        let mut stored = [[0.0; LANES]; N];
        for (lanes, value) in stored.iter_mut().zip(force) {
            *lanes = value.store();
        }
        for lane in 0..batch.count {
            self.scatter_entries(batch.first + lane, |i| stored[i][lane], f);
        }
    }

    /// The same where a node takes up from the elements on both sides of it alone, whose parts are summed first.
    #[inline(always)]
    fn scatter_chain<S: EightLanes, const N: usize>(
        &self,
        batch: Batch,
        force: &[S; N],
        f: &mut [f64],
    ) {
        let n = E::NODE_DOF;
        let mut nodes = [[S::zero(); LANES]; 2];
        for (k, node) in nodes.iter_mut().enumerate() {
            node[..n].copy_from_slice(&force[k * n..(k + 1) * n]);
            *node = S::transpose(*node);
        }
        let mut add = |node: usize, sum: S| {
            let sum = sum.store();
            for (value, part) in f[node * n..][..n].iter_mut().zip(&sum[..n]) {
                *value += part;
            }
        };
        let mut before = S::zero();
        for lane in 0..batch.count {
            add(batch.first + lane, nodes[0][lane] + before);
            before = nodes[1][lane];
        }
        add(self.node(batch.first + batch.count - 1, 1), before);
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
        E::body_damping_power(self, q, v)
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
        if const { is_chain::<E>() && E::DOF >= LANES } {
            return self.load_chain(batch, x);
        }
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

    /// The same where the nodes of an element follow one another: its coordinates stand together, but for the
    /// last element of a closed chain.
    #[inline(always)]
    fn load_chain<S: EightLanes, const N: usize>(&self, batch: Batch, x: &[f64]) -> [S; N] {
        let mut own = [0.0; N];
        let last = batch.first + batch.count - 1;
        self.gather(last, x, &mut own[..E::DOF]);
        let mut loaded = [S::zero(); N];
        for chunk in 0..E::DOF.div_ceil(LANES) {
            // The last eight coordinates overlap those before where there are not eight more.
            let first = (chunk * LANES).min(E::DOF - LANES);
            let mut rows = [eight::<S>(&own, first); LANES];
            for lane in 0..batch.count - 1 {
                rows[lane] = eight(x, (batch.first + lane) * E::NODE_DOF + first);
            }
            loaded[first..first + LANES].copy_from_slice(&S::transpose(rows));
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

/// Eight numbers of `x` from `first` on.
#[inline(always)]
fn eight<S: EightLanes>(x: &[f64], first: usize) -> S {
    // As for any slice, there must be so many.
    let (numbers, _) = x[first..].as_chunks();
    S::load(&numbers[0])
}
