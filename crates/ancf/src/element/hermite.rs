//! Cubic Hermite functions of a centre line with the nodal vectors `[r, r_x, ...]`.

/// Where the four Hermite functions of (r1, r1_x, r2, r2_x) find their vectors among the six of a planar
/// element, `[r, r_x, r_y]` a node.
pub(super) const VECTORS: [usize; 4] = [0, 1, 3, 4];

/// The same among the eight of a spatial element, `[r, r_x, r_y, r_z]` a node.
pub(super) const SPATIAL_VECTORS: [usize; 4] = [0, 1, 4, 5];

/// Cubic Hermite functions of (r1, r1_x, r2, r2_x) at `xi` on an element of length `l`.
pub(super) fn value(xi: f64, l: f64) -> [f64; 4] {
    let (x2, x3) = (xi * xi, xi * xi * xi);
    [
        1.0 - 3.0 * x2 + 2.0 * x3,
        l * (xi - 2.0 * x2 + x3),
        3.0 * x2 - 2.0 * x3,
        l * (x3 - x2),
    ]
}

/// First derivatives by x of [`value`].
pub(super) fn slope(xi: f64, l: f64) -> [f64; 4] {
    let x2 = xi * xi;
    [
        6.0 * (x2 - xi) / l,
        1.0 - 4.0 * xi + 3.0 * x2,
        6.0 * (xi - x2) / l,
        3.0 * x2 - 2.0 * xi,
    ]
}

/// Second derivatives by x of [`value`].
pub(super) fn curve(xi: f64, l: f64) -> [f64; 4] {
    [
        (12.0 * xi - 6.0) / (l * l),
        (6.0 * xi - 4.0) / l,
        (6.0 - 12.0 * xi) / (l * l),
        (6.0 * xi - 2.0) / l,
    ]
}

/// The consistent mass of the four functions on an element of length `l`, per mass of line `l / 420`.
pub(super) fn mass(l: f64) -> [[f64; 4]; 4] {
    [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ]
}

/// Writes Hermite weights to the weights of all vectors of an element: `vectors` are those they belong
/// to, and the last of them but one begins the second node, half way.
pub(super) fn spread(hermite: [f64; 4], vectors: [usize; 4], weights: &mut [f64]) {
    weights[..2 * vectors[2]].fill(0.0);
    for (weight, vector) in hermite.into_iter().zip(vectors) {
        weights[vector] = weight;
    }
}
