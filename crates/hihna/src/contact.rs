//! Contact between belt and pulleys, distributed along each element (Kerkkänen 2006, 3.20-3.27).
//!
//! With the pulley's centre O, radius R and speed omega, `rho = |r - O|`, `n = (r - O) / rho` and
//! `t = I~ n` (counter-clockwise) at a point `r` of the belt's contact line (its centre line, or the
//! face that lies on the pulley):
//!
//! ```text
//! d   = R - rho                 d' = -n.r'              contact where d > 0       (3.21)
//! f_n = k_p d + c_p d'          v_t = t.r' - omega L    f_t = -friction(v_t, |f_n|)
//! f   = f_n n + f_t t           on the belt, per undeformed length                (3.20, 3.23)
//! T   = -(R - d) f_t            torque on the pulley, per undeformed length       (3.26)
//! L   = R, as published (3.25), or R - d, where friction acts
//! ```
//!
//! Where the centre moves, O is where it is now and r' the velocity against it; whoever moves it does the
//! work `f.O'` per length and time.
//!
//! Energy per length and time: the penalty stores `k_p d²/2`; friction takes
//! `-f_t (t.r' - omega (R - d))`, with the lever of the force, which is negative where slip against R and against R - d have different signs;
//! the damper takes `(f_n - k_p d) d'`.
//!
//! Derivatives: `dn/dr = t t^T / rho`, `dt/dr = -n t^T / rho`, so `dd/dr = -n`,
//! `dd'/dr = -(t.r') t / rho`, `dd'/dr' = -n`, `dv_t/dr = -(n.r') t / rho`, `dv_t/dr' = t`; with L = R - d also `dv_t/dr = -omega n`.
//!
//! Laws with memory see the displacement `z = R sin(angle from the bristle's place to n)`, so
//! `dz/dr = R cos(..) t / rho` and `dz/d theta = -R cos(..)`.

mod kernels;
mod memory;
mod point;
pub mod surface;
mod table;

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::scalar::{Lanes, dispatch};
use ancf::system::{ForceLaw, State};

pub(crate) use point::Meeting;
pub use point::PointContact;

use crate::drive::Displacement;
use crate::friction::Law;
use crate::load::ExternalTorque;
use memory::Bristles;
use table::{LANES, Line, MAX_VECTORS, Table};

/// A pulley as the contact sees it.
#[derive(Clone, Debug)]
pub struct ContactPulley {
    /// Centre O at time zero [m].
    pub center: [f64; 2],
    /// Motion of the centre from there.
    pub displacement: Option<Displacement>,
    /// Radius R of the surface [m].
    pub radius: f64,
    /// Friction of its surface.
    pub friction: Law,
    /// Height [m] over the belt's centre line of the line that touches the pulley, along the section's
    /// slope: 0 for the centre line, plus or minus half the thickness for the faces.
    pub height: f64,
    /// Torque from outside of the drive.
    pub external: ExternalTorque,
}

impl ContactPulley {
    /// Centre O [m] and its velocity [m/s] at `time` [s].
    #[inline]
    fn hub(&self, time: f64) -> [[f64; 2]; 2] {
        let Some(displacement) = &self.displacement else {
            return [self.center, [0.0; 2]];
        };
        let [[x, y, _], [vx, vy, _]] = displacement.at(time);
        [[self.center[0] + x, self.center[1] + y], [vx, vy]]
    }
}

/// The penalty law in the normal direction, per length of belt, per area on a surface; and where slip is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// k_p [N/m²], on a surface [N/m³].
    pub stiffness: f64,
    /// c_p [N s/m²], on a surface [N s/m³].
    pub damping: f64,
    /// Whether the normal force is kept from pulling.
    pub clamp: bool,
    /// Part of the penetration by which the lever of the pulley's speed in the slip exceeds that of friction, R - d: 1 for slip
    /// against the surface as published, 0 at the depth where friction acts. Walls of grooves have the latter.
    pub slip_lever_part: f64,
}

/// What the belt does to one pulley, summed over the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PulleyContact {
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// Force of the belt on the pulley in the plane [N].
    pub hub_force: [f64; 2],
    /// The rest of the load on the hub, of belts in space.
    pub lateral: Lateral,
    /// Undeformed length [m] of belt in contact, of a surface its area [m²].
    pub length: f64,
    /// Mean slip velocity around the pulley over that length [m/s].
    pub slip_speed: f64,
    /// Largest penetration [m].
    pub penetration: f64,
    /// Power that friction takes [W].
    pub friction_loss: f64,
    /// Power that the contact damping takes [W].
    pub contact_loss: f64,
    /// Energy stored in the penalty [J].
    pub stored_energy: f64,
}

/// What a belt in space does to a pulley out of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lateral {
    /// Force of the belt on the pulley along z [N].
    pub hub_force: f64,
    /// Moment of the contact forces on the pulley about its centre [N m], the torque about its axis too.
    pub hub_moment: [f64; 3],
    /// Mean place of the belt in contact along the pulley's axis, from its middle [m].
    pub belt_offset: f64,
}

