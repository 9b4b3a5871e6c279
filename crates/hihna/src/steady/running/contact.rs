//! Contact of the belt that runs through the mesh: forces, derivatives, and all of its points.
//!
//! The points of the contact line move with `c R'`, so that with the derivatives `f_r`, `f_v`, `f_w` of the
//! force per length by position, velocity and pulley speed ([`crate::contact`])
//!
//! ```text
//! df = f_r dR + f_v (c dR' + R' dc) + f_w d omega
//! ```
//!
//! The point `a` where contact begins or ends moves with `da = -(n . dR)/(n . R')`: the integral of `N f` changes by
//! `-N f (n . dR)/|n . R'|` with the force `f = c_p d' n + f_t t` just inside.

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;

use super::bristles::{Bristles, Marched, Turn};
use super::line::{ContactLine, ElementMatrix, MOST_DOF, MOST_VECTORS, Passage, Weights};
use super::motion::Motion;
use super::split::{Piece, pieces};
use crate::contact::{BeltPoint, ContactPulley, Penalty, PointContact, PulleyContact};

/// Contact with all pulleys, integrated piece by piece.
#[derive(Clone, Debug)]
pub(super) struct SteadyContact {
    pub pulleys: Vec<ContactPulley>,
    pub penalty: Penalty,
    /// The rule on every piece.
    pub rule: Rule,
    /// The bristles of laws with memory; none without such a law.
    pub bristles: Option<Bristles>,
    pieces: Vec<Piece>,
    matrix: ElementMatrix,
}

/// What the contact forces are differentiated by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    /// The unknowns of steady running.
    Unknowns,
    /// Rates of the coordinates on top of it: small motions.
    Rates,
}

impl SteadyContact {
    pub fn new(pulleys: Vec<ContactPulley>, penalty: Penalty, rule: Rule, dof: usize) -> Self {
        Self {
            pulleys,
            penalty,
            rule,
            bristles: None,
            pieces: Vec::new(),
            matrix: ElementMatrix::new(dof),
        }
    }

    /// Adds the forces on the belt to `force` and writes the torques on the pulleys to `torques`.
    pub fn add_force<E: LineElement>(
        &mut self,
        mesh: &Mesh<E>,
        motion: Motion<'_>,
        force: &mut [f64],
        torques: &mut [f64],
    ) {
        torques.fill(0.0);
        self.transport(mesh, motion);
        let mut found = std::mem::take(&mut self.pieces);
        let mut e = [0.0; MOST_DOF];
        for (index, element) in mesh.elements().iter().enumerate() {
            mesh.gather(index, motion.chain, &mut e[..E::DOF]);
            let mut local = [0.0; MOST_DOF];
            let mut touched = false;
            for (p, pulley) in self.pulleys.iter().enumerate() {
                let line = ContactLine::new(element, &e, pulley.height);
                if line.misses(pulley.center, pulley.radius) {
                    continue;
                }
                let passage = self.passage(&line, p, motion);
                pieces(&passage, &mut found);
                for piece in &found {
                    touched = true;
                    for (xi, weight) in self.points(piece) {
                        let weight = weight * line.length;
                        let contact = self.touch(&passage, p, index, xi);
                        let f = contact.force();
                        let weights = Weights::new(element, xi, pulley.height);
                        torques[p] += weight * contact.torque(pulley.radius);
                        for a in 0..E::NODES * E::NODE_VECTORS {
                            local[2 * a] += weight * weights.value[a] * f[0];
                            local[2 * a + 1] += weight * weights.value[a] * f[1];
                        }
                    }
                }
            }
            if touched {
                mesh.scatter(index, &local[..E::DOF], force);
            }
        }
        self.pieces = found;
    }

