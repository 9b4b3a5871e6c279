//! Constraints alone: derivatives against differences, elimination, and messages.
//!
//! A chain of three nodes with four coordinates each, and two rigid bodies; no mechanics.

use std::sync::Arc;

use ancf::constraint::{
    BodyAttachment, Constant, ConstraintError, ConstraintForm, ConstraintSet, LinearEquation,
    SpinUp, TurnedComponent,
};
use ancf::linear::{BorderedMatrix, CyclicSolver, Solver, Structure};
use ancf::system::{Motion, State};

const COORDINATES: Structure = Structure {
    sections: 3,
    block: 4,
    closed: false,
    border: 6,
};
const BODY: usize = 12;

fn equation(name: &str, terms: &[(usize, f64)], value: f64) -> LinearEquation {
    LinearEquation {
        name: name.to_owned(),
        terms: terms.to_vec(),
        value: Arc::new(Constant(value)),
    }
}

fn attachment(name: &str, vector: usize, body: usize, is_place: bool) -> BodyAttachment {
    BodyAttachment {
        name: name.to_owned(),
        vector,
        body,
        arm: [0.3, -0.2],
        is_place,
    }
}

fn set(
    equations: Vec<LinearEquation>,
    attachments: Vec<BodyAttachment>,
    form: ConstraintForm,
) -> Result<ConstraintSet, ConstraintError> {
    ConstraintSet::new(COORDINATES, &[], equations, attachments, form)
}

/// Some numbers without pattern, between -1 and 1.
fn numbers(count: usize, seed: usize) -> Vec<f64> {
    (0..count)
        .map(|i| ((7 * i + 3 * seed + 1) as f64).sin())
        .collect()
}

fn differs(value: f64, expected: f64, tolerance: f64) -> bool {
    (value - expected).abs() > tolerance || value.is_nan()
}

/// Rate and acceleration are derivatives of the value: central differences with step h err by
/// `h² f'''/6` (1e-8 times third derivatives below 10) and `1e-16/h` of round-off.
#[test]
fn prescribed_motions_are_consistent() {
    let spin_up = SpinUp {
        speed: 4.0,
        rise_time: 1.5,
    };
    let turned = TurnedComponent {
        angle: Arc::new(spin_up),
        vector: [0.3, -1.2],
        axis: 1,
    };
    let motions: [&dyn Motion; 2] = [&spin_up, &turned];
    for motion in motions {
        for time in [0.1, 0.7, 1.4, 1.6, 2.5] {
            let h = 1.0e-4;
            let (before, now, after) = (motion.at(time - h), motion.at(time), motion.at(time + h));
            for k in 0..2 {
                let slope = (after[k] - before[k]) / (2.0 * h);
                assert!(
                    !differs(now[k + 1], slope, 1.0e-5),
                    "{motion:?} at {time}: {now:?} {slope}"
                );
            }
        }
    }
    // Continuous where the rise ends: theta = w T/2, theta' = w.
    let [before, after] = [1.5 - 1e-12, 1.5].map(|time| spin_up.at(time));
    for (a, b) in before.iter().zip(after) {
        assert!(!differs(*a, b, 1e-10));
    }
}

