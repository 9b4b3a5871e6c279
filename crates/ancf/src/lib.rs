//! Absolute nodal coordinate (ANCF) beams and plates: elements, meshes, rigid coordinates,
//! constraints, statics and time integration.
//!
//! SI units throughout. This crate knows nothing of belts.

#[cfg(feature = "checks")]
pub mod checks;
pub mod constraint;
pub mod dynamics;
pub mod element;
pub mod linear;
pub mod loads;
pub mod material;
pub mod mesh;
pub mod norm;
pub mod quadrature;
pub mod scalar;
pub mod section;
mod state;
pub mod statics;
pub mod strain;
pub mod structure;
pub mod system;
pub mod unsound;
