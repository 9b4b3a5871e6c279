//! The loops over the elements of a body, compiled for SIMD registers.
//!
//! They are the largest functions of the library by far. [`BodyKernels`] makes the crate that defines an
//! element compile them, once, instead of every crate that uses a mesh of it.

use super::{LANES, MOST_DOF, Mesh};
use crate::element::Element;
use crate::linear::BorderedMatrix;
use crate::scalar::{EightLanes, LaneKernel, dispatch};

/// The loops over the elements of a [`Mesh`], implemented by [`body_kernels!`](crate::body_kernels).
pub trait BodyKernels: Sized {
    /// Strain energy [J] of the configuration `q`.
    fn body_energy(mesh: &Mesh<Self>, q: &[f64]) -> f64;

    /// Power [W] that internal damping takes in the state `(q, v)`.
    fn body_damping_power(mesh: &Mesh<Self>, q: &[f64], v: &[f64]) -> f64;

    /// Adds elastic and internal damping forces of the state `(q, v)` to `f`.
    fn add_body_force(mesh: &Mesh<Self>, q: &[f64], v: &[f64], f: &mut [f64]);

    /// Adds `position_factor * K + velocity_factor * C` of these forces to `matrix`.
    fn add_body_tangent(
        mesh: &Mesh<Self>,
        q: &[f64],
        v: &[f64],
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    );
}

/// Implements [`BodyKernels`](crate::mesh::kernels::BodyKernels) for an element: one line beside its `impl
/// Element`.
#[macro_export]
macro_rules! body_kernels {
    ($element:ty) => {
        impl $crate::mesh::kernels::BodyKernels for $element {
            #[inline(never)]
            fn body_energy(mesh: &$crate::mesh::Mesh<Self>, q: &[f64]) -> f64 {
                $crate::mesh::kernels::energy(mesh, q)
            }

            #[inline(never)]
            fn body_damping_power(mesh: &$crate::mesh::Mesh<Self>, q: &[f64], v: &[f64]) -> f64 {
                $crate::mesh::kernels::damping_power(mesh, q, v)
            }

            #[inline(never)]
            fn add_body_force(
                mesh: &$crate::mesh::Mesh<Self>,
                q: &[f64],
                v: &[f64],
                f: &mut [f64],
            ) {
                $crate::mesh::kernels::add_force(mesh, q, v, f);
            }

            #[inline(never)]
            fn add_body_tangent(
                mesh: &$crate::mesh::Mesh<Self>,
                q: &[f64],
                v: &[f64],
                position_factor: f64,
                velocity_factor: f64,
                matrix: &mut $crate::linear::BorderedMatrix,
            ) {
                let factors = [position_factor, velocity_factor];
                $crate::mesh::kernels::add_tangent(mesh, q, v, factors, matrix);
            }
        }
    };
}

/// [`BodyKernels::body_energy`] of any element.
pub fn energy<E: Element>(mesh: &Mesh<E>, q: &[f64]) -> f64 {
    dispatch(Energy { mesh, q })
}

/// [`BodyKernels::body_damping_power`] of any element.
pub fn damping_power<E: Element>(mesh: &Mesh<E>, q: &[f64], v: &[f64]) -> f64 {
    dispatch(DampingPower { mesh, q, v })
}

/// [`BodyKernels::add_body_force`] of any element.
pub fn add_force<E: Element>(mesh: &Mesh<E>, q: &[f64], v: &[f64], f: &mut [f64]) {
    dispatch(AddForce { mesh, q, v, f });
}

/// [`BodyKernels::add_body_tangent`] of any element; `factors` are those of position and velocity.
pub fn add_tangent<E: Element>(
    mesh: &Mesh<E>,
    q: &[f64],
    v: &[f64],
    [position_factor, velocity_factor]: [f64; 2],
    matrix: &mut BorderedMatrix,
) {
    dispatch(AddTangent {
        mesh,
        q,
        v,
        position_factor,
        velocity_factor,
        matrix,
    });
}

/// Runs `$self.sized::<S, N>()` with working memory for the `N` coordinates of an element, few for a
/// planar beam: the size is known to the compiler, which drops the other calls.
macro_rules! with_element_size {
    ($self:ident, $scalar:ty, $element:ty) => {
        if const { <$element>::DOF <= 8 } {
            $self.sized::<$scalar, 8>()
        } else if const { <$element>::DOF <= 12 } {
            $self.sized::<$scalar, 12>()
        } else if const { <$element>::DOF <= 24 } {
            $self.sized::<$scalar, 24>()
        } else {
            $self.sized::<$scalar, MOST_DOF>()
        }
    };
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
        with_element_size!(self, S, E)
    }
}

