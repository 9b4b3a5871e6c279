//! How elements that stay in their places share the belt.
//!
//! Graded meshes have the node density
//!
//! ```text
//! 1 (on arcs 2) + 3 sum exp(-((s - s_t) / w)²)      w = 0.37 R
//! ```
//!
//! along the path, summed over the points `s_t` where the belt runs on and off a pulley of radius R: forces
//! change there within a fraction of the radius, and on arcs cubics must follow a circle, so that 30 graded elements do what 80 equal
//! ones do.

use crate::drive::{Drive, SteadyMesh};
use crate::layout::Layout;

/// Density at a tangent point beyond that of the spans.
const PEAK: f64 = 3.0;
/// Density on arcs beyond that of spans.
const BENT: f64 = 1.0;
/// Width of a peak, in radii.
const WIDTH: f64 = 0.37;
/// Samples of the density per element.
const SAMPLES: usize = 64;

/// Where the elements of `drive` begin, as parts of the belt, rising from 0.
pub(super) fn starts(drive: &Drive, layout: &Layout) -> Vec<f64> {
    let count = drive.belt.elements;
    match drive.steady.mesh {
        SteadyMesh::Uniform => (0..count).map(|i| i as f64 / count as f64).collect(),
        SteadyMesh::Graded => graded(count, drive.belt.first_node, layout),
    }
}

fn graded(count: usize, first_node: f64, layout: &Layout) -> Vec<f64> {
    let path = layout.length;
    let density = |s: f64| {
        let peaks = layout.arcs.iter().flat_map(|arc| {
            [arc.start, arc.start + arc.length].map(|at| {
                // The shorter way around the loop.
                let away = (s - at + 0.5 * path).rem_euclid(path) - 0.5 * path;
                (-(away / (WIDTH * arc.radius)).powi(2)).exp()
            })
        });
        let bent = (layout.arcs.iter()).any(|arc| (s - arc.start).rem_euclid(path) < arc.length);
        1.0 + if bent { BENT } else { 0.0 } + PEAK * peaks.sum::<f64>()
    };
    let samples = count * SAMPLES;
    let step = path / samples as f64;
    // The integral of the density by the midpoint rule, from the first node.
    let mut integral = Vec::with_capacity(samples + 1);
    let mut sum = 0.0;
    integral.push(sum);
    for i in 0..samples {
        sum += step * density(first_node + (i as f64 + 0.5) * step);
        integral.push(sum);
    }
    (0..count)
        .map(|i| {
            let wanted = sum * i as f64 / count as f64;
            let next = integral.partition_point(|x| *x <= wanted).clamp(1, samples);
            let (low, high) = (integral[next - 1], integral[next]);
            ((next - 1) as f64 + (wanted - low) / (high - low)) / samples as f64
        })
        .collect()
}
