//! Bristles of laws with memory in steady running: transported from where the belt runs on.
//!
//! A point of the belt takes the time `(xi_k - xi_a)/c` from place a to place k of the mesh, in which the pulley turns by
//! `omega (xi_k - xi_a)/c` and the point about the pulley's centre by `theta_k - theta_a`. So a bristle that stands at a and does not
//! slide is bent by
//!
//! ```text
//! z_k = R sin(phi_k)      phi_k = theta_k - (omega/c) xi_k - B      B = theta_a - (omega/c) xi_a - asin(z_a / R)
//! ```
//!
//! the integral of `c dz/dxi = v_t` in closed form, with the displacement of the time run. Bristles stand unbent where contact
//! begins; where `k_t |z| > mu |f_n|` at an integration point what exceeds it has slid, and a new B counts from there. Along most of a
//! pulley's arc B is one number: it is an unknown of its own, so that the coupling of a whole arc to the place where the belt runs on
//! stays in one border row and one border column.

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;
use ancf::mesh::Mesh;

use super::line::{ContactLine, MOST_DOF, Passage, Weights};
use super::motion::Motion;
use crate::contact::{ContactPulley, Penalty, PointContact};
use crate::friction::FrictionLaw;
use crate::layout::Layout;

/// A place from which on bristles are transported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    /// Element and place in it.
    pub element: usize,
    pub xi: f64,
    /// Mesh coordinate from the middle of the arc [m].
    pub place: f64,
    /// Angle about the pulley's centre from the middle of the arc [rad].
    pub angle: f64,
    /// B [rad].
    pub phase: f64,
    /// Sign of the displacement where bristles have slid; zero where contact begins.
    pub slid: f64,
    /// Weight of the points that stick from here on [m].
    stuck: f64,
}

/// A point as the march along an arc sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Marched {
    pub element: usize,
    pub xi: f64,
    /// Mesh coordinate from the middle of the arc [m].
    pub place: f64,
    pub normal: [f64; 2],
    /// Largest displacement that does not slide [m].
    pub limit: f64,
    pub weight: f64,
    /// Whether contact begins here.
    pub begins: bool,
}

impl Marched {
    /// The point of `passage` at `xi`.
    pub fn new(passage: &Passage<'_>, element: usize, place: f64, xi: f64, weight: f64) -> Self {
        let contact = passage.contact(xi);
        let normal_force = contact.normal_force.abs();
        Self {
            element,
            xi,
            place,
            normal: contact.normal,
            limit: (passage.pulley.friction.elastic_limit(normal_force)).unwrap_or(0.0),
            weight,
            begins: false,
        }
    }
}

/// The bristles on one pulley.
#[derive(Clone, Debug, Default)]
pub(super) struct BristleArc {
    /// Middle of the arc when the belt was at rest: mesh coordinate [m] and outward direction.
    pub middle: f64,
    pub direction: [f64; 2],
    /// In the direction of travel.
    pub anchors: Vec<Anchor>,
    /// The one that most points hang on: its phase is the unknown.
    pub main: usize,
    /// The unknown [rad].
    pub unknown: f64,
    /// `omega / c` [rad/m], and whether the belt runs towards growing mesh coordinates.
    ratio: f64,
    forwards: bool,
}

impl BristleArc {
    /// Mesh coordinate `x` from the middle of the arc, on a belt of `length`.
    pub fn place(&self, x: f64, length: f64) -> f64 {
        (x - self.middle + 0.5 * length).rem_euclid(length) - 0.5 * length
    }

    /// Angle of `normal` from the middle of the arc [rad].
    fn angle(&self, normal: [f64; 2]) -> f64 {
        let [x, y] = self.direction;
        (x * normal[1] - y * normal[0]).atan2(x * normal[0] + y * normal[1])
    }

