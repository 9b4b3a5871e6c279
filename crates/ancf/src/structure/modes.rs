//! Natural frequencies and shapes about an equilibrium, at rest or in a rotating frame.
//!
//! Small motions `q + x` that keep the constraints are `x = Z y`, with Z from the dependence of all
//! coordinates on the independent ones:
//!
//! ```text
//! Z^T M Z y'' + Z^T C Z y' + Z^T K Z y = 0       K = -df/dq + (C_q^T lambda)_q
//! ```
//!
//! The gyroscopic C is that of [`crate::loads::RotatingFrame`]. With `Z^T M Z = L L^T` and the eigenvectors Phi of
//! `L^-1 Z^T K Z L^-T`, whose eigenvalues are omega², that is all without C. With C the spectrum of
//!
//! ```text
//! |  0                  omega                            |
//! | -sign(omega²) omega  -Phi^T L^-1 Z^T C Z L^-T Phi     |
//! ```
//!
//! gives the exponents: this form has entries as large as frequencies, not their squares, so low
//! frequencies keep their digits beside the very high ones of the cross-section.

use faer::linalg::solvers::{Eigen, Llt, SelfAdjointEigen};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par, Side};

use super::finite::finite;
use super::{PlanarStructure, StructureError};
use crate::constraint::ConstraintSet;
use crate::element::{Element, LineElement};
use crate::linear::BorderedMatrix;
use crate::statics::{Equilibrium, Loaded};
use crate::system::{ForceLaw, Mechanics, State, System};

/// A natural motion `exp((growth + i frequency) t)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Circular frequency [rad/s].
    pub frequency: f64,
    /// Rate of growth [1/s]; positive where the equilibrium is unstable.
    pub growth: f64,
    /// Real and imaginary part of the shape by coordinate, as long as the coordinates without
    /// multipliers; scaled to a sum of squares of one.
    pub shape: Vec<[f64; 2]>,
}

impl<E: LineElement> PlanarStructure<E> {
    /// All modes about an equilibrium, by rising frequency. In a rotating frame those of the motion
    /// relative to it. A free structure has three with frequencies that are rounding errors.
    pub fn modes(&self, equilibrium: &Equilibrium) -> Result<Vec<Mode>, StructureError> {
        let mut system = self.build()?;
        let turns = system.law.frame.is_some();
        natural_modes(&mut system, equilibrium, turns)
    }
}

/// All modes of a system under its whole load, by rising frequency. `gyroscopic`: forces depend on velocities.
pub(super) fn natural_modes<E: Element, L: ForceLaw>(
    system: &mut System<E, L>,
    equilibrium: &Equilibrium,
    gyroscopic: bool,
) -> Result<Vec<Mode>, StructureError>
where
    System<E, L>: Loaded,
{
    let wanted = system.structure().size();
    for (what, values) in [
        ("the equilibrium", &equilibrium.q),
        (
            "the multipliers of the equilibrium",
            &equilibrium.multipliers,
        ),
    ] {
        let given = values.len();
        if given != wanted {
            return Err(StructureError::Foreign {
                what,
                given,
                wanted,
            });
        }
        finite(what, values.iter().copied())?;
    }
    let reduced = Reduced::new(system, equilibrium, gyroscopic);
    if reduced.mass.nrows() == 0 {
        // Everything is held.
        return Ok(Vec::new());
    }
    let mass = Llt::new(reduced.mass.as_ref(), Side::Lower).map_err(|_| StructureError::Modes)?;
    let free = reduced.mass.nrows();
    let mut inverse = Mat::<f64>::identity(free, free);
    solve_lower_triangular_in_place(mass.L(), inverse.as_mut(), Par::Seq);
    let stiffness = &inverse * &reduced.stiffness * inverse.transpose();
    let eigen = SelfAdjointEigen::new(stiffness.as_ref(), Side::Lower)
        .map_err(|_| StructureError::Modes)?;
    let vectors = inverse.transpose() * eigen.U();
    let shapes = reduced.basis.times(&vectors);
    let squares: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
    let mut modes = match &reduced.gyroscopic {
        None => plain(&squares, shapes.as_ref()),
        Some(gyroscopic) => {
            let coupling = vectors.transpose() * gyroscopic * &vectors;
            with_gyroscopic(&squares, coupling.as_ref(), shapes.as_ref())?
        }
    };
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    Ok(modes)
}

/// Matrices of the independent coordinates.
struct Reduced {
    basis: Basis,
    mass: Mat<f64>,
    stiffness: Mat<f64>,
    gyroscopic: Option<Mat<f64>>,
}

impl Reduced {
    fn new<E: Element, L: ForceLaw>(
        system: &mut System<E, L>,
        equilibrium: &Equilibrium,
        gyroscopic: bool,
    ) -> Self
    where
        System<E, L>: Loaded,
    {
        system.set_load_factor(1.0);
        let structure = system.structure();
        let constraints = system.constraints();
        let size = structure.size() - constraints.map_or(0, ConstraintSet::multipliers);
        let basis = Basis::new(system, &equilibrium.q, size);
        let rest = vec![0.0; structure.size()];
        let state = State {
            time: 0.0,
            q: &equilibrium.q,
            v: &rest,
        };
        let mut matrix = BorderedMatrix::new(structure);
        let project = |matrix: &BorderedMatrix| basis.project(matrix);
        let mass = project(system.mass());
        system.add_tangent(state, 1.0, 0.0, &mut matrix);
        if let Some(constraints) = system.constraints().filter(|set| set.multipliers() > 0) {
            constraints.complete_matrix(&equilibrium.q, &equilibrium.multipliers, 1.0, &mut matrix);
        }
        let stiffness = project(&matrix);
        let gyroscopic = gyroscopic.then(|| {
            matrix.clear();
            system.add_tangent(state, 0.0, 1.0, &mut matrix);
            project(&matrix)
        });
        Self {
            basis,
            mass,
            stiffness,
            gyroscopic,
        }
    }
}

