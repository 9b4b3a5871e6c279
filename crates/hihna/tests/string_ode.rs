//! The string theory against an independent integration of its two differential equations.
//!
//! In each slip zone the momentum equation and the length of unstretched belt that passes,
//! ```text
//! full:         (k - G v0) dlambda = ±mu (T - G v) dtheta,    ds0 = R/lambda dtheta
//! centrifugal:           k dlambda = ±mu (T - G v) dtheta
//! capstan:               k dlambda = ±mu T dtheta,            T = k (lambda - 1), v = v0 lambda
//! ```
//! are integrated by diffsol's Runge-Kutta 5(4) at tolerance 1e-13, from the speed with which the
//! belt arrives to the end of the slip zone. The stretch there must be that of the next span, and
//! the parts must add up to the belt's unstretched length, both to 1e-10 relative: the integrator's
//! tolerance times some hundred steps, with a decade to spare.

use std::f64::consts::PI;

use diffsol::{DenseMatrix, MatrixCommon, NalgebraMat, OdeBuilder, OdeSolverMethod};
use hihna::steady::string::{
    Answer, Closure, Model, Role, Running, StringDrive, StringPulley, Tightness,
};

const TOLERANCE: f64 = 1.0e-10;

/// Kerkkänen (2006), Model 2 of Table 4.1: 50 N at rest, 2 N m on the driven pulley.
fn model_2(axial_stiffness: f64, model: Model) -> StringDrive {
    let radius = 0.05;
    let pulley = |role| StringPulley {
        radius,
        wrap_angle: PI,
        friction: 0.6,
        role,
        span: PI * radius,
    };
    StringDrive {
        axial_stiffness,
        line_density: 0.02,
        tightness: Tightness::InitialTension(50.0),
        pulleys: vec![
            pulley(Role::SpeedControlled(500.0)),
            pulley(Role::Torque(-2.0)),
        ],
        model,
        closure: Closure::UnstretchedLength,
    }
}

/// Three pulleys and an idler; the torques of two of them pull against one another.
fn four_pulleys(model: Model) -> StringDrive {
    let pulley = |radius, wrap_angle, role, span| StringPulley {
        radius,
        wrap_angle,
        friction: 0.7,
        role,
        span,
    };
    StringDrive {
        axial_stiffness: 3.0e3,
        line_density: 0.15,
        tightness: Tightness::InitialTension(500.0),
        pulleys: vec![
            pulley(0.06, 2.5, Role::Torque(-9.0), 0.4),
            pulley(0.03, 0.8, Role::Torque(0.0), 0.2),
            pulley(0.05, 2.2, Role::SpeedControlled(400.0), 0.3),
            pulley(0.04, 1.9, Role::Torque(2.0), 0.1),
        ],
        model,
        closure: Closure::UnstretchedLength,
    }
}

/// Stretch at the end of the slip zone of pulley `i` and the unstretched length of belt in that zone.
fn slip_zone(drive: &StringDrive, running: &Running, i: usize) -> [f64; 2] {
    let (pulley, state) = (&drive.pulleys[i], &running.pulleys[i]);
    let (k, v0, flow) = (
        drive.axial_stiffness,
        running.unstretched_speed,
        running.mass_flow,
    );
    // A braked pulley raises the tension of the belt that leaves it.
    let grip = -state.torque.signum() * pulley.friction;
    let model = drive.model;
    let slope = move |stretch: f64| {
        let (tension, speed) = (k * (stretch - 1.0), v0 * stretch);
        match model {
            Model::Full => grip * (tension - flow * speed) / (k - flow * v0),
            Model::Centrifugal => grip * (tension - flow * speed) / k,
            Model::Capstan => grip * tension / k,
        }
    };
    let (radius, start) = (pulley.radius, state.speed * pulley.radius / v0);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rhs(move |y: &[f64], _: &[f64], _: f64, dy: &mut [f64]| {
            dy[0] = slope(y[0]);
            dy[1] = radius / y[0];
        })
        .init(
            move |_: &[f64], _: f64, y: &mut [f64]| {
                y[0] = start;
                y[1] = 0.0;
            },
            2,
        )
        .h0(1.0e-3)
        .rtol(1.0e-13)
        .atol([1.0e-13, 1.0e-14])
        .build()
        .unwrap();
    let mut solver = problem.tsit45().unwrap();
    let (states, ..) = solver.solve(state.slip_angle).unwrap();
    let last = states.ncols() - 1;
    [states.get_index(0, last), states.get_index(1, last)]
}

#[test]
fn integration_reproduces_stretch_and_length() {
    for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
        for drive in [
            model_2(200.0, model),
            model_2(25.0e3, model),
            four_pulleys(model),
        ] {
            let Answer::Running(running) = drive.solve().unwrap() else {
                panic!("does not run")
            };
            let mut unstretched = 0.0;
            for (i, pulley) in drive.pulleys.iter().enumerate() {
                let (state, span) = (&running.pulleys[i], &running.spans[i]);
                let mut stretch = state.speed * pulley.radius / running.unstretched_speed;
                unstretched += state.stick_angle * pulley.radius / stretch;
                if state.slip_angle > 0.0 {
                    let [end, length] = slip_zone(&drive, &running, i);
                    stretch = end;
                    unstretched += length;
                }
                let error = (stretch - (1.0 + span.strain)) / stretch;
                assert!(
                    error.abs() < TOLERANCE,
                    "{model:?} pulley {i}: stretch off by {error:e}"
                );
                unstretched += pulley.span / stretch;
            }
            let rest = match drive.tightness {
                Tightness::InitialTension(force) => 1.0 + force / drive.axial_stiffness,
                Tightness::UnstretchedLength(length) => drive.path_length() / length,
            };
            let error = unstretched * rest / drive.path_length() - 1.0;
            assert!(
                error.abs() < TOLERANCE,
                "{model:?}: length off by {error:e}"
            );
        }
    }
}