    /// Adds minus the derivatives of [`SteadyContact::add_force`] `by` the unknowns or by their rates to `matrix`: border
    /// unknown `p` is the speed of pulley `p`, its row the torque on it, border unknown `circulation` the column of c.
    pub fn add_tangent<E: LineElement>(
        &mut self,
        mesh: &Mesh<E>,
        motion: Motion<'_>,
        by: By,
        circulation: usize,
        matrix: &mut BorderedMatrix,
    ) {
        self.transport(mesh, motion);
        let mut found = std::mem::take(&mut self.pieces);
        let mut local = std::mem::replace(&mut self.matrix, ElementMatrix::new(0));
        let mut e = [0.0; MOST_DOF];
        for (index, element) in mesh.elements().iter().enumerate() {
            mesh.gather(index, motion.chain, &mut e[..E::DOF]);
            local.clear();
            let mut touched = false;
            for (p, pulley) in self.pulleys.iter().enumerate() {
                let line = ContactLine::new(element, &e, pulley.height);
                if line.misses(pulley.center, pulley.radius) {
                    continue;
                }
                let passage = self.passage(&line, p, motion);
                pieces(&passage, &mut found);
                if found.is_empty() {
                    continue;
                }
                touched = true;
                let mut pulley_border = PulleyBorder::default();
                for piece in &found {
                    for (xi, weight) in self.points(piece) {
                        let weights = Weights::new(element, xi, pulley.height);
                        let weight = weight * line.length;
                        let turn = (self.bristles.as_ref()).map_or(Turn::default(), |bristles| {
                            bristles.turn(p, &passage, index, xi)
                        });
                        add_point::<E>(
                            &passage,
                            &self.touch(&passage, p, index, xi),
                            (by, turn),
                            (xi, weight),
                            &weights,
                            &mut local,
                            &mut pulley_border,
                        );
                    }
                    let ends = [(piece.begins, piece.from), (piece.ends, piece.to)];
                    for (_, xi) in ends
                        .into_iter()
                        .filter(|(moves, _)| *moves && by == By::Unknowns)
                    {
                        let weights = Weights::new(element, xi, pulley.height);
                        let contact = self.touch(&passage, p, index, xi);
                        let end = (&contact, passage.line.slope(xi), pulley.radius);
                        add_moving_end::<E>(end, &weights, &mut local, &mut pulley_border);
                    }
                }
                let first = index * E::NODE_DOF;
                matrix.add_border_row(p, first, &pulley_border.row[..E::DOF]);
                if by == By::Rates {
                    continue;
                }
                matrix.add_border_column(p, first, &pulley_border.column[..E::DOF]);
                matrix.add_corner(p, p, pulley_border.by_speed);
                matrix.add_corner(p, circulation, pulley_border.by_circulation);
                if self.bristles.is_some() {
                    let phase = circulation + 2 + p;
                    matrix.add_border_column(phase, first, &pulley_border.by_phase[..E::DOF]);
                    matrix.add_corner(p, phase, pulley_border.torque_by_phase);
                }
            }
            if touched {
                if by == By::Rates {
                    local.by_circulation.fill(0.0);
                }
                local.scatter(index, E::NODE_DOF, circulation, matrix);
            }
        }
        self.pieces = found;
        self.matrix = local;
        if let Some(bristles) = self.bristles.as_ref().filter(|_| by == By::Unknowns) {
            for p in 0..self.pulleys.len() {
                let rows = (circulation + 2 + p, circulation);
                let laws = (&self.penalty, &self.pulleys[p]);
                bristles.add_row(p, rows, mesh, motion, laws, matrix);
            }
        }
    }

    /// Follows the bristles through the belt at `motion`.
    pub fn transport<E: LineElement>(&mut self, mesh: &Mesh<E>, motion: Motion<'_>) {
        let Some(mut bristles) = self.bristles.take() else {
            return;
        };
        let mut found = std::mem::take(&mut self.pieces);
        let forwards = motion.circulation > 0.0;
        let mut e = [0.0; MOST_DOF];
        for points in &mut bristles.points {
            points.clear();
        }
        for (index, element) in mesh.elements().iter().enumerate() {
            mesh.gather(index, motion.chain, &mut e[..E::DOF]);
            for (p, pulley) in self.pulleys.iter().enumerate() {
                let line = ContactLine::new(element, &e, pulley.height);
                if !pulley.friction.has_memory() || line.misses(pulley.center, pulley.radius) {
                    continue;
                }
                let passage = self.passage(&line, p, motion);
                pieces(&passage, &mut found);
                for piece in &found {
                    let marched = |xi: f64, weight: f64| {
                        let place = bristles.place(p, &passage, index, xi);
                        Marched::new(&passage, index, place, xi, weight * line.length)
                    };
                    let (enters, at) = if forwards {
                        (piece.begins, piece.from)
                    } else {
                        (piece.ends, piece.to)
                    };
                    let first = enters.then(|| Marched {
                        begins: true,
                        ..marched(at, 0.0)
                    });
                    let all: Vec<Marched> = (first.into_iter())
                        .chain(self.points(piece).map(|(xi, weight)| marched(xi, weight)))
                        .collect();
                    bristles.points[p].extend(all);
                }
            }
        }
        let mut all = std::mem::take(&mut bristles.points);
        for (p, points) in all.iter_mut().enumerate() {
            let arc = &mut bristles.arcs[p];
            arc.unknown = motion.phases[p];
            let ratio = motion.speeds[p] / motion.circulation;
            arc.march(points, self.pulleys[p].radius, ratio, forwards);
        }
        bristles.points = all;
        self.pieces = found;
        self.bristles = Some(bristles);
    }

