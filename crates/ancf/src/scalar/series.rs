//! A number together with its derivative along an element.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::Scalar;

/// `value + slope dx`, a series cut off after its first term: what a function gives of `Series`
/// arguments holds its value and, by the chain rule, its derivative by x.
///
/// So a kernel of a vector v(x) serves v and v' alike. If `F = p.v + q.v'`, its derivatives are those of
/// the weighted `w.v` with `w = q + p dx`: by the arguments' slopes in `value`, by the arguments in
/// `slope`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series<S> {
    pub value: S,
    pub slope: S,
}

impl<S: Scalar> Series<S> {
    #[inline(always)]
    pub fn new(value: S, slope: S) -> Self {
        Self { value, slope }
    }

    /// Vectors of values and of slopes.
    #[inline(always)]
    pub fn vector(value: [S; 3], slope: [S; 3]) -> [Self; 3] {
        [
            Self::new(value[0], slope[0]),
            Self::new(value[1], slope[1]),
            Self::new(value[2], slope[2]),
        ]
    }
}

impl<S: Scalar> Add for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.slope + other.slope)
    }
}

impl<S: Scalar> Sub for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.slope - other.slope)
    }
}

impl<S: Scalar> Mul for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.value * other.value,
            self.value * other.slope + self.slope * other.value,
        )
    }
}

impl<S: Scalar> Div for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Self::new(
            quotient,
            (self.slope - quotient * other.slope) / other.value,
        )
    }
}

impl<S: Scalar> Neg for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}

impl<S: Scalar> Add<f64> for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self::new(self.value + other, self.slope)
    }
}

impl<S: Scalar> Sub<f64> for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self::new(self.value - other, self.slope)
    }
}

impl<S: Scalar> Mul<f64> for Series<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self::new(self.value * other, self.slope * other)
    }
}

impl<S: Scalar> AddAssign for Series<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Scalar> SubAssign for Series<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Scalar> Scalar for Series<S> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::new(S::constant(value), S::zero())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::new(root, self.slope * 0.5 / root)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let reciprocal = self.value.recip();
        Self::new(reciprocal, -(self.slope * reciprocal * reciprocal))
    }

    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        Self::new(
            self.value.select_positive(yes.value, no.value),
            self.value.select_positive(yes.slope, no.slope),
        )
    }

    fn apply<const N: usize>(
        arguments: [Self; N],
        function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
    ) -> (Self, [Self; N]) {
        let (value, derivatives) = S::apply(arguments.map(|x| x.value), function);
        let mut slope = S::zero();
        for (x, derivative) in arguments.iter().zip(derivatives) {
            slope += derivative * x.slope;
        }
        let constant = |derivative| Self::new(derivative, S::zero());
        (Self::new(value, slope), derivatives.map(constant))
    }
}
