//! Thin plates as structures: static deflection and natural frequencies of square plates, strips in
//! large deflection, pressure that follows the surface.

use std::f64::consts::PI;

use ancf::element::{BendingRigidity, PlateQuadrature, ThinPlate};
use ancf::linear::BorderedMatrix;
use ancf::material::Isotropic;
use ancf::statics::{Equilibrium, LoadSteps};
use ancf::structure::{Edge, NodeVector, PlateStructure, StructureError};
use ancf::system::{ForceLaw, Mechanics, State};

const YOUNGS: f64 = 2e11;
const DENSITY: f64 = 7800.0;

fn material(poisson_ratio: f64) -> Isotropic {
    Isotropic {
        youngs_modulus: YOUNGS,
        poisson_ratio,
        density: DENSITY,
    }
}

/// Supports of a square plate in bending.
#[derive(Clone, Copy, Debug)]
enum Support {
    Simple,
    Clamped,
    /// One clamped edge (x = 0).
    Cantilever,
}

/// Side of the square plates [m], and their thickness.
const SIDE: f64 = 1.0;
const THICKNESS: f64 = 0.01;

/// A square plate of n x n elements that moves out of its plane only, nu = 0.3.
fn square(n: usize, support: Support) -> PlateStructure {
    let side = SIDE / n as f64;
    let material = material(0.3);
    let element = ThinPlate::new(side, side, THICKNESS, &material, BendingRigidity::Kirchhoff);
    let mut plate = PlateStructure::rectangle(element, n, n);
    plate.bending_only();
    match support {
        Support::Simple => plate.support(Edge::ALL),
        Support::Clamped => plate.clamp(Edge::ALL),
        Support::Cantilever => plate.clamp([Edge::Start]),
    };
    plate
}

fn rigidity() -> f64 {
    YOUNGS * THICKNESS.powi(3) / (12.0 * (1.0 - 0.09))
}

/// Deflection of the middle over `q a⁴ / D` under the pressure q; linear. `lumped`: a quarter of the
/// load of an element at each of its nodes, as in the published table; else the work of the pressure.
fn deflection(n: usize, support: Support, lumped: bool) -> f64 {
    let mut plate = square(n, support);
    if lumped {
        let quarter = 0.25 * (SIDE / n as f64).powi(2);
        for [i, j] in (0..n).flat_map(|i| (0..n).map(move |j| [i, j])) {
            for corner in [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]] {
                plate.force(corner, [0.0, 0.0, quarter]);
            }
        }
    } else {
        plate.pressure(1.0);
    }
    let displacements = plate.linear_displacements().unwrap();
    plate.position(&displacements, [n / 2, n / 2])[2] * rigidity() / SIDE.powi(4)
}

/// Zienkiewicz (The Finite Element Method, table of the 12-term rectangle: central deflection of a square
/// plate, a quarter of each element's load at its corners): the same element, so each value agrees as
/// printed, to one unit of its last digit.
#[test]
fn square_plates_deflect_as_published_for_this_element() {
    for (support, printed) in [
        (Support::Simple, [3.446e-3, 3.939e-3, 4.033e-3, 4.056e-3]),
        (Support::Clamped, [1.480e-3, 1.403e-3, 1.304e-3, 1.275e-3]),
    ] {
        for (n, expected) in [2, 4, 8, 16].into_iter().zip(printed) {
            let value = deflection(n, support, true);
            assert!(
                (value - expected).abs() < 1e-6,
                "{support:?} {n}: {value} {expected}"
            );
        }
    }
}

/// Timoshenko & Woinowsky-Krieger (1959): 0.00406235 and 0.00126532 q a⁴ / D by the series. The element
/// converges with h²: halving it quarters the error. The ratio is asked to 0.2, what the next term
/// of the error leaves at 8 elements.
#[test]
fn square_plates_converge_to_the_series_with_the_square_of_the_size() {
    for (support, exact) in [
        (Support::Simple, 4.062_35e-3),
        (Support::Clamped, 1.265_32e-3),
    ] {
        for lumped in [true, false] {
            let [coarse, middle, fine] =
                [8, 16, 32].map(|n| deflection(n, support, lumped) - exact);
            for ratio in [coarse / middle, middle / fine] {
                assert!((ratio - 4.0).abs() < 0.2, "{support:?} {lumped}: {ratio}");
            }
            let extrapolated = fine - (middle - fine) / 3.0;
            assert!(extrapolated.abs() < 1e-4 * exact, "{extrapolated}");
        }
    }
}