/// Z by rows, most of which have one entry: what unit velocities of the independent coordinates make of each.
struct Basis {
    rows: Vec<Vec<(usize, f64)>>,
    /// Number of independent coordinates.
    columns: usize,
}

impl Basis {
    fn new<E: Element, L: ForceLaw>(system: &System<E, L>, q: &[f64], size: usize) -> Self {
        let dependents = system
            .constraints()
            .map_or_else(Vec::new, ConstraintSet::dependents);
        let mut free = vec![true; size];
        for index in (system.prescribed().iter().map(|(index, _)| *index)).chain(dependents) {
            free[index] = false;
        }
        let independent: Vec<usize> = (0..size).filter(|i| free[*i]).collect();
        let velocity = |unit: Option<usize>| {
            let mut q = q.to_vec();
            let (mut v, mut a) = (vec![0.0; q.len()], vec![0.0; q.len()]);
            if let Some(unit) = unit {
                v[unit] = 1.0;
            }
            system.prescribe(0.0, &mut q, &mut v, &mut a);
            v
        };
        let still = velocity(None);
        let mut rows = vec![Vec::new(); size];
        for (column, unit) in independent.iter().enumerate() {
            let moved = velocity(Some(*unit));
            for (row, entries) in rows.iter_mut().enumerate() {
                let value = moved[row] - still[row];
                if value != 0.0 {
                    entries.push((column, value));
                }
            }
        }
        Self {
            rows,
            columns: independent.len(),
        }
    }

    /// `Z^T A Z`.
    fn project(&self, matrix: &BorderedMatrix) -> Mat<f64> {
        let mut projected = Mat::<f64>::zeros(self.columns, self.columns);
        let size = self.rows.len();
        for (row, column, value) in matrix.triplets() {
            if row < size && column < size {
                for (i, left) in &self.rows[row] {
                    for (j, right) in &self.rows[column] {
                        projected[(*i, *j)] += left * value * right;
                    }
                }
            }
        }
        projected
    }

    /// `Z A`.
    fn times(&self, vectors: &Mat<f64>) -> Mat<f64> {
        Mat::from_fn(self.rows.len(), vectors.ncols(), |row, column| {
            (self.rows[row].iter())
                .map(|(k, value)| value * vectors[(*k, column)])
                .sum()
        })
    }
}

/// Modes from eigenvalues omega² and shapes column by column.
fn plain(squares: &[f64], shapes: MatRef<'_, f64>) -> Vec<Mode> {
    (squares.iter().enumerate())
        .map(|(k, square)| {
            let root = square.abs().sqrt();
            let shape = shapes.col(k).iter().map(|x| [*x, 0.0]).collect();
            Mode {
                frequency: if *square >= 0.0 { root } else { 0.0 },
                growth: if *square < 0.0 { root } else { 0.0 },
                shape: normalised(shape),
            }
        })
        .collect()
}

/// Modes with gyroscopic coupling; of each pair the one that turns counter-clockwise in the complex plane.
fn with_gyroscopic(
    squares: &[f64],
    coupling: MatRef<'_, f64>,
    shapes: MatRef<'_, f64>,
) -> Result<Vec<Mode>, StructureError> {
    let n = squares.len();
    let mut matrix = Mat::<f64>::zeros(2 * n, 2 * n);
    for i in 0..n {
        let root = squares[i].abs().sqrt();
        matrix[(i, n + i)] = root;
        matrix[(n + i, i)] = -root * squares[i].signum();
        for j in 0..n {
            matrix[(n + i, n + j)] = -coupling[(i, j)];
        }
    }
    let eigen = Eigen::new_from_real(matrix.as_ref()).map_err(|_| StructureError::Modes)?;
    let exponents = eigen.S().column_vector();
    let mut modes = Vec::with_capacity(n);
    for k in 0..2 * n {
        let exponent = exponents[k];
        if exponent.im < 0.0 {
            continue;
        }
        let shape = (0..shapes.nrows())
            .map(|row| {
                let mut sum = [0.0; 2];
                for i in 0..n {
                    let amplitude = eigen.U()[(n + i, k)];
                    sum[0] += shapes[(row, i)] * amplitude.re;
                    sum[1] += shapes[(row, i)] * amplitude.im;
                }
                sum
            })
            .collect();
        modes.push(Mode {
            frequency: exponent.im,
            growth: exponent.re,
            shape: normalised(shape),
        });
    }
    Ok(modes)
}

fn normalised(mut shape: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let sum: f64 = shape.iter().flatten().map(|x| x * x).sum();
    let factor = 1.0 / sum.sqrt();
    shape.iter_mut().flatten().for_each(|x| *x *= factor);
    shape
}