/// One integration point of the belt: where it is and what acts on it.
#[derive(Clone, Copy, Debug)]
pub struct BeltPoint {
    /// Element and place in it.
    pub element: usize,
    /// `xi` in `[0, 1]`.
    pub xi: f64,
    /// Quadrature weight times length [m].
    pub weight: f64,
    /// Position on the centre line [m].
    pub position: [f64; 2],
    /// Velocity there [m/s].
    pub velocity: [f64; 2],
    /// The pulley it touches and the contact there.
    pub contact: Option<(usize, PointContact<f64>)>,
}

/// Contact of a belt with pulleys, and the external torques on the pulleys. Pulley `p` turns
/// with rigid coordinate `p`.
#[derive(Clone, Debug)]
pub struct BeltContact {
    /// The pulleys.
    pub pulleys: Vec<ContactPulley>,
    penalty: Penalty,
    rule: Rule,
    /// Whether the last element ends in the first node, or in one of its own that joins it.
    closed: bool,
    /// Coordinates of a node.
    node_dof: usize,
    line: Line,
    /// First coordinate of each vector of the contact line, by element.
    places: Vec<[usize; MAX_VECTORS]>,
    /// Greatest distance of a contact line from the centre line [m].
    highest: f64,
    /// Which contact line touches each pulley.
    line_of: Vec<usize>,
    lines: usize,
    /// Tables by kind of element and contact line; the last line of each kind is the centre line.
    tables: Vec<Table>,
    /// Kind of each element.
    kind_of: Vec<usize>,
    /// A third of the undeformed length of each element [m], eight at a time, the last one repeated.
    thirds: Vec<Lanes<LANES>>,
    /// Where bristles stand, by element and batch; empty without a law that remembers.
    bristles: Vec<Bristles>,
    /// Memory for the next state of them.
    next_bristles: Vec<Bristles>,
}

impl BeltContact {
    /// Contact of a belt of the elements of `mesh` with `pulleys`, integrated by `rule` along each.
    #[must_use]
    pub fn new<E: LineElement>(
        mesh: &Mesh<E>,
        pulleys: Vec<ContactPulley>,
        penalty: Penalty,
        rule: Rule,
    ) -> Self {
        let mut heights: Vec<f64> = Vec::new();
        let line_of = pulleys
            .iter()
            .map(|pulley| {
                heights
                    .iter()
                    .position(|height| height.to_bits() == pulley.height.to_bits())
                    .unwrap_or_else(|| {
                        heights.push(pulley.height);
                        heights.len() - 1
                    })
            })
            .collect();
        let highest = heights.iter().fold(0.0, |h: f64, y| h.max(y.abs()));
        let line = Line::new::<E>(highest);
        // The centre line is observed wherever the contact is.
        heights.push(0.0);
        let mut tables: Vec<Table> = Vec::new();
        let mut known: Vec<&E> = Vec::new();
        let kind_of = mesh
            .elements()
            .iter()
            .map(|element| {
                known
                    .iter()
                    .rposition(|other| *other == element)
                    .unwrap_or_else(|| {
                        known.push(element);
                        for height in &heights {
                            tables.push(Table::new(element, &line, &rule, *height));
                        }
                        known.len() - 1
                    })
            })
            .collect();
        let mut contact = Self {
            pulleys,
            penalty,
            rule,
            closed: mesh.is_closed(),
            node_dof: E::NODE_DOF,
            places: places(mesh, &line),
            line,
            highest,
            line_of,
            lines: heights.len(),
            tables,
            kind_of,
            thirds: thirds(mesh),
            bristles: Vec::new(),
            next_bristles: Vec::new(),
        };
        contact.forget();
        contact
    }

    /// Gives the pulleys other friction laws, all bristles unbent.
    pub fn set_friction(&mut self, laws: impl IntoIterator<Item = Law>) {
        for (pulley, law) in self.pulleys.iter_mut().zip(laws) {
            pulley.friction = law;
        }
        self.forget();
    }

    fn forget(&mut self) {
        let remembers = self.pulleys.iter().any(|p| p.friction.has_memory());
        let count = if remembers {
            self.kind_of.len() * self.batches()
        } else {
            0
        };
        self.bristles = vec![Bristles::NONE; count];
        self.next_bristles = vec![Bristles::NONE; count];
    }

    /// Batches of points of an element.
    fn batches(&self) -> usize {
        self.rule.points.len().div_ceil(LANES)
    }

    fn table(&self, element: usize, line: usize) -> &Table {
        &self.tables[self.kind_of[element] * self.lines + line]
    }

    fn rotors(&self) -> usize {
        (self.kind_of.len() + usize::from(!self.closed)) * self.node_dof
    }

