//! Equilibrium under dead loads: Newton's method in load steps, with a line search.
//!
//! ```text
//! f(q) - C_q^T lambda = 0,   C(q) = 0       loads times a factor that rises to 1
//! J b = f - C_q^T lambda,    q <- q + s b   J of (2.32) with K in place of M
//! ```
//!
//! The line search is the natural monotonicity test (Deuflhard): with `b~ = J^-1 r(q + s b)` a step is
//! taken if `|b~| < (1 - s/4) |b|`, else `s` is halved. Unlike a test of forces it is not upset by the
//! axial forces that any finite rotation of a slender beam first calls up. The iteration ends when
//! `|b~|` is below the tolerance after a full step; as b~ is added too, the error left is far smaller.
//! A load step that does not converge is halved, and doubled again after one that does.

use thiserror::Error;

use crate::constraint::ConstraintSet;
use crate::linear::{BorderedMatrix, CyclicSolver, Singular, Solver};
use crate::norm::VectorNorm;
use crate::system::{Mechanics, State};

/// Smallest damping factor of the line search.
const MIN_DAMPING: f64 = 1.0 / 1024.0;

/// A system whose loads can be applied in parts.
pub trait Loaded: Mechanics {
    /// Applies the part `factor` of the loads, 1 for all.
    fn set_load_factor(&mut self, factor: f64);
}

/// How to apply the loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadSteps {
    /// Number of equal load steps to begin with, at least 1.
    pub steps: usize,
    /// How often a step that does not converge may be halved.
    pub halvings: u32,
    /// Correction at which a step ends, in scaled metres.
    pub tolerance: f64,
    /// Most iterations of a step.
    pub max_iterations: usize,
}

/// An equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Coordinates, with zeros at the places of multipliers.
    pub q: Vec<f64>,
    /// Multipliers at their places, zeros elsewhere [N, N m].
    pub multipliers: Vec<f64>,
    /// Generalised forces of the constraints on the structure, `-C_q^T lambda` [N, N m].
    pub reactions: Vec<f64>,
    /// Size of each Newton correction, load step by load step, in scaled metres.
    pub corrections: Vec<Vec<f64>>,
}

impl Equilibrium {
    /// Newton iterations of all load steps together.
    pub fn iterations(&self) -> usize {
        self.corrections.iter().map(Vec::len).sum()
    }
}

/// Loads that found no equilibrium.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LoadStepError {
    /// A load step did not converge.
    #[error(
        "the load step to {tried:.4} of the whole load does not converge: the last converged load is \
         {converged:.4} of the whole; corrections [m] {}; more load steps or halvings may help",
        corrections(history)
    )]
    NotConverged {
        /// Part of the loads that was tried last.
        tried: f64,
        /// Part of the loads that the last equilibrium carried.
        converged: f64,
        /// Size of each correction of the failing step, in scaled metres.
        history: Vec<f64>,
    },
    /// The tangent is singular.
    #[error(
        "the tangent is singular after {converged:.4} of the whole load: coordinate {coordinate} is free, or \
         the structure buckles"
    )]
    Singular {
        /// Part of the loads that the last equilibrium carried.
        converged: f64,
        /// The coordinate whose pivot vanished.
        coordinate: usize,
    },
}

fn corrections(history: &[f64]) -> String {
    let sizes: Vec<String> = history.iter().map(|size| format!("{size:.1e}")).collect();
    sizes.join(", ")
}

/// Finds the equilibrium under the system's loads, from the coordinates `start`, at rest and with the
/// constraints as at `time`.
pub fn equilibrium(
    system: &mut dyn Loaded,
    time: f64,
    start: &[f64],
    options: &LoadSteps,
) -> Result<Equilibrium, LoadStepError> {
    let mut newton = Newton::new(system, time, start);
    let mut corrections = Vec::new();
    let first = (options.steps.max(1) as f64).recip();
    let (mut converged, mut increment) = (0.0, first);
    let mut halvings = 0;
    while converged < 1.0 {
        // What rounding leaves to the end is no step of its own.
        let rest = 1.0 - converged;
        let tried = if rest < 1.001 * increment {
            1.0
        } else {
            converged + increment
        };
        system.set_load_factor(tried);
        let mut history = Vec::new();
        newton.keep();
        match newton.solve(system, options, &mut history) {
            Ok(true) => {
                converged = tried;
                corrections.push(history);
                if halvings > 0 {
                    halvings -= 1;
                    increment *= 2.0;
                }
            }
            Ok(false) if halvings < options.halvings => {
                newton.restore(system);
                halvings += 1;
                increment = 0.5 * (tried - converged);
            }
            Ok(false) => {
                return Err(LoadStepError::NotConverged {
                    tried,
                    converged,
                    history,
                });
            }
            Err(Singular { row }) => {
                return Err(LoadStepError::Singular {
                    converged,
                    coordinate: row,
                });
            }
        }
    }
    let Newton {
        q,
        multipliers,
        force,
        ..
    } = newton;
    Ok(Equilibrium {
        reactions: force.iter().map(|f| -f).collect(),
        q,
        multipliers,
        corrections,
    })
}

/// The displacements of linear theory: the first Newton correction from `start`, under the whole load.
pub fn linear_response(
    system: &mut dyn Loaded,
    time: f64,
    start: &[f64],
) -> Result<Vec<f64>, LoadStepError> {
    system.set_load_factor(1.0);
    let mut newton = Newton::new(system, time, start);
    newton.residual(system, Which::Base);
    (newton.factor(system)).map_err(|Singular { row }| LoadStepError::Singular {
        converged: 0.0,
        coordinate: row,
    })?;
    newton.solver.solve(&mut newton.correction);
    newton.correction.truncate(newton.first_multiplier);
    Ok(newton.correction)
}

