//! A section of the belt beam: its five vectors and what its energy's derivatives are by
//! the centre line, the fibres' nodal directions and their nodal shears.
//!
//! Second derivatives go through three sets of variables. [`SpaceSection`] gives them by the vectors
//! `(c, s_y, s_z, s_y', s_z')`. To first order these depend on the *reduced* variables
//! `c, c', delta, delta', tau, tau'` (the last four for each fibre; see `fibre.rs`), 14 numbers. Each
//! of those is a sum over *element* variables: line vectors, nodal d and nodal tau, of which every
//! one enters exactly two. What the fibres' own second derivatives add is placed where it belongs.

use super::Point;
use super::fibre::Fibre;
use super::lines::Lines;
use crate::element::space_section::{CENTRE, FIBRE_SLOPES, FIBRES, Hessian, SpaceSection, Vectors};
use crate::scalar::{Scalar, Series};

/// Element variables: three line vectors, r_y of both nodes, r_z of both, and the four nodal shears
/// (y of both nodes, z of both).
pub(super) const VARIABLES: usize = 25;
/// First of the nodal directions of each fibre.
pub(super) const DIRECTIONS: [usize; 2] = [9, 15];
/// First of the nodal shears of each fibre.
pub(super) const SHEARS: [usize; 2] = [21, 23];

/// Reduced variables: c, c', then `delta, delta', tau, tau'` of each fibre.
const REDUCED: usize = 14;
const FIRST_REDUCED: [usize; 2] = [6, 10];

/// Symmetric second derivatives by the element variables; only entries with `row <= column` are used.
pub(super) type Sum<S> = [[S; VARIABLES]; VARIABLES];

/// What a section depends on.
pub(super) struct Nodal<S> {
    pub lines: Lines<S>,
    /// r_y of both nodes, r_z of both.
    pub directions: [[[S; 3]; 2]; 2],
    /// Shears of y at both nodes, of z at both.
    pub shears: [[S; 2]; 2],
}

/// A section at a quadrature point.
pub(super) struct Section<S> {
    fibres: [Fibre<S>; 2],
    pub vectors: Vectors<S>,
}

/// First derivatives by the element variables.
pub(super) struct Gradient<S> {
    pub lines: Lines<S>,
    pub directions: [[[S; 3]; 2]; 2],
    pub shears: [[S; 2]; 2],
}

impl<S: Scalar> Section<S> {
    #[inline(always)]
    pub fn new(point: &Point, nodal: &Nodal<S>) -> Self {
        let (c, curve) = point.shape.apply(&nodal.lines);
        let centre = Series::vector(c, curve);
        let mut vectors = [c; 5];
        let fibres = [
            Self::fibre(point, nodal, centre, 0),
            Self::fibre(point, nodal, centre, 1),
        ];
        for k in 0..2 {
            let s = fibres[k].vector();
            vectors[FIBRES[k]] = [s[0].value, s[1].value, s[2].value];
            vectors[FIBRE_SLOPES[k]] = [s[0].slope, s[1].slope, s[2].slope];
        }
        Self { fibres, vectors }
    }

    #[inline(always)]
    fn fibre(point: &Point, nodal: &Nodal<S>, centre: [Series<S>; 3], k: usize) -> Fibre<S> {
        let [first, second] = nodal.directions[k];
        let direction = [
            point.interpolate(first[0], second[0]),
            point.interpolate(first[1], second[1]),
            point.interpolate(first[2], second[2]),
        ];
        let [first, second] = nodal.shears[k];
        Fibre::new(centre, direction, point.interpolate(first, second))
    }

    /// Weights of s and s' in a series: see [`Series`].
    #[inline(always)]
    fn weights(by: &Vectors<S>, k: usize) -> [Series<S>; 3] {
        Series::vector(by[FIBRE_SLOPES[k]], by[FIBRES[k]])
    }

