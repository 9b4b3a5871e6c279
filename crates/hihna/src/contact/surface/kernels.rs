//! The loops over batches of contact points of a surface, compiled for SIMD registers.

use ancf::linear::BorderedMatrix;
use ancf::scalar::{EightLanes, LaneKernel};
use ancf::system::State;

use super::SurfaceContact;
use super::meridian::Meridian;
use super::point::{Meeting, SurfacePoint, across};
use super::table::{Batch, LANES, VECTORS};
use crate::contact::PulleyContact;

/// Batches of an element whose tangents are summed together.
const GROUP: usize = 16;

/// A batch of points of one element that touches one pulley.
struct Touch<'a, S> {
    pulley: usize,
    table: &'a Batch,
    at: &'a [usize; VECTORS],
    /// Position of the points from the pulley's centre.
    arm: [S; 3],
    contact: SurfacePoint<S>,
}

impl<S: EightLanes> Touch<'_, S> {
    #[inline(always)]
    fn area(&self) -> S {
        S::load(&self.table.area)
    }
}

/// Sum of the shape functions of a batch times vectors of `x`.
#[inline(always)]
fn interpolate<S: EightLanes>(
    table: &Batch,
    at: &[usize; VECTORS],
    count: usize,
    x: &[f64],
    mut sum: [S; 3],
) -> [S; 3] {
    for slot in 0..count {
        let shape = S::load(&table.shape[slot]);
        for axis in 0..3 {
            sum[axis] += shape * x[at[slot] + axis];
        }
    }
    sum
}

#[inline(always)]
fn less<S: EightLanes>(a: [S; 3], b: [f64; 3]) -> [S; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Whether any of the points at `arm` from the centre lies inside the surface `meridian` about `axis`.
#[inline(always)]
fn reaches<S: EightLanes>(meridian: &Meridian, axis: [f64; 3], arm: [S; 3]) -> bool {
    let (along, radial) = across(arm, axis);
    let square = radial[0] * radial[0] + radial[1] * radial[1] + radial[2] * radial[2];
    let radius = meridian.radius_at(along);
    (radius * radius - square).store().iter().any(|d| *d > 0.0)
}

/// Runs `work` for the batches of `element` that touch a pulley; they are some of its face number `face`.
#[inline(always)]
fn for_touches<S: EightLanes>(
    this: &SurfaceContact,
    state: State<'_>,
    (element, face): (usize, usize),
    batches: &[Batch],
    mut work: impl FnMut(&Touch<'_, S>),
) {
    let at = &this.coordinates[element];
    let count = this.vectors;
    for table in batches {
        let r = interpolate(table, at, count, state.q, [S::zero(); 3]);
        let mut velocity = None;
        for (p, pulley) in this.pulleys.iter().enumerate() {
            if this.face_of[p] != face {
                continue;
            }
            let [center, drift] = pulley.hub(state.time);
            let arm = less(r, center);
            let meridian = pulley.meridian(table.side, this.penalty.slip_lever_part);
            if !reaches(&meridian, pulley.axis, arm) {
                continue;
            }
            let v = match velocity {
                Some(v) => v,
                None => interpolate(table, at, count, state.v, [S::zero(); 3]),
            };
            velocity = Some(v);
            let meeting = Meeting {
                arm,
                v: less(v, drift),
                speed: S::constant(state.v[this.chain + p]),
            };
            work(&Touch {
                pulley: p,
                table,
                at,
                arm,
                contact: SurfacePoint::new(
                    &this.penalty,
                    (pulley, meridian),
                    this.directions,
                    &meeting,
                ),
            });
        }
    }
}

/// The sum over the lanes.
#[inline(always)]
fn sum<S: EightLanes>(x: S) -> f64 {
    let [a, b, c, d, e, f, g, h] = x.store();
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// `sum over lanes of factor[lane] * values[lane]`.
#[inline(always)]
fn contract(factor: &[f64; LANES], values: &[[f64; VECTORS]; LANES]) -> [f64; VECTORS] {
    let mut out = [0.0; VECTORS];
    for lane in 0..LANES {
        for i in 0..VECTORS {
            out[i] += factor[lane] * values[lane][i];
        }
    }
    out
}

/// The work of [`SurfaceContact::resultants`].
pub(super) struct Resultants<'a> {
    pub contact: &'a SurfaceContact,
    pub state: State<'a>,
    pub out: &'a mut [PulleyContact],
}

impl LaneKernel for Resultants<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, out) = (self.contact, self.out);
        for place in this.places() {
            for_touches::<S>(
                this,
                self.state,
                place,
                &this.table(place.0, place.1).batches,
                #[inline(always)]
                |touch| add_resultants(this, touch, &mut out[touch.pulley]),
            );
        }
    }
}

