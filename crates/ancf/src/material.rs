//! Isotropic linear elasticity.

/// An isotropic, linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic {
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio nu [-].
    pub poisson_ratio: f64,
    /// Density rho [kg/m³].
    pub density: f64,
}

impl Isotropic {
    /// Shear modulus G = E / (2 (1 + nu)) [Pa].
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// First Lamé constant lambda = E nu / ((1 + nu) (1 - 2 nu)) [Pa].
    #[must_use]
    pub fn lame_lambda(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }
}
