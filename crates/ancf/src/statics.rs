//! Static equilibrium by Newton's method with a shrinking shift and a line search.
//!
//! Solves `f(q, 0) = 0` for the coordinates that are not prescribed:
//!
//! ```text
//! (K + sigma M) b = f(q)        q <- q + s b
//! ```
//!
//! The shift `sigma` [1/s²] starts large, so that the first steps follow the forces like a heavily
//! damped motion, and shrinks with every good step until the plain Newton step remains. It also keeps
//! rigid motions without stiffness (a belt sliding along itself) from making the matrix singular.
//! `s` is halved until the step does not overshoot, `f(q + s b).b >= -(1 - s/10) f(q).b`: to second
//! order the potential then falls. Unlike a test of norms this is not upset by the kinks of contact or
//! by directions of negative stiffness. Steps are capped; where `b` leads uphill the shift grows again.

mod load_steps;

use std::ops::ControlFlow;

pub use load_steps::{Equilibrium, LoadStepError, LoadSteps, Loaded, equilibrium, linear_response};

use thiserror::Error;

use crate::linear::{BorderedMatrix, CyclicSolver, Solver};
use crate::norm::VectorNorm;
use crate::system::{Mechanics, State};

/// Part of the first shift below which a correction counts as Newton's own.
const NEGLIGIBLE_SHIFT: f64 = 1.0e-6;

/// How far from turning the forces' work along the correction around a step must stay.
const LINE_SEARCH: f64 = 0.1;
/// Halvings of a step before the shift is raised.
const MAX_HALVINGS: usize = 12;

/// How to look for the equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// First shift [1/s²].
    pub shift: f64,
    /// Factor on the shift after a good step.
    pub shrink: f64,
    /// Largest step of any coordinate, in scaled metres.
    pub step_limit: f64,
    /// Correction, in scaled metres, at which the iteration ends.
    pub tolerance: f64,
    /// Most iterations.
    pub max_iterations: usize,
}

/// A spring that keeps the mean of two vectors near its start along a direction, and not at all across it: they may draw
/// closer, as nodes beside the middle of a strip do while its width contracts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// First coordinates of the vectors; the same twice holds one vector.
    pub vectors: [usize; 2],
    /// Unit vector; zero beyond the dimension of the vectors.
    pub direction: [f64; 3],
    /// Stiffness [N/m].
    pub stiffness: f64,
}

impl Hold {
    /// What is held as a sum over coordinates, with the factors in it that are not zero.
    fn components(&self) -> impl Iterator<Item = (usize, f64)> + Clone + use<> {
        let components = self.direction.into_iter().enumerate();
        let components = components.filter(|(_, component)| *component != 0.0);
        self.vectors.into_iter().flat_map(move |first| {
            (components.clone()).map(move |(axis, component)| (first + axis, 0.5 * component))
        })
    }

    fn add_force(&self, start: &[f64], q: &[f64], force: &mut [f64]) {
        let moved: f64 = (self.components())
            .map(|(i, component)| component * (q[i] - start[i]))
            .sum();
        for (i, component) in self.components() {
            force[i] -= self.stiffness * moved * component;
        }
    }

    fn add_tangent(&self, matrix: &mut BorderedMatrix) {
        for (i, a) in self.components() {
            for (j, b) in self.components() {
                matrix.add(i, j, self.stiffness * a * b);
            }
        }
    }
}

/// A found equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Newton iterations.
    pub iterations: usize,
    /// Last correction, in scaled metres.
    pub correction: f64,
}

/// No equilibrium was found.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StaticsError {
    /// The iteration did not come to rest.
    #[error(
        "no equilibrium after {iterations} iterations: last correction {correction:.1e} m at coordinate {coordinate}"
    )]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// Last correction in scaled metres.
        correction: f64,
        /// Coordinate with the largest correction.
        coordinate: usize,
    },
    /// The tangent is singular: a free motion is left.
    #[error("the structure can move freely at coordinate {coordinate}")]
    Singular {
        /// The coordinate whose pivot vanished.
        coordinate: usize,
    },
    /// The system has constraints, which this iteration does not know.
    #[error("the system has constraints: look for its equilibrium in load steps")]
    Constrained,
    /// The watcher asked to stop.
    #[error("stopped in iteration {iteration}")]
    Stopped {
        /// Iteration that was about to begin.
        iteration: usize,
    },
}

/// Moves `q` to an equilibrium near it, at zero velocity and time `time`. For systems with constraints
/// see [`equilibrium`].
pub fn settle(
    system: &mut dyn Mechanics,
    time: f64,
    q: &mut [f64],
    options: Settle,
) -> Result<Settled, StaticsError> {
    settle_watched(system, time, q, &[], options, &mut |_, _| {
        ControlFlow::Continue(())
    })
}

