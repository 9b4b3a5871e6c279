//! Coordinates in a frame that turns with constant speed about the origin.
//!
//! All vectors of all nodes are turned alike, `q = R(Omega t) p`, elastic forces are objective and the
//! mass matrix acts on whole vectors, so it commutes with R and with I~:
//!
//! ```text
//! M p'' = f(p) + Omega² M p - 2 Omega M I~ p'
//! ```
//!
//! The same for the place of a rigid body; its angle, measured in the frame, feels neither force.

use crate::linear::BorderedMatrix;
use crate::system::State;

/// A frame turning about the origin.
#[derive(Clone, Debug)]
pub struct RotatingFrame {
    /// Omega [rad/s], counter-clockwise.
    speed: f64,
    /// Entries of M that act on vectors.
    entries: Vec<Entry>,
}

/// An entry of M, and where the Coriolis force reads the other component of the same vector.
#[derive(Clone, Copy, Debug)]
struct Entry {
    row: usize,
    column: usize,
    partner: usize,
    /// Of I~: -1 for the x component, 1 for y.
    sign: f64,
    mass: f64,
}

impl RotatingFrame {
    /// A frame with speed `speed` [rad/s] for a planar system with mass matrix `mass`: vectors in the
    /// chain, then `bodies` rigid bodies with x, y and angle.
    #[must_use]
    pub fn new(speed: f64, mass: &BorderedMatrix, bodies: usize) -> Self {
        let chain = mass.structure().chain();
        // 0 for x, 1 for y, 2 for an angle
        let component = |i: usize| if i < chain { i % 2 } else { (i - chain) % 3 };
        let end = chain + 3 * bodies;
        let entries = (mass.triplets())
            .filter(|(row, column, value)| {
                *value != 0.0 && *row < end && *column < end && component(*column) < 2
            })
            .map(|(row, column, mass)| {
                let (partner, sign) = if component(column) == 0 {
                    (column + 1, -1.0)
                } else {
                    (column - 1, 1.0)
                };
                Entry {
                    row,
                    column,
                    partner,
                    sign,
                    mass,
                }
            })
            .collect();
        Self { speed, entries }
    }

    /// Omega [rad/s].
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Centrifugal potential [J], `-Omega² p.M p / 2`.
    pub fn potential(&self, p: &[f64]) -> f64 {
        let sum: f64 = (self.entries.iter())
            .map(|entry| p[entry.row] * entry.mass * p[entry.column])
            .sum();
        -0.5 * self.speed * self.speed * sum
    }

    pub(super) fn add_force(&self, state: State<'_>, factor: f64, force: &mut [f64]) {
        let centrifugal = factor * self.speed * self.speed;
        let coriolis = 2.0 * self.speed;
        for entry in &self.entries {
            force[entry.row] += entry.mass
                * (centrifugal * state.q[entry.column]
                    - coriolis * entry.sign * state.v[entry.partner]);
        }
    }

    pub(super) fn add_tangent(&self, factor: f64, factors: [f64; 2], matrix: &mut BorderedMatrix) {
        let [position_factor, velocity_factor] = factors;
        let centrifugal = position_factor * factor * self.speed * self.speed;
        let coriolis = velocity_factor * 2.0 * self.speed;
        for entry in &self.entries {
            matrix.add(entry.row, entry.column, -centrifugal * entry.mass);
            if coriolis != 0.0 {
                matrix.add(entry.row, entry.partner, coriolis * entry.sign * entry.mass);
            }
        }
    }
}
