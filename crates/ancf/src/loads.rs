//! Dead loads on a structure: forces, moments on nodes, and the forces of a rotating frame.
//!
//! A moment m turns a node by its slope s, `theta = atan2(s_y, s_x)`, so its power is `m theta'`:
//!
//! ```text
//! Q = m I~ s / |s|²        I~ = [[0, -1], [1, 0]]
//! K = -dQ/ds = -m (I~ - 2 (I~ s) s^T / |s|²) / |s|²       (symmetric)
//! ```

mod rotating_frame;
mod surface;

pub use rotating_frame::RotatingFrame;
pub use surface::SurfaceLoads;

use crate::linear::BorderedMatrix;
use crate::system::{ForceLaw, State};

/// A moment on a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeMoment {
    /// First of the two coordinates of the slope that the moment turns.
    pub slope: usize,
    /// Moment [N m], counter-clockwise.
    pub moment: f64,
}

/// Loads that grow together by a factor.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Part of the loads that is applied.
    pub factor: f64,
    /// Constant generalised forces; may be shorter than the coordinates.
    pub dead: Vec<f64>,
    /// Moments on nodes.
    pub moments: Vec<NodeMoment>,
    /// The rotating frame that the coordinates belong to, if any.
    pub frame: Option<RotatingFrame>,
}

impl Loads {
    /// Potential [J] of the dead forces and of a rotating frame; moments have none that is
    /// single-valued.
    pub fn potential(&self, q: &[f64]) -> f64 {
        let dead: f64 = self.dead.iter().zip(q).map(|(f, x)| -f * x).sum();
        let frame = self.frame.as_ref().map_or(0.0, |frame| frame.potential(q));
        self.factor * (dead + frame)
    }
}

impl ForceLaw for Loads {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        for (sum, value) in force.iter_mut().zip(&self.dead) {
            *sum += self.factor * value;
        }
        for NodeMoment { slope, moment } in &self.moments {
            let [x, y] = [state.q[*slope], state.q[*slope + 1]];
            let factor = self.factor * moment / (x * x + y * y);
            force[*slope] -= factor * y;
            force[*slope + 1] += factor * x;
        }
        if let Some(frame) = &self.frame {
            frame.add_force(state, self.factor, force);
        }
    }

    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        for NodeMoment { slope, moment } in &self.moments {
            let s = [state.q[*slope], state.q[*slope + 1]];
            let square = s[0] * s[0] + s[1] * s[1];
            let factor = position_factor * self.factor * moment / square;
            let normal = [-s[1], s[0]];
            let cross = [[0.0, -1.0], [1.0, 0.0]];
            for i in 0..2 {
                for j in 0..2 {
                    let value = cross[i][j] - 2.0 * normal[i] * s[j] / square;
                    matrix.add(*slope + i, *slope + j, -factor * value);
                }
            }
        }
        if let Some(frame) = &self.frame {
            frame.add_tangent(self.factor, [position_factor, velocity_factor], matrix);
        }
    }
}
