//! Isotropic linear elasticity.

use crate::unsound::{Unsound, positive, within};

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

    /// Refuses what resists some deformation with negative energy: E and the density must be positive, and
    /// -1 < nu <= 1/2 keeps shear and bulk modulus from being negative.
    pub fn check(&self) -> Result<(), Unsound> {
        positive("Young's modulus [Pa]", self.youngs_modulus)?;
        let nu = self.poisson_ratio;
        let fits = nu > -1.0 && nu <= 0.5;
        within("Poisson's ratio", nu, fits, "above -1 and at most 0.5")?;
        positive("the density [kg/m³]", self.density)
    }

    /// [`Isotropic::check`] where the bulk modulus counts: in plane strain nu = 1/2 makes it infinite.
    pub(crate) fn check_compressible(&self) -> Result<(), Unsound> {
        self.check()?;
        let nu = self.poisson_ratio;
        within("Poisson's ratio", nu, nu < 0.5, "below 0.5 in plane strain")
    }

    /// First Lamé constant lambda = E nu / ((1 + nu) (1 - 2 nu)) [Pa].
    #[must_use]
    pub fn lame_lambda(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }
}
