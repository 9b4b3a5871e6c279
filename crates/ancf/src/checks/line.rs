//! Checks of beams: what loads and contact along the centre line rely on.

use super::{DIFFERENCE_TOLERANCE, assert_close, reference};
use crate::element::LineElement;

/// The centre line of a beam is a partition of unity, its slope is its derivative, its ends are the
/// nodes, and the axial force is zero in the reference and pulls in a stretched beam.
pub fn centre_line_is_consistent<E: LineElement>(element: &E) {
    let n = E::NODES * E::NODE_VECTORS;
    let length = element.length();
    let line = |xi: f64| {
        let mut weights = vec![f64::NAN; n];
        element.centre_line(xi, &mut weights);
        weights
    };
    let slope = |xi: f64| -> Vec<f64> {
        let mut weights = vec![f64::NAN; n];
        element.centre_line_slope(xi, &mut weights);
        weights.iter().map(|weight| weight * length).collect()
    };
    for (xi, node) in [(0.0, 0), (1.0, E::NODES - 1)] {
        for (vector, weight) in line(xi).into_iter().enumerate() {
            let at_node = f64::from(vector == node * E::NODE_VECTORS);
            assert!((weight - at_node).abs() < 1e-14, "end {xi} is not a node");
        }
    }
    let mut stretched = reference(element);
    for coordinate in stretched.iter_mut().step_by(E::DIMENSION) {
        *coordinate *= 1.0 + 1e-6;
    }
    for xi in [0.1, 0.35, 0.5, 0.8] {
        let sum: f64 = line(xi).iter().step_by(E::NODE_VECTORS).sum();
        assert!((sum - 1.0).abs() < 1e-14, "weights at {xi} sum to {sum}");
        let step = 1e-5;
        let difference: Vec<f64> = line(xi + step)
            .iter()
            .zip(line(xi - step))
            .map(|(after, before)| (after - before) / (2.0 * step))
            .collect();
        assert_close(
            "slope of the centre line",
            &slope(xi),
            &difference,
            DIFFERENCE_TOLERANCE,
        );
        let stiffness = element.energy_scale() / length;
        let at_rest = element.axial_force(&reference(element), xi) / stiffness;
        assert!(at_rest.abs() < 1e-13, "axial force {at_rest:e} at rest");
        let force = element.axial_force(&stretched, xi);
        assert!(force > 0.0, "a stretched beam does not pull");
    }
}
