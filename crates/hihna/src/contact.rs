//! Contact between belt and pulleys, distributed along each element (Kerkkänen 2006, 3.20-3.27).
//!
//! With the pulley's centre O, radius R and speed omega, `rho = |r - O|`, `n = (r - O) / rho` and
//! `t = I~ n` (counter-clockwise) at a point `r` of the belt's centre line:
//!
//! ```text
//! d   = R - rho                 d' = -n.r'              contact where d > 0       (3.21)
//! f_n = k_p d + c_p d'          v_t = t.r' - omega R    f_t = -friction(v_t, |f_n|)
//! f   = f_n n + f_t t           on the belt, per undeformed length                (3.20, 3.23)
//! T   = -(R - d) f_t            torque on the pulley, per undeformed length       (3.26)
//! ```
//!
//! Energy per length and time: the penalty stores `k_p d²/2`; friction takes
//! `-f_t (t.r' - omega (R - d))`, with the lever of the force; the damper takes `(f_n - k_p d) d'`.
//!
//! Derivatives: `dn/dr = t t^T / rho`, `dt/dr = -n t^T / rho`, so `dd/dr = -n`,
//! `dd'/dr = -(t.r') t / rho`, `dd'/dr' = -n`, `dv_t/dr = -(n.r') t / rho`, `dv_t/dr' = t`.

use std::marker::PhantomData;

use ancf::element::LineElement;
use ancf::linear::BorderedMatrix;
use ancf::quadrature::Rule;
use ancf::scalar::{EightLanes, LaneKernel, Scalar, dispatch};
use ancf::system::{ForceLaw, State};

use crate::friction::FrictionLaw;
use crate::profile::Profile;

/// Integration points computed side by side.
const LANES: usize = 8;
/// Most vectors that a centre line reads.
const MAX_VECTORS: usize = 4;

/// A pulley as the contact sees it.
#[derive(Clone, Debug)]
pub struct ContactPulley {
    /// Centre O [m].
    pub center: [f64; 2],
    /// Radius R [m].
    pub radius: f64,
    /// External torque [N m].
    pub torque: Profile,
}

/// The penalty law in the normal direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// k_p [N/m²].
    pub stiffness: f64,
    /// c_p [N s/m²].
    pub damping: f64,
    /// Whether the normal force is kept from pulling.
    pub clamp: bool,
}

/// What happens at one point of the belt in contact (all zero outside).
#[derive(Clone, Copy, Debug)]
pub struct PointContact<S> {
    /// Penetration d [m], negative outside.
    pub penetration: S,
    /// Its rate d' [m/s].
    pub rate: S,
    /// Outward unit normal n.
    pub normal: [S; 2],
    /// Normal force per length f_n [N/m], positive pushes outwards.
    pub normal_force: S,
    /// Friction force per length f_t [N/m] on the belt, positive counter-clockwise.
    pub friction_force: S,
    /// Slip velocity v_t [m/s].
    pub slip: S,
    /// Belt velocity in the direction t [m/s].
    pub tangential_velocity: S,
    // For the derivatives.
    by_penetration: S,
    by_rate: S,
    friction_by_slip: S,
    friction_by_normal: S,
    inverse_distance: S,
}

