//! Why pulleys cannot carry a belt.

use crate::drive::Wrap;

/// Why pulleys cannot carry a belt in the given order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LayoutError {
    /// Fewer than two pulleys.
    #[error("a belt needs at least two pulleys, there are {count}")]
    TooFewPulleys {
        /// Number of pulleys.
        count: usize,
    },
    /// A centre or radius that is no length.
    #[error(
        "pulley \"{pulley}\": radius {radius} m and center {center:?} m must be finite, the radius above zero"
    )]
    BadPulley {
        /// Name of the pulley.
        pulley: String,
        /// Its radius [m].
        radius: f64,
        /// Its centre [m].
        center: [f64; 2],
    },
    /// Pulleys that touch, overlap or lie in one another.
    #[error(
        "pulleys \"{first}\" and \"{second}\" overlap: their centers are {distance:.6} m apart, their radii need more than \
         {needed:.6} m"
    )]
    Overlap {
        /// Name of the one pulley.
        first: String,
        /// Name of the other.
        second: String,
        /// Distance of the centres [m].
        distance: f64,
        /// Sum of the radii [m].
        needed: f64,
    },
    /// No pulley lies inside the loop.
    #[error("every pulley has wrap = \"outside\": at least one must lie inside the belt's loop")]
    AllOutside,
    /// The belt would pass a pulley without touching it on the wanted side.
    #[error(
        "the belt does not touch pulley \"{pulley}\" on the side that wrap = \"{}\" asks for: it would have to turn by {:.1} \
         degrees around it; move the pulley into the belt, change its wrap or its place in the order",
        wrap_name(*.wrap), .turn.to_degrees()
    )]
    NoContact {
        /// Name of the pulley.
        pulley: String,
        /// The wrap asked for.
        wrap: Wrap,
        /// The turn that would be needed [rad].
        turn: f64,
    },
    /// A free span runs through a third pulley.
    #[error(
        "the span from \"{from}\" to \"{to}\" runs through pulley \"{pulley}\", {depth:.6} m deep: move the pulley or list it \
         between the two"
    )]
    SpanBlocked {
        /// Name of the pulley where the span starts.
        from: String,
        /// Name of the pulley where it ends.
        to: String,
        /// Name of the pulley in the way.
        pulley: String,
        /// How deep the span lies in it [m].
        depth: f64,
    },
    /// The path does not close to a loop: two of its spans cross.
    #[error(
        "the belt crosses itself between the spans \"{}\"-\"{}\" and \"{}\"-\"{}\": list the pulleys in the order in which the \
         belt meets them and check each wrap (only two pulleys can have a crossed belt)",
        .spans[0].0, .spans[0].1, .spans[1].0, .spans[1].1
    )]
    SelfCrossing {
        /// The names at the ends of the two spans.
        spans: [(String, String); 2],
    },
    /// The path turns by something else than a full turn.
    #[error("the path does not close to a loop: it turns by {:.1} degrees in all, not by one full turn", .turning.to_degrees())]
    NotClosed {
        /// The total turning [rad].
        turning: f64,
    },
}

fn wrap_name(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Inside => "inside",
        Wrap::Outside => "outside",
    }
}