/// Natural frequencies `omega a² sqrt(rho h / D)`, lowest first.
fn frequencies(n: usize, support: Support) -> Vec<f64> {
    let plate = square(n, support);
    let modes = plate.modes(&plate.equilibrium().unwrap()).unwrap();
    let scale = SIDE.powi(2) * (DENSITY * THICKNESS / rigidity()).sqrt();
    modes.iter().map(|mode| mode.frequency * scale).collect()
}

/// Leissa (1973): simply supported `(m² + n²) pi²`; clamped and cantilever (nu = 0.3). Within 1 % at
/// 12 x 12, and between 6 and 12 elements a side the error of the supported plates falls with h².
#[test]
fn natural_frequencies_of_square_plates() {
    let simple = [2.0, 5.0, 5.0].map(|waves| waves * PI.powi(2)).to_vec();
    for (support, published) in [
        (Support::Simple, simple),
        (Support::Clamped, vec![35.985, 73.394, 73.394]),
        (
            Support::Cantilever,
            vec![3.4711, 8.5066, 21.2847, 27.1994, 30.9554],
        ),
    ] {
        let values = frequencies(12, support);
        for (value, expected) in values.iter().zip(&published) {
            let error = value / expected - 1.0;
            assert!(error.abs() < 0.01, "{support:?}: {value} {expected}");
        }
        if !matches!(support, Support::Cantilever) {
            let coarse = frequencies(6, support)[0] - published[0];
            let ratio = coarse / (values[0] - published[0]);
            assert!((ratio - 4.0).abs() < 0.4, "{support:?}: ratio {ratio}");
        }
    }
}

/// Length of the strips [m].
const LENGTH: f64 = 1.0;
const STRIP_WIDTH: f64 = 0.1;

/// A strip, nu = 0. At x = 0 its position, the direction of its slope and r_y are fixed; the length of
/// r_x is free, so that it may stretch there as elsewhere.
#[derive(Clone, Copy)]
struct Strip {
    along: usize,
    across: usize,
    thickness: f64,
    /// r_y is held everywhere: a strip out of the middle of a wide plate.
    cylindrical: bool,
    quadrature: PlateQuadrature,
}

impl Strip {
    fn plate(&self) -> PlateStructure {
        let element = ThinPlate::new(
            LENGTH / self.along as f64,
            STRIP_WIDTH / self.across as f64,
            self.thickness,
            &material(0.0),
            BendingRigidity::Kirchhoff,
        )
        .with_quadrature(self.quadrature);
        let mut plate = PlateStructure::rectangle(element, self.along, self.across);
        plate.clamp([Edge::Start]).load_steps(LoadSteps {
            steps: 10,
            halvings: 6,
            tolerance: 1e-9 * LENGTH,
            max_iterations: 60,
        });
        if self.cylindrical {
            for node in plate.nodes() {
                for axis in 0..3 {
                    plate.hold(node, NodeVector::Across, axis);
                }
                for vector in [NodeVector::Position, NodeVector::Along] {
                    plate.hold(node, vector, 1);
                }
            }
        }
        plate
    }

    fn bent(&self, load: impl Fn(&mut PlateStructure)) -> (PlateStructure, Equilibrium) {
        let mut plate = self.plate();
        load(&mut plate);
        let bent = plate
            .equilibrium()
            .unwrap_or_else(|error| panic!("{error}"));
        (plate, bent)
    }

    /// E I.
    fn rigidity(&self) -> f64 {
        YOUNGS * self.thickness.powi(3) / 12.0 * STRIP_WIDTH
    }
}

/// Angle by which a strip's tip has turned beyond a full circle under the moment `2 pi E I / L`, and the
/// tip's place.
fn rolled(strip: &Strip) -> [f64; 3] {
    let moment = 2.0 * PI * strip.rigidity() / (LENGTH * STRIP_WIDTH);
    let (plate, bent) = strip.bent(|plate| {
        plate.end_moment(moment);
    });
    let tip = [strip.along, 0];
    let [x, _, z] = plate.position(&bent.q, tip);
    let slope = plate.vector(&bent.q, tip, NodeVector::Along);
    [slope[2].atan2(slope[0]), x, z]
}

/// Strips of h = L / 100 unless a test says otherwise.
const STRIP: Strip = Strip {
    along: 32,
    across: 1,
    thickness: 0.01,
    cylindrical: true,
    quadrature: PlateQuadrature {
        membrane: 5,
        bending: 4,
    },
};

