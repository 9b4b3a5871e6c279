//! The centre line of a spatial belt beam by three vectors: the chord `r2 - r1` and the slopes r1_x, r2_x.
//!
//! The Hermite functions of r1 and r2 have opposite derivatives, so c and c' need three functions
//! instead of four.

use super::DOF;
use crate::element::hermite;
use crate::scalar::Scalar;

/// Vectors (or forces on them) of the centre line.
pub(super) type Lines<S> = [[S; 3]; 3];

/// Derivatives of the three shape functions at one quadrature point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    /// First derivatives by x.
    pub slope: [f64; 3],
    /// Second derivatives by x.
    pub curve: [f64; 3],
}

impl Shape {
    pub fn new(xi: f64, length: f64) -> Self {
        let [_, left, chord, right] = hermite::slope(xi, length);
        let slope = [chord, left, right];
        let [_, left, chord, right] = hermite::curve(xi, length);
        Self {
            slope,
            curve: [chord, left, right],
        }
    }

    /// `c` and `c'`.
    #[inline(always)]
    pub fn apply<S: Scalar>(&self, lines: &Lines<S>) -> ([S; 3], [S; 3]) {
        let (mut c, mut curve) = ([S::zero(); 3], [S::zero(); 3]);
        for (k, line) in lines.iter().enumerate() {
            for i in 0..3 {
                c[i] += line[i] * self.slope[k];
                curve[i] += line[i] * self.curve[k];
            }
        }
        (c, curve)
    }

    /// Adds what derivatives by c and c' are by the line vectors.
    #[inline(always)]
    pub fn add<S: Scalar>(&self, by_c: [S; 3], by_curve: [S; 3], lines: &mut Lines<S>) {
        for (k, line) in lines.iter_mut().enumerate() {
            for i in 0..3 {
                line[i] += by_c[i] * self.slope[k] + by_curve[i] * self.curve[k];
            }
        }
    }
}

/// The line vectors of coordinates.
#[inline(always)]
pub(super) fn lines<S: Scalar>(e: &[S; DOF]) -> Lines<S> {
    [
        [e[12] - e[0], e[13] - e[1], e[14] - e[2]],
        [e[3], e[4], e[5]],
        [e[15], e[16], e[17]],
    ]
}
