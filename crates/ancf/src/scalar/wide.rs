//! Eight numbers in the widest SIMD registers that the running processor has.
//!
//! [`Lanes`] leaves it to the compiler to find vector instructions, which it does not in kernels as
//! long as an element's. A [`Wide`] number is a register from the start, by `pulp`'s safe interface:
//! every operation is IEEE 754's on each lane, so results equal plain numbers bit for bit.
//!
//! ```
//! use ancf::scalar::{EightLanes, LaneKernel, Scalar, dispatch};
//!
//! struct Squares<'a>(&'a mut [f64; 8]);
//! impl LaneKernel for Squares<'_> {
//!     type Output = ();
//!     #[inline(always)]
//!     fn run<S: EightLanes>(self) {
//!         let x = S::load(self.0);
//!         *self.0 = (x * x).store();
//!     }
//! }
//! let mut numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
//! dispatch(Squares(&mut numbers));
//! assert_eq!(numbers[7], 64.0);
//! ```

#[cfg(target_arch = "x86_64")]
mod called;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::Simd;

use super::{Lanes, Scalar};

/// Eight numbers side by side, of a type that [`dispatch`] chooses.
pub trait EightLanes: Scalar {
    /// Eight numbers from memory.
    fn load(values: &[f64; 8]) -> Self;
    /// The eight numbers.
    fn store(self) -> [f64; 8];

    /// Whether any of the eight numbers is positive.
    #[inline(always)]
    fn any_positive(self) -> bool {
        self.store().iter().any(|x| *x > 0.0)
    }

    /// Rows to columns: lane `i` of number `j` becomes lane `j` of number `i`.
    #[inline(always)]
    fn transpose(rows: [Self; 8]) -> [Self; 8] {
        let mut columns = [[0.0; 8]; 8];
        for (j, row) in rows.into_iter().enumerate() {
            for (column, value) in columns.iter_mut().zip(row.store()) {
                column[j] = value;
            }
        }
        columns.map(|column| Self::load(&column))
    }
}

/// Work that is compiled once for each kind of register.
pub trait LaneKernel {
    /// What the work returns.
    type Output;

    /// The work, with numbers of type `S`. Mark it and all that it calls `#[inline(always)]`: only what
    /// is inlined is compiled for the registers of `S`.
    fn run<S: EightLanes>(self) -> Self::Output;
}

/// Runs the kernel with the widest registers of the processor.
pub fn dispatch<K: LaneKernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        if let Some(simd) = V4::try_new() {
            return simd.vectorize(
                #[inline(always)]
                || kernel.run::<Wide<V4, 1>>(),
            );
        }
        if let Some(simd) = V3::try_new() {
            return simd.vectorize(
                #[inline(always)]
                || kernel.run::<Wide<V3, 2>>(),
            );
        }
    }
    kernel.run::<Fallback>()
}

/// For processors without the registers above. Where these are only the oldest of their kind, kernels
/// call its operations instead of unrolling all lanes, which would double the time to compile them.
#[cfg(target_arch = "x86_64")]
type Fallback = called::Called;
#[cfg(not(target_arch = "x86_64"))]
type Fallback = Lanes<8>;

impl EightLanes for Lanes<8> {
    #[inline(always)]
    fn load(values: &[f64; 8]) -> Self {
        Self(*values)
    }
    #[inline(always)]
    fn store(self) -> [f64; 8] {
        self.0
    }
}

/// An instruction set whose presence can be proved at any time.
pub trait Present: Simd {
    /// The proof.
    ///
    /// # Panics
    /// If the processor lacks the instructions: never inside [`dispatch`], which asks first.
    fn present() -> Self;

    /// Rows to columns of a square of registers: eight numbers in `N` registers a row.
    fn transpose<const N: usize>(self, rows: [[Self::f64s; N]; 8]) -> [[Self::f64s; N]; 8];
}

/// Eight numbers in `N` registers of the instruction set `T`.
#[derive(Clone, Copy, Debug)]
pub struct Wide<T: Simd, const N: usize> {
    simd: T,
    registers: [T::f64s; N],
}

impl<T: Simd, const N: usize> Wide<T, N> {
    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(T, T::f64s, T::f64s) -> T::f64s) -> Self {
        let mut registers = self.registers;
        for i in 0..N {
            registers[i] = operation(self.simd, self.registers[i], other.registers[i]);
        }
        Self { registers, ..self }
    }

    #[inline(always)]
    fn splat(simd: T, value: f64) -> Self {
        Self {
            simd,
            registers: [simd.splat_f64s(value); N],
        }
    }
}

impl<T: Present, const N: usize> EightLanes for Wide<T, N> {
    #[inline(always)]
    fn load(values: &[f64; 8]) -> Self {
        let (registers, _) = T::as_simd_f64s(values);
        let mut wide = Self::constant(0.0);
        wide.registers.copy_from_slice(&registers[..N]);
        wide
    }

    #[inline(always)]
    fn store(self) -> [f64; 8] {
        let mut values = [0.0; 8];
        let (registers, _) = T::as_mut_simd_f64s(&mut values);
        registers[..N].copy_from_slice(&self.registers);
        values
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        let positive = |register: &T::f64s| {
            let zero = self.simd.splat_f64s(0.0);
            let mask = self.simd.greater_than_f64s(*register, zero);
            self.simd.first_true_m64s(mask) < T::F64_LANES
        };
        self.registers.iter().any(positive)
    }

    #[inline(always)]
    fn transpose(rows: [Self; 8]) -> [Self; 8] {
        let simd = T::present();
        let columns = simd.transpose(rows.map(
            #[inline(always)]
            |row| row.registers,
        ));
        columns.map(
            #[inline(always)]
            |registers| Self { simd, registers },
        )
    }
}

impl<T: Present, const N: usize> Scalar for Wide<T, N> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::splat(T::present(), value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.zip(self, |simd, a, _| simd.sqrt_f64s(a))
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::splat(self.simd, 1.0) / self
    }

    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        let mut out = no;
        for i in 0..N {
            let zero = self.simd.splat_f64s(0.0);
            let positive = self.simd.greater_than_f64s(self.registers[i], zero);
            out.registers[i] = self
                .simd
                .select_f64s(positive, yes.registers[i], no.registers[i]);
        }
        out
    }

    #[inline(never)]
    fn apply<const M: usize>(
        arguments: [Self; M],
        function: &mut dyn FnMut([f64; M]) -> (f64, [f64; M]),
    ) -> (Self, [Self; M]) {
        let (value, derivatives) = Lanes::apply(arguments.map(|x| Lanes(x.store())), function);
        (
            Self::load(&value.0),
            derivatives.map(|derivative| Self::load(&derivative.0)),
        )
    }
}

macro_rules! operator {
    ($operator:ident, $function:ident, $simd:ident) => {
        impl<T: Simd, const N: usize> $operator for Wide<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.zip(other, |simd, a, b| simd.$simd(a, b))
            }
        }
        impl<T: Simd, const N: usize> $operator<f64> for Wide<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.zip(Self::splat(self.simd, other), |simd, a, b| simd.$simd(a, b))
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<T: Simd, const N: usize> Neg for Wide<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.zip(self, |simd, a, _| simd.neg_f64s(a))
    }
}
impl<T: Simd, const N: usize> AddAssign for Wide<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<T: Simd, const N: usize> SubAssign for Wide<T, N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
