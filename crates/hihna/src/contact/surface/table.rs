//! Shape functions of a belt's surface at the contact points of an element.

use ancf::element::SurfaceElement;
use ancf::quadrature::Rule;

/// Contact points computed side by side.
pub(super) const LANES: usize = 8;
/// Most vectors of an element: of a thin plate. Elements with fewer have zeros in the rest.
pub(super) const VECTORS: usize = 12;

/// Shape functions at the points of one kind of element.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub batches: Vec<Batch>,
}

/// Up to eight points. Lanes without a point repeat the last one with area zero.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    /// By vector, by lane.
    pub shape: [[f64; LANES]; VECTORS],
    /// By lane, by vector.
    pub by_lane: [[f64; VECTORS]; LANES],
    /// Quadrature weight times area [m²], by lane.
    pub area: [f64; LANES],
}

impl Table {
    /// Points of `rule` along and across the surface of `element`, rows across together.
    pub fn of_surface<E: SurfaceElement>(element: &E, rule: &Rule) -> Self {
        let count = rule.points.len();
        let area = element.length() * element.width();
        let mut weights = [0.0; VECTORS];
        Self::new(count * count, |k| {
            let (i, j) = (k / count, k % count);
            element.surface([rule.points[i], rule.points[j]], &mut weights);
            (weights, rule.weights[i] * rule.weights[j] * area)
        })
    }

    /// `count` points, each with a weight for every vector of the element and an area [m²].
    pub fn new(count: usize, mut point: impl FnMut(usize) -> ([f64; VECTORS], f64)) -> Self {
        let batches = (0..count.div_ceil(LANES))
            .map(|first| {
                let mut batch = Batch {
                    shape: [[0.0; LANES]; VECTORS],
                    by_lane: [[0.0; VECTORS]; LANES],
                    area: [0.0; LANES],
                };
                for lane in 0..LANES {
                    let k = first * LANES + lane;
                    let (weights, area) = point(k.min(count - 1));
                    for (slot, weight) in weights.into_iter().enumerate() {
                        batch.shape[slot][lane] = weight;
                        batch.by_lane[lane][slot] = weight;
                    }
                    if k < count {
                        batch.area[lane] = area;
                    }
                }
                batch
            })
            .collect();
        Self { batches }
    }
}