impl<S: Scalar> PointContact<S> {
    /// Contact of a point at `r` moving at `v` with a pulley turning at `speed` [rad/s].
    #[inline(always)]
    fn new<F: FrictionLaw>(
        penalty: &Penalty,
        friction: &F,
        pulley: &ContactPulley,
        speed: f64,
        r: [S; 2],
        v: [S; 2],
    ) -> Self {
        let arm = [r[0] - pulley.center[0], r[1] - pulley.center[1]];
        let distance = (arm[0] * arm[0] + arm[1] * arm[1]).sqrt();
        let inverse_distance = distance.recip();
        let n = [arm[0] * inverse_distance, arm[1] * inverse_distance];
        let penetration = -distance + pulley.radius;
        let rate = -(n[0] * v[0] + n[1] * v[1]);
        let tangential_velocity = n[0] * v[1] - n[1] * v[0];
        let slip = tangential_velocity - speed * pulley.radius;
        let zero = S::zero();
        let touching = |x: S| penetration.select_positive(x, zero);
        let force = penetration * penalty.stiffness + rate * penalty.damping;
        let pushing = |x: S| {
            if penalty.clamp {
                touching(force.select_positive(x, zero))
            } else {
                touching(x)
            }
        };
        let normal_force = pushing(force);
        let developed = friction.develop(slip, normal_force.abs());
        let sign = normal_force.select_positive(S::constant(1.0), S::constant(-1.0));
        Self {
            penetration,
            rate,
            normal: n,
            normal_force,
            friction_force: -touching(developed.force),
            slip,
            tangential_velocity,
            by_penetration: pushing(S::constant(penalty.stiffness)),
            by_rate: pushing(S::constant(penalty.damping)),
            friction_by_slip: -touching(developed.by_slip),
            friction_by_normal: -touching(developed.by_normal) * sign,
            inverse_distance,
        }
    }

    /// Force per length on the belt.
    #[inline(always)]
    pub fn force(&self) -> [S; 2] {
        let ([n0, n1], fn_, ft) = (self.normal, self.normal_force, self.friction_force);
        [fn_ * n0 - ft * n1, fn_ * n1 + ft * n0]
    }

    /// Torque per length on the pulley of the given radius.
    #[inline(always)]
    pub fn torque(&self, radius: f64) -> S {
        -((-self.penetration + radius) * self.friction_force)
    }

    /// Power per length that friction takes [W/m].
    #[inline(always)]
    fn friction_loss(&self, radius: f64, speed: f64) -> S {
        -(self.friction_force * (self.tangential_velocity - (-self.penetration + radius) * speed))
    }

    /// `-(gq d/dr + gv d/dv)` of force and torque, `-gv d/d speed` of both.
    #[inline(always)]
    fn tangent(&self, radius: f64, gq: f64, gv: f64) -> PointTangent<S> {
        let n = self.normal;
        let t = [-n[1], n[0]];
        let (fn_, ft) = (self.normal_force, self.friction_force);
        let per = self.inverse_distance;
        let radial_velocity = -self.rate;
        // gradients by (r, v) combined: gq d/dr + gv d/dv, split into parts along n and t
        let d_n = S::constant(-gq);
        let rate_n = S::constant(-gv);
        let rate_t = -(self.tangential_velocity * per) * gq;
        let slip_t = -(radial_velocity * per) * gq + gv;
        let fn_n = self.by_penetration * d_n + self.by_rate * rate_n;
        let fn_t = self.by_rate * rate_t;
        let ft_n = self.friction_by_normal * fn_n;
        let ft_t = self.friction_by_normal * fn_t + self.friction_by_slip * slip_t;
        // f = fn n + ft t; dn = t (t.dr)/rho, dt = -n (t.dr)/rho
        let turn = per * gq;
        let nn = fn_n;
        let nt = fn_t - ft * turn;
        let tn = ft_n;
        let tt = ft_t + fn_ * turn;
        let matrix =
            |i: usize, j: usize| -(n[i] * (nn * n[j] + nt * t[j]) + t[i] * (tn * n[j] + tt * t[j]));
        let lever = -self.penetration + radius;
        // torque = -(R - d) ft
        let torque_n = ft * d_n - lever * ft_n;
        let torque_t = -(lever * ft_t);
        let slip_by_speed = -radius * gv;
        let ft_by_speed = self.friction_by_slip * slip_by_speed;
        PointTangent {
            force: [[matrix(0, 0), matrix(0, 1)], [matrix(1, 0), matrix(1, 1)]],
            force_by_speed: [-(t[0] * ft_by_speed), -(t[1] * ft_by_speed)],
            torque: [
                -(torque_n * n[0] + torque_t * t[0]),
                -(torque_n * n[1] + torque_t * t[1]),
            ],
            torque_by_speed: lever * ft_by_speed,
        }
    }
}

