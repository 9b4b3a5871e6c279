//! Newton's method with the natural monotonicity test (Deuflhard 2004, 3.3).
//!
//! ```text
//! J b = F(z)      z <- z + s b   accepted where  |J^-1 F(z + s b)| <= (1 - s/4) |b|,   else s <- s/2
//! ```
//!
//! The old tangent measures the new residual in the units of the unknowns: rows of 1e5 N stand beside rows of
//! 1e-3 N m, so that norms of residuals say nothing. Steps are capped: beyond a few penetrations the
//! belt would lose its contact.

use ancf::element::LineElement;
use ancf::linear::{BorderedMatrix, CyclicSolver, Solver, Structure};

use super::equations::Equations;

/// Longest step [m].
const STEP_LIMIT: f64 = 0.01;
/// Correction that ends the iteration [m].
const TOLERANCE: f64 = 1.0e-11;
/// Corrections below this that shrink no further are round-off [m].
const ROUND_OFF: f64 = 1.0e-9;
/// Halvings of a step.
const MAX_HALVINGS: usize = 12;

/// Working memory of the iteration.
#[derive(Debug)]
pub(super) struct Newton {
    pub matrix: BorderedMatrix,
    pub solver: CyclicSolver,
    residual: Vec<f64>,
    trial_residual: Vec<f64>,
    correction: Vec<f64>,
    trial: Vec<f64>,
    next: Vec<f64>,
    /// Tangents factored since it was made.
    pub factorizations: usize,
}

/// A found root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Converged {
    pub iterations: usize,
}

/// No root was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotFound;

impl Newton {
    pub fn new(structure: Structure) -> Self {
        let zeros = vec![0.0; structure.size()];
        Self {
            matrix: BorderedMatrix::new(structure),
            solver: CyclicSolver::new(structure),
            residual: zeros.clone(),
            trial_residual: zeros.clone(),
            correction: zeros.clone(),
            trial: zeros.clone(),
            next: zeros,
            factorizations: 0,
        }
    }

    /// Factors the tangent of `equations` at `z`.
    pub fn factor<E: LineElement>(
        &mut self,
        equations: &mut Equations<E>,
        z: &[f64],
    ) -> Result<(), NotFound> {
        equations.tangent(z, &mut self.matrix);
        self.factorizations += 1;
        self.solver.factor(&self.matrix).map_err(|_| NotFound)
    }

    /// Moves `z` to a root of `equations`; where there is none, `z` is left as it was.
    pub fn solve<E: LineElement>(
        &mut self,
        equations: &mut Equations<E>,
        z: &mut [f64],
        max_iterations: usize,
    ) -> Result<Converged, NotFound> {
        let before = z.to_vec();
        let found = self.iterate(equations, z, max_iterations);
        if found.is_err() {
            z.copy_from_slice(&before);
        }
        found
    }

    fn iterate<E: LineElement>(
        &mut self,
        equations: &mut Equations<E>,
        z: &mut [f64],
        max_iterations: usize,
    ) -> Result<Converged, NotFound> {
        equations.residual(z, &mut self.residual);
        for iteration in 1..=max_iterations {
            self.factor(equations, z)?;
            self.correction.copy_from_slice(&self.residual);
            self.solver.solve(&mut self.correction);
            let (size, largest) = norms(&self.correction, &equations.scales);
            if !size.is_finite() {
                break;
            }
            if largest <= TOLERANCE {
                for (x, b) in z.iter_mut().zip(&self.correction) {
                    *x += b;
                }
                return Ok(Converged {
                    iterations: iteration,
                });
            }
            let mut step = (STEP_LIMIT / largest).min(1.0);
            let mut accepted = false;
            for _ in 0..MAX_HALVINGS {
                for ((trial, x), b) in self.trial.iter_mut().zip(&*z).zip(&self.correction) {
                    *trial = x + step * b;
                }
                equations.residual(&self.trial, &mut self.trial_residual);
                self.next.copy_from_slice(&self.trial_residual);
                self.solver.solve(&mut self.next);
                // Not a number is no success.
                if norms(&self.next, &equations.scales).0 <= (1.0 - 0.25 * step) * size {
                    accepted = true;
                    break;
                }
                step *= 0.5;
            }
            if !accepted {
                if largest <= ROUND_OFF {
                    return Ok(Converged {
                        iterations: iteration,
                    });
                }
                break;
            }
            z.copy_from_slice(&self.trial);
            std::mem::swap(&mut self.residual, &mut self.trial_residual);
        }
        Err(NotFound)
    }
}

/// Root of the mean square and largest magnitude of a correction, in scaled metres.
fn norms(correction: &[f64], scales: &[f64]) -> (f64, f64) {
    let (mut sum, mut largest) = (0.0, 0.0_f64);
    for (value, scale) in correction.iter().zip(scales) {
        let scaled = (value * scale).abs();
        sum += scaled * scaled;
        largest = largest.max(scaled);
    }
    ((sum / correction.len() as f64).sqrt(), largest)
}
