//! The norm of corrections and errors: the longest vector of a node, whatever the axes.

use crate::system::Mechanics;

/// Measures coordinate vectors of one system.
#[derive(Clone, Debug)]
pub struct VectorNorm {
    /// Number of coordinates that come in vectors.
    chain: usize,
    dimension: usize,
    /// Scale of each coordinate [m per unit].
    scales: Vec<f64>,
}

impl VectorNorm {
    /// The norm of `system`, by its scales.
    #[must_use]
    pub fn new(system: &dyn Mechanics) -> Self {
        Self {
            chain: system.structure().chain(),
            dimension: system.dimension(),
            scales: system.scales().to_vec(),
        }
    }

    /// The same norm that looks only at coordinates in metres: positions.
    #[must_use]
    pub fn of_positions(system: &dyn Mechanics) -> Self {
        let mut norm = Self::new(system);
        for scale in &mut norm.scales {
            if (*scale - 1.0).abs() > f64::EPSILON {
                *scale = 0.0;
            }
        }
        norm
    }

    /// Length of the longest weighted vector of `x` and its first coordinate; NaN counts as infinite.
    #[must_use]
    pub fn largest(&self, x: &[f64]) -> (f64, usize) {
        let (vectors, single) = x.split_at(self.chain);
        let (vector_scales, single_scales) = self.scales.split_at(self.chain);
        let mut largest = (0.0, 0);
        let mut look = |square: f64, place: usize| {
            let square = if square.is_nan() {
                f64::INFINITY
            } else {
                square
            };
            if square > largest.0 {
                largest = (square, place);
            }
        };
        for (i, (vector, scales)) in vectors
            .chunks_exact(self.dimension)
            .zip(vector_scales.chunks_exact(self.dimension))
            .enumerate()
        {
            let length: f64 = vector.iter().map(|x| x * x).sum();
            look(length * scales[0] * scales[0], i * self.dimension);
        }
        for (i, (x, scale)) in single.iter().zip(single_scales).enumerate() {
            look((x * scale).powi(2), self.chain + i);
        }
        (largest.0.sqrt(), largest.1)
    }
}
