//! Where the bristles of laws with memory stand.

use super::table::LANES;

/// The bristles of one batch of points: the pulley each stands on and the place there.
#[derive(Clone, Debug)]
pub(super) struct Bristles {
    /// Number of the pulley; [`usize::MAX`] for a point without contact.
    pub pulley: [usize; LANES],
    /// Unit vector to the place in axes that turn with the pulley.
    pub x: [f64; LANES],
    /// Its second component.
    pub y: [f64; LANES],
}

impl Bristles {
    pub const NONE: Self = Self {
        pulley: [usize::MAX; LANES],
        x: [0.0; LANES],
        y: [0.0; LANES],
    };

    /// Whether the point in `lane` has a bristle on `pulley`: one or zero.
    #[inline(always)]
    pub fn stands_on(&self, pulley: usize) -> [f64; LANES] {
        self.pulley
            .map(|number| f64::from(u8::from(number == pulley)))
    }
}
