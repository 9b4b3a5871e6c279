//! The nonlinear solver of implicit stages: a damped simplified Newton method that keeps its factor.
//!
//! With the residual `r(x) = M x - f(t, q_base + g_q x, v_base + g_v x)` and
//! `J = M + g_v C + g_q K`:
//!
//! * the correction `b = J^-1 r(x)` uses an old factor as long as it contracts;
//! * a trial `x - s b` costs one force and one solve, whose result is the next correction;
//! * natural monotonicity `|b_trial| < (1 - s/4) |b|` accepts it (Deuflhard), otherwise the tangent
//!   is renewed at `x`, and if it is fresh already, `s` is halved;
//! * a contraction above [`SLOW`] renews the tangent at the new point;
//! * where that has been cheaper lately, a stage begins with a new tangent (`renewal.rs`).
//!
//! * with the contraction `c` of the last trial, `c / (1 - c) |b|` bounds what is left after the last
//!   correction: below the tolerance the stage is done.
//!
//! An unconverged iterate is never accepted. Norms are velocities: the longest vector of a node or the
//! largest rigid coordinate, weighed by its scale in metres, `|b| = max_i g_v scale_i |b_i|`.

use thiserror::Error;

use super::renewal::Renewal;
use super::{Motion, Statistics};
use crate::constraint::ConstraintSet;
use crate::linear::{BorderedMatrix, CyclicSolver, DenseInverse, SectionPanels, Solver};
use crate::norm::VectorNorm;
use crate::system::{Mechanics, State};

/// Trials before a stage is given up.
const MAX_TRIALS: usize = 30;
/// Contraction above which the tangent is renewed.
const SLOW: f64 = 0.3;
/// Relative change of `g_v` beyond which the factor is renewed.
const STALE: f64 = 0.3;
/// Smallest damping factor.
const MIN_DAMPING: f64 = 1.0 / 1024.0;

/// A stage whose equations could not be solved.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "the step to t = {time} s does not converge: correction {residual:.1e} m/s at coordinate {coordinate}"
)]
pub struct NotConverged {
    /// Time of the stage [s].
    pub time: f64,
    /// Size of the last correction [m/s].
    pub residual: f64,
    /// The coordinate with the largest correction.
    pub coordinate: usize,
}

impl NotConverged {
    /// The error for a state at `time` that is no longer finite.
    pub(super) fn diverged(time: f64) -> Self {
        Self {
            time,
            residual: f64::INFINITY,
            coordinate: 0,
        }
    }
}

/// How position and velocity depend on the unknown acceleration of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageBase {
    /// `g_q = dQ/dx` [s²].
    pub position_factor: f64,
    /// `g_v = dV/dx` [s].
    pub velocity_factor: f64,
}

/// Working memory, factor and counters of the stages of one system.
#[derive(Debug)]
pub struct Stage {
    tolerance: f64,
    mass: SectionPanels,
    matrix: BorderedMatrix,
    solver: CyclicSolver,
    mass_solver: CyclicSolver,
    mass_factored: bool,
    /// The inverse of a small constant mass, once it has paid for itself.
    mass_inverse: Option<DenseInverse>,
    /// Solutions with the present factor of the mass.
    mass_solutions: usize,
    /// `g_v` of the present factor, zero for none.
    factored_for: f64,
    force: Vec<f64>,
    residual: Vec<f64>,
    correction: Vec<f64>,
    trial_residual: Vec<f64>,
    trial_correction: Vec<f64>,
    trial: Motion,
    /// Base positions and velocities.
    base_q: Vec<f64>,
    base_v: Vec<f64>,
    norm: VectorNorm,
    renewal: Renewal,
    /// Counters since the start.
    pub statistics: Statistics,
}

impl Stage {
    /// A solver for stages of `system` that stops when the error of the velocities is below
    /// `tolerance` [m/s].
    #[must_use]
    pub fn new(system: &dyn Mechanics, tolerance: f64) -> Self {
        let structure = system.structure();
        let size = structure.size();
        Self {
            tolerance,
            mass: SectionPanels::new(system.mass()),
            matrix: BorderedMatrix::new(structure),
            solver: CyclicSolver::new(structure),
            mass_solver: CyclicSolver::new(structure),
            mass_factored: false,
            mass_inverse: None,
            mass_solutions: 0,
            factored_for: 0.0,
            force: vec![0.0; size],
            residual: vec![0.0; size],
            correction: vec![0.0; size],
            trial_residual: vec![0.0; size],
            trial_correction: vec![0.0; size],
            trial: Motion::zero(size),
            base_q: vec![0.0; size],
            base_v: vec![0.0; size],
            norm: VectorNorm::new(system),
            renewal: Renewal::default(),
            statistics: Statistics::default(),
        }
    }