/// The iterate and working memory.
struct Newton {
    time: f64,
    q: Vec<f64>,
    multipliers: Vec<f64>,
    rest: Vec<f64>,
    /// Velocities that prescribed motions write; statics has none.
    unused: Vec<f64>,
    force: Vec<f64>,
    correction: Vec<f64>,
    base: Vec<f64>,
    base_multipliers: Vec<f64>,
    /// The last equilibrium and its multipliers.
    kept: [Vec<f64>; 2],
    trial_correction: Vec<f64>,
    matrix: BorderedMatrix,
    solver: CyclicSolver,
    norm: VectorNorm,
    first_multiplier: usize,
}

impl Newton {
    fn new(system: &dyn Mechanics, time: f64, start: &[f64]) -> Self {
        let structure = system.structure();
        let size = structure.size();
        let zero = vec![0.0; size];
        let mut q = start.to_vec();
        q.resize(size, 0.0);
        let mut newton = Self {
            time,
            q,
            multipliers: zero.clone(),
            rest: zero.clone(),
            unused: zero.clone(),
            force: zero.clone(),
            correction: zero.clone(),
            base: zero.clone(),
            base_multipliers: zero.clone(),
            kept: [zero.clone(), zero.clone()],
            trial_correction: zero,
            matrix: BorderedMatrix::new(structure),
            solver: CyclicSolver::new(structure),
            norm: VectorNorm::new(system),
            first_multiplier: size - system.constraints().map_or(0, ConstraintSet::multipliers),
        };
        newton.prescribe(system);
        newton
    }

    fn keep(&mut self) {
        self.kept[0].copy_from_slice(&self.q);
        self.kept[1].copy_from_slice(&self.multipliers);
    }

    fn restore(&mut self, system: &dyn Mechanics) {
        self.q.copy_from_slice(&self.kept[0]);
        self.multipliers.copy_from_slice(&self.kept[1]);
        self.prescribe(system);
    }

    /// Iterates to equilibrium; false if it does not converge.
    fn solve(
        &mut self,
        system: &mut dyn Mechanics,
        options: &LoadSteps,
        history: &mut Vec<f64>,
    ) -> Result<bool, Singular> {
        self.residual(system, Which::Base);
        for _ in 0..options.max_iterations {
            self.factor(system)?;
            self.solver.solve(&mut self.correction);
            let size = self.norm.size(&self.correction);
            history.push(size);
            if !size.is_finite() {
                return Ok(false);
            }
            self.base.copy_from_slice(&self.q);
            self.base_multipliers.copy_from_slice(&self.multipliers);
            let mut damping = 1.0;
            let next = loop {
                self.step(system, damping);
                self.residual(system, Which::Trial);
                self.solver.solve(&mut self.trial_correction);
                let next = self.norm.size(&self.trial_correction);
                if next < (1.0 - 0.25 * damping) * size || next < options.tolerance {
                    break next;
                }
                damping *= 0.5;
                if damping < MIN_DAMPING {
                    return Ok(false);
                }
            };
            if damping >= 1.0 && next < options.tolerance {
                self.base.copy_from_slice(&self.q);
                self.base_multipliers.copy_from_slice(&self.multipliers);
                self.correction.copy_from_slice(&self.trial_correction);
                self.step(system, 1.0);
                self.residual(system, Which::Base);
                return Ok(true);
            }
            self.residual(system, Which::Base);
        }
        Ok(false)
    }

    /// Puts constraints in.
    fn prescribe(&mut self, system: &dyn Mechanics) {
        self.unused.fill(0.0);
        let mut accelerations = std::mem::take(&mut self.trial_correction);
        accelerations.fill(0.0);
        system.prescribe(self.time, &mut self.q, &mut self.unused, &mut accelerations);
        self.trial_correction = accelerations;
    }

    fn step(&mut self, system: &dyn Mechanics, damping: f64) {
        for i in 0..self.q.len() {
            let change = damping * self.correction[i];
            if i < self.first_multiplier {
                self.q[i] = self.base[i] + change;
            } else {
                self.multipliers[i] = self.base_multipliers[i] + change;
            }
        }
        self.prescribe(system);
    }

    /// Writes `f - C_q^T lambda` to the vector that becomes a correction, `f` to the forces.
    fn residual(&mut self, system: &mut dyn Mechanics, which: Which) {
        let state = State {
            time: self.time,
            q: &self.q,
            v: &self.rest,
        };
        system.force(state, &mut self.force);
        let out = match which {
            Which::Base => &mut self.correction,
            Which::Trial => &mut self.trial_correction,
        };
        for (out, force) in out.iter_mut().zip(&self.force) {
            *out = -force;
        }
        if let Some(constraints) = system.constraints() {
            constraints.complete_residual(&self.q, &self.multipliers, out);
        }
        for (index, _) in system.prescribed() {
            out[*index] = 0.0;
        }
        for out in out.iter_mut() {
            *out = -*out;
        }
    }

    fn factor(&mut self, system: &mut dyn Mechanics) -> Result<(), Singular> {
        let state = State {
            time: self.time,
            q: &self.q,
            v: &self.rest,
        };
        self.matrix.clear();
        system.add_tangent(state, 1.0, 0.0, &mut self.matrix);
        if let Some(constraints) = system.constraints() {
            constraints.complete_matrix(&self.q, &self.multipliers, 1.0, &mut self.matrix);
        }
        for (index, _) in system.prescribed() {
            self.matrix.set_unit_row(*index);
        }
        self.solver.factor(&self.matrix)
    }
}

#[derive(Clone, Copy)]
enum Which {
    Base,
    Trial,
}
