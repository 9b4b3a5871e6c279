//! The loops over batches of contact points, compiled for SIMD registers.

use ancf::linear::BorderedMatrix;
use ancf::scalar::{EightLanes, LaneKernel, Lanes};
use ancf::system::State;

use super::memory::Bristles;
use super::point::{Meeting, PointContact};
use super::table::{BatchTable, LANES, MAX_VECTORS};
use super::{BeltContact, PulleyContact};
use crate::friction::FrictionLaw;

/// A batch of points of one element facing one pulley.
struct Batch<'a, S> {
    element: usize,
    /// Index among all batches of the belt.
    index: usize,
    pulley: usize,
    speed: f64,
    /// First coordinate of each vector of the contact line.
    at: &'a [usize; MAX_VECTORS],
    table: &'a BatchTable,
    contact: PointContact<S>,
}

impl<S: EightLanes> Batch<'_, S> {
    #[inline(always)]
    fn weight(&self) -> S {
        S::load(&self.table.weight)
    }
}

/// Discs that hold eight consecutive elements at `places`, the last one repeated where there are fewer.
#[inline(always)]
fn hulls<S: EightLanes>(
    contact: &BeltContact,
    places: &[[usize; MAX_VECTORS]],
    third: &Lanes<LANES>,
    q: &[f64],
) -> ([S; 2], S) {
    let count = contact.line.vectors.len();
    let mut lanes = [[[0.0; LANES]; 2]; MAX_VECTORS];
    for lane in 0..LANES {
        let at = &places[lane.min(places.len() - 1)];
        for slot in 0..count {
            for axis in 0..2 {
                lanes[slot][axis][lane] = q[at[slot] + axis];
            }
        }
    }
    let mut vectors = [[S::zero(); 2]; MAX_VECTORS];
    for slot in 0..count {
        for axis in 0..2 {
            vectors[slot][axis] = S::load(&lanes[slot][axis]);
        }
    }
    (contact.line).hull(S::load(&third.0), contact.highest, &vectors)
}

/// Runs `work` for every batch of points of an element of which one is inside of a pulley.
#[inline(always)]
fn for_contacts<S: EightLanes>(
    contact: &BeltContact,
    state: State<'_>,
    mut work: impl FnMut(&Batch<'_, S>),
) {
    let count = contact.line.vectors.len();
    let rotors = contact.rotors();
    let batches = contact.batches();
    let groups = contact.places.chunks(LANES).zip(&contact.thirds);
    for (group, (places, third)) in groups.enumerate() {
        let (middle, reach) = hulls::<S>(contact, places, third, state.q);
        for (p, pulley) in contact.pulleys.iter().enumerate() {
            let [center, drift] = pulley.hub(state.time);
            let arm = [middle[0] - center[0], middle[1] - center[1]];
            let limit = reach + pulley.radius;
            let near = limit * limit - (arm[0] * arm[0] + arm[1] * arm[1]);
            if !near.any_positive() {
                continue;
            }
            let near = near.store();
            let speed = state.v[rotors + p];
            for (lane, at) in places.iter().enumerate() {
                if near[lane] <= 0.0 {
                    continue;
                }
                let element = group * LANES + lane;
                let table = contact.table(element, contact.line_of[p]);
                for (k, table) in table.batches.iter().enumerate() {
                    let mut r = [S::zero(); 2];
                    for slot in 0..count {
                        let shape = S::load(&table.shape[slot].0);
                        for axis in 0..2 {
                            r[axis] += shape * state.q[at[slot] + axis];
                        }
                    }
                    let arm = [r[0] - center[0], r[1] - center[1]];
                    let outside = arm[0] * arm[0] + arm[1] * arm[1] - pulley.radius * pulley.radius;
                    if !(-outside).any_positive() {
                        continue;
                    }
                    let mut v = drift.map(
                        #[inline(always)]
                        |x| S::constant(0.0 - x),
                    );
                    for slot in 0..count {
                        let shape = S::load(&table.shape[slot].0);
                        for axis in 0..2 {
                            v[axis] += shape * state.v[at[slot] + axis];
                        }
                    }
                    let index = element * batches + k;
                    let anchor = contact
                        .bristles
                        .get(index)
                        .filter(|_| pulley.friction.has_memory())
                        .map(|bristles| turned(bristles, p, state.q[rotors + p]));
                    let meeting = Meeting {
                        r,
                        v,
                        center,
                        speed,
                        anchor,
                    };
                    work(&Batch {
                        element,
                        index,
                        pulley: p,
                        speed,
                        at,
                        table,
                        contact: PointContact::new(&contact.penalty, pulley, &meeting),
                    });
                }
            }
        }
    }
}

/// Where the bristles of a batch stand on `pulley` in global axes; zero for points without one.
#[inline(always)]
fn turned<S: EightLanes>(bristles: &Bristles, pulley: usize, angle: f64) -> [S; 2] {
    let (s, c) = angle.sin_cos();
    let stands = S::load(&bristles.stands_on(pulley));
    let (x, y) = (S::load(&bristles.x) * stands, S::load(&bristles.y) * stands);
    [x * c - y * s, x * s + y * c]
}

/// The sum over the lanes.
#[inline(always)]
fn sum<S: EightLanes>(x: S) -> f64 {
    let [a, b, c, d, e, f, g, h] = x.store();
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// `sum over lanes of factor[lane] * values[lane]`, in two sums that do not wait for each other.
#[inline(always)]
fn contract<S: EightLanes>(factor: S, values: &[Lanes<LANES>; LANES]) -> [f64; LANES] {
    let factor = factor.store();
    let mut sums = [
        S::load(&values[0].0) * factor[0],
        S::load(&values[1].0) * factor[1],
    ];
    for lane in 2..LANES {
        sums[lane % 2] += S::load(&values[lane].0) * factor[lane];
    }
    (sums[0] + sums[1]).store()
}

/// The work of [`BeltContact::resultants`].
pub(super) struct Resultants<'a> {
    pub contact: &'a BeltContact,
    pub state: State<'a>,
    pub out: &'a mut [PulleyContact],
}

impl LaneKernel for Resultants<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, out) = (self.contact, self.out);
        // Elements on one pulley follow one another: lanes are summed where the pulley changes.
        let mut sums = Sums::<S>::zero();
        let mut pulley = 0;
        for_contacts::<S>(
            this,
            self.state,
            #[inline(always)]
            |batch| {
                if batch.pulley != pulley {
                    sums.add_to(&mut out[pulley]);
                    sums = Sums::zero();
                    pulley = batch.pulley;
                }
                sums.add(batch, this.pulleys[pulley].radius, this.penalty.stiffness);
            },
        );
        if let Some(total) = out.get_mut(pulley) {
            sums.add_to(total);
        }
    }
}

