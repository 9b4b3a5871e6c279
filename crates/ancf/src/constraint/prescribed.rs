//! Right-hand sides of constraints as functions of time.

use std::sync::Arc;

use crate::state::Motion;

/// A value that does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

impl Motion for Constant {
    fn at(&self, _time: f64) -> [f64; 3] {
        [self.0, 0.0, 0.0]
    }
}

/// The rotation of a spin-up manoeuvre, smooth to its second derivative (Wu & Haug; Kerkkänen 2006,
/// 2.35):
///
/// ```text
/// theta = (w/T) [t²/2 + (T/2pi)² (cos(2 pi t/T) - 1)]    t < T
/// theta = w (t - T/2)                                    t >= T
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinUp {
    /// Final speed w [rad/s].
    pub speed: f64,
    /// Time T to reach it [s].
    pub rise_time: f64,
}

impl Motion for SpinUp {
    fn at(&self, time: f64) -> [f64; 3] {
        let (w, rise) = (self.speed, self.rise_time);
        if time >= rise {
            return [w * (time - 0.5 * rise), w, 0.0];
        }
        let rate = std::f64::consts::TAU / rise;
        let (sine, cosine) = (rate * time).sin_cos();
        [
            w / rise * (0.5 * time * time + (cosine - 1.0) / (rate * rate)),
            w / rise * (time - sine / rate),
            w / rise * (1.0 - cosine),
        ]
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
