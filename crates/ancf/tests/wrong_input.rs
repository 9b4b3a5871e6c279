//! What cannot be is refused by name, before anything is computed.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use ancf::constraint::{Constant, ConstraintForm};
use ancf::dynamics::{Control, IntegrationError, Method, Motion, integrate};
use ancf::element::{BeltBeam2, CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::{Coordinate, NodeVector, PlanarStructure, RigidBody, StructureError};

const STEEL: Isotropic = Isotropic {
    youngs_modulus: 2.07e11,
    poisson_ratio: 0.3,
    density: 7850.0,
};

fn section() -> PlanarSection {
    PlanarSection::rectangle(0.1, 0.1)
}

fn cantilever<E: LineElement>(element: E) -> PlanarStructure<E> {
    let mut beam = PlanarStructure::straight(element, 4, [0.0; 2], 0.0);
    beam.clamp(0).force(4, [0.0, -1000.0]);
    beam
}

fn beam() -> PlanarStructure<LinearBeam2> {
    cantilever(LinearBeam2::new(0.5, &section(), &STEEL))
}

fn refusal<E: LineElement>(element: E) -> String {
    match cantilever(element).equilibrium() {
        Err(error @ StructureError::Value { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

/// No body resists with negative energy or has negative mass: E, rho > 0, -1 < nu <= 1/2, and in plane strain
/// nu < 1/2.
#[test]
fn materials_that_cannot_be() {
    let of = |youngs_modulus: f64, poisson_ratio: f64, density: f64| Isotropic {
        youngs_modulus,
        poisson_ratio,
        density,
    };
    for (material, name) in [
        (of(0.0, 0.3, 1.0), "Young's modulus"),
        (of(f64::NAN, 0.3, 1.0), "Young's modulus"),
        (of(1.0, 0.51, 1.0), "Poisson's ratio"),
        (of(1.0, -1.0, 1.0), "Poisson's ratio"),
        (of(1.0, f64::NAN, 1.0), "Poisson's ratio"),
        (of(1.0, 0.3, 0.0), "density"),
        (of(1.0, 0.3, -7850.0), "density"),
    ] {
        for text in [
            refusal(LinearBeam2::new(0.5, &section(), &material)),
            refusal(CubicBeam2::new(0.5, &section(), &material)),
            refusal(BeltBeam2::new(0.5, &section(), &material, 1.0, 1.0, 0.0)),
        ] {
            assert!(text.contains(name), "{material:?}: {text}");
        }
    }
    let incompressible = of(2.07e11, 0.5, 7850.0);
    let text = refusal(CubicBeam2::new(0.5, &section(), &incompressible));
    assert!(text.contains("below 0.5 in plane strain"), "{text}");
    // A beam whose thickness follows no law of volume may be of rubber.
    let rubber = cantilever(LinearBeam2::new(0.5, &section(), &incompressible));
    assert!(rubber.equilibrium().is_ok());
}

/// Moments are positive and keep the inequality of Cauchy and Schwarz, sharp for two flanges at ±y.
#[test]
fn sections_and_lengths_that_cannot_be() {
    let of = |area: f64, second_moment: f64, fourth_moment: f64| PlanarSection {
        area,
        second_moment,
        fourth_moment,
    };
    for (section, name) in [
        (PlanarSection::tube(0.05, 0.06), "area"),
        (PlanarSection::rectangle(f64::NAN, 0.1), "area"),
        (PlanarSection::rectangle(0.1, 0.0), "area"),
        (of(0.01, -8e-6, 1e-8), "second moment"),
        (of(0.01, 8e-6, -1e-8), "fourth moment"),
        (of(0.01, 8e-6, 6e-9), "fourth moment"),
        (of(0.01, 8e-6, f64::INFINITY), "fourth moment"),
    ] {
        for text in [
            refusal(LinearBeam2::new(0.5, &section, &STEEL)),
            refusal(CubicBeam2::new(0.5, &section, &STEEL)),
        ] {
            assert!(text.contains(name), "{section:?}: {text}");
        }
    }
    for length in [0.0, -0.5, f64::NAN, f64::INFINITY] {
        let text = refusal(LinearBeam2::new(length, &section(), &STEEL));
        assert!(text.contains("length"), "{text}");
    }
    for (factors, name) in [
        ([0.0, 1.0, 0.0], "axial factor"),
        ([1.0, -1.0, 0.0], "bending factor"),
        ([1.0, 1.0, -1e-3], "damping time"),
    ] {
        let [axial, bending, damping] = factors;
        let text = refusal(BeltBeam2::new(
            0.5,
            &section(),
            &STEEL,
            axial,
            bending,
            damping,
        ));
        assert!(text.contains(name), "{text}");
    }
    let flanges = of(0.01, 0.01 * 0.05_f64.powi(2), 0.01 * 0.05_f64.powi(4));
    let annulus = of(PI * 2e-3, PI * 1e-6, PI * 7.5e-10);
    for section in [flanges, annulus] {
        section.check().expect("it is an area");
    }
}

/// Numbers of nodes, bodies and components are checked, not bent to the nearest that is there.
#[test]
fn what_is_not_there_is_named() {
    let error = |structure: &PlanarStructure<LinearBeam2>| {
        structure
            .equilibrium()
            .expect_err("it is not there")
            .to_string()
    };
    let place = |axis: usize| Coordinate::Node {
        node: 4,
        vector: NodeVector::Position,
        axis,
    };
    let mut sideways = beam();
    sideways.prescribe(place(2), Arc::new(Constant(0.0)));
    assert!(error(&sideways).contains("no component 2 of a vector"));
    let mut turned = beam();
    let body = turned.body(RigidBody {
        name: "weight".to_owned(),
        mass: 1.0,
        inertia: 1.0,
        place: [2.0, 0.0],
        angle: 0.0,
    });
    turned.fasten(4, body);
    turned.prescribe(Coordinate::Body { body, index: 3 }, Arc::new(Constant(0.0)));
    assert!(error(&turned).contains("no component 3 of a rigid body"));
    for count in [0, 1] {
        let none = PlanarStructure::straight(
            LinearBeam2::new(0.5, &section(), &STEEL),
            count,
            [0.0; 2],
            0.0,
        );
        assert_eq!(
            none.build().err() == Some(StructureError::NoElements),
            count == 0
        );
    }
    let mut moved = beam();
    moved.prescribe(place(1), Arc::new(Constant(f64::NAN)));
    let text = error(&moved);
    assert!(text.contains("prescribed motion of y of node 4"), "{text}");
}

/// States and equilibria of other structures are refused; where all is held, there is no mode.
#[test]
fn states_of_other_structures_are_refused() {
    let beam = beam();
    let bent = beam.equilibrium().expect("it is clamped");
    let mut shorter =
        PlanarStructure::straight(LinearBeam2::new(0.5, &section(), &STEEL), 2, [0.0; 2], 0.0);
    shorter.clamp(0);
    let mut eliminated = beam.clone();
    eliminated.constraint_form(ConstraintForm::Elimination);
    for other in [&shorter, &eliminated] {
        let error = other.modes(&bent).expect_err("it is of another structure");
        assert!(matches!(error, StructureError::Foreign { .. }), "{error}");
    }
    let mut broken = bent.clone();
    broken.q[5] = f64::NAN;
    assert!(matches!(
        beam.modes(&broken),
        Err(StructureError::Value { .. })
    ));

    let system = shorter.build().expect("it is sound");
    let (short, long) = (shorter.drawn(), beam.drawn());
    let mut still = vec![0.0; short.len()];
    for (q, v) in [(&long, &still), (&short, &long), (&vec![0.0], &still)] {
        let error = shorter.start(&system, q, v).expect_err("lengths differ");
        assert!(matches!(error, StructureError::Foreign { .. }), "{error}");
    }
    assert!(shorter.start(&system, &short, &still).is_ok());
    still[7] = f64::NAN;
    assert!(shorter.start(&system, &short, &still).is_err());

    let mut held = shorter.clone();
    held.clamp(1).clamp(2);
    let rest = held.equilibrium().expect("nothing moves");
    assert_eq!(held.modes(&rest), Ok(Vec::new()));
}

/// Steps that no run can be made of.
#[test]
fn controls_that_choose_no_steps_are_refused() {
    let mut pendulum =
        PlanarStructure::straight(LinearBeam2::new(0.5, &section(), &STEEL), 2, [0.0; 2], 0.0);
    pendulum.pin(0).gravity([0.0, -9.81]);
    let mut system = pendulum.build().expect("it is sound");
    let start = pendulum.at_rest(&system);
    let usual = Control::fixed(Method::Auto, 1e-3);
    let step = |step: f64| Control {
        step,
        ..usual.clone()
    };
    let newton = |newton_tolerance: f64| Control {
        newton_tolerance,
        ..usual.clone()
    };
    let error = |tolerance: f64| Control {
        error_tolerance: Some(tolerance),
        ..usual.clone()
    };
    for (control, end, name) in [
        (step(0.0), 0.01, "the step"),
        (step(-1e-3), 0.01, "the step"),
        (step(f64::NAN), 0.01, "the step"),
        (step(1e-20), 0.01, "fewer than 1e11 steps"),
        (newton(0.0), 0.01, "Newton"),
        (newton(f64::NAN), 0.01, "Newton"),
        (error(0.0), 0.01, "error tolerance"),
        (usual.clone(), -1.0, "the end"),
        (usual.clone(), f64::NAN, "the end"),
        (usual.clone(), f64::INFINITY, "the end"),
    ] {
        let mut motion = start.clone();
        let done = integrate(&mut system, &mut motion, end, &control, |_, _| {
            ControlFlow::Continue(())
        });
        let text = done.expect_err(name).to_string();
        assert!(text.contains(name), "{text}");
        assert_eq!(motion.q, start.q);
    }
    let mut other = Motion::zero(3);
    let done = integrate(&mut system, &mut other, 0.01, &usual, |_, _| {
        ControlFlow::Continue(())
    });
    assert_eq!(
        done,
        Err(IntegrationError::Size {
            given: 3,
            wanted: 14
        })
    );
    // No time, no step.
    let mut motion = start.clone();
    let done = integrate(&mut system, &mut motion, 0.0, &usual, |_, _| {
        ControlFlow::Continue(())
    });
    assert_eq!(done.expect("it ends at once").steps, 0);
}
