//! The belt's sections at the contact points along it, whatever the elements are.

use ancf::dynamics::Motion;
use ancf::element::{Element, LineElement};
use ancf::mesh::Mesh;
use ancf::system::{ForceLaw, State};

use super::section_table::SectionTables;
use super::state;
use crate::contact::{BeltContact, BeltPoint, ContactPulley, PulleyContact};
use crate::load::ExternalTorque;

/// A section of the belt at one integration point along it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Station {
    /// Element along the belt.
    pub element: usize,
    /// Place in it, in `[0, 1]`.
    pub xi: f64,
    /// Quadrature weight times length [m].
    pub weight: f64,
    /// Position on the line that is shown [m].
    pub position: [f64; 3],
    /// The contact with a pulley.
    pub touch: Option<Touch>,
    /// True axial force of the section [N].
    pub tension: f64,
    /// Present over unstretched length [-].
    pub stretch: f64,
    /// Area ratio det J [-].
    pub jacobian: f64,
    /// Speed along the belt, in the order of the path [m/s].
    pub speed: f64,
    /// Turn of the point per length of belt about the pulley it touches, unsigned [rad/m].
    pub turn: f64,
    /// Position of the edges y = 0 and the other [m], of a belt that is a surface.
    pub edges: Option<[[f64; 3]; 2]>,
}

/// Contact of a section with a pulley.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// The pulley.
    pub pulley: usize,
    /// Normal force per length [N/m].
    pub normal_force: f64,
    /// Friction force around the pulley per length [N/m].
    pub friction_force: f64,
    /// Slip velocity around the pulley [m/s].
    pub slip: f64,
    /// Whether friction is exhausted.
    pub slides: bool,
}

/// All sections of a state, in order along the belt.
#[derive(Clone, Debug, Default)]
pub struct Stations {
    /// The sections.
    pub points: Vec<Station>,
    /// Undeformed length of an element along the belt [m], by element.
    pub element_length: Vec<f64>,
    /// Working memory.
    contacts: Vec<BeltPoint>,
    /// Shape functions of plates.
    pub(super) tables: SectionTables,
}

/// Contact of a belt of elements `E` with pulleys, as runs and records see it. Pulley `p` turns with rigid
/// coordinate `p`.
pub trait PulleyLaw<E: Element>: ForceLaw {
    /// Writes torque, hub force, slip and power of every pulley to `out`.
    fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]);

    /// The torque from outside of the drive on pulley `p`.
    fn external(&self, p: usize) -> &ExternalTorque;

    /// Velocity of the centre of pulley `p` at `time` [m/s].
    fn hub_velocity(&self, p: usize, time: f64) -> [f64; 3];

    /// Writes the sections of the belt at `motion` to `stations`.
    fn stations(&self, mesh: &Mesh<E>, motion: &Motion, stations: &mut Stations);
}

impl<E: LineElement> PulleyLaw<E> for BeltContact {
    fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]) {
        Self::resultants(self, state, out);
    }

    fn external(&self, p: usize) -> &ExternalTorque {
        &self.pulleys[p].external
    }

    fn hub_velocity(&self, p: usize, time: f64) -> [f64; 3] {
        let displacement = self.pulleys[p].displacement.as_ref();
        displacement.map_or([0.0; 3], |displacement| displacement.at(time)[1])
    }

    fn stations(&self, mesh: &Mesh<E>, motion: &Motion, stations: &mut Stations) {
        let mut contacts = std::mem::take(&mut stations.contacts);
        self.points(state(motion), &mut contacts);
        stations_at(mesh, &self.pulleys, &motion.q, &contacts, stations);
        stations.contacts = contacts;
    }
}

/// Writes the sections of the belt of `mesh` at `q` to `stations`, at points whose contact with `pulleys` is known.
pub(super) fn stations_at<E: LineElement>(
    mesh: &Mesh<E>,
    pulleys: &[ContactPulley],
    q: &[f64],
    points: &[BeltPoint],
    stations: &mut Stations,
) {
    stations.points.clear();
    stations.element_length.clear();
    stations
        .element_length
        .extend(mesh.elements().iter().map(LineElement::length));
    let mut e = [0.0; 12];
    let mut gathered = usize::MAX;
    for point in points {
        if point.element != gathered {
            mesh.gather(point.element, q, &mut e[..E::DOF]);
            gathered = point.element;
        }
        let e = &e[..E::DOF];
        let element = &mesh.elements()[point.element];
        let slope = element.slope(e, point.xi);
        let stretch = slope[0].hypot(slope[1]);
        let turn = point.contact.map_or(0.0, |(p, contact)| {
            let [nx, ny] = contact.normal;
            let distance = pulleys[p].radius - contact.penetration;
            (nx * slope[1] - ny * slope[0]).abs() / distance
        });
        stations.points.push(Station {
            element: point.element,
            xi: point.xi,
            weight: point.weight,
            position: [point.position[0], point.position[1], 0.0],
            touch: point.contact.map(|(pulley, contact)| Touch {
                pulley,
                normal_force: contact.normal_force,
                friction_force: contact.friction_force,
                slip: contact.slip,
                slides: contact.slides(),
            }),
            tension: element.axial_force(e, point.xi),
            stretch,
            jacobian: element.jacobian(e, point.xi),
            speed: (slope[0] * point.velocity[0] + slope[1] * point.velocity[1]) / stretch,
            turn,
            edges: None,
        });
    }
}
