//! Constraints `C(q, t) = 0` with Lagrange multipliers, or by elimination.
//!
//! Kerkkänen (2006, 2.29-2.33, 3.28). Beside the equations of motion stand
//!
//! ```text
//! M q'' + C_q^T lambda = f(t, q, q')      C(q, t) = 0                                (2.29, 2.30)
//! C_q q'' = Q_d = -C_tt - (C_q q')_q q' - 2 C_qt q'                                 (2.31)
//! ```
//!
//! Every equation here can be solved for a coordinate of its own, `q_d = F(q_i, t)`: a
//! [`LinearEquation`] after Gauss-Jordan elimination, a [`BodyAttachment`] for the node or the body. So
//! position, velocity and acceleration are put on the constraints exactly in every stage of every
//! scheme (coordinate partitioning, Wehage & Haug 1982): nothing drifts and nothing is stabilised. What is
//! left is equilibrium of the independent coordinates, in one of two forms:
//!
//! * [`ConstraintForm::Multipliers`]: the multipliers are unknowns of the border (2.32, 2.33),
//!
//! ```text
//! | A  C_q^T | | dx      |     | r |
//! | C_q    0 | | dlambda | = - | 0 |     A = M + g_v C + g_q [K + (C_q^T lambda)_q]
//! ```
//!
//! * [`ConstraintForm::Elimination`]: row d of A and r, times `dF/dq_i`, is added to row i, and row d becomes
//!   `dx_d = dF/dq_i dx_i`. For constant C_q this is the projection of (3.28).

mod attachment;
mod linear;
mod prescribed;

pub use attachment::BodyAttachment;
pub use linear::LinearEquation;
pub use prescribed::{Constant, SpinUp, TurnedComponent};

use thiserror::Error;

use crate::linear::{BorderedMatrix, Structure};
use crate::state::State;
use linear::ReducedEquation;

/// How constraints enter the equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConstraintForm {
    /// Lagrange multipliers as unknowns.
    #[default]
    Multipliers,
    /// Dependent coordinates eliminated: linear equations within a node, or between a node and rigid
    /// coordinates.
    Elimination,
}

/// Constraints that cannot be kept together.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ConstraintError {
    /// Equations demand different values of the same thing.
    #[error(
        "the constraints {} contradict each other: together they leave {excess:.3e} m; drop or change one",
        names.join(", ")
    )]
    Contradiction {
        /// Names of the constraints.
        names: Vec<String>,
        /// What remains of the equation when all else is eliminated [m or 1].
        excess: f64,
    },
    /// An equation follows from others.
    #[error("the constraints {} say the same thing twice: drop one", names.join(", "))]
    Repetition {
        /// Names of the constraints.
        names: Vec<String>,
    },
    /// No coordinate is left that the constraint could determine.
    #[error("the constraint {name} finds nothing free to hold: {} hold it already", others.join(", "))]
    Overdetermined {
        /// Name of the constraint.
        name: String,
        /// Names of the constraints that hold its coordinates.
        others: Vec<String>,
    },
    /// Constraints depend on each other in a circle.
    #[error("the constraints {} depend on each other in a circle", names.join(", "))]
    Circle {
        /// Names of the constraints.
        names: Vec<String>,
    },
    /// The form by elimination cannot take the constraint.
    #[error(
        "the constraint {name} cannot be eliminated: it is nonlinear or couples different nodes; \
         choose the form with multipliers"
    )]
    NotEliminable {
        /// Name of the constraint.
        name: String,
    },
}

/// The constraints of one system.
#[derive(Debug)]
pub struct ConstraintSet {
    form: ConstraintForm,
    /// Global index of the first multiplier.
    first: usize,
    equations: Vec<LinearEquation>,
    reduced: Vec<ReducedEquation>,
    attachments: Vec<BodyAttachment>,
    /// The order in which dependent coordinates are put in.
    order: Vec<Assignment>,
}

/// One thing that determines coordinates of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Assignment {
    Reduced(usize),
    /// An attachment, solved for its node.
    Node(usize),
    /// An attachment, solved for the place of its body.
    Body(usize),
}

impl ConstraintSet {
    /// Joins constraints of a system whose coordinates have the structure `coordinates` (without
    /// multipliers) and whose coordinates `prescribed` follow motions already.
    pub fn new(
        coordinates: Structure,
        prescribed: &[usize],
        equations: Vec<LinearEquation>,
        attachments: Vec<BodyAttachment>,
        form: ConstraintForm,
    ) -> Result<Self, ConstraintError> {
        let reduced = linear::reduce(&equations, coordinates.chain(), prescribed)?;
        let mut set = Self {
            form,
            first: coordinates.size(),
            equations,
            reduced,
            attachments,
            order: Vec::new(),
        };
        set.order = set.find_order(prescribed)?;
        if form == ConstraintForm::Elimination {
            set.check_eliminable(coordinates)?;
        }
        Ok(set)
    }