#[inline(always)]
fn add_resultants<S: EightLanes>(
    this: &SurfaceContact,
    touch: &Touch<'_, S>,
    total: &mut PulleyContact,
) {
    let contact = &touch.contact;
    let pulley = &this.pulleys[touch.pulley];
    let area = contact.penetration.select_positive(touch.area(), S::zero());
    let [x, y, z] = contact.force(pulley);
    let [ax, ay, az] = touch.arm;
    total.torque += sum(contact.torque() * area);
    total.hub_force[0] -= sum(x * area);
    total.hub_force[1] -= sum(y * area);
    total.lateral.hub_force -= sum(z * area);
    let moment = &mut total.lateral.hub_moment;
    moment[0] -= sum((ay * z - az * y) * area);
    moment[1] -= sum((az * x - ax * z) * area);
    moment[2] -= sum((ax * y - ay * x) * area);
    total.lateral.belt_offset += sum(contact.along * area);
    total.length += sum(area);
    total.slip_speed += sum(contact.slip[0] * area);
    total.friction_loss += sum(contact.friction_loss() * area);
    let elastic = contact.penetration * this.penalty.stiffness;
    total.contact_loss += sum((contact.normal_force - elastic) * contact.rate * area);
    total.stored_energy += sum(elastic * contact.penetration * 0.5 * area);
    let deepest = area.select_positive(contact.penetration, S::zero());
    for penetration in deepest.store() {
        total.penetration = total.penetration.max(penetration);
    }
}

/// The work of `add_force`.
pub(super) struct AddForce<'a> {
    pub contact: &'a SurfaceContact,
    pub state: State<'a>,
    pub force: &'a mut [f64],
}

impl LaneKernel for AddForce<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let (this, force) = (self.contact, self.force);
        for place in this.places() {
            for_touches::<S>(
                this,
                self.state,
                place,
                &this.table(place.0, place.1).batches,
                #[inline(always)]
                |touch| {
                    let area = touch.area();
                    let f = touch.contact.force(&this.pulleys[touch.pulley]);
                    force[this.chain + touch.pulley] += sum(touch.contact.torque() * area);
                    for axis in 0..3 {
                        let sums = contract(&(f[axis] * area).store(), &touch.table.by_lane);
                        for slot in 0..this.vectors {
                            force[touch.at[slot] + axis] += sums[slot];
                        }
                    }
                },
            );
        }
    }
}

/// The work of `add_tangent`.
pub(super) struct AddTangent<'a> {
    pub contact: &'a SurfaceContact,
    pub state: State<'a>,
    /// Factors of the derivatives by position and velocity.
    pub factors: [f64; 2],
    /// Element matrix.
    pub local: &'a mut [f64],
    pub matrix: &'a mut BorderedMatrix,
}