/// What [`PulleyContact`] sums, by lane.
struct Sums<S> {
    torque: S,
    hub_force: [S; 2],
    length: S,
    slip: S,
    penetration: S,
    friction_loss: S,
    contact_loss: S,
    stored_energy: S,
}

impl<S: EightLanes> Sums<S> {
    #[inline(always)]
    fn zero() -> Self {
        let zero = S::zero();
        Self {
            torque: zero,
            hub_force: [zero; 2],
            length: zero,
            slip: zero,
            penetration: zero,
            friction_loss: zero,
            contact_loss: zero,
            stored_energy: zero,
        }
    }

    #[inline(always)]
    fn add(&mut self, batch: &Batch<'_, S>, radius: f64, stiffness: f64) {
        let contact = &batch.contact;
        let depth = contact.penetration;
        let weight = depth.select_positive(batch.weight(), S::zero());
        let force = contact.force();
        self.torque += contact.torque(radius) * weight;
        self.hub_force[0] -= force[0] * weight;
        self.hub_force[1] -= force[1] * weight;
        self.length += weight;
        self.slip += contact.slip * weight;
        self.friction_loss += contact.friction_loss(radius, batch.speed) * weight;
        let elastic = depth * stiffness;
        self.contact_loss += (contact.normal_force - elastic) * contact.rate * weight;
        self.stored_energy += elastic * depth * 0.5 * weight;
        let deepest = weight.select_positive(depth, S::zero());
        self.penetration = (deepest - self.penetration).select_positive(deepest, self.penetration);
    }

    #[inline(always)]
    fn add_to(&self, total: &mut PulleyContact) {
        total.torque += sum(self.torque);
        total.hub_force[0] += sum(self.hub_force[0]);
        total.hub_force[1] += sum(self.hub_force[1]);
        total.length += sum(self.length);
        total.slip_speed += sum(self.slip);
        total.friction_loss += sum(self.friction_loss);
        total.contact_loss += sum(self.contact_loss);
        total.stored_energy += sum(self.stored_energy);
        for penetration in self.penetration.store() {
            total.penetration = total.penetration.max(penetration);
        }
    }
}

/// The work of `add_force`.
pub(super) struct AddForce<'a> {
    pub contact: &'a BeltContact,
    pub state: State<'a>,
    pub force: &'a mut [f64],
}

