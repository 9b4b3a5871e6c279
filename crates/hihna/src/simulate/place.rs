//! Places on the drive, in words.

use crate::drive::Drive;
use crate::layout::Layout;

/// Distance from the path, in smallest radii, whose digits tell nothing.
const FLOWN: f64 = 100.0;

/// Where on the drive a coordinate is, in words: the belt has `chain` coordinates, `dof` for each node.
pub(super) fn place(
    drive: &Drive,
    layout: &Layout,
    q: &[f64],
    coordinate: usize,
    (chain, dof): (usize, usize),
) -> String {
    if coordinate >= chain {
        let pulley = drive.pulley.get(coordinate - chain);
        return pulley.map_or_else(
            || "at the joint of the belt's ends".to_owned(),
            |pulley| format!("at pulley `{}`", pulley.name),
        );
    }
    let node = coordinate / dof;
    let position = [q[node * dof], q[node * dof + 1]];
    let (distance, (from, to)) = nearest_pulleys(layout, position);
    let at = format!("node {node} at ({:.4}, {:.4}) m", position[0], position[1]);
    let smallest = layout
        .arcs
        .iter()
        .fold(f64::INFINITY, |r, arc| r.min(arc.radius));
    if distance.is_nan() || distance > FLOWN * smallest {
        format!("where the belt has flown off, node {node}")
    } else if distance > smallest {
        format!("where the belt has left its path by {distance:.3} m, {at}")
    } else if from == to {
        format!("on pulley `{}`, {at}", drive.pulley[from].name)
    } else {
        format!(
            "between pulleys `{}` and `{}`, {at}",
            drive.pulley[from].name, drive.pulley[to].name
        )
    }
}

/// How far `position` is from the path, and the pulley nearest to it, twice, or the two at the ends of the
/// span that is nearer.
fn nearest_pulleys(layout: &Layout, position: [f64; 2]) -> (f64, (usize, usize)) {
    let to_arc = layout.arcs.iter().map(|arc| {
        let (dx, dy) = (position[0] - arc.center[0], position[1] - arc.center[1]);
        ((dx.hypot(dy) - arc.radius).abs(), (arc.pulley, arc.pulley))
    });
    let to_span = layout.spans.iter().map(|span| {
        let along = [span.end[0] - span.start[0], span.end[1] - span.start[1]];
        let arm = [position[0] - span.start[0], position[1] - span.start[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let part = ((arm[0] * along[0] + arm[1] * along[1]) / square).clamp(0.0, 1.0);
        let off = [arm[0] - part * along[0], arm[1] - part * along[1]];
        (off[0].hypot(off[1]), (span.from, span.to))
    });
    to_arc
        .chain(to_span)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or_default()
}