impl<E: Element> Energy<'_, E> {
    #[inline(always)]
    fn sized<S: EightLanes, const N: usize>(self) -> f64 {
        let mut energy = 0.0;
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S, N>(batch, self.q);
            let lanes = element.energy(&e[..E::DOF]).store();
            energy += lanes[..batch.count].iter().sum::<f64>();
        }
        energy
    }
}

/// The work of [`Mesh::damping_power`].
struct DampingPower<'a, E> {
    mesh: &'a Mesh<E>,
    q: &'a [f64],
    v: &'a [f64],
}

impl<E: Element> LaneKernel for DampingPower<'_, E> {
    type Output = f64;

    #[inline(always)]
    fn run<S: EightLanes>(self) -> f64 {
        with_element_size!(self, S, E)
    }
}

impl<E: Element> DampingPower<'_, E> {
    #[inline(always)]
    fn sized<S: EightLanes, const N: usize>(self) -> f64 {
        let mut power = 0.0;
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            if !element.is_damped() {
                continue;
            }
            let e = self.mesh.load::<S, N>(batch, self.q);
            let rate = self.mesh.load::<S, N>(batch, self.v);
            let mut force = [S::zero(); N];
            element.add_damping_force(&e[..E::DOF], &rate[..E::DOF], &mut force[..E::DOF]);
            let mut taken = S::zero();
            for (force, rate) in force.iter().zip(&rate) {
                taken -= *force * *rate;
            }
            power += taken.store()[..batch.count].iter().sum::<f64>();
        }
        power
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
        with_element_size!(self, S, E);
    }
}

impl<E: Element> AddForce<'_, E> {
    #[inline(always)]
    fn sized<S: EightLanes, const N: usize>(self) {
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S, N>(batch, self.q);
            let mut force = [S::zero(); N];
            if element.is_damped() {
                let rate = self.mesh.load::<S, N>(batch, self.v);
                element.damped_force(&e[..E::DOF], &rate[..E::DOF], &mut force[..E::DOF]);
            } else {
                element.force(&e[..E::DOF], &mut force[..E::DOF]);
            }
            self.mesh.scatter_batch(batch, &force, self.f);
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
        with_element_size!(self, S, E);
    }
}

impl<E: Element> AddTangent<'_, E> {
    #[inline(always)]
    fn sized<S: EightLanes, const N: usize>(self) {
        let square = E::DOF * E::DOF;
        let mut tangent = [[S::zero(); N]; N];
        let tangent = &mut tangent.as_flattened_mut()[..square];
        // The matrix of each element of a batch.
        let mut locals = [[[0.0; N]; N]; LANES];
        for batch in self.mesh.batches() {
            let element = &self.mesh.elements[batch.first];
            let e = self.mesh.load::<S, N>(batch, self.q);
            element.stiffness(&e[..E::DOF], tangent);
            let mut factor = self.position_factor;
            if element.is_damped() {
                let rate = self.mesh.load::<S, N>(batch, self.v);
                for value in &mut *tangent {
                    *value = *value * self.position_factor;
                }
                factor = 1.0;
                element.add_damping_tangent(
                    &e[..E::DOF],
                    &rate[..E::DOF],
                    self.position_factor,
                    self.velocity_factor,
                    tangent,
                );
            }
            let (chunks, rest) = tangent.as_chunks::<LANES>();
            for (chunk, rows) in chunks.iter().enumerate() {
                let columns = S::transpose(*rows);
                for lane in 0..LANES {
                    let local = locals[lane].as_flattened_mut();
                    local[chunk * LANES..][..LANES].copy_from_slice(&columns[lane].store());
                }
            }
            for (i, value) in rest.iter().enumerate() {
                for (local, value) in locals.iter_mut().zip(value.store()) {
                    local.as_flattened_mut()[chunks.len() * LANES + i] = value;
                }
            }
            for (lane, local) in locals[..batch.count].iter().enumerate() {
                let local = &local.as_flattened()[..square];
                self.mesh
                    .scatter_matrix(batch.first + lane, factor, local, self.matrix);
            }
        }
    }
}
