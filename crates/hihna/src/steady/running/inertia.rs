//! Inertia of a belt that runs through a mesh at rest.
//!
//! A material point has the acceleration `c² R''`. By parts along the closed belt its virtual work is
//!
//! ```text
//! -int rho A c² dR . R'' dxi = c² int rho A dR' . R' dxi
//! ```
//!
//! without terms at ends, R being continuous; the slopes across the section likewise with `rho I2`. Densities are read
//! off the element's own mass matrix.

use std::num::NonZeroUsize;

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;

use super::line::{MOST_DOF, MOST_VECTORS};

/// Squares of the derivatives of a cubic are of degree four, its products with them of degree five.
const POINTS: NonZeroUsize = match NonZeroUsize::new(3) {
    Some(points) => points,
    None => NonZeroUsize::MIN,
};

/// `int rho A N' N'^T + rho I2 H' H'^T dxi` of every element, between its vectors.
#[derive(Clone, Debug)]
pub(super) struct ConvectiveInertia {
    vectors: usize,
    /// Row-major `MOST_VECTORS` a row.
    matrices: Vec<[f64; MOST_VECTORS * MOST_VECTORS]>,
    /// The gyroscopic `int rho A (N N'^T - N' N^T) + ... dxi`, likewise: it turns rates into forces of small motions.
    gyroscopic: Vec<[f64; MOST_VECTORS * MOST_VECTORS]>,
}

impl ConvectiveInertia {
    pub fn new<E: LineElement>(mesh: &Mesh<E>) -> Self {
        let rule = Rule::gauss(POINTS);
        let elements = mesh.elements().iter();
        let (matrices, gyroscopic) = elements.map(|element| of_element(element, &rule)).unzip();
        Self {
            vectors: E::NODES * E::NODE_VECTORS,
            matrices,
            gyroscopic,
        }
    }

    /// Adds `factor` times its product with the coordinates `q` to `out`.
    pub fn add_product<E: LineElement>(
        &self,
        mesh: &Mesh<E>,
        factor: f64,
        q: &[f64],
        out: &mut [f64],
    ) {
        let mut e = [0.0; MOST_DOF];
        for (element, matrix) in self.matrices.iter().enumerate() {
            mesh.gather(element, q, &mut e[..E::DOF]);
            let mut local = [0.0; MOST_DOF];
            for a in 0..self.vectors {
                for b in 0..self.vectors {
                    let value = factor * matrix[a * MOST_VECTORS + b];
                    for axis in 0..2 {
                        local[2 * a + axis] += value * e[2 * b + axis];
                    }
                }
            }
            mesh.scatter(element, &local[..E::DOF], out);
        }
    }

    /// Adds `factor` times itself to `matrix`.
    pub fn add_to(&self, factor: f64, matrix: &mut BorderedMatrix) {
        self.add(&self.matrices, factor, matrix);
    }

    /// Adds `factor` times the gyroscopic matrix to `matrix`.
    pub fn add_gyroscopic(&self, factor: f64, matrix: &mut BorderedMatrix) {
        self.add(&self.gyroscopic, factor, matrix);
    }

    fn add(
        &self,
        matrices: &[[f64; MOST_VECTORS * MOST_VECTORS]],
        factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        let dof = 2 * self.vectors;
        let mut local = [0.0; MOST_DOF * MOST_DOF];
        for (element, values) in matrices.iter().enumerate() {
            for a in 0..self.vectors {
                for b in 0..self.vectors {
                    for axis in 0..2 {
                        local[(2 * a + axis) * dof + 2 * b + axis] = values[a * MOST_VECTORS + b];
                    }
                }
            }
            matrix.add_pair(element, factor, &local[..dof * dof]);
        }
    }
}

/// The matrix of one element and its gyroscopic one.
fn of_element<E: LineElement>(
    element: &E,
    rule: &Rule,
) -> (
    [f64; MOST_VECTORS * MOST_VECTORS],
    [f64; MOST_VECTORS * MOST_VECTORS],
) {
    let vectors = E::NODES * E::NODE_VECTORS;
    let mut mass = [0.0; MOST_VECTORS * MOST_VECTORS];
    element.vector_mass(&mut mass[..vectors * vectors]);
    let between = |a: usize, b: usize| mass[a * vectors + b];
    let length = element.length();
    let [first, second] = E::SECTION_VECTORS;
    let (r0, r1) = if let [r0, _, r1, _] = *E::CENTRE_VECTORS {
        (r0, r1)
    } else {
        (E::CENTRE_VECTORS[0], E::CENTRE_VECTORS[1])
    };
    // A rigid translation has the whole mass, a uniform turn of the sections the whole rotary inertia.
    let whole = |a, b| (between(a, a) + 2.0 * between(a, b) + between(b, b)) / length;
    let (line, rotary) = (whole(r0, r1), whole(first, second));
    let mut out = [0.0; MOST_VECTORS * MOST_VECTORS];
    let mut turning = [0.0; MOST_VECTORS * MOST_VECTORS];
    let mut value = [0.0; MOST_VECTORS];
    let mut slope = [0.0; MOST_VECTORS];
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        element.centre_line(*xi, &mut value[..vectors]);
        element.centre_line_slope(*xi, &mut slope[..vectors]);
        for a in 0..vectors {
            for b in 0..vectors {
                let mass = weight * length * line;
                out[a * MOST_VECTORS + b] += mass * slope[a] * slope[b];
                turning[a * MOST_VECTORS + b] += mass * (value[a] * slope[b] - slope[a] * value[b]);
            }
        }
    }
    let stretch = rotary / length;
    for (a, b, value) in [
        (first, first, stretch),
        (second, second, stretch),
        (first, second, -stretch),
        (second, first, -stretch),
    ] {
        out[a * MOST_VECTORS + b] += value;
    }
    // int H H'^T - H' H^T of linear functions is 1 off the diagonal, whatever the length.
    turning[first * MOST_VECTORS + second] += rotary;
    turning[second * MOST_VECTORS + first] -= rotary;
    (out, turning)
}
