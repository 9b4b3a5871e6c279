//! Structures at rest and in steady rotation: forms of constraints, loads, messages, modes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ancf::constraint::{ConstraintError, ConstraintForm};
use ancf::dynamics::Stage;
use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::statics::{Equilibrium, LoadStepError, LoadSteps};
use ancf::structure::{NodeVector, PlanarStructure, RigidBody, RigidMotion, StructureError};

const STEEL: Isotropic = Isotropic {
    youngs_modulus: 2.07e11,
    poisson_ratio: 0.0,
    density: 7850.0,
};
const LENGTH: f64 = 2.0;
const FORMS: [ConstraintForm; 2] = [ConstraintForm::Multipliers, ConstraintForm::Elimination];

fn section() -> PlanarSection {
    PlanarSection::rectangle(0.1, 0.1)
}

fn linear(count: usize) -> LinearBeam2 {
    LinearBeam2::new(LENGTH / count as f64, &section(), &STEEL)
}

fn straight(count: usize, angle: f64) -> PlanarStructure<LinearBeam2> {
    PlanarStructure::straight(linear(count), count, [0.0; 2], angle)
}

fn solve<E: LineElement>(structure: &PlanarStructure<E>) -> Equilibrium {
    structure
        .equilibrium()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A cantilever under 5e5 N from the dissertation's Table 2.3, in one load step and down to round-off: the
/// iteration count is pinned, and the last three corrections show the second order of Newton's method.
#[test]
fn newton_converges_quadratically() {
    let mut beam = straight(64, 0.0);
    beam.clamp(0);
    beam.force(beam.last(), [0.0, -5.0e5]);
    beam.load_steps(LoadSteps {
        steps: 1,
        halvings: 0,
        tolerance: 1e-11,
        max_iterations: 25,
    });
    let bent = solve(&beam);
    assert!(bent.iterations() <= 17, "{:?}", bent.corrections);
    let last: Vec<f64> = bent.corrections[0].iter().rev().take(3).copied().collect();
    let order = (last[0] / last[1]).ln() / (last[1] / last[2]).ln();
    assert!(order > 1.8, "order {order}: {:?}", bent.corrections);
}

/// Supports by multipliers and by elimination: the same equilibrium up to round-off, which the condition
/// of 16 elements (1e5) raises to 1e-11. The same reactions, which balance the load.
#[test]
fn both_forms_give_the_same_equilibrium() {
    for angle in [0.0_f64, 0.7] {
        let [sine, cosine] = [angle.sin(), angle.cos()];
        let [one, two] = FORMS.map(|form| {
            let mut beam = straight(16, angle);
            beam.pin(0)
                .roller(16, [-sine, cosine])
                .constraint_form(form);
            beam.force(5, [2.0e5 * sine, -2.0e5 * cosine])
                .moment(9, 3.0e4);
            let bent = solve(&beam);
            let ends = [0, 16].map(|node| beam.reaction(&bent, node));
            (bent, ends)
        });
        let nodes = 17 * 4;
        for (a, b) in one.0.q[..nodes].iter().zip(&two.0.q[..nodes]) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        let sum = [0, 1].map(|axis| one.1[0][axis] + one.1[1][axis]);
        assert!((sum[0] + 2.0e5 * sine).abs() < 1e-3 && (sum[1] - 2.0e5 * cosine).abs() < 1e-3);
        for (a, b) in one.1.iter().flatten().zip(two.1.iter().flatten()) {
            assert!((a - b).abs() < 1e-3, "reactions {a} {b}");
        }
    }
}

/// A tip moment M bends a slender cantilever to a circle, and the tip's fibre turns by M L / E I, in the
/// linear beam by `n 2 tan(M L / 2 n E I)` to leading order: both within 2 % with 32 elements at a quarter turn,
/// and the moment's work-conjugate angle follows the drawn direction.
#[test]
fn a_moment_bends_to_a_circle() {
    let section = PlanarSection::rectangle(0.1, 0.02);
    let stiffness = STEEL.youngs_modulus * section.second_moment;
    let moment = stiffness * FRAC_PI_2 / LENGTH;
    for angle in [0.0_f64, 2.0] {
        let element = CubicBeam2::new(LENGTH / 16.0, &section, &STEEL);
        let mut beam = PlanarStructure::straight(element, 16, [0.0; 2], angle);
        beam.clamp(0).moment(16, moment);
        let bent = solve(&beam);
        let fibre = beam.vector(&bent.q, 16, NodeVector::Across);
        let turned = fibre[1].atan2(fibre[0]) - angle - FRAC_PI_2;
        let turned = (turned + PI).rem_euclid(TAU) - PI;
        assert!((turned - FRAC_PI_2).abs() < 0.02 * FRAC_PI_2, "{turned}");
        let [x, y] = beam.position(&bent.q, 16);
        let radius = LENGTH / FRAC_PI_2;
        let local = [
            angle.cos() * x + angle.sin() * y,
            angle.cos() * y - angle.sin() * x,
        ];
        for value in local {
            assert!((value / radius - 1.0).abs() < 0.02, "{local:?}");
        }
    }
}

/// Gravity along the beam and a line load across it: reactions are the weight and the load, to round-off.
#[test]
fn distributed_loads_are_carried_whole() {
    let mut beam = straight(7, 0.3);
    beam.clamp(0).gravity([1.0, -9.81]).line_load([100.0, 50.0]);
    let bent = solve(&beam);
    let mass = STEEL.density * 0.01 * LENGTH;
    let [x, y] = beam.reaction(&bent, 0);
    assert!((x + mass + 100.0 * LENGTH).abs() < 1e-6 * mass, "{x}");
    assert!((y - mass * 9.81 + 50.0 * LENGTH).abs() < 1e-6 * mass, "{y}");
}

/// A rigid body at the tip carries the load as the tip itself would; fastened to it off its centre, its
/// weight bends the beam by the moment too. Both against the beam with force and moment on its tip node, whose
/// moment is that of the weight about the turned tip.
#[test]
fn a_body_on_the_tip_loads_the_beam() {
    let arm = 0.3;
    let mut beam = straight(8, 0.0);
    beam.clamp(0);
    let body = beam.body(RigidBody {
        name: "weight".to_owned(),
        mass: 1.0e4,
        inertia: 50.0,
        place: [LENGTH + arm, 0.0],
        angle: 0.4,
    });
    beam.fasten(8, body).body_load(body, [0.0, -1.0e5], 0.0);
    let loaded = solve(&beam);
    let fibre = beam.vector(&loaded.q, 8, NodeVector::Across);
    // The body turns with the fibre: its centre lies at the fibre's right.
    let mut alone = straight(8, 0.0);
    alone
        .clamp(0)
        .force(8, [0.0, -1.0e5])
        .moment(8, -1.0e5 * arm * fibre[1]);
    let bent = solve(&alone);
    let (with, without) = (beam.position(&loaded.q, 8), alone.position(&bent.q, 8));
    // The fastened fibre cannot stretch, the free one does by strains of 1e-5.
    for axis in 0..2 {
        assert!(
            (with[axis] - without[axis]).abs() < 1e-5,
            "{with:?} {without:?}"
        );
    }
}

/// A ring of `count` curved elements without stress and of square section, its nodes evenly on a circle.
fn ring(count: usize, radius: f64, height: f64) -> PlanarStructure<CubicBeam2> {
    let section = PlanarSection::rectangle(height, height);
    let place = |i: usize| {
        let (sine, cosine) = (TAU * (i % count) as f64 / count as f64).sin_cos();
        [
            radius * cosine,
            radius * sine,
            -sine,
            cosine,
            -cosine,
            -sine,
        ]
    };
    let coordinates: Vec<f64> = (0..=count).flat_map(place).collect();
    let arc = TAU * radius / count as f64;
    let elements: Vec<CubicBeam2> = (0..count)
        .map(|i| {
            let ends = [place(i), place(i + 1)].concat();
            let ends = ends.try_into().expect("two nodes of six coordinates");
            CubicBeam2::curved(&ends, arc, &section, &STEEL).expect("it is thin")
        })
        .collect();
    let mut ring = PlanarStructure::with_nodes(elements, coordinates);
    ring.join_ends();
    ring
}

/// A ring pulled apart by two opposite forces widens by `F R³/(E I) [pi/4 (1 - a + b) - 2/pi (1 - a)²]`,
/// `a = I/(A R²)`, `b = E I/(G A R²)` (Timoshenko; no shear correction in this element), up to `(h/R)²` of a
/// straight beam's law. Fully integrated curved elements are far too stiff in membrane and shear while
/// `l² > R h`, here up to 25 elements, and lose the error fast from there on: by more than 2² per halving.
#[test]
fn a_ring_of_curved_elements_tends_to_the_ring_formula() {
    let (radius, height, force) = (0.5, 0.02, 1.0e-3);
    let widening = |count: usize| {
        let mut ring = ring(count, radius, height);
        ring.pin(0).roller(count / 2, [0.0, 1.0]);
        ring.force(count / 2, [force, 0.0]);
        ring.position(&solve(&ring).q, count / 2)[0] + radius
    };
    let stiffness = STEEL.youngs_modulus * height.powi(4) / 12.0;
    let a = (height / radius).powi(2) / 12.0;
    let b = a * STEEL.youngs_modulus / STEEL.shear_modulus();
    let factor = PI / 4.0 * (1.0 - a + b) - 2.0 / PI * (1.0 - a).powi(2);
    let exact = force * radius.powi(3) / stiffness * factor;
    let errors = [32, 64, 128].map(|count| (widening(count) / exact - 1.0).abs());
    assert!(errors[2] < (height / radius).powi(2), "{errors:?}");
    assert!(
        errors[0] > 4.0 * errors[1] && errors[1] > 4.0 * errors[2],
        "{errors:?}"
    );
    assert!(
        widening(8) < 0.1 * exact,
        "it locks as long as l² is far beyond R h"
    );
}

/// A ring of 24 curved elements, clamped at the first node and pulled at the opposite one: the joint as a
/// shared node and by multipliers give the same shape.
#[test]
fn the_joint_of_a_ring_may_be_shared_or_held_by_multipliers() {
    let (count, radius) = (24, 0.5);
    let shapes = FORMS.map(|form| {
        let mut ring = ring(count, radius, 0.02);
        ring.clamp(0).constraint_form(form);
        ring.force(count / 2, [-2000.0, 500.0]);
        let bent = solve(&ring);
        (0..=count)
            .map(|node| ring.position(&bent.q, node))
            .collect::<Vec<_>>()
    });
    for (a, b) in shapes[0].iter().flatten().zip(shapes[1].iter().flatten()) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!(
        (shapes[0][count / 2][0] + radius).abs() > 1e-3,
        "it deforms: {:?}",
        shapes[0][count / 2]
    );
}

#[test]
fn an_unsupported_structure_names_its_free_motion() {
    let motions = |beam: &PlanarStructure<LinearBeam2>| match beam.equilibrium() {
        Err(StructureError::Unsupported { motions }) => motions
            .into_iter()
            .flat_map(|motion| motion.parts)
            .map(|(_, motion)| motion)
            .collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let mut free = straight(4, 0.0);
    free.force(4, [0.0, -1.0]);
    assert_eq!(motions(&free).len(), 3);

    let mut pinned = straight(4, 0.0);
    pinned.pin(2).force(4, [0.0, -1.0]);
    assert_eq!(motions(&pinned), [RigidMotion::Rotation([1.0, 0.0])]);

    let mut sliding = straight(4, 0.0);
    sliding
        .roller(0, [0.0, 1.0])
        .roller(4, [0.0, 1.0])
        .force(4, [1.0, 0.0]);
    assert_eq!(motions(&sliding), [RigidMotion::Translation([1.0, 0.0])]);
    let text = sliding.equilibrium().expect_err("it slides").to_string();
    assert!(text.contains("free to translate along x"), "{text}");
}

#[test]
fn supports_that_contradict_name_themselves() {
    let mut beam = straight(4, 0.0);
    beam.clamp(0).pin(0).force(4, [0.0, -1.0]);
    let error = beam.equilibrium().expect_err("held twice");
    let names = vec!["clamp of node 0".to_owned(), "pin of node 0".to_owned()];
    assert_eq!(
        error,
        StructureError::Constraint(ConstraintError::Repetition { names })
    );
}

#[test]
fn a_load_step_that_fails_reports_the_last_converged_load() {
    let mut beam = straight(16, 0.0);
    beam.clamp(0).force(16, [0.0, -1.0e8]);
    beam.load_steps(LoadSteps {
        steps: 4,
        halvings: 0,
        tolerance: 1e-9,
        max_iterations: 4,
    });
    match beam.equilibrium() {
        Err(StructureError::LoadStep(LoadStepError::NotConverged {
            tried,
            converged,
            history,
        })) => {
            assert!(
                (tried - converged - 0.25).abs() < 1e-12,
                "{converged} {tried}"
            );
            assert!(!history.is_empty() && history.len() <= 4);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_node_that_is_not_there_is_named() {
    let mut beam = straight(4, 0.0);
    beam.pin(5);
    assert_eq!(
        beam.equilibrium().expect_err("no node 5"),
        StructureError::NoNode { node: 5, last: 4 }
    );
}

/// Free in the plane: three eigenvalues omega² that are rounding errors of the largest (1e12 1/s²), the
/// fourth is the first bending mode's, some 1e5 1/s². Drawn at any angle.
#[test]
fn a_free_beam_has_three_zero_frequencies() {
    for angle in [0.0, 0.5] {
        let beam = straight(8, angle);
        let rest = Equilibrium {
            q: beam.drawn(),
            multipliers: vec![0.0; 36],
            reactions: vec![0.0; 36],
            corrections: Vec::new(),
        };
        let modes = beam.modes(&rest).expect("it has modes");
        let rates: Vec<f64> = modes
            .iter()
            .map(|mode| mode.frequency.hypot(mode.growth))
            .collect();
        let mut sorted = rates.clone();
        sorted.sort_by(f64::total_cmp);
        assert!(sorted[2] < 0.1 && sorted[3] > 500.0, "{:?}", &sorted[..5]);
    }
}

/// A rigid body hung on a held node is a physical pendulum, `w² = m g a / (I + m a²)`. All of its stiffness is
/// the multipliers' own tangent. The eigenvalue carries rounding errors of the largest: 1e-16 of 1e12 1/s².
#[test]
fn a_hanging_body_swings_as_a_physical_pendulum() {
    let (mass, inertia, arm, gravity) = (3.0, 0.5, 0.8, 9.81);
    let mut beam = straight(2, 0.0);
    let body = beam.body(RigidBody {
        name: "pendulum".to_owned(),
        mass,
        inertia,
        place: [0.0, -arm],
        angle: 0.7,
    });
    beam.clamp(0)
        .hinge(0, body)
        .body_load(body, [0.0, -mass * gravity], 0.0);
    let mut system = beam.build().expect("it is sound");
    let mut motion = beam.at_rest(&system);
    // At rest in equilibrium the accelerations vanish, and their multipliers are those of statics.
    Stage::new(&system, 1e-9).accelerations(&mut system, &mut motion);
    let rest = Equilibrium {
        reactions: vec![0.0; motion.q.len()],
        q: motion.q,
        multipliers: motion.a,
        corrections: Vec::new(),
    };
    let modes = beam.modes(&rest).expect("it has modes");
    let expected = (mass * gravity * arm / (inertia + mass * arm * arm)).sqrt();
    let found = modes[0].frequency;
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
}

/// Circular frequency of a simply supported Timoshenko beam in its `n`-th mode:
///
/// ```text
/// (rho I rho A / ks G A) w⁴ - (rho A + k² (rho I + rho A E I / ks G A)) w² + E I k⁴ = 0    k = n pi / L
/// ```
fn timoshenko(n: f64) -> f64 {
    let section = section();
    let bending = STEEL.youngs_modulus * section.second_moment;
    let shear = 5.0 / 6.0 * STEEL.shear_modulus() * section.area;
    let (line, rotary) = (
        STEEL.density * section.area,
        STEEL.density * section.second_moment,
    );
    let k2 = (n * PI / LENGTH).powi(2);
    let (a, b, c) = (
        rotary * line / shear,
        line + k2 * (rotary + line * bending / shear),
        bending * k2 * k2,
    );
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
}

/// The linear beam's bending modes are those of a Timoshenko beam: second order in the element length,
/// and extrapolation from 16 and 32 elements by that order leaves the fourth: (k l)⁴/100, 1e-6 for
/// the first mode and 1e-4 for the third.
#[test]
fn bending_frequencies_are_timoshenkos() {
    let bending = |count: usize| -> Vec<f64> {
        let mut beam = straight(count, 0.0);
        beam.pin(0).roller(count, [0.0, 1.0]);
        let modes = beam.modes(&solve(&beam)).expect("it has modes");
        // Modes across the beam; the others stretch it.
        (modes.iter())
            .filter(|mode| {
                let across: f64 = mode
                    .shape
                    .chunks_exact(4)
                    .map(|node| node[1][0].powi(2))
                    .sum();
                let along: f64 = mode
                    .shape
                    .chunks_exact(4)
                    .map(|node| node[0][0].powi(2))
                    .sum();
                across > along
            })
            .map(|mode| mode.frequency)
            .collect()
    };
    let (coarse, fine) = (bending(16), bending(32));
    for (n, tolerance) in [(1, 1e-5), (2, 1e-4), (3, 1e-3)] {
        let exact = timoshenko(n as f64);
        let errors = [coarse[n - 1], fine[n - 1]].map(|w| w / exact - 1.0);
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "mode {n}: {errors:?}");
        let extrapolated = (4.0 * errors[1] - errors[0]) / 3.0;
        assert!(extrapolated.abs() < tolerance, "mode {n}: {extrapolated}");
    }
}

/// The spin-up beam (8 m, slender) turning steadily about its root: its extension is
/// `L (tan(aL)/(aL) - 1)`, a = Omega sqrt(rho/E) (Kerkkänen 2006, 2.36). Green-Lagrange strain and linear
/// elements differ from that by parts of the order of the strain (1e-5) and of `(a L / n)²/12` of it.
#[test]
fn steady_rotation_stretches_as_theory_says() {
    let (length, speed) = (8.0_f64, 4.0_f64);
    let aluminium = Isotropic {
        youngs_modulus: 6.895e10,
        poisson_ratio: 0.0,
        density: 2766.67,
    };
    let section = PlanarSection::rectangle(1.986e-3, 3.675e-2);
    let element = LinearBeam2::new(length / 3.0, &section, &aluminium);
    let mut beam = PlanarStructure::straight(element, 3, [0.0; 2], 0.0);
    beam.clamp(0).rotating_frame(speed);
    let extension = beam.position(&solve(&beam).q, 3)[0] - length;
    let reach = speed * (aluminium.density / aluminium.youngs_modulus).sqrt() * length;
    let theory = length * (reach.tan() / reach - 1.0);
    assert!((theory - 1.09572e-4).abs() < 5e-10, "{theory}");
    assert!(
        (extension / theory - 1.0).abs() < 5e-5,
        "{extension} {theory}"
    );
}

/// In-plane modes of a cantilever rotating about its root. Out of the plane the first frequency is 4.1373
/// at Omega = 2 in units of sqrt(E I / rho A L⁴) (Hodges & Rutkowski 1981), in the plane its square is
/// less by Omega²: 3.6218. n = 32 linear elements err by about 1/n² in the bending stiffness, shear and
/// rotary inertia by (h/L)² = 1e-4 times a number of order one: below 1e-3 together.
#[test]
fn a_rotating_cantilever_stiffens() {
    let section = PlanarSection::rectangle(0.1, 0.02);
    let count = 32;
    let element = LinearBeam2::new(LENGTH / count as f64, &section, &STEEL);
    let unit = (STEEL.youngs_modulus * section.second_moment
        / (STEEL.density * section.area * LENGTH.powi(4)))
    .sqrt();
    let mut beam = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    beam.clamp(0).rotating_frame(2.0 * unit);
    let modes = beam.modes(&solve(&beam)).expect("it has modes");
    let first = modes[0].frequency / unit;
    let expected = (4.1373_f64.powi(2) - 4.0).sqrt();
    assert!((first / expected - 1.0).abs() < 1e-3, "{first} {expected}");
    // Conservative: no exponent grows beyond rounding errors of the largest.
    let largest = modes[modes.len() - 1].frequency;
    assert!(modes.iter().all(|mode| mode.growth.abs() < 1e-9 * largest));
}