/// Derivatives of [`PointContact`], signs and factors as the effective matrix wants them.
struct PointTangent<S> {
    force: [[S; 2]; 2],
    force_by_speed: [S; 2],
    torque: [S; 2],
    torque_by_speed: S,
}

/// Shape functions of the centre line at the contact points of an element.
#[derive(Clone, Debug)]
struct Table {
    /// Per batch of points, per vector of the centre line.
    shape: Vec<[[f64; LANES]; MAX_VECTORS]>,
    /// Quadrature weight times length [m]; zero in lanes without a point.
    weight: Vec<[f64; LANES]>,
    length: f64,
}

/// What the belt does to one pulley, summed over the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PulleyContact {
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// Force of the belt on the pulley [N].
    pub hub_force: [f64; 2],
    /// Undeformed length of belt in contact [m].
    pub length: f64,
    /// Mean slip velocity over that length [m/s].
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

/// One integration point of the belt: where it is and what acts on it.
#[derive(Clone, Copy, Debug)]
pub struct BeltPoint {
    /// Element and place in it.
    pub element: usize,
    /// `xi` in `[0, 1]`.
    pub xi: f64,
    /// Quadrature weight times length [m].
    pub weight: f64,
    /// Position [m].
    pub position: [f64; 2],
    /// Velocity [m/s].
    pub velocity: [f64; 2],
    /// The pulley it touches and the contact there.
    pub contact: Option<(usize, PointContact<f64>)>,
}

/// Contact of a closed belt of elements `E` with pulleys under friction law `F`, and the external
/// torques on the pulleys. Pulley `p` turns with rigid coordinate `p`.
#[derive(Clone, Debug)]
pub struct BeltContact<E, F> {
    /// The pulleys.
    pub pulleys: Vec<ContactPulley>,
    /// The friction law.
    pub friction: F,
    penalty: Penalty,
    rule: Rule,
    tables: Vec<Table>,
    /// Table of each element.
    table_of: Vec<usize>,
    /// Element matrix, allocated once.
    local: Vec<f64>,
    element: PhantomData<E>,
}

impl<E: LineElement, F: FrictionLaw> BeltContact<E, F> {
    /// Contact of a belt of `elements` (closed) with `pulleys`, integrated by `rule` along each.
    #[must_use]
    pub fn new(
        elements: &[E],
        pulleys: Vec<ContactPulley>,
        penalty: Penalty,
        friction: F,
        rule: Rule,
    ) -> Self {
        let mut tables: Vec<Table> = Vec::new();
        let mut known: Vec<&E> = Vec::new();
        let table_of = elements
            .iter()
            .map(|element| {
                known
                    .iter()
                    .rposition(|other| *other == element)
                    .unwrap_or_else(|| {
                        known.push(element);
                        tables.push(Table::new(element, &rule));
                        tables.len() - 1
                    })
            })
            .collect();
        Self {
            pulleys,
            friction,
            penalty,
            rule,
            tables,
            table_of,
            local: vec![0.0; E::DOF * E::DOF],
            element: PhantomData,
        }
    }

    /// The same contact under another friction law.
    #[must_use]
    pub fn with_friction<G: FrictionLaw>(self, friction: G) -> BeltContact<E, G> {
        BeltContact {
            pulleys: self.pulleys,
            friction,
            penalty: self.penalty,
            rule: self.rule,
            tables: self.tables,
            table_of: self.table_of,
            local: self.local,
            element: PhantomData,
        }
    }

    fn rotors(&self) -> usize {
        self.table_of.len() * E::NODE_DOF
    }

    /// First coordinate of the node of local vector `vector` of `element`.
    #[inline(always)]
    fn coordinate(&self, element: usize, vector: usize) -> usize {
        let node = if vector < E::NODE_VECTORS {
            element
        } else if element + 1 == self.table_of.len() {
            0
        } else {
            element + 1
        };
        node * E::NODE_DOF + (vector % E::NODE_VECTORS) * 2
    }

