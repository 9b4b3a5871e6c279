//! Energy of curvature.
//!
//! With `a = r_x`, `b = r_y`, the unit normal N of `a x b`, `R = (r_xx, r_yy, r_xy)` and
//! `p = (1/a.a, 1/b.b, 1/(|a| |b|))`
//!
//! ```text
//! k_i = p_i R_i.N                                                                         (4.18)
//! W = D/2 [(kxx + kyy)² - 2 (1 - nu) (kxx kyy - kxy²)],     M_i = dW/dk_i
//! ```
//!
//! Derivatives: with the dual base `a*, b*` (`a*.a = 1, a*.b = 0, a*.N = 0`) the normal turns by
//! `dN = -a* (N.da) - b* (N.db)`, and `dp_i = -p_i (m_i X + n_i Y)`, `X = a.da/a.a`, `Y = b.db/b.b`,
//! `m = (2, 0, 1)`, `n = (0, 2, 1)`. So
//!
//! ```text
//! dk_i/dR_i = p_i N
//! dk_i/da = -p_i (R_i.a*) N - m_i k_i a/a.a          dk_i/db = -p_i (R_i.b*) N - n_i k_i b/b.b
//! ```
//!
//! and the Hessian is `sum D_ij dk_i dk_j + sum M_i d²k_i`, the last from
//! `d²N = 2 a* (a*.da N.da + b*.da N.db) + 2 b* (a*.db N.da + b*.db N.db) - N |a* N.da + b* N.db|²` and
//! `d²p_i = p_i [(m_i X + n_i Y)² + m_i (2 X² - |da|²/a.a) + n_i (2 Y² - |db|²/b.b)]`.

use crate::element::vector::dot;
use crate::scalar::Scalar;

/// D [N m] and nu.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bending {
    rigidity: f64,
    poisson_ratio: f64,
}

/// `(r_x, r_y, r_xx, r_yy, r_xy)`, or derivatives by them.
pub(super) type Vectors<S> = [[S; 3]; 5];

/// Second derivatives by the vectors: `[row vector][column vector][row][column]`.
pub(super) type Hessian<S> = [[[[S; 3]; 3]; 5]; 5];

/// First of the second derivatives among the vectors.
const SECOND: usize = 2;

/// Powers of 1/|a| and 1/|b| in the three curvatures.
const POWERS: [[f64; 3]; 2] = [[2.0, 0.0, 1.0], [0.0, 2.0, 1.0]];

/// What the derivatives at a point have in common.
struct Surface<S> {
    normal: [S; 3],
    /// a* and b*.
    dual: [[S; 3]; 2],
    /// 1/a.a and 1/b.b.
    per_square: [S; 2],
    p: [S; 3],
    /// R_i.N.
    raw: [S; 3],
}

#[inline(always)]
fn cross<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl<S: Scalar> Surface<S> {
    #[inline(always)]
    fn new(vectors: &Vectors<S>) -> Self {
        let [a, b, ..] = *vectors;
        let area = cross(a, b);
        let per_area = dot(area, area).sqrt().recip();
        let normal = area.map(|value| value * per_area);
        let per_square = [dot(a, a).recip(), dot(b, b).recip()];
        let mut raw = [S::zero(); 3];
        for i in 0..3 {
            raw[i] = dot(vectors[SECOND + i], normal);
        }
        Self {
            normal,
            dual: [
                cross(b, normal).map(|value| value * per_area),
                cross(normal, a).map(|value| value * per_area),
            ],
            per_square,
            p: [
                per_square[0],
                per_square[1],
                (per_square[0] * per_square[1]).sqrt(),
            ],
            raw,
        }
    }

    #[inline(always)]
    fn curvature(&self) -> [S; 3] {
        [
            self.raw[0] * self.p[0],
            self.raw[1] * self.p[1],
            self.raw[2] * self.p[2],
        ]
    }
}

impl Bending {
    pub fn new(rigidity: f64, poisson_ratio: f64) -> Self {
        Self {
            rigidity,
            poisson_ratio,
        }
    }

    /// Whether there is no stiffness.
    pub fn is_none(&self) -> bool {
        self.rigidity <= 0.0
    }

