//! Small motions about the running state: modes of spans and of the drive, with transport speed and damping.
//!
//! With `r = R(xi) + u(xi, t)` on the same mesh and speeds `omega_p + w` of the pulleys
//!
//! ```text
//! M u'' + (c G + C) u' + K u + k w = 0      K: tangent of steady running, with -c² int rho A N' N'^T
//! I w' + P_v u' + P_u u + P_w w = 0         C, P_v: contact by rates      G = int rho A (N N'^T - N' N^T) + ...
//! ```
//!
//! The exponents s nearest a small shift `sigma` are found by Arnoldi's method on `(A - sigma B)^-1 B`; a step costs one
//! solution with the cyclic matrix `K + sigma D + sigma² M`, `D = c G + C`, and all factors are kept. Driving speeds and torques are held.
//!
//! The shift of the belt along itself is neutral: `u = R'`, `s = 0`. On a mesh it is not quite, and where little friction holds the belt, an
//! artificial growth or swing of several 1/s could be made of that. So what the mesh does to the shift x, the vector nearest to R' that K
//! hardly resists, is taken out,
//!
//! ```text
//! K - (K x) (M x)^T / (x^T M x),      and the rows of the pulleys likewise,
//! ```
//!
//! which makes x neutral exactly, to be left out by its exponent.
//!
//! Dry friction follows the motion: with partial slip some modes grow weakly in this linear picture, at rates that change
//! with the mesh. A growth counts only where a finer mesh confirms it.

use ancf::linear::{BorderedMatrix, CyclicSolver, Solver};
use faer::Mat;
use faer::linalg::solvers::Eigen;

use super::contact::By;
use super::{Running, RunningBelt};
use crate::assemble::BeltElementType;

/// The shift [1/s].
const SHIFT: f64 = 3.0;
/// Residual of an eigenpair, relative to it, that counts as converged.
const TOLERANCE: f64 = 1.0e-9;
/// Images below this part of the largest are round-off.
const ROUND_OFF: f64 = 1.0e-12;
/// Largest space searched.
const MOST_DIRECTIONS: usize = 400;
/// Exponents below this are neutral [1/s]: where hardly any friction acts, two that are zero mix, and round-off parts them by its root.
const NEUTRAL: f64 = 1.0e-4;
/// Steps of inverse iteration from the difference quotient of R to the shift.
const REFINEMENTS: usize = 3;
/// Frequencies below this part of the growth are motions without swing.
const APERIODIC: f64 = 1.0e-9;

/// A mode `exp((growth + i frequency) t)` of the running drive: one that swings, or one that grows without swing.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Circular frequency [rad/s]; zero for a growth without swing.
    pub frequency: f64,
    /// Rate of growth [1/s]: negative for a mode that decays.
    pub growth: f64,
    /// Part of the pulleys in the kinetic energy [-]: near one for torsional modes of the drive, near zero for modes of spans.
    pub pulley_share: f64,
    /// Displacement of every node, real and imaginary part of x and y; the largest has magnitude one.
    pub shape: Vec<[[f64; 2]; 2]>,
    /// Angular velocity of every pulley on the same scale, real and imaginary part.
    pub pulleys: Vec<[f64; 2]>,
}

impl Mode {
    /// Damping relative to the critical one [-].
    pub fn damping_ratio(&self) -> f64 {
        -self.growth / self.growth.hypot(self.frequency)
    }
}

