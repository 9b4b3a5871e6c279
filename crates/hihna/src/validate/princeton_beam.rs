//! The slender strip of the Princeton beam experiment: bent far in both planes and twisted by one tip load.
//!
//! The reference that this program integrates itself is the spatial elastica with stretch and shear: with the force n
//! constant along the rod, R the frame of the section and m the moment,
//!
//! ```text
//! r' = R (e1 + C_n⁻¹ R^T n),   R' = R [k]x,   k = C_m⁻¹ R^T m,   m' = n x r',   m(L) = 0
//! C_n = diag(E A, ks G A, ks G A),   C_m = diag(G J, E Iz, E Iy)
//! ```

use ancf::element::BeltBeam3;
use ancf::material::Isotropic;
use ancf::section::{SHEAR_CORRECTION, SpatialSection};
use ancf::statics::LoadSteps;
use ancf::structure::{NodeDirection, SpatialStructure, StructureError};

use super::{CaseError, Quantities};

/// Aluminium 7075; density does not matter.
const ALUMINIUM: Isotropic = Isotropic {
    youngs_modulus: 71.7e9,
    poisson_ratio: 0.31,
    density: 2810.0,
};
/// Length, width (along z) and height (along y) of the strip [m].
const LENGTH: f64 = 0.508;
const WIDTH: f64 = 3.2024e-3;
const HEIGHT: f64 = 12.377e-3;
/// Tip loads [N], as the data names them.
const LOADS: [(&str, f64); 2] = [("8.896 N", 8.896), ("13.345 N", 13.345)];
/// Angles of the load from the height of the section [degrees].
const ANGLES: [u32; 7] = [0, 15, 30, 45, 60, 75, 90];
const ELEMENTS: usize = 32;

/// Where the tip is, and how far its section has turned about the beam.
#[derive(Clone, Copy, Debug)]
struct Tip {
    /// Displacement [m].
    moved: [f64; 3],
    /// Turn of the width about x, seen along it [rad].
    twist: f64,
}

impl Tip {
    fn new(place: [f64; 3], width: [f64; 3]) -> Self {
        let [x, y, z] = place;
        Self {
            moved: [x - LENGTH, y, z],
            twist: (-width[1]).atan2(width[2]),
        }
    }

    fn apart(&self, other: &Self) -> f64 {
        let squares = (self.moved.iter().zip(other.moved)).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    }
}

fn section() -> SpatialSection {
    SpatialSection::rectangle(WIDTH, HEIGHT)
}

/// A load that points down the height at 0 degrees and along the width at 90.
fn load(size: f64, degrees: u32) -> [f64; 3] {
    let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
    [0.0, -size * cosine, size * sine]
}

/// The tip of a cantilever of belt beams with the torsion constant `torsion` [m⁴].
fn by_elements(count: usize, torsion: f64, force: [f64; 3]) -> Result<Tip, StructureError> {
    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let section = SpatialSection {
        torsion_constant: torsion,
        ..section()
    };
    let element = BeltBeam3::new(LENGTH / count as f64, &section, &ALUMINIUM, 1.0, 1.0)
        .with_torsion_factor(section.saint_venant_torsion_factor());
    let mut beam = SpatialStructure::straight(element, count, [0.0; 3], AXES);
    beam.clamp_section(0)
        .force(count, NodeDirection::Position, force)
        .load_steps(LoadSteps {
            steps: 4,
            halvings: 8,
            tolerance: 1.0e-9 * LENGTH,
            max_iterations: 60,
        });
    let bent = beam.equilibrium()?;
    let of = |vector| beam.vector(&bent.q, count, vector);
    Ok(Tip::new(
        of(NodeDirection::Position),
        of(NodeDirection::Width),
    ))
}

/// Tips in the published conditions, Saint-Venant's torsion.
pub(super) fn tips() -> Result<Quantities, CaseError> {
    let torsion = section().torsion_constant;
    let mut quantities = Quantities::new();
    let (mut apart, mut coarse, mut turned) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (name, size) in LOADS {
        for degrees in ANGLES {
            let force = load(size, degrees);
            let tip = by_elements(ELEMENTS, torsion, force)?;
            let rod = elastica(force).ok_or(CaseError::DoesNotRun)?;
            apart = apart.max(tip.apart(&rod));
            coarse = coarse.max(by_elements(ELEMENTS / 2, torsion, force)?.apart(&rod));
            turned = turned.max((tip.twist - rod.twist).abs());
            let [_, y, z] = tip.moved.map(|metres| 1.0e3 * metres);
            if degrees < 90 {
                quantities.push((format!("{name} at {degrees} degrees, over the height"), -y));
            }
            if degrees > 0 {
                quantities.push((format!("{name} at {degrees} degrees, over the width"), z));
            }
            if degrees == 45 {
                let name = format!("{name} at 45 degrees, turn of the tip");
                quantities.push((name, tip.twist.to_degrees()));
            }
        }
    }
    Ok([
        quantities,
        vec![
            (
                "tip from that of the elastica, farthest".to_owned(),
                1.0e3 * apart,
            ),
            ("the same with 16 elements".to_owned(), 1.0e3 * coarse),
            (
                "turn of the tip from that of the elastica, largest".to_owned(),
                turned.to_degrees(),
            ),
        ],
    ]
    .concat())
}

