//! Closed forms, invariances and every refusal of the layout.

#![expect(clippy::float_cmp, reason = "senses and mirrored values are exact")]

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;
use crate::profile::Profile;

/// Path lengths are sums of a dozen terms of order one: round-off alone.
const ROUND_OFF: f64 = 1.0e-12;

fn pulley(name: &str, center: [f64; 2], radius: f64, wrap: Wrap) -> Pulley {
    Pulley {
        name: name.into(),
        center,
        radius,
        displacement: None,
        offset: 0.0,
        tilt: [0.0; 2],
        taper: 0.0,
        crown: None,
        wrap,
        speed: None,
        angle: None,
        inertia: 0.0,
        torque: Profile::Constant(0.0),
        load: None,
        irregularity: Vec::new(),
        groove_angle: None,
    }
}

fn inside(name: &str, x: f64, y: f64, radius: f64) -> Pulley {
    pulley(name, [x, y], radius, Wrap::Inside)
}

fn outside(name: &str, x: f64, y: f64, radius: f64) -> Pulley {
    pulley(name, [x, y], radius, Wrap::Outside)
}

/// Wraps pi, spans the centre distance: length 2 pi R + 2 d. The drive of Table 3.1 (Kerkkänen 2006).
#[test]
fn two_equal_pulleys() {
    let (radius, half) = (0.081_25, 0.191_441);
    let layout = Layout::new(&[
        inside("driver", -half, 0.0, radius),
        inside("driven", half, 0.0, radius),
    ])
    .unwrap();
    assert!((layout.length - (TAU * radius + 4.0 * half)).abs() < ROUND_OFF);
    assert_eq!(layout.sense, 1.0);
    for arc in &layout.arcs {
        assert!((arc.sweep - PI).abs() < ROUND_OFF);
    }
    // Counter-clockwise: the lower span leads from the left pulley to the right one.
    assert!((layout.spans[0].start[1] + radius).abs() < ROUND_OFF);
    let middle = layout.point(0.0);
    assert!((middle.position[0] + half + radius).abs() < ROUND_OFF);
    assert!((middle.tangent[1] + 1.0).abs() < ROUND_OFF);
    assert_eq!(middle.on, Place::Pulley(0));
    assert_eq!(layout.point(0.25 * layout.length).on, Place::Span(0));
}

/// Open belt: 2 sqrt(d² - (R1 - R2)²) + pi (R1 + R2) + 2 (R1 - R2) asin((R1 - R2)/d).
#[test]
fn unequal_radii() {
    let (r1, r2, d) = (0.3, 0.1, 0.7_f64);
    let layout = Layout::new(&[inside("a", 0.0, 0.0, r1), inside("b", 0.0, d, r2)]).unwrap();
    let angle: f64 = ((r1 - r2) / d).asin();
    let length = 2.0 * d * angle.cos() + PI * (r1 + r2) + 2.0 * (r1 - r2) * angle;
    assert!((layout.length - length).abs() < ROUND_OFF);
    assert!((layout.arcs[0].sweep - (PI + 2.0 * angle)).abs() < ROUND_OFF);
    assert!((layout.arcs[1].sweep - (PI - 2.0 * angle)).abs() < ROUND_OFF);
}

/// Crossed belt: 2 sqrt(d² - (R1 + R2)²) + (R1 + R2) (pi + 2 asin((R1 + R2)/d)); the outside pulley
/// turns clockwise.
#[test]
fn crossed_belt() {
    let (r1, r2, d) = (0.3, 0.1, 0.7_f64);
    let layout = Layout::new(&[inside("a", 0.0, 0.0, r1), outside("b", d, 0.0, r2)]).unwrap();
    let angle: f64 = ((r1 + r2) / d).asin();
    let length = 2.0 * d * angle.cos() + (r1 + r2) * (PI + 2.0 * angle);
    assert!((layout.length - length).abs() < ROUND_OFF);
    assert!((layout.arcs[0].sweep - (PI + 2.0 * angle)).abs() < ROUND_OFF);
    assert!((layout.arcs[1].sweep + (PI + 2.0 * angle)).abs() < ROUND_OFF);
}