/// In cylindrical bending the energy is `E h (lambda² - 1)²/8 + E h³/24 (theta'/lambda)²` per area: under the
/// moment `M = 2 pi E I / L` the strip becomes a circular arc with `lambda² = 1 + 2 pi² h² / (3 L²)` that
/// turns by `2 pi lambda²`. The cubic line converges to it with the fourth power of the size.
#[test]
fn a_strip_rolls_up_under_an_end_moment() {
    let square = 1.0 + 2.0 * (PI * STRIP.thickness).powi(2) / (3.0 * LENGTH * LENGTH);
    let angle = 2.0 * PI * square;
    let radius = square.sqrt() * LENGTH / angle;
    let exact = [
        angle - 2.0 * PI,
        radius * angle.sin(),
        radius * (1.0 - angle.cos()),
    ];
    let error = |along: usize| {
        let strip = Strip { along, ..STRIP };
        let values = rolled(&strip);
        (0..3).fold(0.0f64, |most, i| most.max((values[i] - exact[i]).abs()))
    };
    let [coarse, middle, fine] = [16, 32, 64].map(error);
    for ratio in [coarse / middle, middle / fine] {
        assert!((ratio - 16.0).abs() < 0.8, "{ratio}");
    }
    assert!(fine < 1e-6 * angle * LENGTH, "{fine}");
}

/// With free edges the slope across the strip's edges is only held at nodes, which costs more than the size
/// along: 0.2 % of the angle, less with more elements across.
#[test]
fn free_edges_cost_little() {
    let exact = 2.0 * PI * 2.0 * (PI * STRIP.thickness).powi(2) / (3.0 * LENGTH * LENGTH);
    let [one, two, four] = [1, 2, 4].map(|across| {
        let strip = Strip {
            across,
            cylindrical: false,
            ..STRIP
        };
        (rolled(&strip)[0] - exact).abs() / (2.0 * PI)
    });
    assert!(one < 2e-3 && two < 2e-3, "{one} {two}");
    assert!(four < 0.5 * two, "{four} {two}");
}

/// The points of the quadrature change a rolled strip of eight elements, 45 degrees each, by less than
/// a hundredth of what its size does (two more points a side).
#[test]
fn the_quadrature_is_fine_enough() {
    let coarse = Strip {
        along: 8,
        cylindrical: false,
        ..STRIP
    };
    let quadrature = PlateQuadrature {
        membrane: 7,
        bending: 6,
    };
    let more_points = rolled(&Strip {
        quadrature,
        ..coarse
    });
    let more_elements = rolled(&Strip {
        along: 16,
        ..coarse
    });
    let values = rolled(&coarse);
    let by_points = (values[0] - more_points[0]).abs();
    let by_elements = (values[0] - more_elements[0]).abs();
    assert!(by_points < 0.01 * by_elements, "{by_points} {by_elements}");
}

/// Place of the tip of a cantilever strip with free edges under the tip force `10 E I / L²`: shortening
/// and deflection over L.
fn elastica(strip: &Strip) -> [f64; 2] {
    let load = 10.0 * strip.rigidity() / LENGTH.powi(2);
    let (plate, bent) = strip.bent(|plate| {
        // The end's deflection is cubic in y: the work of an even load on r and on r_y.
        for (j, sign) in [(0, 1.0), (1, -1.0)] {
            let tip = [strip.along, j];
            plate.force(tip, [0.0, 0.0, 0.5 * load]).slope_force(
                tip,
                NodeVector::Across,
                2,
                sign * load * STRIP_WIDTH / 12.0,
            );
        }
    });
    let [x, _, z] = plate.position(&bent.q, [strip.along, 0]);
    [1.0 - x / LENGTH, z / LENGTH]
}

/// Mattiasson (1981), elliptic integrals, `F L² / E I = 10`: 0.55500 and 0.81061. The plate stretches and so
/// turns by `lambda² - 1 = (kappa h)²/6` more than the elastica, 1.3e-5 at the root where `kappa L = 4.45`; with
/// the last published digit that makes 3e-5. 64 elements are converged to 1e-5: their difference from 32
/// is 2e-5, and differences fall by 16 or more.
#[test]
fn a_strip_under_a_tip_force_is_the_elastica() {
    let at = |along: usize| {
        elastica(&Strip {
            along,
            thickness: 0.002,
            cylindrical: false,
            ..STRIP
        })
    };
    let (coarse, middle, fine) = (at(16), at(32), at(64));
    for (i, exact) in [0.55500, 0.81061].into_iter().enumerate() {
        assert!((fine[i] - exact).abs() < 3e-5, "{} {exact}", fine[i]);
        let ratio = (coarse[i] - middle[i]) / (middle[i] - fine[i]);
        assert!(ratio > 16.0, "{ratio}");
    }
}

