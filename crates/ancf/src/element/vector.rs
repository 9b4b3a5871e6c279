//! Vectors in space, of any scalar.

use crate::scalar::Scalar;

#[inline(always)]
pub(super) fn dot<S: Scalar>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
