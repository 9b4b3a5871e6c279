//! One flexible body: a chain of elements, open or closed to a loop.

use crate::element::Element;
use crate::linear::BorderedMatrix;
use crate::scalar::{EightLanes, LaneKernel, dispatch};

/// Elements computed side by side.
const LANES: usize = 8;
/// Most coordinates of an element; sizes the working memory on the stack.
const MAX_DOF: usize = 12;

/// A chain of two-node elements. Element `i` joins section (node) `i` to section `i + 1`; in a
/// closed chain the last joins the first.
#[derive(Clone, Debug)]
pub struct Mesh<E> {
    elements: Vec<E>,
    closed: bool,
    /// All elements equal: they are computed in lanes.
    uniform: bool,
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
        const {
            assert!(E::DOF <= MAX_DOF, "raise MAX_DOF for this element");
        }
        Self {
            elements,
            closed,
            uniform,
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
        dispatch(Energy { mesh: self, q })
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
    pub fn add_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        dispatch(AddForce {
            mesh: self,
            q,
            v,
            f,
        });
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
        dispatch(AddTangent {
            mesh: self,
            q,
            v,
            position_factor,
            velocity_factor,
            matrix,
        });
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
    fn load<S: EightLanes>(&self, batch: Batch, x: &[f64]) -> [S; MAX_DOF] {
        let n = E::NODE_DOF;
        let mut lanes = [[0.0; LANES]; MAX_DOF];
        for lane in 0..LANES {
            let node = batch.first + lane.min(batch.count - 1);
            let (a, b) = (node * n, self.next(node) * n);
            for i in 0..n {
                lanes[i][lane] = x[a + i];
                lanes[n + i][lane] = x[b + i];
            }
        }
        let mut loaded = [S::zero(); MAX_DOF];
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

/// Consecutive equal elements computed together.
#[derive(Clone, Copy)]
struct Batch {
    first: usize,
    count: usize,
}

/// The work of [`Mesh::energy`].
struct Energy<'a, E> {
    mesh: &'a Mesh<E>,
    q: &'a [f64],
}

impl<E: Element> LaneKernel for Energy<'_, E> {
    type Output = f64;

    #[inline(always)]
    fn run<S: EightLanes>(self) -> f64 {
        let mut energy = 0.0;
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S>(batch, self.q);
            let lanes = element.energy(&e[..E::DOF]).store();
            energy += lanes[..batch.count].iter().sum::<f64>();
        }
        energy
    }
}

/// The work of [`Mesh::add_force`].
struct AddForce<'a, E> {
    mesh: &'a Mesh<E>,
    q: &'a [f64],
    v: &'a [f64],
    f: &'a mut [f64],
}

impl<E: Element> LaneKernel for AddForce<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S>(batch, self.q);
            let mut force = [S::zero(); MAX_DOF];
            element.force(&e[..E::DOF], &mut force[..E::DOF]);
            if element.is_damped() {
                let rate = self.mesh.load::<S>(batch, self.v);
                element.add_damping_force(&e[..E::DOF], &rate[..E::DOF], &mut force[..E::DOF]);
            }
            let mut stored = [[0.0; LANES]; MAX_DOF];
            for (lanes, value) in stored.iter_mut().zip(&force) {
                *lanes = value.store();
            }
            for lane in 0..batch.count {
                let local: [f64; MAX_DOF] = std::array::from_fn(|i| stored[i][lane]);
                self.mesh.scatter(batch.first + lane, &local, self.f);
            }
        }
    }
}

/// The work of [`Mesh::add_tangent`].
struct AddTangent<'a, E> {
    mesh: &'a Mesh<E>,
    q: &'a [f64],
    v: &'a [f64],
    position_factor: f64,
    velocity_factor: f64,
    matrix: &'a mut BorderedMatrix,
}

impl<E: Element> LaneKernel for AddTangent<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let square = E::DOF * E::DOF;
        let mut tangent = [S::zero(); MAX_DOF * MAX_DOF];
        let mut stored = [[0.0; LANES]; MAX_DOF * MAX_DOF];
        let mut local = [0.0; MAX_DOF * MAX_DOF];
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S>(batch, self.q);
            element.stiffness(&e[..E::DOF], &mut tangent[..square]);
            let mut factor = self.position_factor;
            if element.is_damped() {
                let rate = self.mesh.load::<S>(batch, self.v);
                for value in &mut tangent[..square] {
                    *value = *value * self.position_factor;
                }
                factor = 1.0;
                element.add_damping_tangent(
                    &e[..E::DOF],
                    &rate[..E::DOF],
                    self.position_factor,
                    self.velocity_factor,
                    &mut tangent[..square],
                );
            }
            for (lanes, value) in stored.iter_mut().zip(&tangent[..square]) {
                *lanes = value.store();
            }
            for lane in 0..batch.count {
                for (value, lanes) in local[..square].iter_mut().zip(&stored) {
                    *value = lanes[lane];
                }
                self.matrix
                    .add_pair(batch.first + lane, factor, &local[..square]);
            }
        }
    }
}