    /// The contact at `xi` of `element`, with its bristle where the law has memory.
    fn touch(&self, passage: &Passage<'_>, p: usize, element: usize, xi: f64) -> PointContact<f64> {
        match &self.bristles {
            Some(bristles) if passage.pulley.friction.has_memory() => {
                bristles.touch(p, passage, element, xi)
            }
            _ => passage.contact(xi),
        }
    }

    /// All points of the belt, in order, at the ends of whose pieces nothing is smooth.
    pub fn belt_points<E: LineElement>(
        &mut self,
        mesh: &Mesh<E>,
        motion: Motion<'_>,
    ) -> Vec<BeltPoint> {
        self.transport(mesh, motion);
        let mut found = std::mem::take(&mut self.pieces);
        let mut out = Vec::new();
        let mut e = [0.0; MOST_DOF];
        let mut touching: Vec<(usize, Piece)> = Vec::new();
        let mut breaks: Vec<f64> = Vec::new();
        for (index, element) in mesh.elements().iter().enumerate() {
            mesh.gather(index, motion.chain, &mut e[..E::DOF]);
            touching.clear();
            breaks.clear();
            breaks.extend([0.0, 1.0]);
            let line_of = |p: usize| ContactLine::new(element, &e, self.pulleys[p].height);
            for p in 0..self.pulleys.len() {
                let line = line_of(p);
                if line.misses(self.pulleys[p].center, self.pulleys[p].radius) {
                    continue;
                }
                pieces(&self.passage(&line, p, motion), &mut found);
                for piece in &found {
                    touching.push((p, *piece));
                    breaks.extend([piece.from, piece.to]);
                }
            }
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            let centre = ContactLine::new(element, &e, 0.0);
            for pair in breaks.windows(2) {
                let whole = Piece {
                    from: pair[0],
                    to: pair[1],
                    begins: false,
                    ends: false,
                };
                let middle = 0.5 * (whole.from + whole.to);
                let on = touching
                    .iter()
                    .find(|(_, piece)| piece.from < middle && middle < piece.to)
                    .map(|(p, _)| (*p, line_of(*p)));
                for (xi, weight) in self.points(&whole) {
                    let contact = on.as_ref().map(|(p, line)| {
                        let passage = self.passage(line, *p, motion);
                        (*p, self.touch(&passage, *p, index, xi))
                    });
                    out.push(BeltPoint {
                        element: index,
                        xi,
                        weight: weight * centre.length,
                        position: centre.position(xi),
                        velocity: centre.slope(xi).map(|s| motion.circulation * s),
                        contact,
                    });
                }
            }
        }
        self.pieces = found;
        out
    }

    /// What the belt does to each pulley, from its points.
    pub fn resultants(&self, points: &[BeltPoint], speeds: &[f64]) -> Vec<PulleyContact> {
        let mut out = vec![PulleyContact::default(); self.pulleys.len()];
        for point in points {
            let Some((p, contact)) = &point.contact else {
                continue;
            };
            let (total, weight) = (&mut out[*p], point.weight);
            let radius = self.pulleys[*p].radius;
            let force = contact.force();
            let elastic = contact.penetration * self.penalty.stiffness;
            total.torque += weight * contact.torque(radius);
            total.hub_force[0] -= weight * force[0];
            total.hub_force[1] -= weight * force[1];
            total.length += weight;
            total.slip_speed += weight * contact.slip;
            total.penetration = total.penetration.max(contact.penetration);
            total.friction_loss += weight * contact.friction_loss(radius, speeds[*p]);
            total.contact_loss += weight * (contact.normal_force - elastic) * contact.rate;
            total.stored_energy += weight * 0.5 * elastic * contact.penetration;
        }
        for total in out.iter_mut().filter(|total| total.length > 0.0) {
            total.slip_speed /= total.length;
        }
        out
    }

