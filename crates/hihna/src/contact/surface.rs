//! Contact between the surface of a belt in space and pulleys (Kerkkänen 2006, 4.43-4.45).
//!
//! With the pulley's centre O, the unit vector p of its axis, its speed omega and its radius `R(s)` at the
//! place `s` along the axis, `r` a point of the belt and r' its velocity against O:
//!
//! ```text
//! s = (r - O).p     rho n = (r - O) - s p,  |n| = 1     t = p x n                 (4.44)
//! d = R(s) - rho    d' = R' v_p - v_n                   contact where d > 0       (4.45)
//! f_n = k_p d + c_p d'       v_t = t.r' - omega L       v_a = a.r'
//! m = n - R' p               a = p + R' n               (R' = dR/ds)
//! f   = f_n m + f_t t + f_a a     on the belt, per undeformed area                (4.43)
//! T   = -rho f_t                  torque on the pulley about p, per undeformed area
//! L   = R, as published, or rho, where friction acts
//! ```
//!
//! Friction is `f_t = -friction(v_t, |f_n|)`, `f_a = 0` around the pulley only, as published, or against the
//! slip velocity, `(f_t, f_a) = -friction(|v|, |f_n|) (v_t, v_a)/|v|`: Coulomb's disc. On a tapered or crowned
//! pulley d is measured at right angles to the axis and k_p acts on that, so that the force has the potential
//! `k_p d²/2` exactly; m and a are then longer than one by `R'²/2`.
//!
//! The flanks of a V-belt meet the walls of a groove, cones with the slope `R' = ±cot(groove angle / 2)`. There depth
//! and directions are those at right angles to the wall and along it: with `c = sin(groove angle / 2)`
//!
//! ```text
//! d = c (R(s) - rho)    m = c (n - R' p)    a = c (p + R' n)    v_t = t.r' - omega rho
//! ```
//!
//! so that friction acts between points of belt and wall in one place, `v_a` is the slip up or down the flank, and
//! wedging is what the forces do.
//!
//! Energy per area and time: friction takes `-f_t (t.r' - omega rho) - f_a v_a`, the damper
//! `(f_n - k_p d) d'`.
//!
//! The law reads positions at given points of any element as sums over its vectors, so it serves plates and
//! spatial beams alike. Derivatives are in the head of `point.rs`.

mod face;
mod kernels;
mod meridian;
mod point;
mod table;

#[cfg(test)]
mod tests;

use ancf::element::{Element, LineElement, SurfaceElement};
use ancf::linear::BorderedMatrix;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::scalar::dispatch;
use ancf::system::{ForceLaw, State};

use super::{Penalty, PulleyContact};
use crate::drive::{Displacement, FrictionDirections};
use crate::friction::Law;
use crate::load::ExternalTorque;
pub use face::Face;
pub use meridian::Groove;
use meridian::{Meridian, Side};
use point::{Meeting, SurfacePoint};
use table::{Table, VECTORS};

/// A pulley as the contact of a surface sees it.
#[derive(Clone, Debug)]
pub struct SurfacePulley {
    /// Centre O at time zero [m].
    pub center: [f64; 3],
    /// Motion of the centre from there.
    pub displacement: Option<Displacement>,
    /// Unit vector p of the axis.
    pub axis: [f64; 3],
    /// Radius in the middle [m].
    pub radius: f64,
    /// Slope R' of the radius in the middle [-].
    pub slope: f64,
    /// Its decrease along the axis, -R'' [1/m].
    pub curvature: f64,
    /// The groove of a V-belt's pulley, which the belt's flanks touch.
    pub groove: Option<Groove>,
    /// Friction of its surface.
    pub friction: Law,
    /// Torque from outside of the drive.
    pub external: ExternalTorque,
}

impl SurfacePulley {
    /// The surface that the points on one side of the belt's section meet.
    #[inline(always)]
    fn meridian(&self, side: Side, lever_part: f64) -> Meridian {
        match (side, &self.groove) {
            (Side::Flank(flank), Some(groove)) => groove.wall(self.radius, flank),
            _ => Meridian {
                radius: self.radius,
                slope: self.slope,
                curvature: self.curvature,
                unit: 1.0,
                lever_part,
            },
        }
    }

    /// Centre O [m] and its velocity [m/s] at `time` [s].
    #[inline]
    pub fn hub(&self, time: f64) -> [[f64; 3]; 2] {
        let Some(displacement) = &self.displacement else {
            return [self.center, [0.0; 3]];
        };
        let [moved, velocity] = displacement.at(time);
        [std::array::from_fn(|i| self.center[i] + moved[i]), velocity]
    }
}