impl LaneKernel for AddForce<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, force) = (self.contact, self.force);
        let rotors = this.rotors();
        let count = this.line.vectors.len();
        for_contacts::<S>(
            this,
            self.state,
            #[inline(always)]
            |batch| {
                let weight = batch.weight();
                let f = batch.contact.force();
                let torque = batch.contact.torque(this.pulleys[batch.pulley].radius);
                force[rotors + batch.pulley] += sum(torque * weight);
                let x = contract(f[0] * weight, &batch.table.by_lane);
                let y = contract(f[1] * weight, &batch.table.by_lane);
                for slot in 0..count {
                    force[batch.at[slot]] += x[slot];
                    force[batch.at[slot] + 1] += y[slot];
                }
            },
        );
    }
}

/// The work of `add_tangent`.
pub(super) struct AddTangent<'a> {
    pub contact: &'a BeltContact,
    pub state: State<'a>,
    pub position_factor: f64,
    pub velocity_factor: f64,
    pub matrix: &'a mut BorderedMatrix,
}

impl LaneKernel for AddTangent<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let Self {
            contact: this,
            state,
            position_factor,
            velocity_factor,
            matrix,
        } = self;
        let count = this.line.vectors.len();
        let pairs = &this.line.pairs;
        for_contacts::<S>(
            this,
            state,
            #[inline(always)]
            |batch| {
                let weight = batch.weight();
                let radius = this.pulleys[batch.pulley].radius;
                let tangent = batch
                    .contact
                    .tangent(radius, position_factor, velocity_factor);
                let [xx, xy, yx, yy] = tangent.force;
                let mut pairs = pairs.iter();
                for products in &batch.table.products {
                    let blocks = [xx, xy, yx, yy].map(
                        #[inline(always)]
                        |entry| contract(entry * weight, products),
                    );
                    for (k, [row, column]) in pairs.by_ref().take(LANES).enumerate() {
                        let values = [[blocks[0][k], blocks[1][k]], [blocks[2][k], blocks[3][k]]];
                        let at = [2 * row, 2 * column];
                        matrix.add_pair_square(batch.element, at, values);
                        if row != column {
                            matrix.add_pair_square(batch.element, [at[1], at[0]], values);
                        }
                    }
                }
                let [fx, fy] = tangent.force_by_pulley;
                let [tx, ty] = tangent.torque;
                let [fx, fy, tx, ty] = [fx, fy, tx, ty].map(
                    #[inline(always)]
                    |entry| contract(entry * weight, &batch.table.by_lane),
                );
                for (slot, at) in batch.at[..count].iter().enumerate() {
                    matrix.add_border_column(batch.pulley, *at, &[fx[slot], fy[slot]]);
                    matrix.add_border_row(batch.pulley, *at, &[tx[slot], ty[slot]]);
                }
                matrix.add_corner(
                    batch.pulley,
                    batch.pulley,
                    sum(tangent.torque_by_pulley * weight),
                );
            },
        );
    }
}

/// The work of `accept`: points in contact keep or get a bristle, bent no further than it sticks.
pub(super) struct Accept<'a> {
    pub contact: &'a BeltContact,
    pub state: State<'a>,
    pub next: &'a mut [Bristles],
}

impl LaneKernel for Accept<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, next) = (self.contact, self.next);
        let rotors = this.rotors();
        for_contacts::<S>(
            this,
            self.state,
            #[inline(always)]
            |batch| {
                let pulley = &this.pulleys[batch.pulley];
                let (s, c) = self.state.q[rotors + batch.pulley].sin_cos();
                let contact = &batch.contact;
                let [n0, n1] = contact.normal.map(S::store);
                let penetration = contact.penetration.store();
                let displacement = contact.displacement.store();
                let normal_force = contact.normal_force.store();
                let old = &this.bristles[batch.index];
                let stands = old.stands_on(batch.pulley);
                let new = &mut next[batch.index];
                for lane in 0..LANES {
                    let Some(limit) = pulley.friction.elastic_limit(normal_force[lane].abs())
                    else {
                        continue;
                    };
                    if penetration[lane] <= 0.0 {
                        continue;
                    }
                    new.pulley[lane] = batch.pulley;
                    if stands[lane] > 0.0 && displacement[lane].abs() <= limit {
                        (new.x[lane], new.y[lane]) = (old.x[lane], old.y[lane]);
                        continue;
                    }
                    // sin of the angle by which the bristle lags the point
                    let bent = displacement[lane].clamp(-limit, limit) / pulley.radius;
                    let level = (1.0 - bent * bent).max(0.0).sqrt();
                    let (x, y) = (
                        n0[lane] * level + n1[lane] * bent,
                        n1[lane] * level - n0[lane] * bent,
                    );
                    (new.x[lane], new.y[lane]) = (c * x + s * y, c * y - s * x);
                }
            },
        );
    }
}