    /// Adds the first derivatives that belong to `by`, those by the five vectors.
    #[inline(always)]
    pub fn add_gradient(&self, point: &Point, by: &Vectors<S>, gradient: &mut Gradient<S>) {
        let (mut by_c, mut by_curve) = (by[CENTRE], [S::zero(); 3]);
        for k in 0..2 {
            let fibre = &self.fibres[k];
            let of_fibre = fibre.gradient(Self::weights(by, k));
            let turn = fibre.turn();
            for i in 0..3 {
                by_c[i] += of_fibre.c[i].slope;
                by_curve[i] += of_fibre.c[i].value;
                let by_direction = turn[i] * of_fibre.delta;
                for node in 0..2 {
                    gradient.directions[k][node][i] += point.share(by_direction, node);
                }
            }
            for node in 0..2 {
                gradient.shears[k][node] += point.share(of_fibre.tau, node);
            }
        }
        point.shape.add(by_c, by_curve, &mut gradient.lines);
    }

    /// Adds second derivatives by the element variables, and first ones by the nodal shears.
    #[inline(always)]
    pub fn add_hessian(
        &self,
        point: &Point,
        law: &SpaceSection,
        sum: &mut Sum<S>,
        shears: &mut [[S; 2]; 2],
    ) {
        let by = law.gradient(&self.vectors, point.weight);
        let hessian = law.hessian(&self.vectors, point.weight);
        let mut reduced = self.reduce(&hessian);
        for k in 0..2 {
            let fibre = &self.fibres[k];
            let weights = Self::weights(&by, k);
            let tau = fibre.gradient(weights).tau;
            for node in 0..2 {
                shears[k][node] += point.share(tau, node);
            }
            let curvature = fibre.curvature(weights);
            let tau = FIRST_REDUCED[k] + 2;
            for i in 0..3 {
                for j in 0..3 {
                    reduced[i][j] += curvature.cc[i][j].slope;
                    reduced[i][3 + j] += curvature.cc[i][j].value;
                }
                reduced[i][tau] += curvature.c_tau[i].slope;
                reduced[i][tau + 1] += curvature.c_tau[i].value;
                reduced[3 + i][tau] += curvature.c_tau[i].value;
            }
            let first = DIRECTIONS[k];
            for i in 0..3 {
                for j in 0..3 {
                    let (cd, dd) = (curvature.cd[i][j], curvature.dd[i][j]);
                    for node in 0..2 {
                        let column = first + 3 * node + j;
                        let (by_c, by_curve) = (point.share(cd, node), cd.value * point.at[node]);
                        for line in 0..3 {
                            sum[3 * line + i][column] +=
                                by_c * point.shape.slope[line] + by_curve * point.shape.curve[line];
                        }
                        let own =
                            dd.slope * point.at[node] + dd.value * (2.0 * point.per_length[node]);
                        sum[first + 3 * node + i][column] += own * point.at[node];
                    }
                    let across = dd.slope * (point.at[0] * point.at[1])
                        + dd.value
                            * (point.at[0] * point.per_length[1]
                                + point.at[1] * point.per_length[0]);
                    sum[first + i][first + 3 + j] += across;
                }
            }
        }
        self.expand(point, &reduced, sum);
    }

