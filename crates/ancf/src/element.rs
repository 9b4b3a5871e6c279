//! What a finite element of the absolute nodal coordinate formulation must answer.
//!
//! An element is linear kinematics plus an energy. Its nodal coordinates are global vectors (the
//! position of a node and slopes of the position field there), so a material point has the position
//! `r = sum_k S_k e_k` with constant shape functions, the mass matrix is constant and rigid motion is
//! exact. The elastic force is minus the gradient of the strain energy, the tangent its Hessian.
//!
//! To add an element: one file in `element/`, one `impl Element`, one line
//! `ancf::element_checks!(...)` in its tests (see CONTRIBUTING.md).

mod beam2_belt;
mod beam2_cubic;
mod beam2_linear;
mod beam3_belt;
mod beam3_linear;
mod hermite;
mod plane_section;
mod plate_thin;
mod space_section;
mod vector;

pub use beam2_belt::BeltBeam2;
pub use beam2_cubic::{CubicBeam2, FoldedReference};
pub use beam2_linear::LinearBeam2;
pub use beam3_belt::BeltBeam3;
pub use beam3_linear::LinearBeam3;
pub use plate_thin::{BendingRigidity, PlateQuadrature, ThinPlate};

use crate::mesh::kernels::BodyKernels;
use crate::scalar::Scalar;
use crate::strain::SurfaceGradient;
use crate::unsound::Unsound;

/// An element with `NODES` nodes of `NODE_VECTORS` vectors in `DIMENSION` dimensions.
///
/// Nodal coordinates of an element are stored node by node, vector by vector:
/// `[r1x, r1y, r1_x x, r1_x y, ...]`, a slice of length [`Element::DOF`].
/// Two elements that compare equal have the same reference shape, section and material, and may be
/// computed side by side in SIMD lanes.
pub trait Element: BodyKernels + Clone + PartialEq + std::fmt::Debug + Send + Sync {
    /// Dimension of space: 2 or 3.
    const DIMENSION: usize;
    /// Nodes of the element.
    const NODES: usize;
    /// Vectors per node: the position and its slopes.
    const NODE_VECTORS: usize;
    /// Where each node lies in a mesh: how many sections ahead of the first, and how many nodes across the
    /// section from it. A beam's second node is the next section.
    const NODE_PLACES: &'static [[usize; 2]] = &[[0, 0], [1, 0]];
    /// Coordinates of a node.
    const NODE_DOF: usize = Self::DIMENSION * Self::NODE_VECTORS;
    /// Coordinates of the element.
    const DOF: usize = Self::NODES * Self::NODE_DOF;

    /// Strain energy [J] in the configuration `e` (length `DOF`).
    fn energy<S: Scalar>(&self, e: &[S]) -> S;

    /// Writes the elastic force `-dU/de` [N, N m] in the configuration `e` to `force`.
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]);

    /// Writes the tangent stiffness `d²U/de²`, row-major `DOF x DOF`, to `stiffness`.
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]);

    /// Whether the element has internal damping; if not, the damping methods are never called.
    fn is_damped(&self) -> bool {
        false
    }

    /// Adds the internal damping force in the configuration `e` with rates `rate` to `force`.
    fn add_damping_force<S: Scalar>(&self, e: &[S], rate: &[S], force: &mut [S]) {
        let _ = (e, rate, force);
    }

    /// Writes the elastic force and that of the internal damping together; elements that share work between
    /// both may do so here.
    #[inline(always)]
    fn damped_force<S: Scalar>(&self, e: &[S], rate: &[S], force: &mut [S]) {
        self.force(e, force);
        self.add_damping_force(e, rate, force);
    }

    /// Adds `position_factor * (-dF/de) + rate_factor * (-dF/d rate)` of the damping force, row-major.
    fn add_damping_tangent<S: Scalar>(
        &self,
        e: &[S],
        rate: &[S],
        position_factor: f64,
        rate_factor: f64,
        tangent: &mut [S],
    ) {
        let _ = (e, rate, position_factor, rate_factor, tangent);
    }

    /// Writes the constant mass between the element's vectors, row-major
    /// `(NODES * NODE_VECTORS)²`; it acts on every direction of space alike.
    fn vector_mass(&self, mass: &mut [f64]);

    /// The nodal coordinates of the undeformed element with its first node at the origin and its
    /// axes along the global ones.
    fn reference(&self, e: &mut [f64]);

    /// Stiffness times length [N m] that makes energies of this element dimensionless in checks:
    /// `E A l` for a beam, `E h l w` for a plate.
    fn energy_scale(&self) -> f64;

    /// Refuses an element of a material, section or length that cannot be. Structures ask before they compute.
    fn check(&self) -> Result<(), Unsound> {
        Ok(())
    }
}

/// An element whose material points lie on a line `0 <= x <= length`: beams.
pub trait LineElement: Element {
    /// The vectors that the centre line reads: two for a line `(r1, r2)`, four for a cubic
    /// `(r1, r1_x, r2, r2_x)`, in this order.
    const CENTRE_VECTORS: &'static [usize];

    /// The slopes across the section (r1_y, r2_y): the point at height `y` over the centre line lies `y`
    /// times their linear interpolation beside it.
    const SECTION_VECTORS: [usize; 2];

    /// Undeformed length [m].
    fn length(&self) -> f64;

    /// Shape functions of the centre line at `xi = x / length`, one weight for each vector
    /// coordinate of the element (length `NODES * NODE_VECTORS`).
    fn centre_line(&self, xi: f64, weights: &mut [f64]);

    /// Derivatives of [`LineElement::centre_line`] by x [1/m].
    fn centre_line_slope(&self, xi: f64, weights: &mut [f64]);

    /// The slope `dr/dx` of the centre line at `xi` in the configuration `e` (length `DIMENSION`,
    /// padded with zeros).
    fn slope(&self, e: &[f64], xi: f64) -> [f64; 3] {
        let mut weights = [0.0; 8];
        self.centre_line_slope(xi, &mut weights);
        let mut slope = [0.0; 3];
        for vector in Self::CENTRE_VECTORS {
            for axis in 0..Self::DIMENSION {
                slope[axis] += weights[*vector] * e[Self::DIMENSION * vector + axis];
            }
        }
        slope
    }

    /// Area (2D) or volume (3D) ratio `det dr/d(x, y, ...)` on the centre line at `xi`.
    fn jacobian(&self, e: &[f64], xi: f64) -> f64;

    /// Axial force [N] at `xi` in the configuration `e`.
    fn axial_force(&self, e: &[f64], xi: f64) -> f64;
}

/// An element whose material points lie on a rectangle `0 <= x <= length`, `0 <= y <= width`: plates.
/// Places on it are `[x / length, y / width]`.
pub trait SurfaceElement: Element {
    /// Undeformed length [m], along the body.
    fn length(&self) -> f64;

    /// Undeformed width [m], across it.
    fn width(&self) -> f64;

    /// Shape functions at `place`, one weight for each vector coordinate of the element (length
    /// `NODES * NODE_VECTORS`).
    fn surface(&self, place: [f64; 2], weights: &mut [f64]);

    /// Derivatives of [`SurfaceElement::surface`] by x and y [1/m].
    fn surface_slopes(&self, place: [f64; 2], by_x: &mut [f64], by_y: &mut [f64]);

    /// `(r_x, r_y)` at `place` in the configuration `e`, with the measures of strain.
    fn surface_gradient(&self, e: &[f64], place: [f64; 2]) -> SurfaceGradient;
}

/// `det [a b c]` of three vectors.
fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
