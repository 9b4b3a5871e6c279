//! A vector of a node that a planar rigid body carries.
//!
//! ```text
//! C = e - s x - R(phi) p = 0      s = 1: the node's place, hinged to the body at p
//!                                 s = 0: a slope of the node, turning with the body
//! C_q^T lambda: lambda on e, -s lambda on x, -(I~ R p).lambda on phi
//! (C_q^T lambda)_q: (R p).lambda in (phi, phi)      Q_d = -R p phi'²
//! ```
//!
//! x, phi: place of the body's centre of mass and its angle.

use crate::linear::BorderedMatrix;
use crate::state::State;

/// A vector of a node, held by a planar rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyAttachment {
    /// What the user calls it.
    pub name: String,
    /// First of the two coordinates of the node's vector.
    pub vector: usize,
    /// First of the body's coordinates x, y, angle.
    pub body: usize,
    /// The vector p in the body's axes: [m] for a place, else [-].
    pub arm: [f64; 2],
    /// Whether the vector is a place (s = 1) or a slope (s = 0).
    pub is_place: bool,
}

impl BodyAttachment {
    fn follows(&self) -> f64 {
        if self.is_place { 1.0 } else { 0.0 }
    }

    /// R p.
    #[inline]
    fn turned(&self, q: &[f64]) -> [f64; 2] {
        let (sine, cosine) = q[self.body + 2].sin_cos();
        let [x, y] = self.arm;
        [cosine * x - sine * y, sine * x + cosine * y]
    }

    pub(super) fn node_coordinates(&self) -> [usize; 2] {
        [self.vector, self.vector + 1]
    }

    pub(super) fn body_place(&self) -> [usize; 2] {
        [self.body, self.body + 1]
    }

    pub(super) fn body_coordinates(&self) -> [usize; 3] {
        [self.body, self.body + 1, self.body + 2]
    }

    /// Value, rate and acceleration of R p by axis.
    #[inline]
    fn arm_motion(&self, q: &[f64], v: &[f64], a: &[f64]) -> [[f64; 3]; 2] {
        let p = self.turned(q);
        let normal = [-p[1], p[0]];
        let (rate, acceleration) = (v[self.body + 2], a[self.body + 2]);
        std::array::from_fn(|i| {
            [
                p[i],
                normal[i] * rate,
                normal[i] * acceleration - p[i] * rate * rate,
            ]
        })
    }

    #[inline]
    pub(super) fn place_node(&self, q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        let s = self.follows();
        for (i, [value, rate, acceleration]) in self.arm_motion(q, v, a).into_iter().enumerate() {
            let (node, body) = (self.vector + i, self.body + i);
            q[node] = s * q[body] + value;
            v[node] = s * v[body] + rate;
            a[node] = s * a[body] + acceleration;
        }
    }

    #[inline]
    pub(super) fn place_body(&self, q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        for (i, [value, rate, acceleration]) in self.arm_motion(q, v, a).into_iter().enumerate() {
            let (node, body) = (self.vector + i, self.body + i);
            q[body] = q[node] - value;
            v[body] = v[node] - rate;
            a[body] = a[node] - acceleration;
        }
    }

    /// Adds `C_q^T lambda`.
    #[inline]
    pub(super) fn add_force(&self, q: &[f64], multiplier: [f64; 2], residual: &mut [f64]) {
        let p = self.turned(q);
        for (i, value) in multiplier.into_iter().enumerate() {
            residual[self.vector + i] += value;
            residual[self.body + i] -= self.follows() * value;
        }
        residual[self.body + 2] -= p[0] * multiplier[1] - p[1] * multiplier[0];
    }

    /// Adds C_q and its transpose in the rows and columns from `first`, and the multipliers' tangent.
    pub(super) fn add_tangent(
        &self,
        q: &[f64],
        multiplier: [f64; 2],
        position_factor: f64,
        first: usize,
        matrix: &mut BorderedMatrix,
    ) {
        for (k, row) in self.rows(q).into_iter().enumerate() {
            for (i, value) in row {
                matrix.add(first + k, i, value);
                matrix.add(i, first + k, value);
            }
        }
        let p = self.turned(q);
        let angle = self.body + 2;
        let value = p[0] * multiplier[0] + p[1] * multiplier[1];
        matrix.add(angle, angle, position_factor * value);
    }

    /// Rows of C_q.
    pub(super) fn rows(&self, q: &[f64]) -> [Vec<(usize, f64)>; 2] {
        let p = self.turned(q);
        let by_angle = [p[1], -p[0]];
        std::array::from_fn(|i| {
            vec![
                (self.vector + i, 1.0),
                (self.body + i, -self.follows()),
                (self.body + 2, by_angle[i]),
            ]
        })
    }

    /// Q_d.
    pub(super) fn acceleration_right(&self, state: State<'_>) -> [f64; 2] {
        let rate = state.v[self.body + 2];
        self.turned(state.q).map(|p| -p * rate * rate)
    }

    /// `C` and its rate, axis by axis.
    pub(super) fn values(&self, State { q, v, .. }: State<'_>) -> [[f64; 2]; 2] {
        let s = self.follows();
        let p = self.turned(q);
        let normal = [-p[1], p[0]];
        let rate = v[self.body + 2];
        std::array::from_fn(|i| {
            let (node, body) = (self.vector + i, self.body + i);
            [
                q[node] - s * q[body] - p[i],
                v[node] - s * v[body] - normal[i] * rate,
            ]
        })
    }
}