    /// Runs `work` for every batch of points of an element that may touch a pulley.
    #[inline(always)]
    fn for_contacts<S: EightLanes>(&self, state: State<'_>, mut work: impl FnMut(&Batch<'_, S>)) {
        let count = E::CENTRE_VECTORS.len();
        let rotors = self.rotors();
        for (element, table) in self.table_of.iter().enumerate() {
            let table = &self.tables[*table];
            let mut at = [0; MAX_VECTORS];
            let mut position = [[0.0; 2]; MAX_VECTORS];
            for (slot, vector) in E::CENTRE_VECTORS.iter().enumerate() {
                at[slot] = self.coordinate(element, *vector);
                position[slot] = [state.q[at[slot]], state.q[at[slot] + 1]];
            }
            let (middle, reach) = hull(&position[..count], table.length);
            for (p, pulley) in self.pulleys.iter().enumerate() {
                let (dx, dy) = (middle[0] - pulley.center[0], middle[1] - pulley.center[1]);
                let limit = pulley.radius + reach;
                if dx * dx + dy * dy >= limit * limit {
                    continue;
                }
                let speed = state.v[rotors + p];
                for (stored, weight) in table.shape.iter().zip(&table.weight) {
                    let mut shape = [S::zero(); MAX_VECTORS];
                    let mut r = [S::zero(); 2];
                    let mut v = [S::zero(); 2];
                    for slot in 0..count {
                        shape[slot] = S::load(&stored[slot]);
                        for axis in 0..2 {
                            r[axis] += shape[slot] * position[slot][axis];
                            v[axis] += shape[slot] * state.v[at[slot] + axis];
                        }
                    }
                    work(&Batch {
                        element,
                        pulley: p,
                        speed,
                        at: &at,
                        shape,
                        weight: S::load(weight),
                        contact: PointContact::new(
                            &self.penalty,
                            &self.friction,
                            pulley,
                            speed,
                            r,
                            v,
                        ),
                    });
                }
            }
        }
    }

    /// Torque, hub force, slip and power on every pulley.
    pub fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]) {
        out.fill(PulleyContact::default());
        dispatch(Resultants {
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

    /// Every integration point along the belt, in order.
    pub fn points(&self, state: State<'_>) -> Vec<BeltPoint> {
        let rotors = self.rotors();
        let mut weights = vec![0.0; E::NODES * E::NODE_VECTORS];
        let mut points = Vec::with_capacity(self.table_of.len() * self.rule.points.len());
        for element in 0..self.table_of.len() {
            let table = &self.tables[self.table_of[element]];
            for (k, xi) in self.rule.points.iter().enumerate() {
                let (batch, lane) = (k / LANES, k % LANES);
                weights.fill(0.0);
                for (slot, vector) in E::CENTRE_VECTORS.iter().enumerate() {
                    weights[*vector] = table.shape[batch][slot][lane];
                }
                let mut position = [0.0; 2];
                let mut velocity = [0.0; 2];
                for vector in E::CENTRE_VECTORS {
                    let at = self.coordinate(element, *vector);
                    for axis in 0..2 {
                        position[axis] += weights[*vector] * state.q[at + axis];
                        velocity[axis] += weights[*vector] * state.v[at + axis];
                    }
                }
                let contact = self.pulleys.iter().enumerate().find_map(|(p, pulley)| {
                    let speed = state.v[rotors + p];
                    let contact = PointContact::new(
                        &self.penalty,
                        &self.friction,
                        pulley,
                        speed,
                        position,
                        velocity,
                    );
                    (contact.penetration > 0.0).then_some((p, contact))
                });
                points.push(BeltPoint {
                    element,
                    xi: *xi,
                    weight: table.weight[batch][lane],
                    position,
                    velocity,
                    contact,
                });
            }
        }
        points
    }
}

/// A batch of points of one element facing one pulley.
struct Batch<'a, S> {
    element: usize,
    pulley: usize,
    speed: f64,
    /// First coordinate of each vector of the centre line.
    at: &'a [usize; MAX_VECTORS],
    shape: [S; MAX_VECTORS],
    weight: S,
    contact: PointContact<S>,
}

/// Centre and radius of a disc that holds the centre line: the hull of its Bézier points for a cubic
/// (r1, r1_x, r2, r2_x), of its ends for a line.
#[inline(always)]
fn hull(vectors: &[[f64; 2]], length: f64) -> ([f64; 2], f64) {
    let cubic = vectors.len() == 4;
    let (first, last) = (vectors[0], vectors[if cubic { 2 } else { 1 }]);
    let middle = [0.5 * (first[0] + last[0]), 0.5 * (first[1] + last[1])];
    let square = |x: f64, y: f64| (x - middle[0]).powi(2) + (y - middle[1]).powi(2);
    let mut reach = square(first[0], first[1]);
    if cubic {
        let third = length / 3.0;
        let (a, b) = (vectors[1], vectors[3]);
        reach = reach
            .max(square(first[0] + third * a[0], first[1] + third * a[1]))
            .max(square(last[0] - third * b[0], last[1] - third * b[1]));
    }
    (middle, reach.sqrt())
}

impl Table {
    fn new<E: LineElement>(element: &E, rule: &Rule) -> Self {
        let batches = rule.points.len().div_ceil(LANES);
        let zero = [0.0; LANES];
        let mut table = Self {
            shape: vec![[zero; MAX_VECTORS]; batches],
            weight: vec![zero; batches],
            length: element.length(),
        };
        let mut weights = vec![0.0; E::NODES * E::NODE_VECTORS];
        for lane in 0..batches * LANES {
            // lanes without a point repeat the last one with weight zero
            let k = lane.min(rule.points.len() - 1);
            element.centre_line(rule.points[k], &mut weights);
            let (batch, lane_of) = (lane / LANES, lane % LANES);
            for (slot, vector) in E::CENTRE_VECTORS.iter().enumerate() {
                table.shape[batch][slot][lane_of] = weights[*vector];
            }
            if lane < rule.points.len() {
                table.weight[batch][lane_of] = rule.weights[k] * element.length();
            }
        }
        table
    }
}

impl<E: LineElement, F: FrictionLaw> ForceLaw for BeltContact<E, F> {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        dispatch(AddForce {
            contact: self,
            state,
            force,
        });
        let rotors = self.rotors();
        for (p, pulley) in self.pulleys.iter().enumerate() {
            force[rotors + p] += pulley.torque.value(state.time);
        }
    }

    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        let mut local = std::mem::take(&mut self.local);
        dispatch(AddTangent {
            contact: self,
            state,
            position_factor,
            velocity_factor,
            local: &mut local,
            matrix,
        });
        self.local = local;
    }
}