/// The rod's state: r, the columns of R and m.
type Rod = [f64; 15];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn part(state: &Rod, k: usize) -> [f64; 3] {
    [state[3 * k], state[3 * k + 1], state[3 * k + 2]]
}

/// Derivative of the rod's state along it under the tip force n.
fn slope(state: &Rod, force: [f64; 3]) -> Rod {
    let section = section();
    let (young, shear) = (ALUMINIUM.youngs_modulus, ALUMINIUM.shear_modulus());
    let sheared = SHEAR_CORRECTION * shear * section.area;
    let frame = [1, 2, 3].map(|k| part(state, k));
    let moment = part(state, 4);
    let stiff = [young * section.area, sheared, sheared];
    let bent = [
        shear * section.torsion_constant,
        young * section.second_moment_z,
        young * section.second_moment_y,
    ];
    let strain: [f64; 3] = std::array::from_fn(|k| dot(frame[k], force) / stiff[k]);
    let curvature: [f64; 3] = std::array::from_fn(|k| dot(frame[k], moment) / bent[k]);
    let spin: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| frame[k][i] * curvature[k]).sum());
    let along: [f64; 3] =
        std::array::from_fn(|i| frame[0][i] + (0..3).map(|k| frame[k][i] * strain[k]).sum::<f64>());
    let [x, y, z] = frame.map(|axis| cross(spin, axis));
    let parts = [along, x, y, z, cross(force, along)];
    std::array::from_fn(|i| parts[i / 3][i % 3])
}

/// The rod's end from the moment at its root, by Runge and Kutta's method of fourth order: 400 steps leave 1e-10.
fn shoot(root: [f64; 3], force: [f64; 3]) -> Rod {
    const STEPS: u32 = 400;
    let step = LENGTH / f64::from(STEPS);
    let mut state: Rod = [0.0; 15];
    for k in 0..3 {
        state[3 + 4 * k] = 1.0;
        state[12 + k] = root[k];
    }
    let ahead = |state: &Rod, slope: &Rod, by: f64| -> Rod {
        std::array::from_fn(|i| state[i] + by * slope[i])
    };
    for _ in 0..STEPS {
        let a = slope(&state, force);
        let b = slope(&ahead(&state, &a, 0.5 * step), force);
        let c = slope(&ahead(&state, &b, 0.5 * step), force);
        let d = slope(&ahead(&state, &c, step), force);
        for i in 0..15 {
            state[i] += step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
    }
    state
}

/// The tip of the elastica, by Newton's method on the moment at its root while the load grows in ten steps.
fn elastica(force: [f64; 3]) -> Option<Tip> {
    const STEPS: u32 = 10;
    let scale = LENGTH * dot(force, force).sqrt();
    let mut root = [0.0; 3];
    for step in 1..=STEPS {
        let now = force.map(|f| f * f64::from(step) / f64::from(STEPS));
        let mut left = f64::INFINITY;
        for _ in 0..20 {
            let miss = part(&shoot(root, now), 4);
            left = dot(miss, miss).sqrt();
            if left < 1.0e-11 * scale {
                break;
            }
            let by = 1.0e-5 * scale;
            let columns: [[f64; 3]; 3] = std::array::from_fn(|k| {
                let moved = |sign: f64| {
                    let mut root = root;
                    root[k] += sign * by;
                    part(&shoot(root, now), 4)
                };
                let (ahead, behind) = (moved(1.0), moved(-1.0));
                std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * by))
            });
            // Cramer's rule.
            let [a, b, c] = columns;
            let determinant = dot(a, cross(b, c));
            let correction =
                [cross(b, c), cross(c, a), cross(a, b)].map(|row| dot(row, miss) / determinant);
            root = std::array::from_fn(|k| root[k] - correction[k]);
        }
        if left > 1.0e-9 * scale {
            return None;
        }
    }
    let end = shoot(root, force);
    Some(Tip::new(part(&end, 0), part(&end, 3)))
}