    /// Follows the bristles through `points`, which it sorts, on a pulley of `radius` that turns by `ratio` per mesh coordinate.
    pub fn march(&mut self, points: &mut [Marched], radius: f64, ratio: f64, forwards: bool) {
        self.anchors.clear();
        self.main = 0;
        self.ratio = ratio;
        self.forwards = forwards;
        let order = |point: &Marched| if forwards { point.place } else { -point.place };
        points.sort_by(|a, b| order(a).total_cmp(&order(b)).then(b.begins.cmp(&a.begins)));
        for point in points.iter() {
            let angle = self.angle(point.normal);
            let turned = angle - ratio * point.place;
            let anchor = |displacement: f64| Anchor {
                element: point.element,
                xi: point.xi,
                place: point.place,
                angle,
                phase: turned - (displacement / radius).asin(),
                slid: if displacement == 0.0 {
                    0.0
                } else {
                    displacement.signum()
                },
                stuck: 0.0,
            };
            if point.begins || self.anchors.is_empty() {
                self.anchors.push(anchor(0.0));
            }
            let Some(last) = self.anchors.last_mut() else {
                continue;
            };
            let displacement = radius * (turned - last.phase).sin();
            if displacement.abs() > point.limit {
                self.anchors
                    .push(anchor(point.limit.copysign(displacement)));
            } else {
                last.stuck += point.weight;
            }
        }
        self.main = (0..self.anchors.len()).fold(0, |most, i| {
            if self.anchors[i].stuck > self.anchors[most].stuck {
                i
            } else {
                most
            }
        });
    }

    /// Where the bristle of a point at `place` has stood last; none before contact begins.
    pub fn anchor(&self, place: f64) -> Option<usize> {
        let before = |anchor: &Anchor| {
            if self.forwards {
                anchor.place < place
            } else {
                anchor.place > place
            }
        };
        self.anchors.partition_point(before).checked_sub(1)
    }

    /// Outward direction to where the bristle of a point with `normal` at `place` stands, turned with the pulley.
    pub fn stands(&self, place: f64, normal: [f64; 2]) -> [f64; 2] {
        let phase = match self.anchor(place) {
            Some(i) if i == self.main => self.unknown,
            Some(i) => self.anchors[i].phase,
            None => return normal,
        };
        let (sine, cosine) = (self.angle(normal) - self.ratio * place - phase).sin_cos();
        let [x, y] = normal;
        [x * cosine + y * sine, y * cosine - x * sine]
    }

    /// Phase of the main anchor [rad]: what the unknown is to be; the unknown itself where nothing touches.
    pub fn main_phase(&self) -> f64 {
        self.anchors
            .get(self.main)
            .map_or(self.unknown, |anchor| anchor.phase)
    }
}

/// Derivatives of the angle by which a pulley has turned since a point's bristle stood unbent, by the unknowns of the border.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turn {
    pub speed: f64,
    pub circulation: f64,
    pub phase: f64,
}

/// The bristles on all pulleys.
#[derive(Clone, Debug)]
pub(super) struct Bristles {
    pub arcs: Vec<BristleArc>,
    /// Mesh coordinate at which every element begins [m], and the length of the belt.
    starts: Vec<f64>,
    length: f64,
    /// Working memory: the points on every pulley.
    pub points: Vec<Vec<Marched>>,
}

impl Bristles {
    /// Unbent bristles on the pulleys of `layout`, the first node of the belt being at `first_node` on it [m].
    pub fn new<E: LineElement>(mesh: &Mesh<E>, layout: &Layout, first_node: f64) -> Self {
        let mut length = 0.0;
        let starts = (mesh.elements().iter())
            .map(|element| {
                let start = length;
                length += element.length();
                start
            })
            .collect();
        let arcs = layout.arcs.iter().map(|arc| {
            let middle = arc.start + 0.5 * arc.length;
            let [x, y] = layout.point(middle).position;
            let [dx, dy] = [x - arc.center[0], y - arc.center[1]];
            BristleArc {
                middle: (middle - first_node) / layout.length * length,
                direction: [dx, dy].map(|d| d / dx.hypot(dy)),
                ..BristleArc::default()
            }
        });
        Self {
            arcs: arcs.collect(),
            points: vec![Vec::new(); layout.arcs.len()],
            starts,
            length,
        }
    }

    /// Place of a point of `passage` from the middle of pulley `p`'s arc [m].
    pub fn place(&self, p: usize, passage: &Passage<'_>, element: usize, xi: f64) -> f64 {
        let x = self.starts[element] + xi * passage.line.length;
        self.arcs[p].place(x, self.length)
    }

