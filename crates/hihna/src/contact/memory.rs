//! Where the bristles of laws with memory stand.

use super::table::LANES;

/// The bristles of one batch of points: the pulley each stands on and the place there.
#[derive(Clone, Debug)]
pub(super) struct Bristles {
    /// Number of the pulley plus one; zero for a point without contact.
    pub pulley: [f64; LANES],
    /// Unit vector to the place in axes that turn with the pulley.
    pub x: [f64; LANES],
    /// Its second component.
    pub y: [f64; LANES],
}

impl Bristles {
    pub const NONE: Self = Self {
        pulley: [0.0; LANES],
        x: [0.0; LANES],
        y: [0.0; LANES],
    };

    /// Whether the point in `lane` has a bristle on `pulley`: one or zero.
    #[inline(always)]
    pub fn stands_on(&self, pulley: usize) -> [f64; LANES] {
        let number = (pulley + 1) as f64;
        std::array::from_fn(|lane| f64::from(u8::from(self.pulley[lane] == number)))
    }
}