/// What happens at one point of a belt's surface that touches a pulley.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceTouch {
    /// The pulley.
    pub pulley: usize,
    /// Penetration d [m].
    pub penetration: f64,
    /// Place along the pulley's axis, from its middle [m].
    pub along: f64,
    /// Unit vector n, from the axis to the point.
    pub normal: [f64; 3],
    /// Unit vector t.
    pub around: [f64; 3],
    /// f_n [N/m²].
    pub normal_force: f64,
    /// f_t and f_a [N/m²].
    pub friction: [f64; 2],
    /// v_t and v_a [m/s].
    pub slip: [f64; 2],
    /// Whether friction is exhausted.
    pub slides: bool,
}

/// Contact of a belt's surface with pulleys, and the external torques on the pulleys. Pulley `p` turns with
/// rigid coordinate `p`.
#[derive(Clone, Debug)]
pub struct SurfaceContact {
    /// The pulleys.
    pub pulleys: Vec<SurfacePulley>,
    /// The line along the belt that profiles show: 0 for the edge y = 0 (of beams that of the lesser z), 1 for the other.
    pub line: f64,
    /// Width of a belt of beams, at its centre line [m].
    pub width: f64,
    penalty: Penalty,
    directions: FrictionDirections,
    rule: Rule,
    /// Which face of the belt touches each pulley.
    face_of: Vec<usize>,
    faces: usize,
    /// Tables by kind of element, face by face.
    tables: Vec<Table>,
    /// Kind of each element.
    kind_of: Vec<usize>,
    /// First coordinate of each vector of each element.
    coordinates: Vec<[usize; VECTORS]>,
    /// Vectors of an element, and of a node.
    vectors: usize,
    node_vectors: usize,
    /// Coordinates of the belt.
    chain: usize,
    /// Element matrix, allocated once.
    local: Vec<f64>,
}

impl SurfaceContact {
    /// Contact of a strip of the elements of `mesh` with `pulleys`, by `rule` along and across each element.
    #[must_use]
    pub fn new<E: SurfaceElement>(
        mesh: &Mesh<E>,
        pulleys: Vec<SurfacePulley>,
        penalty: Penalty,
        directions: FrictionDirections,
        rule: Rule,
    ) -> Self {
        let face_of = vec![0; pulleys.len()];
        let laws = (penalty, directions);
        Self::of(mesh, (pulleys, face_of), laws, rule, |element, rule| {
            vec![Table::of_surface(element, rule)]
        })
    }

    /// Contact of a chain of spatial beams with `pulleys`, each with the face of the belt that touches it, by `rule`
    /// along each element. A pulley with a groove takes the flanks.
    #[must_use]
    pub fn of_beams<E: LineElement>(
        mesh: &Mesh<E>,
        pulleys: Vec<(SurfacePulley, Face)>,
        penalty: Penalty,
        directions: FrictionDirections,
        rule: Rule,
    ) -> Self {
        let mut faces: Vec<Face> = Vec::new();
        let (pulleys, face_of) = pulleys
            .into_iter()
            .map(|(pulley, face)| {
                let known = faces.iter().position(|known| *known == face);
                let number = known.unwrap_or_else(|| {
                    faces.push(face);
                    faces.len() - 1
                });
                (pulley, number)
            })
            .unzip();
        let laws = (penalty, directions);
        Self::of(mesh, (pulleys, face_of), laws, rule, |element, rule| {
            let table = |face| Table::of_face(element, rule, face);
            faces.iter().map(table).collect()
        })
    }

    /// Contact by the tables that `tables` makes for each face of an element.
    fn of<E: Element>(
        mesh: &Mesh<E>,
        (pulleys, face_of): (Vec<SurfacePulley>, Vec<usize>),
        (penalty, directions): (Penalty, FrictionDirections),
        rule: Rule,
        make: impl Fn(&E, &Rule) -> Vec<Table>,
    ) -> Self {
        const {
            assert!(E::NODES * E::NODE_VECTORS <= VECTORS && E::DIMENSION == 3);
        }
        let mut tables: Vec<Table> = Vec::new();
        let mut known: Vec<&E> = Vec::new();
        let kind_of = mesh
            .elements()
            .iter()
            .map(|element| {
                let found = known.iter().rposition(|other| *other == element);
                found.unwrap_or_else(|| {
                    known.push(element);
                    tables.extend(make(element, &rule));
                    known.len() - 1
                })
            })
            .collect();
        let faces = tables.len() / known.len().max(1);
        let vectors = E::NODES * E::NODE_VECTORS;
        let coordinates = (0..mesh.elements().len())
            .map(|element| {
                std::array::from_fn(|slot| {
                    // Slots beyond the element's own have weight zero; they read its first vector.
                    let vector = if slot < vectors { slot } else { 0 };
                    let node = mesh.node(element, vector / E::NODE_VECTORS);
                    node * E::NODE_DOF + 3 * (vector % E::NODE_VECTORS)
                })
            })
            .collect();
        Self {
            pulleys,
            line: 0.5,
            width: 0.0,
            penalty,
            directions,
            rule,
            face_of,
            faces,
            tables,
            kind_of,
            coordinates,
            vectors,
            node_vectors: E::NODE_VECTORS,
            chain: mesh.dof(),
            local: vec![0.0; E::DOF * E::DOF],
        }
    }