    /// The law `M = D k`, times `weight`.
    #[inline(always)]
    fn moments<S: Scalar>(&self, [xx, yy, xy]: [S; 3], weight: f64) -> [S; 3] {
        let rigidity = self.rigidity * weight;
        let coupling = rigidity * self.poisson_ratio;
        [
            xx * rigidity + yy * coupling,
            xx * coupling + yy * rigidity,
            xy * (2.0 * (rigidity - coupling)),
        ]
    }

    /// W [J/m²].
    #[inline(always)]
    pub fn energy<S: Scalar>(&self, vectors: &Vectors<S>) -> S {
        let curvature = Surface::new(vectors).curvature();
        dot(curvature, self.moments(curvature, 1.0)) * 0.5
    }

    /// Derivatives of W by the vectors, times `weight`.
    #[inline(always)]
    pub fn gradient<S: Scalar>(&self, vectors: &Vectors<S>, weight: f64) -> Vectors<S> {
        let at = Surface::new(vectors);
        let curvature = at.curvature();
        let moments = self.moments(curvature, weight);
        let mut by = [[S::zero(); 3]; 5];
        for i in 0..3 {
            let scaled = moments[i] * at.p[i];
            for axis in 0..3 {
                by[SECOND + i][axis] = at.normal[axis] * scaled;
            }
        }
        for side in 0..2 {
            let (mut turning, mut shrinking) = (S::zero(), S::zero());
            for i in 0..3 {
                turning += moments[i] * at.p[i] * dot(vectors[SECOND + i], at.dual[side]);
                shrinking += moments[i] * curvature[i] * POWERS[side][i];
            }
            let along = shrinking * at.per_square[side];
            for axis in 0..3 {
                by[side][axis] = -(at.normal[axis] * turning + vectors[side][axis] * along);
            }
        }
        by
    }

    /// Second derivatives of W, times `weight`.
    #[inline(always)]
    pub fn hessian<S: Scalar>(&self, vectors: &Vectors<S>, weight: f64) -> Hessian<S> {
        let at = Surface::new(vectors);
        let moments = self.moments(at.curvature(), weight);
        let turns = self.turns(vectors, &at, weight);
        let mut h = [[[[S::zero(); 3]; 3]; 5]; 5];
        self.add_second(vectors, &at, moments, &turns, weight, &mut h);
        add_slopes(vectors, &at, moments, &turns, &mut h);
        h
    }

    #[inline(always)]
    fn turns<S: Scalar>(&self, vectors: &Vectors<S>, at: &Surface<S>, weight: f64) -> Turns<S> {
        let curvature = at.curvature();
        let mut turn = [[S::zero(); 3]; 2];
        let mut gradient = [[[S::zero(); 3]; 3]; 2];
        let mut stressed = gradient;
        for side in 0..2 {
            for i in 0..3 {
                turn[side][i] = at.p[i] * dot(vectors[SECOND + i], at.dual[side]);
                let along = curvature[i] * at.per_square[side] * POWERS[side][i];
                for axis in 0..3 {
                    gradient[side][i][axis] =
                        -(at.normal[axis] * turn[side][i] + vectors[side][axis] * along);
                }
            }
            for axis in 0..3 {
                let by = [0, 1, 2].map(|i: usize| gradient[side][i][axis]);
                for (i, value) in self.moments(by, weight).into_iter().enumerate() {
                    stressed[side][i][axis] = value;
                }
            }
        }
        Turns {
            turn,
            gradient,
            stressed,
        }
    }