    /// The contact of a point of `passage` past pulley `p`, with its bristle.
    pub fn touch(
        &self,
        p: usize,
        passage: &Passage<'_>,
        element: usize,
        xi: f64,
    ) -> PointContact<f64> {
        let normal = passage.contact(xi).normal;
        let place = self.place(p, passage, element, xi);
        passage.contact_with(xi, Some(self.arcs[p].stands(place, normal)))
    }

    /// The turn of pulley `p` since the bristle there stood unbent.
    pub fn turn(&self, p: usize, passage: &Passage<'_>, element: usize, xi: f64) -> Turn {
        let (arc, c) = (&self.arcs[p], passage.circulation);
        let place = self.place(p, passage, element, xi);
        let (since, phase) = match arc.anchor(place) {
            Some(i) if i == arc.main => (place, 1.0),
            Some(i) => (place - arc.anchors[i].place, 0.0),
            None => return Turn::default(),
        };
        Turn {
            speed: since / c,
            circulation: -arc.ratio * since / c,
            phase,
        }
    }

    /// Adds minus the derivative of `B - unknown` of pulley `p` to row `row` of the border: border unknown `p` is the pulley's
    /// speed, `circulation` the circulation speed.
    pub fn add_row<E: LineElement>(
        &self,
        p: usize,
        (row, circulation): (usize, usize),
        mesh: &Mesh<E>,
        motion: Motion<'_>,
        (penalty, pulley): (&Penalty, &ContactPulley),
        matrix: &mut BorderedMatrix,
    ) {
        matrix.add_corner(row, row, 1.0);
        let arc = &self.arcs[p];
        let Some(anchor) = arc.anchors.get(arc.main) else {
            return;
        };
        let c = motion.circulation;
        let element = &mesh.elements()[anchor.element];
        let mut e = [0.0; MOST_DOF];
        mesh.gather(anchor.element, motion.chain, &mut e[..E::DOF]);
        let line = ContactLine::new(element, &e, pulley.height);
        let passage = Passage {
            line: &line,
            penalty,
            pulley,
            circulation: c,
            speed: motion.speeds[p],
        };
        let contact = passage.contact(anchor.xi);
        let n = contact.normal;
        let t = [-n[1], n[0]];
        let slope = line.slope(anchor.xi);
        let distance = pulley.radius - contact.penetration;
        let along = |v: [f64; 2], w: [f64; 2]| v[0] * w[0] + v[1] * w[1];
        // By the point's position and by its slope; the angle first.
        let mut by_position = t.map(|t| t / distance);
        let mut by_slope = [0.0; 2];
        let mut by_circulation = arc.ratio * anchor.place / c;
        if anchor.slid == 0.0 {
            // The place where contact begins moves by -(n . dR)/(n . R').
            let drift = along(t, slope) / distance - arc.ratio;
            let moved = drift / along(n, slope);
            for (by, n) in by_position.iter_mut().zip(n) {
                *by -= moved * n;
            }
        } else {
            let limit = pulley.friction.elastic_limit(1.0).unwrap_or(0.0);
            let bent = anchor.angle - arc.ratio * anchor.place - anchor.phase;
            let factor = anchor.slid * limit / (pulley.radius * bent.cos());
            let (stiffness, damping) = (penalty.stiffness, penalty.damping);
            let turning = c * along(t, slope) / distance;
            for axis in 0..2 {
                by_position[axis] += factor * (stiffness * n[axis] + damping * turning * t[axis]);
                by_slope[axis] += factor * damping * c * n[axis];
            }
            by_circulation += factor * damping * along(n, slope);
        }
        let weights = Weights::new(element, anchor.xi, pulley.height);
        let mut values = [0.0; MOST_DOF];
        for b in 0..E::NODES * E::NODE_VECTORS {
            for axis in 0..2 {
                values[2 * b + axis] =
                    -(weights.value[b] * by_position[axis] + weights.slope[b] * by_slope[axis]);
            }
        }
        matrix.add_border_row(row, anchor.element * E::NODE_DOF, &values[..E::DOF]);
        matrix.add_corner(row, p, anchor.place / c);
        matrix.add_corner(row, circulation, -by_circulation);
    }
}
