//! Loads alone: the forces of moments and of a rotating frame against differences and closed forms.

use ancf::linear::{BorderedMatrix, Structure};
use ancf::loads::{Loads, NodeMoment, RotatingFrame};
use ancf::system::{ForceLaw, State};

/// Two nodes of two vectors, and a rigid body.
const STRUCTURE: Structure = Structure {
    sections: 2,
    block: 4,
    closed: false,
    border: 3,
};
const SIZE: usize = 11;
const SPEED: f64 = 1.7;

fn numbers(seed: usize) -> Vec<f64> {
    (0..SIZE)
        .map(|i| ((7 * i + 3 * seed + 1) as f64).sin())
        .collect()
}

/// A mass that acts on whole vectors.
fn mass() -> BorderedMatrix {
    let mut mass = BorderedMatrix::new(STRUCTURE);
    for row in 0..4 {
        for column in 0..4 {
            let value = if row == column {
                3.0
            } else {
                0.4 * (row + column) as f64
            };
            for axis in 0..2 {
                mass.add(2 * row + axis, 2 * column + axis, value);
            }
        }
    }
    for (i, value) in [5.0, 5.0, 0.7].into_iter().enumerate() {
        mass.add(8 + i, 8 + i, value);
    }
    mass
}

fn loads() -> Loads {
    Loads {
        factor: 0.6,
        dead: numbers(9),
        moments: vec![
            NodeMoment {
                slope: 2,
                moment: 2.5,
            },
            NodeMoment {
                slope: 6,
                moment: -1.5,
            },
        ],
        frame: Some(RotatingFrame::new(SPEED, &mass(), 1)),
    }
}

fn force(q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; SIZE];
    loads().add_force(State { time: 0.0, q, v }, &mut force);
    force
}

/// `K` and `C` are minus the derivatives of the forces: central differences of functions of order ten with a
/// step of 1e-5 err below 1e-8.
#[test]
fn tangents_are_derivatives() {
    let (q, v) = (numbers(1), numbers(2));
    let state = State {
        time: 0.0,
        q: &q,
        v: &v,
    };
    for by_velocity in [false, true] {
        let mut matrix = BorderedMatrix::new(STRUCTURE);
        let (position, velocity) = if by_velocity { (0.0, 1.0) } else { (1.0, 0.0) };
        loads().add_tangent(state, position, velocity, &mut matrix);
        for column in 0..SIZE {
            let shifted = |step: f64| {
                let (mut q, mut v) = (q.clone(), v.clone());
                let target = if by_velocity { &mut v } else { &mut q };
                target[column] += step;
                force(&q, &v)
            };
            let (plus, minus) = (shifted(1e-5), shifted(-1e-5));
            let mut unit = vec![0.0; SIZE];
            unit[column] = 1.0;
            let mut product = vec![0.0; SIZE];
            matrix.multiply(&unit, &mut product);
            for row in 0..SIZE {
                let slope = -(plus[row] - minus[row]) / 2e-5;
                assert!(
                    (product[row] - slope).abs() < 1e-8,
                    "({row}, {column}): {} {slope}",
                    product[row]
                );
            }
        }
    }
}

/// A moment does the work `m theta'` on any motion of its slope, whatever the slope's length, and no work
/// on its stretch.
#[test]
fn a_moment_is_conjugate_to_rotation() {
    let only_moments = Loads {
        frame: None,
        dead: Vec::new(),
        factor: 1.0,
        ..loads()
    };
    let (q, v) = (numbers(3), numbers(4));
    let mut force = vec![0.0; SIZE];
    let state = State {
        time: 0.0,
        q: &q,
        v: &v,
    };
    only_moments.clone().add_force(state, &mut force);
    let power: f64 = force.iter().zip(&v).map(|(f, v)| f * v).sum();
    let expected: f64 = (only_moments.moments.iter())
        .map(|NodeMoment { slope, moment }| {
            let angle = |time: f64| {
                let [x, y] = [0, 1].map(|axis| q[slope + axis] + time * v[slope + axis]);
                y.atan2(x)
            };
            moment * (angle(1e-5) - angle(-1e-5)) / 2e-5
        })
        .sum();
    assert!((power - expected).abs() < 1e-8, "{power} {expected}");
    let stretch: f64 = [2, 6]
        .iter()
        .map(|s| force[*s] * q[*s] + force[*s + 1] * q[*s + 1])
        .sum();
    assert!(stretch.abs() < 1e-14);
}

/// The forces of the frame are those of (2.30) with `q = R(Omega t) p`: a motion at rest in space, seen from
/// the frame (`p' = -Omega I~ p`, `p'' = -Omega² p`), needs no other force: `M p'' = Q`.
#[test]
fn a_motion_at_rest_in_space_needs_no_force() {
    let p = numbers(5);
    let mut v = vec![0.0; SIZE];
    for i in [0, 2, 4, 6, 8] {
        [v[i], v[i + 1]] = [SPEED * p[i + 1], -SPEED * p[i]];
    }
    let mut only_frame = Loads {
        factor: 1.0,
        dead: Vec::new(),
        moments: Vec::new(),
        frame: loads().frame,
    };
    let mut force = vec![0.0; SIZE];
    let state = State {
        time: 0.0,
        q: &p,
        v: &v,
    };
    only_frame.add_force(state, &mut force);
    let mut acceleration: Vec<f64> = p.iter().map(|x| -SPEED * SPEED * x).collect();
    acceleration[10] = 0.0;
    let mut expected = vec![0.0; SIZE];
    mass().multiply(&acceleration, &mut expected);
    for (a, b) in force.iter().zip(&expected) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}
