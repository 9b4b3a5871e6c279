//! One flexible body: a chain of elements, open or closed to a loop.

use pulp::Arch;

use crate::element::Element;
use crate::linear::BorderedMatrix;
use crate::scalar::{Lanes, Scalar};

/// Elements computed side by side.
const LANES: usize = 8;

/// A chain of two-node elements. Element `i` joins section (node) `i` to section `i + 1`; in a
/// closed chain the last joins the first.
#[derive(Clone, Debug)]
pub struct Mesh<E> {
    elements: Vec<E>,
    closed: bool,
    /// All elements equal: they are computed in lanes.
    uniform: bool,
    arch: Arch,
    scratch: Scratch,
}

/// Working memory of the element loops, allocated once.
#[derive(Clone, Debug)]
struct Scratch {
    e: Vec<Lanes<LANES>>,
    rate: Vec<Lanes<LANES>>,
    force: Vec<Lanes<LANES>>,
    matrix: Vec<Lanes<LANES>>,
    local: Vec<f64>,
}

impl<E: Element> Mesh<E> {
    /// An open chain.
    #[must_use]
    pub fn open(elements: Vec<E>) -> Self {
        Self::new(elements, false)
    }

    /// A closed loop; it needs at least three elements.
    #[must_use]
    pub fn closed(elements: Vec<E>) -> Self {
        Self::new(elements, true)
    }

    fn new(elements: Vec<E>, closed: bool) -> Self {
        let uniform = elements.windows(2).all(|pair| pair[0] == pair[1]);
        let zero = Lanes([0.0; LANES]);
        let scratch = Scratch {
            e: vec![zero; E::DOF],
            rate: vec![zero; E::DOF],
            force: vec![zero; E::DOF],
            matrix: vec![zero; E::DOF * E::DOF],
            local: vec![0.0; E::DOF * E::DOF],
        };
        Self {
            elements,
            closed,
            uniform,
            arch: Arch::new(),
            scratch,
        }
    }

    /// The elements in order.
    pub fn elements(&self) -> &[E] {
        &self.elements
    }

