//! Shape functions of the belt's contact line at the integration points of an element.

use ancf::element::LineElement;
use ancf::quadrature::Rule;
use ancf::scalar::{Lanes, Scalar};

/// Integration points computed side by side.
pub(super) const LANES: usize = 8;
/// Most vectors that a contact line reads: four of a cubic centre line, two across the section.
pub(super) const MAX_VECTORS: usize = 6;

/// Which vectors of an element the contact line reads: those of the centre line first, then, for a line
/// on a face of the belt, the slopes across the section at both nodes.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// Local vectors in the order of the slots.
    pub vectors: Vec<usize>,
    /// How many of them belong to the centre line: two for a straight one, four for a cubic.
    pub centre: usize,
    /// Local vectors of the slots `a <= b` in the order `(0, 0), (0, 1), ..., (1, 1), ...`.
    pub pairs: Vec<[usize; 2]>,
}

impl Line {
    /// The line that elements `E` make at height `y` over their centre line.
    pub fn new<E: LineElement>(y: f64) -> Self {
        let mut vectors = E::CENTRE_VECTORS.to_vec();
        if y != 0.0 {
            vectors.extend(E::SECTION_VECTORS);
        }
        let pairs = slot_pairs(vectors.len())
            .map(|pair| pair.map(|slot| vectors[slot]))
            .collect();
        Self {
            vectors,
            centre: E::CENTRE_VECTORS.len(),
            pairs,
        }
    }

    /// Centre and radius of a disc that holds all points up to `height` beside the centre line: the hull
    /// of its Bézier points for a cubic (r1, r1_x, r2, r2_x), of its ends for a straight one, widened.
    /// `third` is a third of the element's undeformed length [m].
    #[inline(always)]
    pub fn hull<S: Scalar>(
        &self,
        third: S,
        height: f64,
        vectors: &[[S; 2]; MAX_VECTORS],
    ) -> ([S; 2], S) {
        let cubic = self.centre == 4;
        let (first, last) = (vectors[0], vectors[if cubic { 2 } else { 1 }]);
        let middle = [(first[0] + last[0]) * 0.5, (first[1] + last[1]) * 0.5];
        let square = |x: S, y: S| {
            let (dx, dy) = (x - middle[0], y - middle[1]);
            dx * dx + dy * dy
        };
        let mut reach = square(first[0], first[1]);
        if cubic {
            let (a, b) = (vectors[1], vectors[3]);
            reach = larger(
                reach,
                square(first[0] + third * a[0], first[1] + third * a[1]),
            );
            reach = larger(
                reach,
                square(last[0] - third * b[0], last[1] - third * b[1]),
            );
        }
        let mut reach = reach.sqrt();
        if height > 0.0 {
            let across = |v: [S; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
            let slopes = [vectors[self.centre], vectors[self.centre + 1]].map(across);
            reach += larger(slopes[0], slopes[1]) * height;
        }
        (middle, reach)
    }
}

#[inline(always)]
fn larger<S: Scalar>(a: S, b: S) -> S {
    (a - b).select_positive(a, b)
}

/// Pairs `a <= b` of so many slots, row by row.
fn slot_pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |a| (a..count).map(move |b| [a, b]))
}

/// Shape functions at the points of one kind of element, at one height over the centre line.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub batches: Vec<BatchTable>,
}

/// Up to eight points. Lanes without a point repeat the last one with weight zero.
#[derive(Clone, Debug)]
pub(super) struct BatchTable {
    /// By slot, by lane.
    pub shape: [Lanes<LANES>; MAX_VECTORS],
    /// The same by lane, by slot, padded with zeros.
    pub by_lane: [Lanes<LANES>; LANES],
    /// Quadrature weight times length [m], by lane.
    pub weight: [f64; LANES],
    /// Products of the shape functions of the pairs of [`Line::pairs`], eight at a time: by lane, by pair, padded
    /// with zeros.
    pub products: Vec<[Lanes<LANES>; LANES]>,
}

impl Table {
    pub fn new<E: LineElement>(element: &E, line: &Line, rule: &Rule, height: f64) -> Self {
        let zero = Lanes([0.0; LANES]);
        let mut weights = vec![0.0; E::NODES * E::NODE_VECTORS];
        let batches = (0..rule.points.len().div_ceil(LANES))
            .map(|batch| {
                let mut table = BatchTable {
                    shape: [zero; MAX_VECTORS],
                    by_lane: [zero; LANES],
                    weight: zero.0,
                    products: Vec::new(),
                };
                for lane in 0..LANES {
                    let k = batch * LANES + lane;
                    let xi = rule.points[k.min(rule.points.len() - 1)];
                    element.centre_line(xi, &mut weights);
                    if height != 0.0 {
                        let [first, second] = E::SECTION_VECTORS;
                        weights[first] += height * (1.0 - xi);
                        weights[second] += height * xi;
                    }
                    for (slot, vector) in line.vectors.iter().enumerate() {
                        table.shape[slot].0[lane] = weights[*vector];
                        table.by_lane[lane].0[slot] = weights[*vector];
                    }
                    if k < rule.points.len() {
                        table.weight[lane] = rule.weights[k] * element.length();
                    }
                }
                let pairs: Vec<_> = slot_pairs(line.vectors.len()).collect();
                for pairs in pairs.chunks(LANES) {
                    let mut group = [zero; LANES];
                    for (k, [a, b]) in pairs.iter().enumerate() {
                        for lane in 0..LANES {
                            group[lane].0[k] = table.shape[*a].0[lane] * table.shape[*b].0[lane];
                        }
                    }
                    table.products.push(group);
                }
                table
            })
            .collect();
        Self { batches }
    }
}