/// Two equal pulleys at (+-a, 0), a back-side idler at (0, y) on the upper span. The spans beside
/// it are inner tangents inclined by beta = asin((R + r)/d) - atan(y/a), d² = a² + y²: length 2 R
/// (pi + beta) + 2 r beta + 2 a + 2 sqrt(d² - (R + r)²).
#[test]
fn three_pulleys_with_outside_idler() {
    let (a, radius, y, small) = (0.5_f64, 0.12_f64, 0.14_f64, 0.05_f64);
    let d = a.hypot(y);
    let beta = ((radius + small) / d).asin() - y.atan2(a);
    let length = 2.0 * radius * (PI + beta)
        + 2.0 * small * beta
        + 2.0 * a
        + 2.0 * (d * d - (radius + small).powi(2)).sqrt();
    let pulleys = [
        inside("driver", -a, 0.0, radius),
        inside("driven", a, 0.0, radius),
        outside("idler", 0.0, y, small),
    ];
    let layout = Layout::new(&pulleys).unwrap();
    assert_eq!(layout.sense, 1.0);
    assert!((layout.length - length).abs() < ROUND_OFF);
    assert!((layout.arcs[0].sweep - (PI + beta)).abs() < ROUND_OFF);
    assert!((layout.arcs[2].sweep + 2.0 * beta).abs() < ROUND_OFF);

    // The idler listed on the other way round: the loop is walked clockwise.
    let reversed = [pulleys[0].clone(), pulleys[2].clone(), pulleys[1].clone()];
    let layout = Layout::new(&reversed).unwrap();
    assert_eq!(layout.sense, -1.0);
    assert!((layout.length - length).abs() < ROUND_OFF);
    assert!((layout.arcs[1].sweep - 2.0 * beta).abs() < ROUND_OFF);
}

#[test]
fn refusals_name_the_pulleys() {
    let refuse = |pulleys: &[Pulley]| Layout::new(pulleys).unwrap_err();
    let named = |error: &LayoutError, name: &str| error.to_string().contains(name);
    assert!(matches!(
        refuse(&[]),
        LayoutError::TooFewPulleys { count: 0 }
    ));
    assert!(matches!(
        refuse(&[inside("a", 0.0, 0.0, 1.0)]),
        LayoutError::TooFewPulleys { count: 1 }
    ));
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refuse(&[
            inside("good", 0.0, 0.0, 1.0),
            inside("bad", 5.0, 0.0, radius),
        ]);
        assert!(matches!(error, LayoutError::BadPulley { .. }) && named(&error, "\"bad\""));
    }
    // Touching, overlapping, nested, concentric.
    for x in [2.0, 1.5, 0.1, 0.0] {
        let error = refuse(&[inside("a", 0.0, 0.0, 1.0), inside("b", x, 0.0, 1.0)]);
        assert!(matches!(error, LayoutError::Overlap { .. }) && named(&error, "\"b\""));
    }
    let error = refuse(&[outside("a", 0.0, 0.0, 1.0), outside("b", 3.0, 0.0, 1.0)]);
    assert_eq!(error, LayoutError::AllOutside);
}