    /// The form in which the constraints enter the equations.
    pub fn form(&self) -> ConstraintForm {
        self.form
    }

    /// Number of scalar equations.
    pub fn equations(&self) -> usize {
        self.equations.len() + 2 * self.attachments.len()
    }

    /// Multipliers among the unknowns.
    pub fn multipliers(&self) -> usize {
        match self.form {
            ConstraintForm::Multipliers => self.equations(),
            ConstraintForm::Elimination => 0,
        }
    }

    /// Whether C_q is constant.
    pub fn is_constant(&self) -> bool {
        self.attachments.is_empty()
    }

    /// Puts dependent coordinates, velocities and accelerations in; clears the places of
    /// multipliers in `q` and `v`.
    #[inline]
    pub fn enforce(&self, time: f64, q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        for assignment in &self.order {
            match *assignment {
                Assignment::Reduced(row) => {
                    let row = &self.reduced[row];
                    let mut value = [0.0; 3];
                    for (equation, factor) in &row.sources {
                        let motion = self.equations[*equation].value.at(time);
                        for k in 0..3 {
                            value[k] += factor * motion[k];
                        }
                    }
                    for (i, coefficient) in &row.terms {
                        value[0] -= coefficient * q[*i];
                        value[1] -= coefficient * v[*i];
                        value[2] -= coefficient * a[*i];
                    }
                    [q[row.dependent], v[row.dependent], a[row.dependent]] = value;
                }
                Assignment::Node(k) => self.attachments[k].place_node(q, v, a),
                Assignment::Body(k) => self.attachments[k].place_body(q, v, a),
            }
        }
        let end = self.first + self.multipliers();
        q[self.first..end].fill(0.0);
        v[self.first..end].fill(0.0);
    }

    /// Turns the residual `M a - f` into that of the independent coordinates: adds `C_q^T lambda` (with
    /// lambda in its places of `a`), or adds the rows of dependent coordinates to the others.
    #[inline]
    pub fn complete_residual(&self, q: &[f64], a: &[f64], residual: &mut [f64]) {
        match self.form {
            ConstraintForm::Multipliers => {
                for (equation, multiplier) in self.equations.iter().zip(&a[self.first..]) {
                    for (i, coefficient) in &equation.terms {
                        residual[*i] += coefficient * multiplier;
                    }
                }
                let mut k = self.first + self.equations.len();
                for attachment in &self.attachments {
                    attachment.add_force(q, [a[k], a[k + 1]], residual);
                    k += 2;
                }
                residual[self.first..k].fill(0.0);
            }
            ConstraintForm::Elimination => {
                for row in &self.reduced {
                    for (i, coefficient) in &row.terms {
                        residual[*i] -= coefficient * residual[row.dependent];
                    }
                    residual[row.dependent] = 0.0;
                }
            }
        }
    }

    /// Turns the matrix A into that of the independent coordinates; `lambda` stands in its places of `a`,
    /// and its tangent `(C_q^T lambda)_q` comes times `position_factor`.
    pub fn complete_matrix(
        &self,
        q: &[f64],
        a: &[f64],
        position_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        match self.form {
            ConstraintForm::Multipliers => {
                for (k, equation) in self.equations.iter().enumerate() {
                    for (i, coefficient) in &equation.terms {
                        matrix.add(*i, self.first + k, *coefficient);
                        matrix.add(self.first + k, *i, *coefficient);
                    }
                }
                let mut k = self.first + self.equations.len();
                for attachment in &self.attachments {
                    attachment.add_tangent(q, [a[k], a[k + 1]], position_factor, k, matrix);
                    k += 2;
                }
            }
            ConstraintForm::Elimination => {
                for row in &self.reduced {
                    for (i, coefficient) in &row.terms {
                        matrix.add_row(*i, -coefficient, row.dependent);
                    }
                    matrix.set_unit_row(row.dependent);
                    for (i, coefficient) in &row.terms {
                        matrix.add(row.dependent, *i, *coefficient);
                    }
                }
            }
        }
    }

    /// Turns the forces `f` into the right-hand side of (2.32), with `Q_d` in the rows of the
    /// constraints.
    pub fn complete_force(&self, state: State<'_>, force: &mut [f64]) {
        match self.form {
            ConstraintForm::Multipliers => {
                for (k, equation) in self.equations.iter().enumerate() {
                    force[self.first + k] = equation.value.at(state.time)[2];
                }
                let mut k = self.first + self.equations.len();
                for attachment in &self.attachments {
                    let right = attachment.acceleration_right(state);
                    force[k..k + 2].copy_from_slice(&right);
                    k += 2;
                }
            }
            ConstraintForm::Elimination => {
                for row in &self.reduced {
                    for (i, coefficient) in &row.terms {
                        force[*i] -= coefficient * force[row.dependent];
                    }
                    force[row.dependent] = (row.sources.iter())
                        .map(|(k, factor)| factor * self.equations[*k].value.at(state.time)[2])
                        .sum();
                }
            }
        }
    }

