//! Eight numbers whose operations are calls.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::EightLanes;
use crate::scalar::{Lanes, Scalar};

/// [`Lanes`] of eight whose operations are never inlined: slow to run, quick to compile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Called(Lanes<8>);

macro_rules! operator {
    ($operator:ident, $function:ident, $symbol:tt) => {
        impl $operator for Called {
            type Output = Self;
            #[inline(never)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }
        impl $operator<f64> for Called {
            type Output = Self;
            #[inline(never)]
            fn $function(self, other: f64) -> Self {
                Self(self.0 $symbol other)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Called {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl AddAssign for Called {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}
impl SubAssign for Called {
    #[inline(never)]
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl Scalar for Called {
    #[inline(never)]
    fn constant(value: f64) -> Self {
        Self(Lanes::constant(value))
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(never)]
    fn recip(self) -> Self {
        Self(self.0.recip())
    }
    #[inline(never)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        Self(self.0.select_positive(yes.0, no.0))
    }
    #[inline(never)]
    fn apply<const N: usize>(
        arguments: [Self; N],
        function: &mut dyn FnMut([f64; N]) -> (f64, [f64; N]),
    ) -> (Self, [Self; N]) {
        let (value, derivatives) = Lanes::apply(arguments.map(|x| x.0), function);
        (Self(value), derivatives.map(Self))
    }
}

impl EightLanes for Called {
    #[inline(never)]
    fn load(values: &[f64; 8]) -> Self {
        Self(Lanes::load(values))
    }
    #[inline(never)]
    fn store(self) -> [f64; 8] {
        self.0.store()
    }
}
