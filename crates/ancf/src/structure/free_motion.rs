//! Names the motions that nothing holds.
//!
//! Beam and bodies each move rigidly, with velocities `v(r) = t + w I~ r`; the motions that satisfy
//! `C_q v = 0` store no energy and meet no resistance.

use std::fmt;

use super::PlanarStructure;
use crate::constraint::ConstraintSet;
use crate::element::LineElement;

/// Entries below this are what rounding left of zero.
const VANISHED: f64 = 1.0e-9;

/// A rigid motion of parts of a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// Parts that move, each with its kind of motion.
    pub parts: Vec<(String, RigidMotion)>,
}

/// How a part moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigidMotion {
    /// Along a direction of unit length.
    Translation([f64; 2]),
    /// About a point [m].
    Rotation([f64; 2]),
}

impl fmt::Display for RigidMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Translation([x, _]) if x.abs() < VANISHED => write!(f, "to translate along y"),
            Self::Translation([_, y]) if y.abs() < VANISHED => write!(f, "to translate along x"),
            Self::Translation([x, y]) => write!(f, "to translate along ({x:.3}, {y:.3})"),
            // Adding zero makes -0 a 0.
            Self::Rotation([x, y]) => {
                let tidy = |x: f64| (x * 1.0e3).round() / 1.0e3 + 0.0;
                write!(f, "to rotate about ({}, {})", tidy(*x), tidy(*y))
            }
        }
    }
}

impl fmt::Display for FreeMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (part, motion)) in self.parts.iter().enumerate() {
            let separator = if i > 0 { " while " } else { "" };
            write!(f, "{separator}{motion}")?;
            if !part.is_empty() {
                write!(f, " ({part})")?;
            }
        }
        Ok(())
    }
}

impl<E: LineElement> PlanarStructure<E> {
    /// Rigid motions of beam and bodies that the constraints leave free.
    pub(super) fn free_motions(&self, constraints: Option<&ConstraintSet>) -> Vec<FreeMotion> {
        let drawn = self.drawn();
        let parts = 1 + self.bodies.len();
        let chain = drawn.len() - 3 * self.bodies.len();
        // Angles are taken times the length, so that all unknowns are lengths.
        let length = self.length();
        let rows = constraints.map_or_else(Vec::new, |set| set.jacobian(&drawn));
        let mut matrix: Vec<Vec<f64>> = (rows.iter())
            .map(|row| {
                let mut on_parts = vec![0.0; 3 * parts];
                for (i, entry) in row {
                    let (part, velocity) = if *i < chain {
                        (0, Self::by_motion(*i, &drawn, length))
                    } else {
                        let (body, index) = ((i - chain) / 3, (i - chain) % 3);
                        let first = chain + 3 * body;
                        let velocity = match index {
                            0 => [1.0, 0.0, -drawn[first + 1] / length],
                            1 => [0.0, 1.0, drawn[first] / length],
                            _ => [0.0, 0.0, 1.0 / length],
                        };
                        (1 + body, velocity)
                    };
                    for (k, value) in velocity.into_iter().enumerate() {
                        on_parts[3 * part + k] += entry * value;
                    }
                }
                on_parts
            })
            .collect();
        null_space(&mut matrix, 3 * parts)
            .into_iter()
            .map(|motion| self.name_motion(&motion, length))
            .collect()
    }

    /// Velocity of a coordinate by the three motions of the beam.
    fn by_motion(i: usize, drawn: &[f64], length: f64) -> [f64; 3] {
        let is_place = i % E::NODE_DOF < 2;
        let moves = if is_place { 1.0 } else { 0.0 };
        if i.is_multiple_of(2) {
            [moves, 0.0, -drawn[i + 1] / length]
        } else {
            [0.0, moves, drawn[i - 1] / length]
        }
    }

    fn name_motion(&self, motion: &[f64], length: f64) -> FreeMotion {
        let mut parts = Vec::new();
        for (k, part) in motion.chunks_exact(3).enumerate() {
            let name = match k {
                0 if self.bodies.is_empty() => String::new(),
                0 => "the beam".to_owned(),
                k => self.bodies[k - 1].name.clone(),
            };
            let [x, y, turn] = [part[0], part[1], part[2] / length];
            let speed = x.hypot(y);
            if (turn * length).abs() > VANISHED {
                parts.push((name, RigidMotion::Rotation([-y / turn, x / turn])));
            } else if speed > VANISHED {
                parts.push((name, RigidMotion::Translation([x / speed, y / speed])));
            }
        }
        FreeMotion { parts }
    }
}

/// A basis of the null space by Gauss-Jordan elimination. Pivots are sought among translations first,
/// so that what stays free is a rotation where there is a choice.
fn null_space(rows: &mut [Vec<f64>], columns: usize) -> Vec<Vec<f64>> {
    let mut pivots: Vec<usize> = Vec::new();
    let translations = (0..columns).filter(|k| k % 3 < 2);
    let rotations = (0..columns).filter(|k| k % 3 == 2);
    for column in translations.chain(rotations) {
        let done = pivots.len();
        let best = (done..rows.len())
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()));
        let Some(best) = best.filter(|row| rows[*row][column].abs() > VANISHED) else {
            continue;
        };
        rows.swap(done, best);
        let scale = rows[done][column];
        rows[done].iter_mut().for_each(|value| *value /= scale);
        let pivot_row = rows[done].clone();
        for (k, row) in rows.iter_mut().enumerate() {
            let factor = row[column];
            if k != done && factor != 0.0 {
                for (value, pivot) in row.iter_mut().zip(&pivot_row) {
                    *value -= factor * pivot;
                }
            }
        }
        pivots.push(column);
    }
    (0..columns)
        .filter(|column| !pivots.contains(column))
        .map(|free| {
            let mut vector = vec![0.0; columns];
            vector[free] = 1.0;
            for (row, pivot) in rows.iter().zip(&pivots) {
                vector[*pivot] = -row[free];
            }
            vector
        })
        .collect()
}
