//! Shape functions of a belt's surface at the contact points of an element.

use ancf::element::{LineElement, SurfaceElement};
use ancf::quadrature::Rule;

use super::face::Face;
use super::meridian::Side;

/// Contact points computed side by side.
pub(super) const LANES: usize = 8;
/// Most vectors of an element: of a thin plate. Elements with fewer have zeros in the rest.
pub(super) const VECTORS: usize = 12;

/// Shape functions at the points of one kind of element, on one face of it.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Side by side of the section.
    pub batches: Vec<Batch>,
    /// Points across the section, on all sides.
    pub across: usize,
    /// Points across on each side.
    on_a_side: usize,
    /// Batches of each side.
    batches_on_a_side: usize,
}

/// Up to eight points on one side. Lanes without a point repeat the last one with area zero.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    pub side: Side,
    /// By vector, by lane.
    pub shape: [[f64; LANES]; VECTORS],
    /// By lane, by vector.
    pub by_lane: [[f64; VECTORS]; LANES],
    /// Quadrature weight times area [m²], by lane.
    pub area: [f64; LANES],
}

impl Table {
    /// Points of `rule` along and across the surface of `element`.
    pub fn of_surface<E: SurfaceElement>(element: &E, rule: &Rule) -> Self {
        let count = rule.points.len();
        let area = element.length() * element.width();
        let mut weights = [0.0; VECTORS];
        Self::new(count, count, &[Side::Face], |[i, j]| {
            element.surface([rule.points[i], rule.points[j]], &mut weights);
            (weights, rule.weights[i] * rule.weights[j] * area)
        })
    }

    /// Points of `rule` along the spatial beam `element`, those of `face` across it. They move with the position field
    /// of the mass matrix, `r_c + y r_y + z r_z` with the slopes linear along the element: a sum over its vectors.
    pub fn of_face<E: LineElement>(element: &E, rule: &Rule, face: &Face) -> Self {
        let [first, second] = E::SECTION_VECTORS;
        let on_a_side = face.points.len() / face.sides.len();
        Self::new(rule.points.len(), on_a_side, &face.sides, |[i, j]| {
            let (xi, point) = (rule.points[i], face.points[j]);
            let mut weights = [0.0; VECTORS];
            element.centre_line(xi, &mut weights);
            for (vector, part) in [(first, 1.0 - xi), (second, xi)] {
                weights[vector] += point.y * part;
                weights[vector + 1] += point.z * part;
            }
            (weights, rule.weights[i] * element.length() * point.width)
        })
    }

    /// `along` times `on_a_side` points on each of `sides`, each with a weight for every vector of the element and an
    /// area [m²]; the points across are counted through all sides.
    fn new(
        along: usize,
        on_a_side: usize,
        sides: &[Side],
        mut point: impl FnMut([usize; 2]) -> ([f64; VECTORS], f64),
    ) -> Self {
        let count = along * on_a_side;
        let batches_on_a_side = count.div_ceil(LANES);
        let mut batches = Vec::with_capacity(batches_on_a_side * sides.len());
        for (s, side) in sides.iter().enumerate() {
            for first in (0..count).step_by(LANES) {
                let mut batch = Batch {
                    side: *side,
                    shape: [[0.0; LANES]; VECTORS],
                    by_lane: [[0.0; VECTORS]; LANES],
                    area: [0.0; LANES],
                };
                for lane in 0..LANES {
                    let k = (first + lane).min(count - 1);
                    let (weights, area) = point([k / on_a_side, s * on_a_side + k % on_a_side]);
                    for (slot, weight) in weights.into_iter().enumerate() {
                        batch.shape[slot][lane] = weight;
                        batch.by_lane[lane][slot] = weight;
                    }
                    if first + lane < count {
                        batch.area[lane] = area;
                    }
                }
                batches.push(batch);
            }
        }
        Self {
            batches,
            across: on_a_side * sides.len(),
            on_a_side,
            batches_on_a_side,
        }
    }

    /// Batch and lane of the point `i` along and `j` across.
    pub fn place(&self, [i, j]: [usize; 2]) -> (&Batch, usize) {
        let k = i * self.on_a_side + j % self.on_a_side;
        let batch = j / self.on_a_side * self.batches_on_a_side + k / LANES;
        (&self.batches[batch], k % LANES)
    }
}
