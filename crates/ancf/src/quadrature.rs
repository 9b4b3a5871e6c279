//! Quadrature over the unit interval.

use std::num::NonZeroUsize;

use gauss_quad::legendre::GaussLegendre;

/// A quadrature rule on `[0, 1]`: points and weights that sum to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Points in `[0, 1]`, increasing.
    pub points: Vec<f64>,
    /// Weights, same order.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The Gauss-Legendre rule of `count` points: exact for polynomials of degree `2 count - 1`.
    #[must_use]
    pub fn gauss(count: NonZeroUsize) -> Self {
        let mut pairs: Vec<(f64, f64)> = GaussLegendre::new(count)
            .iter()
            .map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (points, weights) = pairs.into_iter().unzip();
        Self { points, weights }
    }
}