/// [`settle`] on the springs `holds`, showing `watch` the number and the configuration of every iteration; it
/// stops where `watch` breaks.
pub fn settle_watched(
    system: &mut dyn Mechanics,
    time: f64,
    q: &mut [f64],
    holds: &[Hold],
    options: Settle,
    watch: &mut dyn FnMut(usize, &[f64]) -> ControlFlow<()>,
) -> Result<Settled, StaticsError> {
    if system.constraints().is_some() {
        return Err(StaticsError::Constrained);
    }
    let structure = system.structure();
    let size = structure.size();
    let norm = VectorNorm::new(system);
    let mut held = Held::new(system, time, q, holds);
    let mut matrix = BorderedMatrix::new(structure);
    let mut solver = CyclicSolver::new(structure);
    let mut force = vec![0.0; size];
    let mut correction = vec![0.0; size];
    let mut trial = q.to_vec();
    let mut trial_force = vec![0.0; size];
    let mut shift = options.shift;
    let mut last = (f64::INFINITY, 0);

    for iteration in 1..=options.max_iterations {
        if watch(iteration, q).is_break() {
            return Err(StaticsError::Stopped { iteration });
        }
        held.tangent(q, shift, &mut matrix);
        held.force(q, &mut force);
        solver
            .factor(&matrix)
            .map_err(|singular| StaticsError::Singular {
                coordinate: singular.row,
            })?;
        correction.copy_from_slice(&force);
        solver.solve(&mut correction);
        let size_now = (norm.size(&correction), norm.place(&correction));
        last = size_now;
        if size_now.0 < options.tolerance {
            for (x, b) in q.iter_mut().zip(&correction) {
                *x += b;
            }
            let negligible = NEGLIGIBLE_SHIFT * options.shift;
            if shift <= negligible {
                return Ok(Settled {
                    iterations: iteration,
                    correction: size_now.0,
                });
            }
            // At rest under the shift: ask again without it.
            shift = negligible;
            continue;
        }
        // Work of the forces along the correction: positive where it leads downhill.
        let descent = dot(&force, &correction);
        let mut damping = (options.step_limit / size_now.0).min(1.0);
        let mut accepted = false;
        if descent > 0.0 {
            for _ in 0..MAX_HALVINGS {
                for i in 0..size {
                    trial[i] = q[i] + damping * correction[i];
                }
                held.force(&trial, &mut trial_force);
                if dot(&trial_force, &correction) >= -(1.0 - LINE_SEARCH * damping) * descent {
                    accepted = true;
                    break;
                }
                damping *= 0.5;
            }
        }
        if accepted {
            q.copy_from_slice(&trial);
            shift = (shift * options.shrink).max(NEGLIGIBLE_SHIFT * options.shift);
        } else {
            // Less far, more along the forces.
            shift = (shift / options.shrink.powi(3))
                .clamp(NEGLIGIBLE_SHIFT * options.shift, options.shift);
            if !size_now.0.is_finite() {
                break;
            }
        }
    }
    Err(StaticsError::NotConverged {
        iterations: options.max_iterations,
        correction: last.0,
        coordinate: last.1,
    })
}

/// A system at rest with its holds, prescribed coordinates fixed.
struct Held<'a> {
    system: &'a mut dyn Mechanics,
    time: f64,
    holds: &'a [Hold],
    /// Where the holds are at rest.
    start: Vec<f64>,
    rest: Vec<f64>,
    fixed: Vec<bool>,
}

impl<'a> Held<'a> {
    fn new(system: &'a mut dyn Mechanics, time: f64, start: &[f64], holds: &'a [Hold]) -> Self {
        let mut fixed = vec![false; start.len()];
        for (index, _) in system.prescribed() {
            fixed[*index] = true;
        }
        Self {
            system,
            time,
            holds,
            start: start.to_vec(),
            rest: vec![0.0; start.len()],
            fixed,
        }
    }

    /// Forces at `q`, zero where coordinates are prescribed.
    fn force(&mut self, q: &[f64], out: &mut [f64]) {
        let (time, v) = (self.time, &self.rest);
        self.system.force(State { time, q, v }, out);
        for hold in self.holds {
            hold.add_force(&self.start, q, out);
        }
        for (value, is_fixed) in out.iter_mut().zip(&self.fixed) {
            if *is_fixed {
                *value = 0.0;
            }
        }
    }

    /// Minus the derivative of the forces at `q`, and `shift` times the mass matrix.
    fn tangent(&mut self, q: &[f64], shift: f64, matrix: &mut BorderedMatrix) {
        let (time, v) = (self.time, &self.rest);
        matrix.clear();
        matrix.add_scaled(shift, self.system.mass());
        self.system
            .add_tangent(State { time, q, v }, 1.0, 0.0, matrix);
        for hold in self.holds {
            hold.add_tangent(matrix);
        }
        for (index, is_fixed) in self.fixed.iter().enumerate() {
            if *is_fixed {
                matrix.set_unit_row(index);
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
