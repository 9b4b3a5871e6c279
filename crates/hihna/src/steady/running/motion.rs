//! What contact needs to know of a belt that runs and of its pulleys.

/// Motion of belt and pulleys: coordinates of the chain, circulation speed, speeds of the pulleys and phases of their
/// bristles, where there are any.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    pub chain: &'a [f64],
    pub circulation: f64,
    pub speeds: &'a [f64],
    pub phases: &'a [f64],
}