impl LaneKernel for AddTangent<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let Self {
            contact: this,
            state,
            factors: [gq, gv],
            local,
            matrix,
        } = self;
        for element in 0..this.kind_of.len() {
            local.fill(0.0);
            let mut touched = false;
            let groups = (0..this.faces).flat_map(|face| {
                let groups = this.table(element, face).batches.chunks(GROUP);
                groups.map(move |group| (face, group))
            });
            for (face, group) in groups {
                // A batch between two pulleys may touch both: the blocks of both are summed.
                let mut blocks = [[S::zero(); 9]; GROUP];
                let mut tables: [Option<&Batch>; GROUP] = [None; GROUP];
                let mut count = 0;
                for_touches::<S>(
                    this,
                    state,
                    (element, face),
                    group,
                    #[inline(always)]
                    |touch| {
                        let area = touch.area();
                        let pulley = &this.pulleys[touch.pulley];
                        let tangent = touch.contact.tangent(pulley, gq, gv);
                        let again = count > 0
                            && tables[count - 1]
                                .is_some_and(|table| std::ptr::eq(table, touch.table));
                        if !again {
                            tables[count] = group.iter().find(|t| std::ptr::eq(*t, touch.table));
                            count += 1;
                        }
                        for (sum, value) in blocks[count - 1].iter_mut().zip(tangent.force) {
                            *sum += value * area;
                        }
                        let by_lane = &touch.table.by_lane;
                        let mut column = [[0.0; VECTORS]; 3];
                        let mut row = [[0.0; VECTORS]; 3];
                        for axis in 0..3 {
                            let weighted = (tangent.force_by_pulley[axis] * area).store();
                            column[axis] = contract(&weighted, by_lane);
                            row[axis] = contract(&(tangent.torque[axis] * area).store(), by_lane);
                        }
                        let p = touch.pulley;
                        for slot in 0..this.vectors {
                            let at = touch.at[slot];
                            matrix.add_border_column(p, at, &column.map(|axis| axis[slot]));
                            matrix.add_border_row(p, at, &row.map(|axis| axis[slot]));
                        }
                        matrix.add_corner(p, p, sum(tangent.torque_by_pulley * area));
                    },
                );
                if count > 0 {
                    touched = true;
                    add_products(this.vectors, &tables[..count], &blocks[..count], local);
                }
            }
            if touched {
                scatter(this, element, local, matrix);
            }
        }
    }
}

/// Adds `sum over points of S_a S_b B` of the 3 x 3 blocks B to the element matrix, all pairs of vectors.
#[inline(always)]
fn add_products<S: EightLanes>(
    vectors: usize,
    tables: &[Option<&Batch>],
    blocks: &[[S; 9]],
    local: &mut [f64],
) {
    let dof = 3 * vectors;
    let count = blocks.len();
    let mut shapes = [[S::zero(); GROUP]; VECTORS];
    for (k, table) in tables.iter().flatten().enumerate() {
        for (shape, values) in shapes.iter_mut().zip(&table.shape) {
            shape[k] = S::load(values);
        }
    }
    for entry in 0..9 {
        let (i, j) = (entry / 3, entry % 3);
        for a in 0..vectors {
            let mut scaled = [S::zero(); GROUP];
            for k in 0..count {
                scaled[k] = shapes[a][k] * blocks[k][entry];
            }
            for b in a..vectors {
                let mut product = S::zero();
                for k in 0..count {
                    product += scaled[k] * shapes[b][k];
                }
                let value = sum(product);
                local[(3 * a + i) * dof + 3 * b + j] += value;
                if a != b {
                    local[(3 * b + i) * dof + 3 * a + j] += value;
                }
            }
        }
    }
}

/// Adds the element matrix, node by node.
#[inline(always)]
fn scatter(this: &SurfaceContact, element: usize, local: &[f64], matrix: &mut BorderedMatrix) {
    let at = &this.coordinates[element];
    let dof = 3 * this.vectors;
    let size = 3 * this.node_vectors;
    for row in (0..this.vectors).step_by(this.node_vectors) {
        for column in (0..this.vectors).step_by(this.node_vectors) {
            let values = &local[3 * row * dof + 3 * column..];
            matrix.add_square([at[row], at[column]], size, 1.0, values, dof);
        }
    }
}
