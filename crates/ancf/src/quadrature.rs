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

    /// The composite trapezoidal rule of `count` equally spaced points, the ends among them; of one point, the
    /// middle. Its weights are positive at any number of points, unlike those of the closed Newton-Cotes
    /// rules, of which that of nine points has negative ones.
    #[must_use]
    pub fn trapezoidal(count: NonZeroUsize) -> Self {
        let Some(intervals) = NonZeroUsize::new(count.get() - 1) else {
            return Self::gauss(count);
        };
        let last = intervals.get();
        let part = 1.0 / last as f64;
        Self {
            points: (0..=last).map(|i| i as f64 * part).collect(),
            weights: (0..=last)
                .map(|i| {
                    if i == 0 || i == last {
                        0.5 * part
                    } else {
                        part
                    }
                })
                .collect(),
        }
    }
}
