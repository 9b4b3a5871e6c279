//! The state of a system, and how coordinates are told to move.

use std::fmt;

/// Time, coordinates and velocities.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Time [s].
    pub time: f64,
    /// Coordinates.
    pub q: &'a [f64],
    /// Velocities.
    pub v: &'a [f64],
}

/// A prescribed motion of one coordinate.
pub trait Motion: fmt::Debug + Send + Sync {
    /// Position, velocity and acceleration at `time`; right-hand values at kinks.
    fn at(&self, time: f64) -> [f64; 3];
}