/// Modes could not be found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the modes about the running state were not found: {0}")]
pub struct NoModes(&'static str);

/// Those of the linear motion. Border rows and columns of c, the load factor and the prescribed speeds hold these at rest.
struct Matrices {
    mass: BorderedMatrix,
    damping: BorderedMatrix,
    stiffness: BorderedMatrix,
}

impl<E: BeltElementType> RunningBelt<E> {
    /// Up to `count` modes about `running`, by rising frequency: those that swing, and growths without swing among the exponents found.
    pub fn modes(&mut self, running: &Running, count: usize) -> Result<Vec<Mode>, NoModes> {
        if self.equations.contact.bristles.is_some() {
            return Err(NoModes(
                "friction of law `elastic-plastic` remembers displacements, whose small motions are not known; take law `coulomb`",
            ));
        }
        let matrices = self.matrices(&running.state);
        let mut operator = Operator::new(&matrices, self.equations.chain())?;
        operator.free(&self.shift(running));
        let most = operator.size().min(MOST_DIRECTIONS);
        let mut directions = (4 * count + 60).min(most);
        loop {
            let found = arnoldi(&mut operator, directions)?;
            let mut modes: Vec<Mode> = (found.iter())
                .filter(|pair| !pair.is_neutral() && (pair.swings() || pair.value[0] > 0.0))
                .map(|pair| self.mode(pair, &matrices))
                .collect();
            if modes.len() >= count || directions == most {
                modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
                modes.truncate(count);
                return Ok(modes);
            }
            directions = (directions * 3 / 2).min(most);
        }
    }

    fn matrices(&mut self, z: &[f64]) -> Matrices {
        let equations = &mut self.equations;
        let structure = equations.structure();
        let mut stiffness = BorderedMatrix::new(structure);
        equations.tangent(z, &mut stiffness);
        let mut damping = BorderedMatrix::new(structure);
        let motion = equations.motion(z);
        let c = motion.circulation;
        let pulleys = equations.prescribed.len();
        equations.inertia.add_gyroscopic(c, &mut damping);
        let mesh = &equations.mesh;
        (equations.contact).add_tangent(mesh, motion, By::Rates, pulleys, &mut damping);
        let mut mass = BorderedMatrix::new(structure);
        mesh.add_mass(&mut mass);
        let chain = equations.chain();
        for p in 0..pulleys {
            if equations.prescribed[p].is_some() {
                stiffness.set_unit_row(chain + p);
                damping.set_unit_row(chain + p);
                damping.add(chain + p, chain + p, -1.0);
            } else {
                mass.add_corner(p, p, self.inertias[p]);
            }
        }
        stiffness.set_unit_row(equations.circulation());
        stiffness.set_unit_row(equations.load());
        Matrices {
            mass,
            damping,
            stiffness,
        }
    }

    /// Difference quotient of the coordinates along the belt: nearly the motion of the belt along itself.
    fn shift(&self, running: &Running) -> Vec<f64> {
        let elements = self.equations.mesh.elements();
        let nodes: Vec<&[f64]> = running.state[..self.equations.chain()]
            .chunks_exact(E::NODE_DOF)
            .collect();
        let count = nodes.len();
        (0..count)
            .flat_map(|k| {
                let (last, next) = ((k + count - 1) % count, (k + 1) % count);
                let between = elements[last].length() + elements[k].length();
                let pairs = nodes[next].iter().zip(nodes[last]);
                pairs.map(move |(after, before)| (after - before) / between)
            })
            .collect()
    }

    fn mode(&self, pair: &Pair, matrices: &Matrices) -> Mode {
        let chain = self.equations.chain();
        let nodes = pair.vector[..chain].chunks_exact(E::NODE_DOF);
        let mut shape: Vec<[[f64; 2]; 2]> = nodes.map(|node| [node[0], node[1]]).collect();
        let pulleys = &pair.vector[2 * chain..][..self.names.len()];
        let (mut belt, mut turning) = (0.0, 0.0);
        let size = matrices.mass.structure().size();
        let (mut rate, mut momentum) = (vec![0.0; size], vec![0.0; size]);
        for part in 0..2 {
            for (x, v) in rate[..chain].iter_mut().zip(&pair.vector[chain..2 * chain]) {
                *x = v[part];
            }
            matrices.mass.multiply(&rate, &mut momentum);
            belt += dot(&rate, &momentum);
            turning += (self.inertias.iter().zip(pulleys))
                .map(|(inertia, w)| inertia * w[part] * w[part])
                .sum::<f64>();
        }
        let magnitudes = shape.iter().flatten().map(|x| x[0].hypot(x[1]));
        let factor = 1.0 / magnitudes.fold(0.0, f64::max);
        for value in shape.iter_mut().flatten().flatten() {
            *value *= factor;
        }
        Mode {
            frequency: if pair.swings() { pair.value[1] } else { 0.0 },
            growth: pair.value[0],
            pulley_share: turning / (turning + belt),
            shape,
            pulleys: pulleys
                .iter()
                .map(|w| w.map(|part| factor * part))
                .collect(),
        }
    }
}

/// An eigenvalue (real, imaginary part) with its vector `[u, u', border]`.
struct Pair {
    value: [f64; 2],
    vector: Vec<[f64; 2]>,
}

impl Pair {
    fn swings(&self) -> bool {
        self.value[1] > APERIODIC * self.value[0].abs()
    }

    fn is_neutral(&self) -> bool {
        self.value[0].hypot(self.value[1]) < NEUTRAL
    }
}

/// What frees the shift x: `M x / (x^T M x)`, `Q(sigma)^-1 [K x; P_u x]`, and one less their product.
struct Freed {
    along: Vec<f64>,
    answer: Vec<f64>,
    rest: f64,
}

/// `(A - sigma B)^-1 B` on `[u, u', border]`.
struct Operator<'a> {
    matrices: &'a Matrices,
    solver: CyclicSolver,
    chain: usize,
    freed: Option<Freed>,
    rates: Vec<f64>,
    right: Vec<f64>,
    damped: Vec<f64>,
}