    /// Puts prescribed coordinates in and writes the accelerations `M^-1 f` of `motion`.
    pub fn accelerations(&mut self, system: &mut dyn Mechanics, motion: &mut Motion) {
        system.prescribe(motion.time, &mut motion.q, &mut motion.v, &mut motion.a);
        let constant = (system.constraints()).is_none_or(ConstraintSet::is_constant);
        if !self.mass_factored || !constant {
            self.matrix.copy_from(system.mass());
            if let Some(constraints) = system.constraints() {
                constraints.complete_matrix(&motion.q, &motion.a, 0.0, &mut self.matrix);
            }
            for (index, _) in system.prescribed() {
                self.matrix.set_unit_row(*index);
            }
            // A free rotor without inertia leaves the mass singular: its acceleration is NaN then,
            // which the schemes report as a step that does not converge.
            self.mass_factored = self.mass_solver.factor(&self.matrix).is_ok();
            self.mass_inverse = None;
            self.mass_solutions = 0;
        }
        let state = State {
            time: motion.time,
            q: &motion.q,
            v: &motion.v,
        };
        system.force(state, &mut self.force);
        self.statistics.force_evaluations += 1;
        if let Some(constraints) = system.constraints() {
            constraints.complete_force(state, &mut self.force);
        }
        for (index, _) in system.prescribed() {
            self.force[*index] = motion.a[*index];
        }
        if self.mass_factored {
            self.solve_for_accelerations(&mut motion.a);
        } else {
            motion.a.fill(f64::NAN);
        }
    }

    /// Writes the accelerations by the force. The inverse costs as many solutions as there are unknowns.
    fn solve_for_accelerations(&mut self, accelerations: &mut [f64]) {
        if let Some(inverse) = &mut self.mass_inverse {
            inverse.solve(&self.force, accelerations);
            return;
        }
        accelerations.copy_from_slice(&self.force);
        self.mass_solver.solve(accelerations);
        self.mass_solutions += 1;
        if self.mass_solutions == accelerations.len() {
            self.mass_inverse = DenseInverse::new(&mut self.mass_solver, accelerations.len());
        }
    }

    /// Solves for the accelerations of `motion`, which comes with the base values in `q` and `v` and
    /// a guess in `a`, and leaves with all three final.
    pub fn solve(
        &mut self,
        system: &mut dyn Mechanics,
        motion: &mut Motion,
        base: StageBase,
    ) -> Result<(), NotConverged> {
        let before = self.statistics;
        // A factor for other steps is renewed in any case.
        let gv = base.velocity_factor;
        let stale = (gv / self.factored_for - 1.0).abs() > STALE || self.factored_for == 0.0;
        let renewal = self.renewal.is_due() || stale;
        let result = self.iterate(system, motion, base, renewal);
        self.renewal.count(
            renewal,
            self.statistics.force_evaluations - before.force_evaluations,
            self.statistics.tangent_evaluations - before.tangent_evaluations,
        );
        result
    }

    /// Newton's iterations of a stage, the first with a new tangent if `renewal` says so.
    fn iterate(
        &mut self,
        system: &mut dyn Mechanics,
        motion: &mut Motion,
        base: StageBase,
        renewal: bool,
    ) -> Result<(), NotConverged> {
        // What was written there is of no use any more; the base moves in without a copy.
        std::mem::swap(&mut self.base_q, &mut motion.q);
        std::mem::swap(&mut self.base_v, &mut motion.v);
        let gv = base.velocity_factor;
        let mut fresh = false;
        self.place(system, motion, base);
        self.evaluate(system, motion, Target::Current);
        if renewal {
            self.renew(system, motion, base)?;
            fresh = true;
        }
        self.correct(Target::Current);
        let mut size = self.norm(&self.correction, gv);
        let mut damping: f64 = 1.0;
        for _ in 0..MAX_TRIALS {
            if size < 0.01 * self.tolerance {
                self.apply(system, motion, base);
                return Ok(());
            }
            let mut trial = std::mem::replace(&mut self.trial, Motion::zero(0));
            trial.time = motion.time;
            let moved = motion.a.iter().zip(&self.correction);
            for (a, (from, correction)) in trial.a.iter_mut().zip(moved) {
                *a = from - damping * correction;
            }
            self.place(system, &mut trial, base);
            self.evaluate(system, &trial, Target::Trial);
            self.correct(Target::Trial);
            let trial_size = self.norm(&self.trial_correction, gv);
            let contraction = trial_size / size;
            if contraction < 1.0 - 0.25 * damping {
                std::mem::swap(&mut motion.q, &mut trial.q);
                std::mem::swap(&mut motion.v, &mut trial.v);
                std::mem::swap(&mut motion.a, &mut trial.a);
                self.trial = trial;
                std::mem::swap(&mut self.residual, &mut self.trial_residual);
                std::mem::swap(&mut self.correction, &mut self.trial_correction);
                size = trial_size;
                let left = contraction / (1.0 - contraction) * size;
                if damping >= 1.0 && left < self.tolerance {
                    self.apply(system, motion, base);
                    return Ok(());
                }
                fresh = false;
                if contraction > SLOW && damping >= 1.0 {
                    self.renew(system, motion, base)?;
                    fresh = true;
                    self.correct(Target::Current);
                    size = self.norm(&self.correction, gv);
                }
                damping = (2.0 * damping).min(1.0);
            } else {
                self.trial = trial;
                if fresh {
                    damping *= 0.5;
                    if damping < MIN_DAMPING {
                        break;
                    }
                } else {
                    self.renew(system, motion, base)?;
                    fresh = true;
                    self.correct(Target::Current);
                    size = self.norm(&self.correction, gv);
                }
            }
        }
        // The factor belongs to a point that led nowhere.
        self.factored_for = 0.0;
        Err(NotConverged {
            time: motion.time,
            residual: size,
            coordinate: self.norm.place(&self.correction),
        })
    }