#[test]
fn refusals_of_idlers_and_orders() {
    let refuse = |pulleys: &[Pulley]| Layout::new(pulleys).unwrap_err();
    let (left, right) = (
        inside("left", -0.5, 0.0, 0.1),
        inside("right", 0.5, 0.0, 0.1),
    );
    // A back-side idler that hangs above the upper span, just touches it, and one that is as large
    // as the drive.
    for (y, radius) in [(0.2, 0.05), (0.15, 0.05), (1.2, 1.0)] {
        let error = refuse(&[
            left.clone(),
            right.clone(),
            outside("idler", 0.0, y, radius),
        ]);
        assert!(
            matches!(&error, LayoutError::NoContact { pulley, .. } if pulley == "idler"),
            "{error}"
        );
    }
    // An inner idler that stays inside the loop, listed after either pulley.
    let idler = inside("idler", 0.0, 0.02, 0.05);
    for pulleys in [
        [left.clone(), right.clone(), idler.clone()],
        [left.clone(), idler, right.clone()],
    ] {
        let error = refuse(&pulleys);
        assert!(
            matches!(&error, LayoutError::NoContact { pulley, .. } if pulley == "idler"),
            "{error}"
        );
    }
    // Four corners listed crosswise.
    let error = refuse(&[
        inside("a", 0.0, 0.0, 0.1),
        inside("b", 1.0, 1.0, 0.1),
        inside("c", 1.0, 0.0, 0.1),
        inside("d", 0.0, 1.0, 0.1),
    ]);
    assert!(matches!(error, LayoutError::SelfCrossing { .. }));
    // A star: every wrap is fine, but the path turns twice.
    let star: Vec<Pulley> = (0..5)
        .map(|i| {
            let angle = TAU * 0.4 * f64::from(i);
            inside(&format!("p{i}"), angle.cos(), angle.sin(), 0.05)
        })
        .collect();
    assert!(matches!(refuse(&star), LayoutError::SelfCrossing { .. }));
}

/// A span that a listed pulley blocks without the path's closing being at fault.
#[test]
fn refuses_a_blocked_span() {
    // "tooth" dents the upper span from outside so far that it reaches the lower span.
    let error = Layout::new(&[
        inside("left", -1.0, 0.0, 0.1),
        inside("right", 1.0, 0.0, 0.1),
        outside("tooth", 0.0, 0.0, 0.15),
    ])
    .unwrap_err();
    assert!(
        matches!(&error, LayoutError::SpanBlocked { pulley, .. } if pulley == "tooth"),
        "{error}"
    );
}

/// Pulleys on a circle, some of them with a back-side idler pressed into the span behind.
fn serpentine() -> impl Strategy<Value = Vec<Pulley>> {
    (3_usize..7).prop_flat_map(|count| {
        proptest::collection::vec(
            (
                -0.12..0.12_f64,
                0.05..0.15_f64,
                any::<bool>(),
                0.005..0.03_f64,
            ),
            count,
        )
        .prop_map(|draws| {
            let count = draws.len() as f64;
            let hull: Vec<Pulley> = draws
                .iter()
                .enumerate()
                .map(|(i, draw)| {
                    let angle = TAU * (i as f64 + draw.0) / count;
                    inside(&format!("p{i}"), angle.cos(), angle.sin(), draw.1)
                })
                .collect();
            let layout = Layout::new(&hull).unwrap();
            let mut pulleys = Vec::new();
            for (i, draw) in draws.iter().enumerate() {
                pulleys.push(hull[i].clone());
                if draw.2 {
                    let span = &layout.spans[i];
                    let middle = layout.point(span.at + 0.5 * span.length);
                    let out = 0.06 - draw.3;
                    let center = [
                        middle.position[0] + out * middle.tangent[1],
                        middle.position[1] - out * middle.tangent[0],
                    ];
                    pulleys.push(pulley(&format!("idler{i}"), center, 0.06, Wrap::Outside));
                }
            }
            pulleys
        })
    })
}

