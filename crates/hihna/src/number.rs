//! Plain and dual numbers under one name.

use num_dual::DualNum;

/// A number of the closed-form theories: `f64`, or any dual number over `f64` of fixed size, which
/// carries derivatives along.
pub trait Number: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Number for D {}