/// The sum over the lanes.
#[inline(always)]
fn sum<S: EightLanes>(x: S) -> f64 {
    let [a, b, c, d, e, f, g, h] = x.store();
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// The work of [`BeltContact::resultants`].
struct Resultants<'a, E, F> {
    contact: &'a BeltContact<E, F>,
    state: State<'a>,
    out: &'a mut [PulleyContact],
}

impl<E: LineElement, F: FrictionLaw> LaneKernel for Resultants<'_, E, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, out) = (self.contact, self.out);
        this.for_contacts::<S>(
            self.state,
            #[inline(always)]
            |batch| {
                let radius = this.pulleys[batch.pulley].radius;
                let contact = &batch.contact;
                let weight = contact.penetration.select_positive(batch.weight, S::zero());
                let total = &mut out[batch.pulley];
                let force = contact.force();
                total.torque += sum(contact.torque(radius) * weight);
                total.hub_force[0] -= sum(force[0] * weight);
                total.hub_force[1] -= sum(force[1] * weight);
                total.length += sum(weight);
                total.slip_speed += sum(contact.slip * weight);
                total.friction_loss += sum(contact.friction_loss(radius, batch.speed) * weight);
                let elastic = contact.penetration * this.penalty.stiffness;
                total.contact_loss += sum((contact.normal_force - elastic) * contact.rate * weight);
                total.stored_energy += sum(elastic * contact.penetration * 0.5 * weight);
                let deepest = weight.select_positive(contact.penetration, S::zero());
                for penetration in deepest.store() {
                    total.penetration = total.penetration.max(penetration);
                }
            },
        );
    }
}