    /// Takes the last correction, smaller than the tolerance, along.
    fn apply(&mut self, system: &dyn Mechanics, motion: &mut Motion, base: StageBase) {
        for (a, b) in motion.a.iter_mut().zip(&self.correction) {
            *a -= b;
        }
        self.place(system, motion, base);
    }

    /// Position and velocity from the accelerations.
    fn place(&self, system: &dyn Mechanics, motion: &mut Motion, base: StageBase) {
        let (gq, gv) = (base.position_factor, base.velocity_factor);
        for ((v, base), a) in motion.v.iter_mut().zip(&self.base_v).zip(&motion.a) {
            *v = base + gv * a;
        }
        for ((q, base), a) in motion.q.iter_mut().zip(&self.base_q).zip(&motion.a) {
            *q = base + gq * a;
        }
        system.prescribe(motion.time, &mut motion.q, &mut motion.v, &mut motion.a);
    }

    fn evaluate(&mut self, system: &mut dyn Mechanics, motion: &Motion, target: Target) {
        let residual = match target {
            Target::Current => &mut self.residual,
            Target::Trial => &mut self.trial_residual,
        };
        let state = State {
            time: motion.time,
            q: &motion.q,
            v: &motion.v,
        };
        system.force(state, &mut self.force);
        self.statistics.force_evaluations += 1;
        self.mass.residual(&motion.a, &self.force, residual);
        for (index, _) in system.prescribed() {
            residual[*index] = 0.0;
        }
        if let Some(constraints) = system.constraints() {
            constraints.complete_residual(&motion.q, &motion.a, residual);
            for (index, _) in system.prescribed() {
                residual[*index] = 0.0;
            }
        }
    }

    fn correct(&mut self, target: Target) {
        let (residual, correction) = match target {
            Target::Current => (&self.residual, &mut self.correction),
            Target::Trial => (&self.trial_residual, &mut self.trial_correction),
        };
        correction.copy_from_slice(residual);
        self.solver.solve(correction);
    }

    fn renew(
        &mut self,
        system: &mut dyn Mechanics,
        motion: &Motion,
        base: StageBase,
    ) -> Result<(), NotConverged> {
        let state = State {
            time: motion.time,
            q: &motion.q,
            v: &motion.v,
        };
        self.matrix.copy_from(system.mass());
        system.add_tangent(
            state,
            base.position_factor,
            base.velocity_factor,
            &mut self.matrix,
        );
        if let Some(constraints) = system.constraints() {
            let factor = base.position_factor;
            constraints.complete_matrix(&motion.q, &motion.a, factor, &mut self.matrix);
        }
        for (index, _) in system.prescribed() {
            self.matrix.set_unit_row(*index);
        }
        self.statistics.tangent_evaluations += 1;
        self.statistics.factorizations += 1;
        match self.solver.factor(&self.matrix) {
            Ok(()) => {
                self.factored_for = base.velocity_factor;
                Ok(())
            }
            Err(singular) => {
                self.factored_for = 0.0;
                Err(NotConverged {
                    time: motion.time,
                    residual: f64::INFINITY,
                    coordinate: singular.row,
                })
            }
        }
    }

    /// Largest weighted vector of a correction [m/s]; NaN counts as infinite.
    fn norm(&self, correction: &[f64], velocity_factor: f64) -> f64 {
        self.norm.size(correction) * velocity_factor
    }
}

/// Which residual and correction are meant.
#[derive(Clone, Copy)]
enum Target {
    Current,
    Trial,
}
