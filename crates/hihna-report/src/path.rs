//! Where on the path around the rigid pulleys a point of the moving belt is.

use hihna::layout::Layout;
use hihna::observe::ProfileRow;

/// The place of a point on the path.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// The nearest point of the path [m].
    pub point: [f64; 2],
    /// Its path coordinate from mid-wrap of the first pulley, from 0 to the path's length [m].
    pub along: f64,
    /// How much less likely the place is than others: distance, and disagreement of direction [m].
    cost: f64,
}

/// The places of the belt's points, which lie in the order of the path.
pub fn feet(layout: &Layout, belt: &[ProfileRow]) -> Vec<Foot> {
    let count = belt.len();
    (0..count)
        .map(|i| {
            let (before, here, after) = (
                &belt[(i + count - 1) % count],
                &belt[i],
                &belt[(i + 1) % count],
            );
            let heading = [after.x - before.x, after.y - before.y];
            foot(layout, [here.x, here.y], heading)
        })
        .collect()
}

/// The place of a point at `position` where the belt is heading in the direction `heading`. Direction counts, too: where
/// spans cross or run side by side, the nearest point may belong to the wrong one.
fn foot(layout: &Layout, position: [f64; 2], heading: [f64; 2]) -> Foot {
    let smallest = layout
        .arcs
        .iter()
        .fold(f64::INFINITY, |r, arc| r.min(arc.radius));
    let size = heading[0].hypot(heading[1]).max(f64::MIN_POSITIVE);
    let place = |point: [f64; 2], tangent: [f64; 2], along: f64| {
        let agreement = (heading[0] * tangent[0] + heading[1] * tangent[1]) / size;
        Foot {
            point,
            along: along.rem_euclid(layout.length),
            cost: (position[0] - point[0]).hypot(position[1] - point[1])
                + smallest * (1.0 - agreement),
        }
    };
    let on_arcs = layout.arcs.iter().map(|arc| {
        let side = arc.sweep.signum();
        let angle = (position[1] - arc.center[1]).atan2(position[0] - arc.center[0]);
        let turned = (side * (angle - arc.start_angle)).rem_euclid(std::f64::consts::TAU);
        let wrap = arc.sweep.abs();
        // Beyond the arc, the nearer of its ends.
        let turned = if turned <= wrap {
            turned
        } else if turned - wrap < std::f64::consts::TAU - turned {
            wrap
        } else {
            0.0
        };
        let (sine, cosine) = (arc.start_angle + side * turned).sin_cos();
        let point = [
            arc.center[0] + arc.radius * cosine,
            arc.center[1] + arc.radius * sine,
        ];
        place(
            point,
            [-side * sine, side * cosine],
            arc.start + arc.radius * turned,
        )
    });
    let on_spans = layout.spans.iter().map(|span| {
        let along = [span.end[0] - span.start[0], span.end[1] - span.start[1]];
        let tangent = [along[0] / span.length, along[1] / span.length];
        let arm = [position[0] - span.start[0], position[1] - span.start[1]];
        let at = (arm[0] * tangent[0] + arm[1] * tangent[1]).clamp(0.0, span.length);
        let point = [
            span.start[0] + at * tangent[0],
            span.start[1] + at * tangent[1],
        ];
        place(point, tangent, span.at + at)
    });
    on_arcs
        .chain(on_spans)
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .unwrap_or(Foot {
            point: position,
            along: 0.0,
            cost: 0.0,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hihna::input;

    fn layout(crossed: bool) -> Layout {
        let text = include_str!("../../../examples/two_pulley.toml");
        let mut drive = input::parse("drive", text, &[]).unwrap();
        if crossed {
            drive.pulley[1].wrap = hihna::drive::Wrap::Outside;
        }
        Layout::new(&drive.pulley).unwrap()
    }

    /// Points of the path have themselves as feet, also where a crossed belt's spans cross.
    #[test]
    fn the_path_is_its_own_foot() {
        for crossed in [false, true] {
            let layout = layout(crossed);
            for i in 0..997 {
                let s = layout.length * f64::from(i) / 997.0;
                let on = layout.point(s);
                let found = foot(&layout, on.position, on.tangent);
                let gap = (found.along - s).abs();
                // A path coordinate of an ulp below the whole length is that of the start.
                assert!(
                    gap.min(layout.length - gap) < 1e-12,
                    "{crossed} {s}: {found:?}"
                );
            }
        }
    }

    /// A point that sank into a pulley or swings in a span keeps its place on the path.
    #[test]
    fn a_shift_across_the_path_does_not_move_the_foot() {
        let layout = layout(false);
        for (s, shift) in [(0.02, -1e-3), (0.3, 4e-3), (0.3, -4e-3), (0.65, -1e-3)] {
            let on = layout.point(s);
            let position = [
                on.position[0] + shift * on.tangent[1],
                on.position[1] - shift * on.tangent[0],
            ];
            let found = foot(&layout, position, on.tangent);
            assert!((found.along - s).abs() < 1e-12, "{s}: {found:?}");
        }
    }
}