    fn passage<'a>(&'a self, line: &'a ContactLine, p: usize, motion: Motion<'_>) -> Passage<'a> {
        Passage {
            line,
            penalty: &self.penalty,
            pulley: &self.pulleys[p],
            circulation: motion.circulation,
            speed: motion.speeds[p],
        }
    }

    /// Points of a piece and their weights, as parts of the element.
    fn points(&self, piece: &Piece) -> impl Iterator<Item = (f64, f64)> {
        let (from, length) = (piece.from, piece.to - piece.from);
        let pairs = self.rule.points.iter().zip(&self.rule.weights);
        pairs.map(move |(x, w)| (from + length * x, length * w))
    }
}

/// The part of one element in row and column of a pulley.
#[derive(Default)]
struct PulleyBorder {
    column: [f64; MOST_DOF],
    row: [f64; MOST_DOF],
    by_speed: f64,
    by_circulation: f64,
    /// By the phase of the pulley's bristles.
    by_phase: [f64; MOST_DOF],
    torque_by_phase: f64,
}

fn add_point<E: LineElement>(
    passage: &Passage<'_>,
    contact: &PointContact<f64>,
    (by, turn): (By, Turn),
    (xi, weight): (f64, f64),
    weights: &Weights,
    local: &mut ElementMatrix,
    border: &mut PulleyBorder,
) {
    let c = passage.circulation;
    let slope = passage.line.slope(xi);
    let radius = passage.pulley.radius;
    let by_r = contact.tangent(radius, 1.0, 0.0);
    let by_v = contact.tangent(radius, 0.0, 1.0);
    let vectors = E::NODES * E::NODE_VECTORS;
    // By the coordinates of each vector: force and torque.
    let mut force = [[0.0; 4]; MOST_VECTORS];
    for b in 0..vectors {
        let (n, s) = match by {
            By::Unknowns => (weights.value[b], c * weights.slope[b]),
            By::Rates => (0.0, weights.value[b]),
        };
        for k in 0..4 {
            force[b][k] = by_r.force[k] * n + by_v.force[k] * s;
        }
        for axis in 0..2 {
            border.row[2 * b + axis] += weight * (by_r.torque[axis] * n + by_v.torque[axis] * s);
        }
    }
    // By the pulley's turn since the bristle stood unbent; zero for laws without memory.
    let turned = by_r.force_by_pulley;
    let by_circulation = [
        by_v.force[0] * slope[0] + by_v.force[1] * slope[1] + turned[0] * turn.circulation,
        by_v.force[2] * slope[0] + by_v.force[3] * slope[1] + turned[1] * turn.circulation,
    ];
    border.by_circulation += weight * (by_v.torque[0] * slope[0] + by_v.torque[1] * slope[1]);
    border.by_circulation += weight * by_r.torque_by_pulley * turn.circulation;
    border.by_speed += weight * by_v.torque_by_pulley;
    border.by_speed += weight * by_r.torque_by_pulley * turn.speed;
    border.torque_by_phase += weight * by_r.torque_by_pulley * turn.phase;
    for a in 0..vectors {
        let wn = weight * weights.value[a];
        if wn == 0.0 {
            continue;
        }
        for axis in 0..2 {
            let row = (2 * a + axis) * E::DOF;
            for b in 0..vectors {
                local.local[row + 2 * b] += wn * force[b][2 * axis];
                local.local[row + 2 * b + 1] += wn * force[b][2 * axis + 1];
            }
            local.by_circulation[2 * a + axis] += wn * by_circulation[axis];
            border.column[2 * a + axis] +=
                wn * (by_v.force_by_pulley[axis] + turned[axis] * turn.speed);
            border.by_phase[2 * a + axis] += wn * turned[axis] * turn.phase;
        }
    }
}

fn add_moving_end<E: LineElement>(
    (contact, slope, radius): (&PointContact<f64>, [f64; 2], f64),
    weights: &Weights,
    local: &mut ElementMatrix,
    border: &mut PulleyBorder,
) {
    let n = contact.normal;
    let crossing = (n[0] * slope[0] + n[1] * slope[1]).abs();
    let f = contact.force();
    let torque = contact.torque(radius);
    let vectors = E::NODES * E::NODE_VECTORS;
    for b in 0..vectors {
        for j in 0..2 {
            let moved = weights.value[b] * n[j] / crossing;
            for a in 0..vectors {
                for i in 0..2 {
                    let entry = (2 * a + i) * E::DOF + 2 * b + j;
                    local.local[entry] += weights.value[a] * f[i] * moved;
                }
            }
            border.row[2 * b + j] += torque * moved;
        }
    }
}