    /// Whether the last element joins the first node again.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.elements.len() + usize::from(!self.closed)
    }

    /// Number of coordinates.
    pub fn dof(&self) -> usize {
        self.nodes() * E::NODE_DOF
    }

    /// Index of the node after `node`.
    #[inline]
    pub fn next(&self, node: usize) -> usize {
        if self.closed && node + 1 == self.elements.len() {
            0
        } else {
            node + 1
        }
    }

    /// Copies the coordinates of element `element` out of `q` (length `DOF`).
    #[inline]
    pub fn gather(&self, element: usize, q: &[f64], e: &mut [f64]) {
        let n = E::NODE_DOF;
        let (first, second) = (element * n, self.next(element) * n);
        e[..n].copy_from_slice(&q[first..first + n]);
        e[n..2 * n].copy_from_slice(&q[second..second + n]);
    }

    /// Adds the element vector `local` to `f`.
    #[inline]
    pub fn scatter(&self, element: usize, local: &[f64], f: &mut [f64]) {
        let n = E::NODE_DOF;
        let (first, second) = (element * n, self.next(element) * n);
        for i in 0..n {
            f[first + i] += local[i];
        }
        for i in 0..n {
            f[second + i] += local[n + i];
        }
    }

    /// Strain energy [J] of the configuration `q`.
    pub fn energy(&self, q: &[f64]) -> f64 {
        let mut e = vec![0.0; E::DOF];
        let mut energy = 0.0;
        for (i, element) in self.elements.iter().enumerate() {
            self.gather(i, q, &mut e);
            energy += element.energy(&e[..]);
        }
        energy
    }

    /// Power [W] that internal damping takes in the state `(q, v)`.
    pub fn damping_power(&self, q: &[f64], v: &[f64]) -> f64 {
        let (mut e, mut rate, mut force) =
            (vec![0.0; E::DOF], vec![0.0; E::DOF], vec![0.0; E::DOF]);
        let mut power = 0.0;
        for (i, element) in self.elements.iter().enumerate() {
            self.gather(i, q, &mut e);
            self.gather(i, v, &mut rate);
            force.fill(0.0);
            element.add_damping_force(&e[..], &rate[..], &mut force[..]);
            power -= rate.iter().zip(&force).map(|(a, b)| a * b).sum::<f64>();
        }
        power
    }

    /// Adds elastic and internal damping forces of the state `(q, v)` to `f`.
    pub fn add_force(&mut self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let mut scratch = std::mem::take(&mut self.scratch);
        let arch = self.arch;
        arch.dispatch(
            #[inline(always)]
            || {
                self.for_batches(&mut scratch, q, v, |mesh, scratch, batch| {
                    let element = &mesh.elements[batch.first];
                    element.force(&scratch.e, &mut scratch.force);
                    if element.is_damped() {
                        element.add_damping_force(&scratch.e, &scratch.rate, &mut scratch.force);
                    }
                    for lane in 0..batch.count {
                        for i in 0..E::DOF {
                            scratch.local[i] = scratch.force[i].0[lane];
                        }
                        mesh.scatter(batch.first + lane, &scratch.local[..E::DOF], f);
                    }
                });
            },
        );
        self.scratch = scratch;
    }

    /// Adds `position_factor * K + velocity_factor * C` of elastic and damping forces to `matrix`,
    /// with `K = -dF/dq`, `C = -dF/dv`.
    pub fn add_tangent(
        &mut self,
        q: &[f64],
        v: &[f64],
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        let mut scratch = std::mem::take(&mut self.scratch);
        let arch = self.arch;
        arch.dispatch(
            #[inline(always)]
            || {
                self.for_batches(&mut scratch, q, v, |mesh, scratch, batch| {
                    let element = &mesh.elements[batch.first];
                    element.stiffness(&scratch.e, &mut scratch.matrix);
                    let factor = if element.is_damped() {
                        for value in &mut scratch.matrix {
                            *value = *value * position_factor;
                        }
                        element.add_damping_tangent(
                            &scratch.e,
                            &scratch.rate,
                            position_factor,
                            velocity_factor,
                            &mut scratch.matrix,
                        );
                        1.0
                    } else {
                        position_factor
                    };
                    for lane in 0..batch.count {
                        for (local, lanes) in scratch.local.iter_mut().zip(&scratch.matrix) {
                            *local = lanes.0[lane];
                        }
                        matrix.add_pair(batch.first + lane, factor, &scratch.local);
                    }
                });
            },
        );
        self.scratch = scratch;
    }

    /// Runs `work` on batches of equal elements with their coordinates gathered into lanes; lanes
    /// without an element repeat the last one.
    #[inline(always)]
    fn for_batches(
        &self,
        scratch: &mut Scratch,
        q: &[f64],
        v: &[f64],
        mut work: impl FnMut(&Self, &mut Scratch, Batch),
    ) {
        let n = E::NODE_DOF;
        let width = if self.uniform { LANES } else { 1 };
        let damped = self.elements.first().is_some_and(Element::is_damped);
        let mut first = 0;
        while first < self.elements.len() {
            let count = width.min(self.elements.len() - first);
            for lane in 0..LANES {
                let node = first + lane.min(count - 1);
                let (a, b) = (node * n, self.next(node) * n);
                for i in 0..n {
                    scratch.e[i].0[lane] = q[a + i];
                    scratch.e[n + i].0[lane] = q[b + i];
                }
                if damped {
                    for i in 0..n {
                        scratch.rate[i].0[lane] = v[a + i];
                        scratch.rate[n + i].0[lane] = v[b + i];
                    }
                }
            }
            work(self, scratch, Batch { first, count });
            first += count;
        }
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
                        local[(row * E::DIMENSION + axis) * E::DOF
                            + column * E::DIMENSION
                            + axis] = scalar[row * vectors + column];
                    }
                }
            }
            matrix.add_pair(i, 1.0, &local);
        }
    }

    /// Length scales [m] that make the coordinates comparable: 1 for positions, a quarter of the
    /// element's length for slopes along the body, `thickness` for slopes across it.
    pub fn scales(&self, length: f64, thickness: f64) -> Vec<f64> {
        let mut node = vec![thickness; E::NODE_DOF];
        node[..E::DIMENSION].fill(1.0);
        if E::NODE_VECTORS > E::DIMENSION {
            node[E::DIMENSION..2 * E::DIMENSION].fill(0.25 * length);
        }
        node.repeat(self.nodes())
    }
}

/// Consecutive elements computed together.
#[derive(Clone, Copy)]
struct Batch {
    first: usize,
    count: usize,
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            e: Vec::new(),
            rate: Vec::new(),
            force: Vec::new(),
            matrix: Vec::new(),
            local: Vec::new(),
        }
    }
}

// Kernels must see one scalar type for plain and lane evaluation.
const _: fn() = || {
    fn is_scalar<S: Scalar>() {}
    is_scalar::<Lanes<LANES>>();
};