/// The work of [`ForceLaw::add_force`].
struct AddForce<'a, E, F> {
    contact: &'a BeltContact<E, F>,
    state: State<'a>,
    force: &'a mut [f64],
}

impl<E: LineElement, F: FrictionLaw> LaneKernel for AddForce<'_, E, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, force) = (self.contact, self.force);
        let rotors = this.rotors();
        this.for_contacts::<S>(
            self.state,
            #[inline(always)]
            |batch| {
                let f = batch.contact.force();
                let torque = batch.contact.torque(this.pulleys[batch.pulley].radius);
                force[rotors + batch.pulley] += sum(torque * batch.weight);
                let weighted = [f[0] * batch.weight, f[1] * batch.weight];
                for slot in 0..E::CENTRE_VECTORS.len() {
                    for axis in 0..2 {
                        force[batch.at[slot] + axis] += sum(batch.shape[slot] * weighted[axis]);
                    }
                }
            },
        );
    }
}

/// The work of [`ForceLaw::add_tangent`].
struct AddTangent<'a, E, F> {
    contact: &'a BeltContact<E, F>,
    state: State<'a>,
    position_factor: f64,
    velocity_factor: f64,
    /// Element matrix.
    local: &'a mut [f64],
    matrix: &'a mut BorderedMatrix,
}

impl<E: LineElement, F: FrictionLaw> LaneKernel for AddTangent<'_, E, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let Self {
            contact: this,
            state,
            position_factor,
            velocity_factor,
            local,
            matrix,
        } = self;
        let (dof, vectors) = (E::DOF, E::CENTRE_VECTORS);
        this.for_contacts::<S>(
            state,
            #[inline(always)]
            |batch| {
                if batch.contact.penetration.store().iter().all(|d| *d <= 0.0) {
                    return;
                }
                let radius = this.pulleys[batch.pulley].radius;
                let tangent = batch
                    .contact
                    .tangent(radius, position_factor, velocity_factor);
                local.fill(0.0);
                for (a, row) in vectors.iter().enumerate() {
                    let weighted = batch.shape[a] * batch.weight;
                    let left: [[S; 2]; 2] = std::array::from_fn(|i| {
                        std::array::from_fn(|j| tangent.force[i][j] * weighted)
                    });
                    for (b, column) in vectors.iter().enumerate() {
                        let at = 2 * row * dof + 2 * column;
                        local[at] = sum(left[0][0] * batch.shape[b]);
                        local[at + 1] = sum(left[0][1] * batch.shape[b]);
                        local[at + dof] = sum(left[1][0] * batch.shape[b]);
                        local[at + dof + 1] = sum(left[1][1] * batch.shape[b]);
                    }
                    let column: [f64; 2] =
                        std::array::from_fn(|i| sum(tangent.force_by_speed[i] * weighted));
                    let torque: [f64; 2] =
                        std::array::from_fn(|i| sum(tangent.torque[i] * weighted));
                    matrix.add_border_column(batch.pulley, batch.at[a], &column);
                    matrix.add_border_row(batch.pulley, batch.at[a], &torque);
                }
                matrix.add_pair(batch.element, 1.0, local);
                matrix.add_corner(
                    batch.pulley,
                    batch.pulley,
                    sum(tangent.torque_by_speed * batch.weight),
                );
            },
        );
    }
}
