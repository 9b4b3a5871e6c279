//! The norm of corrections and errors: the longest vector of a node, whatever the axes.

use pulp::Arch;

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

    /// Length of the longest weighted vector of `x`; infinite where a value is not finite.
    #[must_use]
    pub fn size(&self, x: &[f64]) -> f64 {
        let (vectors, single) = x.split_at(self.chain);
        let (scales, single_scales) = self.scales.split_at(self.chain);
        let mut sizes = Sizes::default();
        match self.dimension {
            2 => sizes.take::<2>(vectors, scales),
            3 => sizes.take::<3>(vectors, scales),
            _ => sizes.take::<1>(vectors, scales),
        }
        sizes.take::<1>(single, single_scales);
        sizes.largest().sqrt()
    }

    /// First coordinate of the longest weighted vector of `x`; the first value that is not a number counts as longest.
    #[must_use]
    pub fn place(&self, x: &[f64]) -> usize {
        let mut largest = (0.0, 0);
        let mut first = 0;
        while first < x.len() {
            let end = if first < self.chain {
                first + self.dimension
            } else {
                first + 1
            };
            let square: f64 = x[first..end].iter().map(|x| x * x).sum();
            let square = square * self.scales[first] * self.scales[first];
            let square = if square.is_nan() {
                f64::INFINITY
            } else {
                square
            };
            if square > largest.0 {
                largest = (square, first);
            }
            first = end;
        }
        largest.1
    }
}

/// Vectors looked at side by side.
const LANES: usize = 8;

/// The largest square of a weighted vector so far, by lane.
#[derive(Default)]
struct Sizes {
    largest: [f64; LANES],
    /// Zero as long as all squares are finite, not a number from then on.
    finite: [f64; LANES],
}

impl Sizes {
    /// Takes in vectors of `N` components whose scales are alike.
    fn take<const N: usize>(&mut self, vectors: &[f64], scales: &[f64]) {
        let (vectors, _) = vectors.as_chunks::<N>();
        let (scales, _) = scales.as_chunks::<N>();
        let (groups, rest) = vectors.as_chunks::<LANES>();
        let (group_scales, rest_scales) = scales.as_chunks::<LANES>();
        Arch::new().dispatch(
            #[inline(always)]
            || {
                for (group, scales) in groups.iter().zip(group_scales) {
                    for lane in 0..LANES {
                        self.look(lane, &group[lane], scales[lane][0]);
                    }
                }
            },
        );
        for (vector, scales) in rest.iter().zip(rest_scales) {
            self.look(0, vector, scales[0]);
        }
    }

    #[inline(always)]
    fn look<const N: usize>(&mut self, lane: usize, vector: &[f64; N], scale: f64) {
        let square = vector.iter().map(|x| x * x).sum::<f64>() * (scale * scale);
        self.finite[lane] += 0.0 * square;
        let largest = &mut self.largest[lane];
        *largest = if square > *largest { square } else { *largest };
    }

    fn largest(&self) -> f64 {
        if self.finite.iter().any(|x| x.is_nan()) {
            return f64::INFINITY;
        }
        self.largest
            .iter()
            .fold(0.0, |largest: f64, x| largest.max(*x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of 2, 3 and 1 components, in numbers that do and do not fill eight lanes: the largest and its place as plain loops find
    /// them, and nothing that is not finite is lost in a lane.
    #[test]
    fn sizes_and_places_are_those_of_plain_loops() {
        for dimension in [1, 2, 3] {
            for vectors in [1, 7, 8, 9, 20] {
                let chain = dimension * vectors;
                let scales: Vec<f64> = (0..vectors)
                    .flat_map(|k| vec![1.0 + (k % 3) as f64; dimension])
                    .chain([0.5, 4.0])
                    .collect();
                let norm = VectorNorm {
                    chain,
                    dimension,
                    scales: scales.clone(),
                };
                let mut x: Vec<f64> = (0..chain + 2).map(|i| (i as f64 * 1.7).sin()).collect();
                let length = |x: &[f64], first: usize| {
                    let count = if first < chain { dimension } else { 1 };
                    let square: f64 = x[first..first + count].iter().map(|x| x * x).sum();
                    square.sqrt() * scales[first]
                };
                let places = || (0..chain).step_by(dimension).chain([chain, chain + 1]);
                let place = places()
                    .max_by(|a, b| length(&x, *a).total_cmp(&length(&x, *b)))
                    .expect("some");
                assert!((norm.size(&x) - length(&x, place)).abs() < 1.0e-14);
                assert_eq!(norm.place(&x), place);
                for bad in [f64::NAN, f64::INFINITY] {
                    for i in 0..x.len() {
                        let good = std::mem::replace(&mut x[i], bad);
                        assert!(norm.size(&x).is_infinite(), "{dimension}, {vectors}, {i}");
                        x[i] = good;
                    }
                }
            }
        }
    }
}