impl<'a> Operator<'a> {
    fn new(matrices: &'a Matrices, chain: usize) -> Result<Self, NoModes> {
        let structure = matrices.mass.structure();
        let mut shifted = BorderedMatrix::new(structure);
        shifted.add_scaled(1.0, &matrices.stiffness);
        shifted.add_scaled(SHIFT, &matrices.damping);
        // The border holds speeds: their inertia comes with one power of the exponent less.
        for (row, column, value) in matrices.mass.triplets().filter(|entry| entry.2 != 0.0) {
            let power = if row < chain { SHIFT * SHIFT } else { SHIFT };
            shifted.add(row, column, power * value);
        }
        let mut solver = CyclicSolver::new(structure);
        solver
            .factor(&shifted)
            .map_err(|_| NoModes("the shifted matrix is singular"))?;
        let zeros = vec![0.0; structure.size()];
        Ok(Self {
            matrices,
            solver,
            chain,
            freed: None,
            rates: zeros.clone(),
            right: zeros.clone(),
            damped: zeros,
        })
    }

    fn size(&self) -> usize {
        self.chain + self.right.len()
    }

    /// Makes the shift of the belt along itself near `guess` neutral.
    fn free(&mut self, guess: &[f64]) {
        let n = self.chain;
        let mut state = vec![0.0; self.size()];
        let mut image = state.clone();
        state[..n].copy_from_slice(guess);
        for _ in 0..REFINEMENTS {
            self.apply(&state, &mut image);
            state.copy_from_slice(&unit(&image));
        }
        let mut shift = vec![0.0; self.right.len()];
        shift[..n].copy_from_slice(&state[..n]);
        let (mut along, mut answer) = (shift.clone(), shift.clone());
        self.matrices.mass.multiply(&shift, &mut along);
        let mass = dot(&shift, &along);
        for value in &mut along {
            *value /= mass;
        }
        self.matrices.stiffness.multiply(&shift, &mut answer);
        self.solver.solve(&mut answer);
        let rest = 1.0 - dot(&along, &answer);
        self.freed = Some(Freed {
            along,
            answer,
            rest,
        });
    }