    /// `J^T H J` with the derivatives J of the five vectors by the reduced variables. Entries with
    /// `row <= column` are right, but for the block of c' and c, which is not used.
    #[inline(always)]
    fn reduce(&self, hessian: &Hessian<S>) -> [[S; REDUCED]; REDUCED] {
        let by_centre = [self.fibres[0].by_centre(), self.fibres[1].by_centre()];
        let mut half = [[S::zero(); REDUCED]; 15];
        for row in 0..15 {
            let entries = &hessian[row];
            let out = &mut half[row];
            out[..3].copy_from_slice(&entries[3 * CENTRE..3 * CENTRE + 3]);
            for k in 0..2 {
                let Fibre { t, m, .. } = &self.fibres[k];
                let first = FIRST_REDUCED[k];
                for j in 0..3 {
                    let by_s = entries[3 * FIBRES[k] + j];
                    let by_slope = entries[3 * FIBRE_SLOPES[k] + j];
                    for i in 0..3 {
                        let centre = by_centre[k][j][i];
                        out[i] += by_s * centre.value + by_slope * centre.slope;
                        out[3 + i] += by_slope * centre.value;
                    }
                    out[first] += by_s * m[j].value + by_slope * m[j].slope;
                    out[first + 1] += by_slope * m[j].value;
                    out[first + 2] += by_s * t[j].value + by_slope * t[j].slope;
                    out[first + 3] += by_slope * t[j].value;
                }
            }
        }
        let mut reduced = [[S::zero(); REDUCED]; REDUCED];
        for i in 0..3 {
            reduced[i] = half[3 * CENTRE + i];
        }
        for k in 0..2 {
            let Fibre { t, m, .. } = &self.fibres[k];
            let first = FIRST_REDUCED[k];
            for j in 0..3 {
                let (by_s, by_slope) = (&half[3 * FIBRES[k] + j], &half[3 * FIBRE_SLOPES[k] + j]);
                for i in 0..3 {
                    let centre = by_centre[k][j][i];
                    for column in 0..REDUCED {
                        reduced[i][column] +=
                            by_s[column] * centre.value + by_slope[column] * centre.slope;
                    }
                    for column in 3..REDUCED {
                        reduced[3 + i][column] += by_slope[column] * centre.value;
                    }
                }
                for column in first..REDUCED {
                    reduced[first][column] +=
                        by_s[column] * m[j].value + by_slope[column] * m[j].slope;
                    reduced[first + 1][column] += by_slope[column] * m[j].value;
                    reduced[first + 2][column] +=
                        by_s[column] * t[j].value + by_slope[column] * t[j].slope;
                    reduced[first + 3][column] += by_slope[column] * t[j].value;
                }
            }
        }
        reduced
    }

    /// Adds the reduced second derivatives to the sum over element variables.
    #[inline(always)]
    fn expand(&self, point: &Point, reduced: &[[S; REDUCED]; REDUCED], sum: &mut Sum<S>) {
        let factors = self.factors(point);
        let entry = |row: usize, column: usize| {
            if row <= column {
                reduced[row][column]
            } else {
                reduced[column][row]
            }
        };
        let mut half = [[S::zero(); VARIABLES]; REDUCED];
        for row in 0..REDUCED {
            for column in 0..VARIABLES {
                let [first, second] = PLACES[column];
                let [a, b] = factors[column];
                half[row][column] = entry(row, first) * a + entry(row, second) * b;
            }
        }
        for row in 0..VARIABLES {
            let [first, second] = PLACES[row];
            let [a, b] = factors[row];
            for column in START[row]..VARIABLES {
                sum[row][column] += half[first][column] * a + half[second][column] * b;
            }
        }
    }

    /// Derivatives of the two reduced variables that an element variable enters, see [`PLACES`].
    #[inline(always)]
    fn factors(&self, point: &Point) -> [[S; 2]; VARIABLES] {
        let mut factors = [[S::zero(); 2]; VARIABLES];
        for line in 0..3 {
            for i in 0..3 {
                factors[3 * line + i] = [
                    S::constant(point.shape.slope[line]),
                    S::constant(point.shape.curve[line]),
                ];
            }
        }
        for k in 0..2 {
            let turn = self.fibres[k].turn();
            for node in 0..2 {
                let (at, per_length) = (point.at[node], point.per_length[node]);
                for i in 0..3 {
                    factors[DIRECTIONS[k] + 3 * node + i] = [
                        turn[i].value * at,
                        turn[i].slope * at + turn[i].value * per_length,
                    ];
                }
                factors[SHEARS[k] + node] = [S::constant(at), S::constant(per_length)];
            }
        }
        factors
    }
}

/// The two reduced variables that each element variable enters.
const PLACES: [[usize; 2]; VARIABLES] = {
    let mut places = [[0, 0]; VARIABLES];
    let mut variable = 0;
    while variable < VARIABLES {
        places[variable] = if variable < 9 {
            [variable % 3, 3 + variable % 3]
        } else if variable < 15 {
            [6, 7]
        } else if variable < 21 {
            [10, 11]
        } else if variable < 23 {
            [8, 9]
        } else {
            [12, 13]
        };
        variable += 1;
    }
    places
};

/// First column that is summed in each row: that of its own vector.
const START: [usize; VARIABLES] = {
    let mut start = [0; VARIABLES];
    let mut variable = 0;
    while variable < VARIABLES {
        start[variable] = if variable < 21 {
            variable - variable % 3
        } else {
            variable
        };
        variable += 1;
    }
    start
};