fn moved(pulleys: &[Pulley], map: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<Pulley> {
    pulleys
        .iter()
        .map(|p| Pulley {
            center: map(p.center),
            ..p.clone()
        })
        .collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < ROUND_OFF * 10.0
}

proptest! {
    #[test]
    fn a_moved_drive_has_the_moved_path(
        pulleys in serpentine(), angle in -3.0..3.0_f64, shift in [-2.0..2.0_f64, -2.0..2.0_f64],
    ) {
        let (sin, cos) = angle.sin_cos();
        let map = |p: [f64; 2]| [cos * p[0] - sin * p[1] + shift[0], sin * p[0] + cos * p[1] + shift[1]];
        let layout = Layout::new(&pulleys).unwrap();
        let image = Layout::new(&moved(&pulleys, map)).unwrap();
        prop_assert!(close(layout.length, image.length));
        for s in [0.0, 0.3, 1.7, -0.9] {
            let (here, there) = (map(layout.point(s).position), image.point(s).position);
            prop_assert!(close(here[0], there[0]) && close(here[1], there[1]));
        }
    }

    #[test]
    fn a_mirrored_drive_has_the_mirrored_path(pulleys in serpentine()) {
        let layout = Layout::new(&pulleys).unwrap();
        let image = Layout::new(&moved(&pulleys, |p| [p[0], -p[1]])).unwrap();
        prop_assert!(layout.sense == -image.sense && close(layout.length, image.length));
        for (arc, mirrored) in layout.arcs.iter().zip(&image.arcs) {
            prop_assert!(close(arc.sweep, -mirrored.sweep));
        }
        for s in [0.0, 0.3, 1.7, -0.9] {
            let (here, there) = (layout.point(s), image.point(s));
            prop_assert!(close(here.position[0], there.position[0]) && close(here.position[1], -there.position[1]));
            prop_assert!(here.curvature == -there.curvature && here.on == there.on);
        }
    }

    #[test]
    fn order_may_start_anywhere_and_run_either_way(pulleys in serpentine(), start in 0_usize..6) {
        let layout = Layout::new(&pulleys).unwrap();
        let start = start % pulleys.len();
        let mut turned = pulleys.clone();
        turned.rotate_left(start);
        let image = Layout::new(&turned).unwrap();
        prop_assert!(layout.sense == image.sense && close(layout.length, image.length));
        for i in 0..pulleys.len() {
            prop_assert!(close(image.arcs[i].sweep, layout.arcs[(i + start) % pulleys.len()].sweep));
        }
        let mut reversed = pulleys.clone();
        reversed.reverse();
        let image = Layout::new(&reversed).unwrap();
        prop_assert!(layout.sense == -image.sense && close(layout.length, image.length));
        for i in 0..pulleys.len() {
            prop_assert!(close(image.arcs[i].sweep, -layout.arcs[pulleys.len() - 1 - i].sweep));
        }
    }

    /// The path is closed, turns once, and its parameter is the arc length: position is continuous
    /// with unit speed, the derivative of position is the tangent. Central differences over a
    /// junction see the jump of curvature (20 1/m at most): error below 20 h.
    #[test]
    fn path_is_smooth_and_closed(pulleys in serpentine(), s in -20.0..20.0_f64) {
        let layout = Layout::new(&pulleys).unwrap();
        let turning: f64 = layout.arcs.iter().map(|arc| arc.sweep).sum();
        prop_assert!(close(turning, layout.sense * TAU));
        let parts: f64 = layout.arcs.iter().map(|a| a.length).chain(layout.spans.iter().map(|s| s.length)).sum();
        prop_assert!(close(parts, layout.length));
        let h = 1.0e-6;
        let junctions = layout.spans.iter().flat_map(|span| [span.at, span.at + span.length]);
        for s in junctions.chain([s, 0.0, layout.length]) {
            let (before, here, after) = (layout.point(s - h), layout.point(s), layout.point(s + h));
            let around = layout.point(s + layout.length);
            for k in 0..2 {
                let slope = (after.position[k] - before.position[k]) / (2.0 * h);
                prop_assert!((slope - here.tangent[k]).abs() < 20.0 * h + 1.0e-9);
                prop_assert!(close(around.position[k], here.position[k]));
            }
            prop_assert!(close(here.tangent[0].hypot(here.tangent[1]), 1.0));
        }
    }
}