    /// `-Q(sigma) [u; w] = M (v0 + sigma u0) + D u0; I w0 + P_v u0` and `v = u0 + sigma u`.
    fn apply(&mut self, y: &[f64], out: &mut [f64]) {
        let n = self.chain;
        for i in 0..n {
            self.rates[i] = y[n + i] + SHIFT * y[i];
        }
        self.rates[n..].copy_from_slice(&y[2 * n..]);
        self.matrices.mass.multiply(&self.rates, &mut self.right);
        self.rates[..n].copy_from_slice(&y[..n]);
        self.rates[n..].fill(0.0);
        self.matrices
            .damping
            .multiply(&self.rates, &mut self.damped);
        for (r, d) in self.right.iter_mut().zip(&self.damped) {
            *r = -(*r + d);
        }
        self.solver.solve(&mut self.right);
        if let Some(freed) = &self.freed {
            // The matrix less one of rank one (Sherman and Morrison).
            let part = dot(&freed.along, &self.right) / freed.rest;
            for (x, answer) in self.right.iter_mut().zip(&freed.answer) {
                *x += part * answer;
            }
        }
        for i in 0..n {
            out[i] = self.right[i];
            out[n + i] = y[i] + SHIFT * self.right[i];
        }
        out[2 * n..].copy_from_slice(&self.right[n..]);
    }
}

/// Converged eigenpairs nearest the shift, from a space of `count` directions.
fn arnoldi(operator: &mut Operator<'_>, count: usize) -> Result<Vec<Pair>, NoModes> {
    let size = operator.size();
    let mut image = vec![0.0; size];
    // Any start with parts in all modes, the same every time; mapped once, it holds what the constraints allow.
    let start: Vec<f64> = (0..size)
        .map(|i| ((i * 7919 + 13) % 1009) as f64 / 1009.0 - 0.5)
        .collect();
    operator.apply(&start, &mut image);
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(count + 1);
    basis.push(unit(&image));
    let mut hessenberg = Mat::<f64>::zeros(count, count);
    let mut last = 0.0;
    for k in 0..count {
        operator.apply(&basis[k], &mut image);
        // Twice is enough to keep the basis orthogonal to rounding.
        for _ in 0..2 {
            for (i, direction) in basis.iter().enumerate() {
                let along = dot(direction, &image);
                hessenberg[(i, k)] += along;
                for (x, v) in image.iter_mut().zip(direction) {
                    *x -= along * v;
                }
            }
        }
        last = dot(&image, &image).sqrt();
        if k + 1 < count {
            hessenberg[(k + 1, k)] = last;
        }
        basis.push(unit(&image));
    }
    let eigen = Eigen::new_from_real(hessenberg.as_ref())
        .map_err(|_| NoModes("the eigenvalue iteration failed"))?;
    let largest = (eigen.S().column_vector().iter())
        .fold(0.0, |most: f64, theta| most.max(theta.re.hypot(theta.im)));
    let mut pairs = Vec::new();
    for k in 0..count {
        let theta = eigen.S().column_vector()[k];
        let square = theta.re * theta.re + theta.im * theta.im;
        let end = eigen.U()[(count - 1, k)];
        // What holds the border at rest has no inertia: its exponents are infinite but for round-off.
        let finite = square.sqrt() > ROUND_OFF * largest;
        let converged = finite && last * end.re.hypot(end.im) <= TOLERANCE * square.sqrt();
        // s = sigma + 1 / theta; of each pair the one that turns counter-clockwise.
        if !converged || theta.im > 0.0 {
            continue;
        }
        let mut vector = vec![[0.0; 2]; size];
        for (i, direction) in basis.iter().take(count).enumerate() {
            let amplitude = eigen.U()[(i, k)];
            for (sum, x) in vector.iter_mut().zip(direction) {
                sum[0] += amplitude.re * x;
                sum[1] += amplitude.im * x;
            }
        }
        pairs.push(Pair {
            value: [SHIFT + theta.re / square, -theta.im / square],
            vector,
        });
    }
    Ok(pairs)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn unit(x: &[f64]) -> Vec<f64> {
    let factor = 1.0 / dot(x, x).sqrt();
    x.iter().map(|value| factor * value).collect()
}