/// Whatever the coordinates were, they keep all constraints afterwards, at the levels of position,
/// velocity and acceleration; to a few roundings of numbers of order one.
#[test]
fn enforced_coordinates_keep_every_constraint() {
    for form in [ConstraintForm::Multipliers, ConstraintForm::Elimination] {
        let moved = LinearEquation {
            name: "moved".to_owned(),
            terms: vec![(0, 0.6), (1, 0.8)],
            value: Arc::new(SpinUp {
                speed: 2.0,
                rise_time: 1.0,
            }),
        };
        let mut equations = vec![
            moved,
            equation("second direction", &[(0, -0.8), (1, 0.6)], 0.4),
        ];
        let mut attachments = Vec::new();
        if form == ConstraintForm::Multipliers {
            // a joint of the end nodes, the first of which is held
            for i in 0..4 {
                equations.push(equation("joint", &[(8 + i, 1.0), (i, -1.0)], 0.0));
            }
            // the second body hangs on a node that the first body carries
            attachments.push(attachment("carried", 4, BODY, true));
            attachments.push(attachment("turned", 6, BODY, false));
            attachments.push(attachment("hanging", 4, BODY + 3, true));
        } else {
            equations.push(equation("tie to a body", &[(4, 1.0), (BODY, -2.0)], 0.1));
            equations.push(equation(
                "bodies",
                &[(BODY + 1, 1.0), (BODY + 4, -1.0)],
                0.3,
            ));
        }
        let set = set(equations, attachments, form).expect("they are compatible");
        let size = COORDINATES.size() + set.multipliers();
        let (mut q, mut v, mut a) = (numbers(size, 1), numbers(size, 2), numbers(size, 3));
        let time = 0.37;
        set.enforce(time, &mut q, &mut v, &mut a);
        let state = State { time, q: &q, v: &v };
        for (amount, name) in set.violation(state) {
            assert!(amount < 1e-14, "{form:?}: {name} {amount}");
        }
        // C_q a = Q_d
        if form == ConstraintForm::Multipliers {
            let mut right = vec![0.0; size];
            set.complete_force(state, &mut right);
            for (row, expected) in set.jacobian(&q).iter().zip(&right[COORDINATES.size()..]) {
                let sum: f64 = row.iter().map(|(i, c)| c * a[*i]).sum();
                assert!(!differs(sum, *expected, 1e-14), "{sum} {expected}");
            }
        }
    }
}

/// The matrix of the multiplier form is the derivative of its residual: central differences of
/// functions of order one, step 1e-5, err below 1e-9.
#[test]
fn multipliers_have_their_tangent() {
    let set = set(
        vec![equation("slanted", &[(0, 0.6), (1, 0.8)], 0.0)],
        vec![
            attachment("place", 4, BODY, true),
            attachment("slope", 6, BODY, false),
        ],
        ConstraintForm::Multipliers,
    )
    .expect("they are compatible");
    let border = COORDINATES.border + set.multipliers();
    let structure = Structure {
        border,
        ..COORDINATES
    };
    let size = structure.size();
    let first = COORDINATES.size();
    let (q, lambda) = (numbers(size, 4), numbers(size, 5));
    let mut matrix = BorderedMatrix::new(structure);
    set.complete_matrix(&q, &lambda, 1.0, &mut matrix);
    let residual = |q: &[f64], lambda: &[f64]| {
        let mut residual = vec![0.0; size];
        set.complete_residual(q, lambda, &mut residual);
        residual
    };
    let h = 1.0e-5;
    for column in 0..size {
        let shifted = |step: f64| {
            let (mut q, mut lambda) = (q.clone(), lambda.clone());
            let target = if column < first { &mut q } else { &mut lambda };
            target[column] += step;
            residual(&q, &lambda)
        };
        let (plus, minus) = (shifted(h), shifted(-h));
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        let mut product = vec![0.0; size];
        matrix.multiply(&unit, &mut product);
        for row in 0..first {
            let slope = (plus[row] - minus[row]) / (2.0 * h);
            assert!(
                !differs(product[row], slope, 1e-9),
                "({row}, {column}): {slope}"
            );
        }
    }
    // The rows of the constraints are the transposed columns of the multipliers.
    for (row, column, value) in matrix.triplets() {
        let mut unit = vec![0.0; size];
        unit[row] = 1.0;
        let mut product = vec![0.0; size];
        matrix.multiply(&unit, &mut product);
        assert!(!differs(product[column], value, 0.0));
    }
}

