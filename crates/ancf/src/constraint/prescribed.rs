//! Right-hand sides of constraints as functions of time.

use std::sync::Arc;

use crate::system::Motion;

/// A value that does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

impl Motion for Constant {
    fn at(&self, _time: f64) -> [f64; 3] {
        [self.0, 0.0, 0.0]
    }
}

/// A component of a vector that turns by a prescribed angle: `R(theta) p`, with
///
/// ```text
/// (R p)' = theta' I~ R p      (R p)'' = theta'' I~ R p - theta'² R p
/// ```
#[derive(Clone, Debug)]
pub struct TurnedComponent {
    /// theta(t) [rad].
    pub angle: Arc<dyn Motion>,
    /// p at theta = 0.
    pub vector: [f64; 2],
    /// 0 for x, 1 for y.
    pub axis: usize,
}

impl Motion for TurnedComponent {
    fn at(&self, time: f64) -> [f64; 3] {
        let [angle, rate, acceleration] = self.angle.at(time);
        let (sine, cosine) = angle.sin_cos();
        let [x, y] = self.vector;
        let turned = [cosine * x - sine * y, sine * x + cosine * y];
        let normal = [-turned[1], turned[0]];
        let axis = self.axis.min(1);
        [
            turned[axis],
            rate * normal[axis],
            acceleration * normal[axis] - rate * rate * turned[axis],
        ]
    }
}