    /// The largest violation of `C = 0` and of its rate, and the names of the constraints.
    pub fn violation(&self, state: State<'_>) -> [(f64, &str); 2] {
        let mut largest = [(0.0, ""); 2];
        let mut note = |values: [f64; 2], name| {
            for (largest, value) in largest.iter_mut().zip(values) {
                if value.abs() > largest.0 || value.is_nan() {
                    *largest = (value.abs(), name);
                }
            }
        };
        for equation in &self.equations {
            note(equation.values(state), equation.name.as_str());
        }
        for attachment in &self.attachments {
            for values in attachment.values(state) {
                note(values, attachment.name.as_str());
            }
        }
        largest
    }

    /// Rows of C_q, each as pairs of coordinate and entry.
    pub fn jacobian(&self, q: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let linear = self.equations.iter().map(|equation| equation.terms.clone());
        let attached = self
            .attachments
            .iter()
            .flat_map(|attached| attached.rows(q));
        linear.chain(attached).collect()
    }

    /// Dependent coordinates.
    pub fn dependents(&self) -> Vec<usize> {
        let mut all = Vec::new();
        for assignment in &self.order {
            all.extend(self.determined(*assignment));
        }
        all
    }

    fn determined(&self, assignment: Assignment) -> Vec<usize> {
        match assignment {
            Assignment::Reduced(k) => vec![self.reduced[k].dependent],
            Assignment::Node(k) => self.attachments[k].node_coordinates().to_vec(),
            Assignment::Body(k) => self.attachments[k].body_place().to_vec(),
        }
    }

    fn read(&self, assignment: Assignment) -> Vec<usize> {
        match assignment {
            Assignment::Reduced(k) => self.reduced[k].terms.iter().map(|(i, _)| *i).collect(),
            Assignment::Node(k) => self.attachments[k].body_coordinates().to_vec(),
            Assignment::Body(k) => {
                let attachment = &self.attachments[k];
                let angle = attachment.body_coordinates()[2];
                [attachment.node_coordinates().as_slice(), &[angle]].concat()
            }
        }
    }

    fn name(&self, assignment: Assignment) -> String {
        match assignment {
            // The last source is the equation that the row came from.
            Assignment::Reduced(k) => self.reduced[k].name.clone(),
            Assignment::Node(k) | Assignment::Body(k) => self.attachments[k].name.clone(),
        }
    }

    /// Chooses what attachments determine and sorts so that nothing is read before it is put in.
    fn find_order(&self, prescribed: &[usize]) -> Result<Vec<Assignment>, ConstraintError> {
        let mut chosen: Vec<Assignment> =
            (0..self.reduced.len()).map(Assignment::Reduced).collect();
        for (k, attachment) in self.attachments.iter().enumerate() {
            let mut candidates = vec![Assignment::Node(k)];
            if attachment.is_place {
                candidates.push(Assignment::Body(k));
            }
            let holders = |candidate: &Assignment| -> Vec<String> {
                let wanted = self.determined(*candidate);
                let mut names: Vec<String> = (chosen.iter())
                    .filter(|other| self.determined(**other).iter().any(|i| wanted.contains(i)))
                    .map(|other| self.name(*other))
                    .collect();
                if wanted.iter().any(|i| prescribed.contains(i)) {
                    names.push("a prescribed motion".to_owned());
                }
                names
            };
            let Some(candidate) = (candidates.iter()).find(|one| holders(one).is_empty()) else {
                let mut others: Vec<String> = candidates.iter().flat_map(holders).collect();
                others.dedup();
                return Err(ConstraintError::Overdetermined {
                    name: attachment.name.clone(),
                    others,
                });
            };
            chosen.push(*candidate);
        }
        let mut order: Vec<Assignment> = Vec::new();
        while !chosen.is_empty() {
            let open: Vec<usize> = chosen.iter().flat_map(|a| self.determined(*a)).collect();
            let (blocked, ready): (Vec<_>, Vec<_>) = (chosen.iter().copied())
                .partition(|a| self.read(*a).iter().any(|i| open.contains(i)));
            if ready.is_empty() {
                return Err(ConstraintError::Circle {
                    names: blocked.into_iter().map(|a| self.name(a)).collect(),
                });
            }
            order.extend(ready);
            chosen = blocked;
        }
        Ok(order)
    }

    fn check_eliminable(&self, coordinates: Structure) -> Result<(), ConstraintError> {
        if let Some(attachment) = self.attachments.first() {
            return Err(ConstraintError::NotEliminable {
                name: attachment.name.clone(),
            });
        }
        let (chain, block) = (coordinates.chain(), coordinates.block);
        for row in &self.reduced {
            let d = row.dependent;
            // A border row takes any other; a chain row takes those of its own node only.
            let fits = |i: usize| i >= chain || (d < chain && d / block == i / block);
            if !row.terms.iter().all(|(i, _)| fits(*i)) {
                return Err(ConstraintError::NotEliminable {
                    name: row.name.clone(),
                });
            }
        }
        Ok(())
    }
}