/// Both forms solve the same equations: corrections of an arbitrary matrix (diagonal 50 against rows of
/// entries below 1) agree to a few roundings. An inclined line within a node, a node tied to a body, and a
/// body tied to the other.
#[test]
fn both_forms_solve_the_same_equations() {
    let solutions = [ConstraintForm::Multipliers, ConstraintForm::Elimination].map(|form| {
        let equations = vec![
            equation("line", &[(0, 0.6), (1, 0.8)], 0.0),
            equation("tie", &[(5, 1.0), (BODY, -2.0), (BODY + 2, 0.3)], 0.0),
            equation("bodies", &[(BODY + 1, 1.0), (BODY + 4, -1.0)], 0.0),
        ];
        let set = set(equations, Vec::new(), form).expect("they are compatible");
        let border = COORDINATES.border + set.multipliers();
        let structure = Structure {
            border,
            ..COORDINATES
        };
        let mut matrix = BorderedMatrix::new(structure);
        let values = numbers(structure.size() * structure.size(), 6);
        for row in 0..COORDINATES.size() {
            for column in 0..COORDINATES.size() {
                let far = row.max(column) < 12 && (row / 4).abs_diff(column / 4) > 1;
                if !far {
                    matrix.add(row, column, values[18 * row + column]);
                }
            }
            matrix.add(row, row, 50.0);
        }
        let q = vec![0.0; structure.size()];
        let mut right = numbers(structure.size(), 7);
        right[COORDINATES.size()..].fill(0.0);
        set.complete_matrix(&q, &q, 1.0, &mut matrix);
        set.complete_residual(&q, &q, &mut right);
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&matrix).expect("it is regular");
        solver.solve(&mut right);
        right
    });
    for i in 0..COORDINATES.size() {
        assert!(
            !differs(solutions[0][i], solutions[1][i], 1e-14),
            "coordinate {i}"
        );
    }
    assert!(differs(solutions[0][5], 0.0, 1e-6));
}

#[test]
fn contradictions_name_themselves() {
    let twice = vec![
        equation("pin of node 0", &[(1, 1.0)], 0.0),
        equation("roller of node 0", &[(1, 1.0)], 0.1),
    ];
    let error = set(twice, Vec::new(), ConstraintForm::Multipliers).expect_err("y is 0 and 0.1");
    let text = error.to_string();
    assert!(matches!(error, ConstraintError::Contradiction { .. }));
    assert!(
        text.contains("pin of node 0") && text.contains("roller of node 0"),
        "{text}"
    );

    // Three directions in a plane: the third follows from two.
    let three = vec![
        equation("a", &[(0, 1.0)], 1.0),
        equation("b", &[(1, 1.0)], 2.0),
        equation("c", &[(0, 1.0), (1, 1.0)], 3.0),
    ];
    let error = set(three, Vec::new(), ConstraintForm::Elimination).expect_err("c = a + b");
    let names = ["a", "b", "c"].map(str::to_owned).to_vec();
    assert_eq!(error, ConstraintError::Repetition { names });
}

#[test]
fn attachments_that_cannot_be_kept_are_named() {
    // A node held in place whose slope two bodies claim.
    let claims = vec![
        attachment("fastening to one", 6, BODY, false),
        attachment("fastening to two", 6, BODY + 3, false),
    ];
    let error = set(Vec::new(), claims, ConstraintForm::Multipliers).expect_err("two claims");
    assert_eq!(
        error,
        ConstraintError::Overdetermined {
            name: "fastening to two".to_owned(),
            others: vec!["fastening to one".to_owned()],
        }
    );
}

#[test]
fn what_cannot_be_eliminated_is_named() {
    let joint = vec![equation("joint", &[(8, 1.0), (0, -1.0)], 0.0)];
    let hinge = vec![attachment("hinge", 4, BODY, true)];
    for (equations, attachments, name) in
        [(joint, Vec::new(), "joint"), (Vec::new(), hinge, "hinge")]
    {
        let error = set(equations, attachments, ConstraintForm::Elimination).expect_err("coupled");
        let name = name.to_owned();
        assert_eq!(error, ConstraintError::NotEliminable { name });
    }
}
