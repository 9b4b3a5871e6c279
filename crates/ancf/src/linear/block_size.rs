//! Block sizes known to the compiler.

/// Rows of a block, either a constant of the type or a value of the run.
///
/// Loops that run to [`BlockSize::get`] have a constant trip count for [`Fixed`].
pub(super) trait BlockSize: Copy {
    /// Rows (and columns) of a block.
    fn get(self) -> usize;
}

/// A block size the compiler knows.
#[derive(Clone, Copy)]
pub(super) struct Fixed<const N: usize>;

impl<const N: usize> BlockSize for Fixed<N> {
    #[inline(always)]
    fn get(self) -> usize {
        N
    }
}

/// A block size known at run time only.
#[derive(Clone, Copy)]
pub(super) struct Dynamic(pub usize);

impl BlockSize for Dynamic {
    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }
}

/// Evaluates an expression with `$size` bound to the [`BlockSize`] of `$block`: [`Fixed`] for the
/// cross-sections of the shipped elements (planar 4, 6; spatial 9, 12; plates 18, 27, 36).
macro_rules! with_block_size {
    ($block:expr, $size:ident => $body:expr) => {{
        use $crate::linear::block_size::{Dynamic, Fixed};
        match $block {
            4 => {
                let $size = Fixed::<4>;
                $body
            }
            6 => {
                let $size = Fixed::<6>;
                $body
            }
            9 => {
                let $size = Fixed::<9>;
                $body
            }
            12 => {
                let $size = Fixed::<12>;
                $body
            }
            18 => {
                let $size = Fixed::<18>;
                $body
            }
            27 => {
                let $size = Fixed::<27>;
                $body
            }
            36 => {
                let $size = Fixed::<36>;
                $body
            }
            other => {
                let $size = Dynamic(other);
                $body
            }
        }
    }};
}
pub(super) use with_block_size;
