//! The centre line of a belt beam by three vectors: the chord `r2 - r1` and the slopes r1_x, r2_x.
//!
//! The Hermite functions of r1 and r2 have opposite derivatives, so c and c' need three functions
//! instead of four, and sums over quadrature points nine products a block instead of sixteen.

use super::DOF;
use crate::element::hermite;
use crate::scalar::{Scalar, unroll};

/// Vectors of the element that the four Hermite functions multiply.
const VECTORS: [usize; 4] = hermite::VECTORS;

/// Which line vector stands behind each Hermite function, and whether with a minus.
const LINES: [usize; 4] = [0, 1, 0, 2];
const NEGATIVE: [bool; 4] = [true, false, false, false];

/// Pairs of line vectors in symmetric blocks.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// Vectors (or forces on them) of the centre line.
pub(super) type Lines<S> = [[S; 2]; 3];

/// Shape functions at one quadrature point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    /// Derivatives by x of the three functions.
    pub slope: [f64; 3],
    /// Second derivatives by x.
    pub curve: [f64; 3],
    /// Products of the pairs: slope slope, slope curve + curve slope, curve curve.
    products: [[f64; 6]; 3],
}

impl Shape {
    pub fn new(xi: f64, length: f64) -> Self {
        let [_, left, chord, right] = hermite::slope(xi, length);
        let slope = [chord, left, right];
        let [_, left, chord, right] = hermite::curve(xi, length);
        let curve = [chord, left, right];
        Self {
            slope,
            curve,
            products: [
                PAIRS.map(|(i, j)| slope[i] * slope[j]),
                PAIRS.map(|(i, j)| slope[i] * curve[j] + curve[i] * slope[j]),
                PAIRS.map(|(i, j)| curve[i] * curve[j]),
            ],
        }
    }

    /// `c` and `c'`.
    #[inline(always)]
    pub fn apply<S: Scalar>(&self, lines: &Lines<S>) -> ([S; 2], [S; 2]) {
        (
            [
                combine(lines, &self.slope, 0),
                combine(lines, &self.slope, 1),
            ],
            [
                combine(lines, &self.curve, 0),
                combine(lines, &self.curve, 1),
            ],
        )
    }

    /// Adds what derivatives by c and c' are by the line vectors.
    #[inline(always)]
    pub fn add<S: Scalar>(&self, by_c: [S; 2], by_curve: [S; 2], lines: &mut Lines<S>) {
        unroll!(for i in 0..3 {
            unroll!(for axis in 0..2 {
                lines[i][axis] += by_c[axis] * self.slope[i] + by_curve[axis] * self.curve[i];
            });
        });
    }
}

/// A component of the sum of line vectors, each times a factor. A closure here is left a call in some registers.
#[inline(always)]
fn combine<S: Scalar>(lines: &Lines<S>, by: &[f64; 3], axis: usize) -> S {
    lines[0][axis] * by[0] + lines[1][axis] * by[1] + lines[2][axis] * by[2]
}

/// The line vectors of coordinates.
#[inline(always)]
pub(super) fn lines<S: Scalar>(e: &[S; DOF]) -> Lines<S> {
    [[e[6] - e[0], e[7] - e[1]], [e[2], e[3]], [e[8], e[9]]]
}

/// Subtracts derivatives by the line vectors from the force on the coordinates.
#[inline(always)]
pub(super) fn subtract<S: Scalar>(lines: &Lines<S>, force: &mut [S; DOF]) {
    unroll!(for axis in 0..2 {
        force[axis] += lines[0][axis];
        force[6 + axis] -= lines[0][axis];
        force[2 + axis] -= lines[1][axis];
        force[8 + axis] -= lines[2][axis];
    });
}

/// Sum of a symmetric Hessian by the line vectors: blocks (x, x), (y, y) as pairs, and (x, y).
pub(super) struct Sum<S> {
    xx: [S; 6],
    yy: [S; 6],
    xy: [[S; 3]; 3],
}

impl<S: Scalar> Sum<S> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self {
            xx: [S::zero(); 6],
            yy: [S::zero(); 6],
            xy: [[S::zero(); 3]; 3],
        }
    }

    /// Adds the second derivatives by (c, c') at a point: `cc` and `kk` as (xx, xy, yy).
    #[inline(always)]
    pub fn add(&mut self, shape: &Shape, cc: [S; 3], ck: [[S; 2]; 2], kk: [S; 3]) {
        let [ss, sk, k_k] = &shape.products;
        unroll!(for n in 0..6 {
            self.xx[n] += cc[0] * ss[n] + ck[0][0] * sk[n] + kk[0] * k_k[n];
            self.yy[n] += cc[2] * ss[n] + ck[1][1] * sk[n] + kk[2] * k_k[n];
        });
        unroll!(for j in 0..3 {
            let by_c = cc[1] * shape.slope[j] + ck[0][1] * shape.curve[j];
            let by_curve = ck[1][0] * shape.slope[j] + kk[1] * shape.curve[j];
            unroll!(for i in 0..3 {
                self.xy[i][j] += by_c * shape.slope[i] + by_curve * shape.curve[i];
            });
        });
    }

    /// Adds the sum to the tangent of the coordinates.
    #[inline(always)]
    pub fn add_to(&self, tangent: &mut [S; DOF * DOF]) {
        let entry = |m: usize, n: usize, i: usize, j: usize| match (m, n) {
            (0, 0) => self.xx[pair(i, j)],
            (1, 1) => self.yy[pair(i, j)],
            (0, _) => self.xy[i][j],
            (_, _) => self.xy[j][i],
        };
        place(entry, tangent);
    }
}

/// Adds a matrix over the line vectors to the tangent of the coordinates: `entry(m, n, i, j)` has the
/// row of line vector `i`, axis `m`, and the column of `j`, `n`.
#[inline(always)]
pub(super) fn place<S: Scalar>(
    entry: impl Fn(usize, usize, usize, usize) -> S,
    tangent: &mut [S; DOF * DOF],
) {
    unroll!(for i in 0..4 {
        unroll!(for j in 0..4 {
            unroll!(for m in 0..2 {
                unroll!(for n in 0..2 {
                    let value = entry(m, n, LINES[i], LINES[j]);
                    let place = (2 * VECTORS[i] + m) * DOF + 2 * VECTORS[j] + n;
                    if NEGATIVE[i] == NEGATIVE[j] {
                        tangent[place] += value;
                    } else {
                        tangent[place] -= value;
                    }
                });
            });
        });
    });
}

/// Place of a pair in [`PAIRS`].
const fn pair(a: usize, b: usize) -> usize {
    [[0, 1, 2], [1, 3, 4], [2, 4, 5]][a][b]
}

/// Adds `rows outer columns` and its transpose to the tangent: `rows` on the line vectors, `columns` on
/// the four slopes of `node`.
#[inline(always)]
pub(super) fn add_mixed<S: Scalar>(
    rows: &Lines<S>,
    columns: &[S; 4],
    node: usize,
    tangent: &mut [S; DOF * DOF],
) {
    unroll!(for i in 0..3 {
        unroll!(for axis in 0..2 {
            unroll!(for j in 0..4 {
                let value = rows[i][axis] * columns[j];
                let column = 6 * node + 2 + j;
                if i == 0 {
                    tangent[axis * DOF + column] -= value;
                    tangent[column * DOF + axis] -= value;
                }
                let row = [6, 2, 8][i] + axis;
                tangent[row * DOF + column] += value;
                tangent[column * DOF + row] += value;
            });
        });
    });
}