/// Pressure and an end moment on a plate in an arbitrary state: the tangent is the
/// derivative of the forces (central differences of 1e-5; the loads are at most cubic in the step, the moment's
/// third derivative is of the order of the moment: 1e-10, and round-off 1e-11 of the largest force).
#[test]
fn the_tangent_of_loads_is_their_derivative() {
    let element = ThinPlate::new(0.3, 0.2, 0.01, &material(0.3), BendingRigidity::None);
    let mut plate = PlateStructure::rectangle(element, 2, 2);
    plate.pressure(3.0).end_moment(2.0);
    let mut system = plate.build().unwrap();
    let q: Vec<f64> = (plate.drawn().iter().enumerate())
        .map(|(i, x)| x + 0.2 * (7.0 * i as f64).sin())
        .collect();
    let v = vec![0.0; q.len()];
    let mut matrix = BorderedMatrix::new(system.structure());
    let state = State {
        time: 0.0,
        q: &q,
        v: &v,
    };
    system.law.add_tangent(state, 1.0, 0.0, &mut matrix);
    let mut tangent = vec![vec![0.0; q.len()]; q.len()];
    for (row, column, value) in matrix.triplets() {
        tangent[row][column] += value;
    }
    let mut force = |q: &[f64]| {
        let mut force = vec![0.0; q.len()];
        let state = State {
            time: 0.0,
            q,
            v: &v,
        };
        system.law.add_force(state, &mut force);
        force
    };
    let step = 1.0e-5;
    for column in 0..q.len() {
        let moved = |by: f64| {
            let mut q = q.clone();
            q[column] += by;
            q
        };
        let (ahead, behind) = (force(&moved(step)), force(&moved(-step)));
        for row in 0..q.len() {
            let difference = (behind[row] - ahead[row]) / (2.0 * step);
            assert!(
                (difference - tangent[row][column]).abs() < 1e-7,
                "{row} {column}: {difference} {}",
                tangent[row][column]
            );
        }
    }
}

/// A flat plate turned by a quarter about x takes its pressure along: all forces together are the area times
/// the pressure along -y.
#[test]
fn pressure_follows_the_surface() {
    let element = ThinPlate::new(0.3, 0.2, 0.01, &material(0.3), BendingRigidity::None);
    let mut plate = PlateStructure::rectangle(element, 3, 2);
    plate.pressure(5.0);
    let mut system = plate.build().unwrap();
    let turned: Vec<f64> = (plate.drawn().chunks_exact(3))
        .flat_map(|r| [r[0], -r[2], r[1]])
        .collect();
    let rest = vec![0.0; turned.len()];
    let mut force = vec![0.0; turned.len()];
    let (q, v) = (&turned, &rest);
    system.force(State { time: 0.0, q, v }, &mut force);
    let mut sum = [0.0; 3];
    for node in force.chunks_exact(9) {
        (0..3).for_each(|axis| sum[axis] += node[axis]);
    }
    let total = 5.0 * 0.9 * 0.4;
    for (value, expected) in sum.into_iter().zip([0.0, -total, 0.0]) {
        assert!((value - expected).abs() < 1e-12, "{sum:?}");
    }
}

/// What holds nothing and what does not exist is told by node.
#[test]
fn wrong_plates_are_told() {
    let element = || ThinPlate::new(0.5, 0.5, 0.01, &material(0.3), BendingRigidity::Kirchhoff);
    let mut free = PlateStructure::rectangle(element(), 2, 2);
    free.pressure(1.0);
    let text = free.equilibrium().unwrap_err().to_string();
    assert!(text.ends_with("move along x, to move along y, to move along z, to turn about x, to turn about y, to turn about z"), "{text}");
    let mut hinged = PlateStructure::rectangle(element(), 2, 2);
    hinged.pressure(1.0);
    for node in hinged.edge(Edge::Start) {
        for axis in 0..3 {
            hinged.hold(node, NodeVector::Position, axis);
        }
    }
    let text = hinged.equilibrium().unwrap_err().to_string();
    assert!(
        text.contains("turn about y") && !text.contains("along x"),
        "{text}"
    );

    let mut beyond = PlateStructure::rectangle(element(), 2, 2);
    beyond.clamp([Edge::Start]).force([3, 0], [0.0, 0.0, 1.0]);
    assert_eq!(
        beyond.equilibrium().unwrap_err(),
        StructureError::NoPlateNode {
            node: [3, 0],
            last: [2, 2]
        }
    );
}