    /// Blocks of the second derivatives of r with each other and with a and b.
    #[inline(always)]
    fn add_second<S: Scalar>(
        &self,
        vectors: &Vectors<S>,
        at: &Surface<S>,
        moments: [S; 3],
        turns: &Turns<S>,
        weight: f64,
        h: &mut Hessian<S>,
    ) {
        let (n, p) = (&at.normal, &at.p);
        for i in 0..3 {
            let unit = [0, 1, 2].map(|j: usize| S::constant(f64::from(u8::from(i == j))));
            let row = self.moments(unit, weight);
            let moment = moments[i] * p[i];
            for j in 0..3 {
                let factor = row[j] * p[i] * p[j];
                for k in 0..3 {
                    let along = n[k] * factor;
                    for m in 0..3 {
                        h[SECOND + i][SECOND + j][k][m] = along * n[m];
                    }
                }
            }
            for side in 0..2 {
                let shrinking = moment * at.per_square[side] * POWERS[side][i];
                for k in 0..3 {
                    let by_normal = at.dual[side][k] * moment;
                    for m in 0..3 {
                        let stressed = turns.stressed[side][i][m] * p[i];
                        let value =
                            n[k] * (stressed - vectors[side][m] * shrinking) - by_normal * n[m];
                        h[SECOND + i][side][k][m] = value;
                        h[side][SECOND + i][m][k] = value;
                    }
                }
            }
        }
    }
}

/// What turns of the normal and changes of a and b do to the curvatures: for a, then for b.
struct Turns<S> {
    /// p_i R_i.a*.
    turn: [[S; 3]; 2],
    /// dk_i/da.
    gradient: [[[S; 3]; 3]; 2],
    /// D times it.
    stressed: [[[S; 3]; 3]; 2],
}

/// Sums over the curvatures of the energies `M_i k_i` and of `M_i turn_i`, for a and b.
struct Sums<S> {
    energy: S,
    turn: [S; 2],
    /// Weighted with the powers m or n, and with m (m + 2).
    power: [S; 2],
    square: [S; 2],
    /// `[side][other]`: M_i turn[other]_i with the powers of side.
    weighted: [[S; 2]; 2],
}

impl<S: Scalar> Sums<S> {
    #[inline(always)]
    fn new(moments: [S; 3], curvature: [S; 3], turn: &[[S; 3]; 2]) -> Self {
        let mut sums = Self {
            energy: S::zero(),
            turn: [S::zero(); 2],
            power: [S::zero(); 2],
            square: [S::zero(); 2],
            weighted: [[S::zero(); 2]; 2],
        };
        for i in 0..3 {
            let energy = moments[i] * curvature[i];
            sums.energy += energy;
            for side in 0..2 {
                let power = POWERS[side][i];
                sums.turn[side] += moments[i] * turn[side][i];
                sums.power[side] += energy * power;
                sums.square[side] += energy * (power * (power + 2.0));
                for other in 0..2 {
                    sums.weighted[side][other] += moments[i] * turn[other][i] * power;
                }
            }
        }
        sums
    }
}

/// Adds the blocks of a and b with each other.
#[inline(always)]
fn add_slopes<S: Scalar>(
    vectors: &Vectors<S>,
    at: &Surface<S>,
    moments: [S; 3],
    turns: &Turns<S>,
    h: &mut Hessian<S>,
) {
    let (n, dual, per_square) = (&at.normal, &at.dual, &at.per_square);
    let curvature = at.curvature();
    let sums = Sums::new(moments, curvature, &turns.turn);
    let mixed = moments[2] * curvature[2] * per_square[0] * per_square[1];
    for side in 0..2 {
        for other in side..2 {
            let metric = dot(dual[side], dual[other]) * sums.energy;
            let (own, next) = (&vectors[side], &vectors[other]);
            let (by_own, by_next) = (
                sums.weighted[side][other] * per_square[side],
                sums.weighted[other][side] * per_square[other],
            );
            let along = if side == other {
                sums.square[side] * per_square[side] * per_square[side]
            } else {
                mixed
            };
            for k in 0..3 {
                for m in 0..3 {
                    let mut value = (dual[other][k] * n[m]) * sums.turn[side]
                        + (n[k] * dual[side][m]) * sums.turn[other]
                        - n[k] * n[m] * metric
                        + own[k] * next[m] * along
                        + own[k] * n[m] * by_own
                        + n[k] * next[m] * by_next;
                    for i in 0..3 {
                        value += turns.gradient[side][i][k] * turns.stressed[other][i][m];
                    }
                    if side == other && k == m {
                        value -= sums.power[side] * per_square[side];
                    }
                    h[side][other][k][m] = value;
                    h[other][side][m][k] = value;
                }
            }
        }
    }
}
