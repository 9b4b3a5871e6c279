//! What the registers of x86 processors do beyond `pulp`'s common interface.

use std::arch::x86_64::{__m256d, __m512d};

use pulp::cast;
use pulp::x86::{V3, V4};

use super::Present;

macro_rules! proof {
    ($set:ty) => {
        match <$set>::try_new() {
            Some(simd) => simd,
            // `dispatch` runs kernels with this type only where `try_new` gave the proof.
            None => unreachable!("the processor has lost instructions"),
        }
    };
}

impl Present for V3 {
    #[inline(always)]
    fn present() -> Self {
        proof!(V3)
    }

    /// Squares of four, each in its place on the other side of the diagonal.
    #[inline(always)]
    fn transpose<const N: usize>(self, rows: [[Self::f64s; N]; 8]) -> [[Self::f64s; N]; 8] {
        let avx = self.avx;
        let mut columns = rows;
        for from in 0..N {
            for to in 0..N {
                let a: __m256d = cast(rows[4 * to][from]);
                let b: __m256d = cast(rows[4 * to + 1][from]);
                let c: __m256d = cast(rows[4 * to + 2][from]);
                let d: __m256d = cast(rows[4 * to + 3][from]);
                let even = [avx._mm256_unpacklo_pd(a, b), avx._mm256_unpacklo_pd(c, d)];
                let odd = [avx._mm256_unpackhi_pd(a, b), avx._mm256_unpackhi_pd(c, d)];
                for (k, [upper, lower]) in [even, odd].into_iter().enumerate() {
                    columns[4 * from + k][to] =
                        cast(avx._mm256_permute2f128_pd::<0x20>(upper, lower));
                    columns[4 * from + k + 2][to] =
                        cast(avx._mm256_permute2f128_pd::<0x31>(upper, lower));
                }
            }
        }
        columns
    }
}

impl Present for V4 {
    #[inline(always)]
    fn present() -> Self {
        proof!(V4)
    }

    #[inline(always)]
    fn transpose<const N: usize>(self, rows: [[Self::f64s; N]; 8]) -> [[Self::f64s; N]; 8] {
        // Pairs of numbers 0 and 2, or 1 and 3, of each of two registers.
        const EVEN: i32 = 0b10_00_10_00;
        const ODD: i32 = 0b11_01_11_01;
        let avx = self.avx512f;
        let mut columns = rows;
        let mut pairs = [[cast(rows[0][0]); 4]; 2];
        for i in 0..4 {
            let (a, b): (__m512d, __m512d) = (cast(rows[2 * i][0]), cast(rows[2 * i + 1][0]));
            pairs[0][i] = avx._mm512_unpacklo_pd(a, b);
            pairs[1][i] = avx._mm512_unpackhi_pd(a, b);
        }
        for (k, [a, b, c, d]) in pairs.into_iter().enumerate() {
            let even = [
                avx._mm512_shuffle_f64x2::<EVEN>(a, b),
                avx._mm512_shuffle_f64x2::<EVEN>(c, d),
            ];
            let odd = [
                avx._mm512_shuffle_f64x2::<ODD>(a, b),
                avx._mm512_shuffle_f64x2::<ODD>(c, d),
            ];
            for (place, [upper, lower]) in [(k, even), (k + 2, odd)] {
                columns[place][0] = cast(avx._mm512_shuffle_f64x2::<EVEN>(upper, lower));
                columns[place + 4][0] = cast(avx._mm512_shuffle_f64x2::<ODD>(upper, lower));
            }
        }
        columns
    }
}
