//! The line of an element that touches a pulley, and where it lies on it.

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;

use crate::contact::{ContactPulley, Meeting, Penalty, PointContact};

/// Most vectors of a planar element.
pub(super) const MOST_VECTORS: usize = 6;
/// Most coordinates of a planar element.
pub(super) const MOST_DOF: usize = 2 * MOST_VECTORS;

/// The contact line as a polynomial of `xi`: the centre line, or a face of the belt.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactLine {
    powers: [[f64; 2]; 4],
    /// Undeformed length of the element [m].
    pub length: f64,
}

impl ContactLine {
    /// The line `height` over the centre line of `element` with the coordinates `e`.
    pub fn new<E: LineElement>(element: &E, e: &[f64], height: f64) -> Self {
        let l = element.length();
        let vector = |k: usize| [e[2 * k], e[2 * k + 1]];
        let mut powers = [[0.0; 2]; 4];
        let [first, second] = E::SECTION_VECTORS.map(vector);
        for axis in 0..2 {
            if let [r0, s0, r1, s1] = *E::CENTRE_VECTORS {
                let (r0, r1) = (vector(r0)[axis], vector(r1)[axis]);
                let (s0, s1) = (l * vector(s0)[axis], l * vector(s1)[axis]);
                powers[0][axis] = r0;
                powers[1][axis] = s0;
                powers[2][axis] = 3.0 * (r1 - r0) - 2.0 * s0 - s1;
                powers[3][axis] = 2.0 * (r0 - r1) + s0 + s1;
            } else if let [r0, r1] = *E::CENTRE_VECTORS {
                powers[0][axis] = vector(r0)[axis];
                powers[1][axis] = vector(r1)[axis] - vector(r0)[axis];
            }
            powers[0][axis] += height * first[axis];
            powers[1][axis] += height * (second[axis] - first[axis]);
        }
        Self { powers, length: l }
    }

    /// The point at `xi` [m].
    #[inline]
    pub fn position(&self, xi: f64) -> [f64; 2] {
        let [a, b, c, d] = &self.powers;
        [0, 1].map(|i| a[i] + xi * (b[i] + xi * (c[i] + xi * d[i])))
    }

    /// The derivative of the point by the material coordinate [-].
    #[inline]
    pub fn slope(&self, xi: f64) -> [f64; 2] {
        let [_, b, c, d] = &self.powers;
        [0, 1].map(|i| (b[i] + xi * (2.0 * c[i] + xi * 3.0 * d[i])) / self.length)
    }

    /// Whether no point of the line lies within `radius` of `center`: the points of its Bézier polygon
    /// lie in a disc that does not reach it.
    pub fn misses(&self, center: [f64; 2], radius: f64) -> bool {
        let [a, b, c, d] = &self.powers;
        let polygon: [[f64; 2]; 4] = std::array::from_fn(|k| {
            [0, 1].map(|i| match k {
                0 => a[i],
                1 => a[i] + b[i] / 3.0,
                2 => a[i] + (2.0 * b[i] + c[i]) / 3.0,
                _ => a[i] + b[i] + c[i] + d[i],
            })
        });
        let middle = [0, 1].map(|i| 0.5 * (polygon[0][i] + polygon[3][i]));
        let reach = (polygon.iter())
            .map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1]))
            .fold(0.0, f64::max);
        (middle[0] - center[0]).hypot(middle[1] - center[1]) > radius + reach
    }
}

/// Weights of an element's vectors in a point of a line and in its derivative by the material
/// coordinate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Weights {
    pub value: [f64; MOST_VECTORS],
    pub slope: [f64; MOST_VECTORS],
}

impl Weights {
    /// Of the line `height` over the centre line of `element`, at `xi`.
    pub fn new<E: LineElement>(element: &E, xi: f64, height: f64) -> Self {
        let mut weights = Self::default();
        let vectors = E::NODES * E::NODE_VECTORS;
        element.centre_line(xi, &mut weights.value[..vectors]);
        element.centre_line_slope(xi, &mut weights.slope[..vectors]);
        if height != 0.0 {
            let [first, second] = E::SECTION_VECTORS;
            let per_length = height / element.length();
            weights.value[first] += height * (1.0 - xi);
            weights.value[second] += height * xi;
            weights.slope[first] -= per_length;
            weights.slope[second] += per_length;
        }
        weights
    }
}

/// A line that runs past a pulley: its points move with the velocity `c R'`.
#[derive(Clone, Copy)]
pub(super) struct Passage<'a> {
    pub line: &'a ContactLine,
    pub penalty: &'a Penalty,
    pub pulley: &'a ContactPulley,
    /// Circulation speed c [m/s].
    pub circulation: f64,
    /// Speed of the pulley [rad/s].
    pub speed: f64,
}

impl Passage<'_> {
    /// The contact of the point at `xi`.
    #[inline]
    pub fn contact(&self, xi: f64) -> PointContact<f64> {
        self.contact_with(xi, None)
    }

    /// The same with a bristle that stands at `anchor`.
    #[inline]
    pub fn contact_with(&self, xi: f64, anchor: Option<[f64; 2]>) -> PointContact<f64> {
        let meeting = Meeting {
            center: self.pulley.center,
            r: self.line.position(xi),
            v: self.line.slope(xi).map(|s| self.circulation * s),
            speed: self.speed,
            anchor,
        };
        PointContact::new(self.penalty, self.pulley, &meeting)
    }

    /// Penetration of the point at `xi` [m], to the last bit that of [`Passage::contact`]: its sign decides there, too.
    #[inline]
    pub fn penetration(&self, xi: f64) -> f64 {
        let [x, y] = self.line.position(xi);
        let [cx, cy] = self.pulley.center;
        let arm = [x - cx, y - cy];
        -(arm[0] * arm[0] + arm[1] * arm[1]).sqrt() + self.pulley.radius
    }

    /// Its rise with `xi`, but for a positive factor.
    #[inline]
    pub fn deepening(&self, xi: f64) -> f64 {
        let [x, y] = self.line.position(xi);
        let [cx, cy] = self.pulley.center;
        let [sx, sy] = self.line.slope(xi);
        -((x - cx) * sx + (y - cy) * sy)
    }
}

/// Matrix of one element with its part of the border.
#[derive(Clone, Debug)]
pub(super) struct ElementMatrix {
    /// Row-major `DOF x DOF`.
    pub local: Vec<f64>,
    /// Column of the circulation speed.
    pub by_circulation: [f64; MOST_DOF],
}

impl ElementMatrix {
    pub fn new(dof: usize) -> Self {
        Self {
            local: vec![0.0; dof * dof],
            by_circulation: [0.0; MOST_DOF],
        }
    }

    pub fn clear(&mut self) {
        self.local.fill(0.0);
        self.by_circulation.fill(0.0);
    }

    /// Adds it at `element`, the circulation speed being border unknown `circulation`.
    pub fn scatter(
        &self,
        element: usize,
        node_dof: usize,
        circulation: usize,
        matrix: &mut BorderedMatrix,
    ) {
        matrix.add_pair(element, 1.0, &self.local);
        let column = &self.by_circulation[..2 * node_dof];
        matrix.add_border_column(circulation, element * node_dof, column);
    }
}
