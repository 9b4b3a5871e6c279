//! Shape functions of the rectangle with 12 terms a component.
//!
//! On `-1 <= xi, eta <= 1` with nodes at `(xi_k, eta_k)`, half sides a and b (Melosh 1963; Adini & Clough
//! 1961):
//!
//! ```text
//! of r_k:    (1 + xi xi_k) (1 + eta eta_k) (2 + xi xi_k + eta eta_k - xi² - eta²) / 8
//! of r_x,k:  a xi_k (1 + xi xi_k)² (xi xi_k - 1) (1 + eta eta_k) / 8
//! of r_y,k:  b eta_k (1 + eta eta_k)² (eta eta_k - 1) (1 + xi xi_k) / 8
//! ```
//!
//! They span `{1, x, y, x², xy, y², x³, x²y, xy², y³, x³y, xy³}`. Along an edge r and its slope there depend on
//! that edge's nodes alone; the slope across an edge does not, so neighbours meet it at nodes only (the
//! element does not conform).

/// Shape functions of an element.
pub(super) const FUNCTIONS: usize = 12;

/// Corners in the order A, B, C, D.
pub(super) const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Coefficients of `xi^i eta^j`.
#[derive(Clone, Copy)]
struct Polynomial([[f64; 4]; 4]);

impl Polynomial {
    /// `constant + by_xi xi + by_eta eta`.
    fn linear(constant: f64, by_xi: f64, by_eta: f64) -> Self {
        let mut c = [[0.0; 4]; 4];
        c[0][0] = constant;
        c[1][0] = by_xi;
        c[0][1] = by_eta;
        Self(c)
    }

    /// The product; its terms stay below the fourth degree in each variable here.
    fn times(&self, other: &Self) -> Self {
        let mut product = [[0.0; 4]; 4];
        for i in 0..4 {
            for j in 0..4 {
                for m in 0..4 - i {
                    for n in 0..4 - j {
                        product[i + m][j + n] += self.0[i][j] * other.0[m][n];
                    }
                }
            }
        }
        Self(product)
    }

    /// The derivative of the given orders at a point.
    fn derivative(&self, [by_xi, by_eta]: [i32; 2], [xi, eta]: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        for (i, row) in (0..4).zip(&self.0) {
            for (j, coefficient) in (0..4).zip(row) {
                sum += coefficient * power(i, by_xi, xi) * power(j, by_eta, eta);
            }
        }
        sum
    }
}

/// The derivative of `order` of `x^exponent`.
fn power(exponent: i32, order: i32, x: f64) -> f64 {
    let factor: f64 = (0..order).map(|k| f64::from(exponent - k)).product();
    if exponent < order {
        0.0
    } else {
        factor * x.powi(exponent - order)
    }
}

/// The shape functions of a rectangle.
pub(super) struct Shape {
    functions: [Polynomial; FUNCTIONS],
    half_sides: [f64; 2],
}

impl Shape {
    pub fn new(length: f64, width: f64) -> Self {
        let half_sides = [0.5 * length, 0.5 * width];
        let [a, b] = half_sides;
        let mut functions = [Polynomial([[0.0; 4]; 4]); FUNCTIONS];
        for (corner, [xi, eta]) in CORNERS.into_iter().enumerate() {
            let near_x = Polynomial::linear(1.0, xi, 0.0);
            let near_y = Polynomial::linear(1.0, 0.0, eta);
            let both = near_x.times(&near_y);
            let mut rest = Polynomial::linear(2.0, xi, eta);
            rest.0[2][0] = -1.0;
            rest.0[0][2] = -1.0;
            let scaled = |factor: f64| Polynomial::linear(factor / 8.0, 0.0, 0.0);
            functions[3 * corner] = both.times(&rest).times(&scaled(1.0));
            functions[3 * corner + 1] = both
                .times(&near_x)
                .times(&Polynomial::linear(-1.0, xi, 0.0))
                .times(&scaled(a * xi));
            functions[3 * corner + 2] = both
                .times(&near_y)
                .times(&Polynomial::linear(-1.0, 0.0, eta))
                .times(&scaled(b * eta));
        }
        Self {
            functions,
            half_sides,
        }
    }

    /// Derivatives of the given orders by x and y of all functions; `place` in `[0, 1]²`.
    pub fn derivatives(&self, orders: [i32; 2], place: [f64; 2]) -> [f64; FUNCTIONS] {
        let [a, b] = self.half_sides;
        let scale = a.powi(-orders[0]) * b.powi(-orders[1]);
        let at = place.map(|value| 2.0 * value - 1.0);
        self.functions
            .map(|function| scale * function.derivative(orders, at))
    }
}
