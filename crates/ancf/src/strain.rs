//! Measures of strain of a surface and of a fibre in it.
//!
//! With the gradient `D = (r_x, r_y)` of a surface drawn undeformed on the plane of x and y
//! (Kerkkänen 2006, 4.5-4.11), the fibre along the unit vector t0 has
//!
//! ```text
//! lambda = |D t0| = dl/dl0                      stretch
//! e = (D^T D - 1)/2,  t0.e t0 = (lambda² - 1)/2          Green-Lagrange         (4.5)
//! lambda - 1 = -1 + sqrt(1 + 2 t0.e t0)                  engineering            (4.9)
//! 1 - 1/lambda = (dl - dl0)/dl                           by the deformed length (4.10)
//! (1 - D^-T D^-1)/2 along D t0 = (1 - 1/lambda²)/2       Almansi                (4.11)
//! det J = |r_x x r_y|                                    ratio of areas
//! ```
//!
//! The measure that the text takes from Almansi's tensor, `1 - sqrt(1 - 2 t.e_A t)`, is that by the
//! deformed length; the sign printed under its root is a misprint.

/// Derivatives of the position of a surface by its undeformed coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceGradient {
    /// r_x.
    pub x: [f64; 3],
    /// r_y.
    pub y: [f64; 3],
}

impl SurfaceGradient {
    /// Green-Lagrange strains `[exx, eyy, exy]`, exy the tensor component.
    pub fn green(&self) -> [f64; 3] {
        [
            0.5 * (dot(self.x, self.x) - 1.0),
            0.5 * (dot(self.y, self.y) - 1.0),
            0.5 * dot(self.x, self.y),
        ]
    }

    /// `r_x x r_y`: normal to the surface.
    pub fn cross(&self) -> [f64; 3] {
        let (x, y) = (self.x, self.y);
        [
            x[1] * y[2] - x[2] * y[1],
            x[2] * y[0] - x[0] * y[2],
            x[0] * y[1] - x[1] * y[0],
        ]
    }

    /// Ratio of deformed to undeformed area, `det J`.
    pub fn jacobian(&self) -> f64 {
        let normal = self.cross();
        dot(normal, normal).sqrt()
    }

    /// The fibre along the unit vector `direction` of the undeformed plane.
    pub fn fibre(&self, direction: [f64; 2]) -> Fibre {
        let [exx, eyy, exy] = self.green();
        let [x, y] = direction;
        Fibre {
            green: exx * x * x + eyy * y * y + 2.0 * exy * x * y,
        }
    }
}

/// A fibre of the material by its Green-Lagrange strain; all measures keep their digits where it is
/// small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Green-Lagrange strain `(lambda² - 1)/2`.
    pub green: f64,
}

impl Fibre {
    /// The fibre of the given engineering strain.
    pub fn by_engineering(strain: f64) -> Self {
        Self {
            green: strain * (1.0 + 0.5 * strain),
        }
    }

    /// Stretch lambda.
    pub fn stretch(&self) -> f64 {
        (1.0 + 2.0 * self.green).sqrt()
    }

    /// Engineering strain `lambda - 1`.
    pub fn engineering(&self) -> f64 {
        2.0 * self.green / (self.stretch() + 1.0)
    }

    /// Strain by the deformed length, `1 - 1/lambda`.
    pub fn by_deformed_length(&self) -> f64 {
        self.engineering() / self.stretch()
    }

    /// Almansi strain `(1 - 1/lambda²)/2`.
    pub fn almansi(&self) -> f64 {
        self.green / (1.0 + 2.0 * self.green)
    }

    /// True axial force [N] of a bar of stiffness `axial_stiffness` (EA) [N] whose energy is
    /// `EA/2 (Green strain)²` a length: `EA lambda (lambda² - 1)/2`.
    pub fn axial_force(&self, axial_stiffness: f64) -> f64 {
        axial_stiffness * self.green * self.stretch()
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All measures from the tensors themselves at a general state: e from D^T D, Almansi's from the
    /// inverse of D in the surface's own plane, areas from the cross product. Round-off of a few
    /// operations.
    #[test]
    fn measures_agree_with_the_tensors() {
        let surface = SurfaceGradient {
            x: [1.3, 0.2, 0.0],
            y: [-0.1, 0.8, 0.0],
        };
        let (sine, cosine) = 0.4f64.sin_cos();
        let direction = [cosine, sine];
        let fibre = surface.fibre(direction);
        let deformed: [f64; 2] =
            std::array::from_fn(|i| surface.x[i] * cosine + surface.y[i] * sine);
        let stretch = deformed[0].hypot(deformed[1]);
        let determinant = 1.3 * 0.8 + 0.1 * 0.2;
        // D^-1 of the unit vector along the deformed fibre.
        let t = deformed.map(|value| value / stretch);
        let back = [
            (0.8 * t[0] + 0.1 * t[1]) / determinant,
            (-0.2 * t[0] + 1.3 * t[1]) / determinant,
        ];
        let almansi = 0.5 * (1.0 - back[0] * back[0] - back[1] * back[1]);
        for (value, expected) in [
            (fibre.stretch(), stretch),
            (fibre.engineering(), stretch - 1.0),
            (fibre.by_deformed_length(), 1.0 - 1.0 / stretch),
            (
                fibre.by_deformed_length(),
                1.0 - (1.0 - 2.0 * almansi).sqrt(),
            ),
            (fibre.almansi(), almansi),
            (
                fibre.axial_force(3.0),
                1.5 * stretch * (stretch * stretch - 1.0),
            ),
            (surface.jacobian(), determinant),
            (Fibre::by_engineering(stretch - 1.0).green, fibre.green),
        ] {
            assert!((value - expected).abs() < 1e-14, "{value} {expected}");
        }
    }

    /// A strain of 1e-12 keeps its digits: the measures differ by 1e-12 of it.
    #[test]
    fn small_strains_keep_their_digits() {
        let fibre = Fibre { green: 1e-12 };
        for value in [
            fibre.engineering(),
            fibre.by_deformed_length(),
            fibre.almansi(),
        ] {
            assert!((value / 1e-12 - 1.0).abs() < 1e-11, "{value}");
        }
    }
}