    /// The rule along and across an element.
    pub fn rule(&self) -> &Rule {
        &self.rule
    }

    /// Gives the pulleys friction laws.
    pub fn set_friction(&mut self, laws: impl IntoIterator<Item = Law>) {
        for (pulley, law) in self.pulleys.iter_mut().zip(laws) {
            pulley.friction = law;
        }
    }

    /// Torque, hub force and moment, slip and power on every pulley.
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
                total.lateral.belt_offset /= total.length;
            }
        }
    }

    /// The contact at point (`i` along, `j` across) of `element`, if it touches a pulley.
    pub fn touch(
        &self,
        state: State<'_>,
        element: usize,
        place: [usize; 2],
    ) -> Option<SurfaceTouch> {
        (0..self.pulleys.len()).find_map(|p| self.touch_on(p, state, element, place))
    }

    /// The contact at point (`i` along, `j` across the face that touches it) of `element` with pulley `p`, if any.
    pub fn touch_on(
        &self,
        p: usize,
        state: State<'_>,
        element: usize,
        [i, j]: [usize; 2],
    ) -> Option<SurfaceTouch> {
        let table = self.table(element, self.face_of[p]);
        if j >= table.across {
            return None;
        }
        let (batch, lane) = table.place([i, j]);
        let (mut r, mut v) = ([0.0; 3], [0.0; 3]);
        for (weight, at) in batch.by_lane[lane].iter().zip(&self.coordinates[element]) {
            for axis in 0..3 {
                r[axis] += weight * state.q[at + axis];
                v[axis] += weight * state.v[at + axis];
            }
        }
        let pulley = &self.pulleys[p];
        let [center, drift] = pulley.hub(state.time);
        let meeting = Meeting {
            arm: std::array::from_fn(|k| r[k] - center[k]),
            v: std::array::from_fn(|k| v[k] - drift[k]),
            speed: state.v[self.chain + p],
        };
        let surface = (
            pulley,
            pulley.meridian(batch.side, self.penalty.slip_lever_part),
        );
        let at = SurfacePoint::new(&self.penalty, surface, self.directions, &meeting);
        (at.penetration > 0.0).then(|| SurfaceTouch {
            pulley: p,
            penetration: at.penetration,
            along: at.along,
            normal: at.normal,
            around: at.around,
            normal_force: at.normal_force,
            friction: at.friction,
            slip: at.slip,
            slides: at.rise == 0.0 && at.friction.iter().any(|force| *force != 0.0),
        })
    }

    /// Points across the face of `element` that touches pulley `p`.
    pub fn across(&self, p: usize, element: usize) -> usize {
        self.table(element, self.face_of[p]).across
    }

    /// Quadrature weight times area [m²] of point (`i` along, `j` across) of `element` on the face that touches
    /// pulley `p`.
    pub fn area(&self, p: usize, element: usize, place: [usize; 2]) -> f64 {
        let (batch, lane) = self.table(element, self.face_of[p]).place(place);
        batch.area[lane]
    }

    /// All elements, each with all faces.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let faces = self.faces;
        (0..self.kind_of.len()).flat_map(move |element| (0..faces).map(move |face| (element, face)))
    }

    #[inline]
    fn table(&self, element: usize, face: usize) -> &Table {
        &self.tables[self.kind_of[element] * self.faces + face]
    }
}

impl ForceLaw for SurfaceContact {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        dispatch(kernels::AddForce {
            contact: self,
            state,
            force,
        });
        for (p, pulley) in self.pulleys.iter().enumerate() {
            let speed = state.v[self.chain + p];
            force[self.chain + p] += pulley.external.value(state.time, speed);
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
        dispatch(kernels::AddTangent {
            contact: self,
            state,
            factors: [position_factor, velocity_factor],
            local: &mut local,
            matrix,
        });
        self.local = local;
        for (p, pulley) in self.pulleys.iter().enumerate() {
            let speed = state.v[self.chain + p];
            let slope = pulley.external.derivative(state.time, speed);
            matrix.add_corner(p, p, -velocity_factor * slope);
        }
    }
}
