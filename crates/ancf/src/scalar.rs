//! The number type of the kernels: `f64`, several lanes of it, or dual numbers.
//!
//! Element, contact and friction kernels are written once over [`Scalar`]. They select instead of
//! branching (see [`Scalar::select_positive`]), so one text serves plain numbers, SIMD lanes and
//! automatic differentiation.

mod series;
mod wide;

pub(crate) use series::Series;
pub use wide::{EightLanes, LaneKernel, Present, Wide, dispatch};

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number that kernels compute with.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The constant `value` (every lane, no derivative).
    fn constant(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// One over the number.
    fn recip(self) -> Self;
    /// Lane by lane: `yes` where `self > 0`, else `no`.
    fn select_positive(self, yes: Self, no: Self) -> Self;
    /// A function of plain numbers, lane by lane: its value and its derivatives by the arguments. Numbers that
    /// carry derivatives get those of the value by the chain rule, to first order; the derivatives returned are
    /// constants to them.
    fn apply<const N: usize>(
        arguments: [Self; N],
        function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
    ) -> (Self, [Self; N]);

    /// The constant zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    /// The magnitude.
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_positive(self, -self)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        if self > 0.0 { yes } else { no }
    }
    fn apply<const N: usize>(
        arguments: [Self; N],
        function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
    ) -> (Self, [Self; N]) {
        function(arguments)
    }
}

/// `L` numbers side by side; every operation acts on each. The compiler may turn short kernels into SIMD
/// instructions; [`Wide`] numbers are registers in any.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const L: usize>(pub [f64; L]);

macro_rules! lanes_operator {
    ($operator:ident, $function:ident, $symbol:tt) => {
        impl<const L: usize> $operator for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] $symbol other.0[i]))
            }
        }
        impl<const L: usize> $operator<f64> for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                Self(std::array::from_fn(|i| self.0[i] $symbol other))
            }
        }
    };
}
lanes_operator!(Add, add, +);
lanes_operator!(Sub, sub, -);
lanes_operator!(Mul, mul, *);
lanes_operator!(Div, div, /);

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(std::array::from_fn(|i| -self.0[i]))
    }
}
impl<const L: usize> AddAssign for Lanes<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<const L: usize> SubAssign for Lanes<L> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const L: usize> Scalar for Lanes<L> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; L])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].sqrt()))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Self(std::array::from_fn(|i| 1.0 / self.0[i]))
    }
    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|i| {
            if self.0[i] > 0.0 { yes.0[i] } else { no.0[i] }
        }))
    }
    fn apply<const N: usize>(
        arguments: [Self; N],
        function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
    ) -> (Self, [Self; N]) {
        let (mut value, mut derivatives) = (Self::zero(), [Self::zero(); N]);
        for lane in 0..L {
            let by_argument;
            (value.0[lane], by_argument) = function(arguments.map(|x| x.0[lane]));
            for (derivative, one) in derivatives.iter_mut().zip(by_argument) {
                derivative.0[lane] = one;
            }
        }
        (value, derivatives)
    }
}

/// Writes a short loop out, `unroll!(for i in 0..3 { ... })`.
///
/// Left as a loop over [`Lanes`], the compiler may vectorise along `i` with gathers instead of across
/// the lanes, several times slower.
macro_rules! unroll {
    (for $i:ident in 0..2 $body:block) => {
        unroll!(@ $i $body 0 1)
    };
    (for $i:ident in 0..3 $body:block) => {
        unroll!(@ $i $body 0 1 2)
    };
    (for $i:ident in 0..4 $body:block) => {
        unroll!(@ $i $body 0 1 2 3)
    };
    (for $i:ident in 0..6 $body:block) => {
        unroll!(@ $i $body 0 1 2 3 4 5)
    };
    (@ $i:ident $body:block $($n:literal)*) => {{
        $({
            let $i: usize = $n;
            $body
        })*
    }};
}
pub(crate) use unroll;

#[cfg(feature = "checks")]
macro_rules! dual_scalar {
    ($dual:ty) => {
        impl Scalar for $dual {
            fn constant(value: f64) -> Self {
                Self::from_re(value)
            }
            fn sqrt(self) -> Self {
                num_dual::DualNum::sqrt(&self)
            }
            fn recip(self) -> Self {
                num_dual::DualNum::recip(&self)
            }
            fn select_positive(self, yes: Self, no: Self) -> Self {
                if self.re > 0.0 { yes } else { no }
            }
            fn apply<const N: usize>(
                arguments: [Self; N],
                function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
            ) -> (Self, [Self; N]) {
                let (value, derivatives) = function(arguments.map(|x| x.re));
                let mut sum = Self::from_re(value);
                for (x, derivative) in arguments.iter().zip(derivatives) {
                    sum += (*x - x.re) * derivative;
                }
                (sum, derivatives.map(Self::from_re))
            }
        }
    };
}
#[cfg(feature = "checks")]
dual_scalar!(num_dual::Dual64);
#[cfg(feature = "checks")]
dual_scalar!(num_dual::HyperDual64);