    /// Torque, hub force, slip and power on every pulley.
    pub fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]) {
        out.fill(PulleyContact::default());
        dispatch(kernels::Resultants {
            contact: self,
            state,
            out,
        });
        for total in out {
            if total.length > 0.0 {
                total.slip_speed /= total.length;
            }
        }
    }

    /// Writes every integration point along the belt, in order, to `points`.
    pub fn points(&self, state: State<'_>, points: &mut Vec<BeltPoint>) {
        points.clear();
        let centre = self.lines - 1;
        for element in 0..self.kind_of.len() {
            let at = &self.places[element];
            for (k, xi) in self.rule.points.iter().enumerate() {
                let (batch, lane) = (k / LANES, k % LANES);
                let on_line = |line: usize| {
                    let shape = &self.table(element, line).batches[batch].by_lane[lane].0;
                    let (mut r, mut v) = ([0.0; 2], [0.0; 2]);
                    for (slot, at) in at[..self.line.vectors.len()].iter().enumerate() {
                        for axis in 0..2 {
                            r[axis] += shape[slot] * state.q[at + axis];
                            v[axis] += shape[slot] * state.v[at + axis];
                        }
                    }
                    (r, v)
                };
                let contact = (0..self.pulleys.len()).find_map(|p| {
                    let (r, v) = on_line(self.line_of[p]);
                    let [center, drift] = self.pulleys[p].hub(state.time);
                    let meeting = Meeting {
                        r,
                        v: [v[0] - drift[0], v[1] - drift[1]],
                        center,
                        speed: state.v[self.rotors() + p],
                        anchor: self.anchor(element * self.batches() + batch, lane, p, state.q),
                    };
                    let contact = PointContact::new(&self.penalty, &self.pulleys[p], &meeting);
                    (contact.penetration > 0.0).then_some((p, contact))
                });
                let (position, velocity) = on_line(centre);
                points.push(BeltPoint {
                    element,
                    xi: *xi,
                    weight: self.table(element, centre).batches[batch].weight[lane],
                    position,
                    velocity,
                    contact,
                });
            }
        }
    }

    /// Where the bristle of one point stands on `pulley` in global axes, zero if it has none; `None` on
    /// pulleys whose law does not remember.
    fn anchor(&self, batch: usize, lane: usize, pulley: usize, q: &[f64]) -> Option<[f64; 2]> {
        if !self.pulleys[pulley].friction.has_memory() {
            return None;
        }
        let bristles = &self.bristles[batch];
        let stands = bristles.stands_on(pulley)[lane];
        let (s, c) = q[self.rotors() + pulley].sin_cos();
        let (x, y) = (bristles.x[lane] * stands, bristles.y[lane] * stands);
        Some([c * x - s * y, s * x + c * y])
    }
}

/// First coordinate of each vector of `line`, by element of `mesh`.
fn places<E: LineElement>(mesh: &Mesh<E>, line: &Line) -> Vec<[usize; MAX_VECTORS]> {
    let place = |element: usize, vector: usize| {
        let node = mesh.node(element, vector / E::NODE_VECTORS);
        node * E::NODE_DOF + vector % E::NODE_VECTORS * E::DIMENSION
    };
    (0..mesh.elements().len())
        .map(|element| {
            let mut places = [0; MAX_VECTORS];
            for (to, vector) in places.iter_mut().zip(&line.vectors) {
                *to = place(element, *vector);
            }
            places
        })
        .collect()
}

/// A third of the undeformed length of each element of `mesh` [m], eight at a time, the last one repeated.
fn thirds<E: LineElement>(mesh: &Mesh<E>) -> Vec<Lanes<LANES>> {
    (mesh.elements().chunks(LANES))
        .map(|elements| {
            let third = |lane: usize| elements[lane.min(elements.len() - 1)].length() / 3.0;
            Lanes(std::array::from_fn(third))
        })
        .collect()
}

impl ForceLaw for BeltContact {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        dispatch(kernels::AddForce {
            contact: self,
            state,
            force,
        });
        let rotors = self.rotors();
        for (p, pulley) in self.pulleys.iter().enumerate() {
            let speed = state.v[rotors + p];
            force[rotors + p] += pulley.external.value(state.time, speed);
        }
    }

    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        dispatch(kernels::AddTangent {
            contact: self,
            state,
            position_factor,
            velocity_factor,
            matrix,
        });
        for (p, pulley) in self.pulleys.iter().enumerate() {
            let speed = state.v[self.rotors() + p];
            let slope = pulley.external.derivative(state.time, speed);
            matrix.add_corner(p, p, -velocity_factor * slope);
        }
    }

    fn accept(&mut self, state: State<'_>) {
        if self.bristles.is_empty() {
            return;
        }
        let mut next = std::mem::take(&mut self.next_bristles);
        next.fill(Bristles::NONE);
        dispatch(kernels::Accept {
            contact: self,
            state,
            next: &mut next,
        });
        self.next_bristles = std::mem::replace(&mut self.bristles, next);
    }
}
