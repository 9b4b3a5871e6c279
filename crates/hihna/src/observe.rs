//! What the user wants to know of a state: speeds, torques, tensions, slip, hub loads, energies.

mod belt;
mod profile;
mod section_table;
mod space_beams;
mod span;
mod station;
mod surface;

use ancf::dynamics::Motion;
use ancf::element::{Element, LineElement};
use ancf::mesh::Mesh;
use ancf::system::{Mechanics, State, System};

use crate::contact::{BeltPoint, ContactPulley, Lateral, PulleyContact};
use crate::layout::Layout;

use belt::BeltSurvey;
pub use profile::{EdgeRow, ProfileRow};
pub use span::SpanState;
pub use station::{PulleyLaw, Station, Stations, Touch};

/// A pulley at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PulleyState {
    /// Angle [rad].
    pub angle: f64,
    /// Speed [rad/s].
    pub speed: f64,
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// External torque on the pulley [N m]; for a driver what it takes to keep its motion.
    pub external_torque: f64,
    /// Force of the belt on the pulley [N].
    pub hub_force: [f64; 2],
    /// What a belt in space does out of the plane.
    pub lateral: Lateral,
    /// Mean velocity of the belt against the pulley's surface over the contact [m/s].
    pub slip_speed: f64,
    /// Angle of the arc in contact [rad].
    pub contact_angle: f64,
    /// Angle of the part of it where friction is exhausted [rad].
    pub slip_angle: f64,
    /// True axial force where the belt runs on: mean over the element there [N].
    pub tension_in: f64,
    /// True axial force where the belt runs off: mean over the element there [N].
    pub tension_out: f64,
    /// Power that friction takes on the pulley [W].
    pub friction_loss: f64,
}

/// Energies stored at one time [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Kinetic energy of belt and pulleys.
    pub kinetic: f64,
    /// Strain energy of the belt.
    pub strain: f64,
    /// Potential energy: gravity and the compliance of the contact.
    pub potential: f64,
}

impl Stored {
    /// Their sum.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.potential
    }
}

/// Powers at one time [W].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Powers {
    /// Put in by the drivers and by what moves the pulleys' centres.
    pub input: f64,
    /// Put in by external torques on the other pulleys (negative: taken out).
    pub load: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by the damping of the contact.
    pub contact: f64,
    /// Taken by the damping of the belt.
    pub damping: f64,
    /// Put in or taken out at each pulley, summed without sign.
    pub turnover: f64,
}

impl Powers {
    /// `self + factor * other`, entry by entry.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        Self {
            input: self.input + factor * other.input,
            load: self.load + factor * other.load,
            friction: self.friction + factor * other.friction,
            contact: self.contact + factor * other.contact,
            damping: self.damping + factor * other.damping,
            turnover: self.turnover + factor * other.turnover,
        }
    }
}

/// Reads states of one system; holds its working memory. [`Observer::look`] takes the sums over the
/// contact in, [`Observer::survey`] every point of the belt too; the other methods answer from them.
#[derive(Debug)]
pub struct Observer {
    contacts: Vec<PulleyContact>,
    /// For each pulley: inertia and whether its motion is prescribed.
    rotors: Vec<(f64, bool)>,
    names: Vec<String>,
    damped: bool,
    belt: BeltSurvey,
}

impl Observer {
    /// An observer of `system` whose pulleys are named `names`.
    pub fn new<E: Element, L: PulleyLaw<E>>(
        system: &System<E, L>,
        names: Vec<String>,
        inertias: &[f64],
    ) -> Self {
        let first = system.structure().chain();
        let rotors = inertias
            .iter()
            .enumerate()
            .map(|(p, inertia)| {
                let prescribed = system.prescribed().iter().any(|(i, _)| *i == first + p);
                (*inertia, prescribed)
            })
            .collect();
        Self {
            contacts: vec![PulleyContact::default(); names.len()],
            rotors,
            names,
            damped: system.mesh().elements().iter().any(Element::is_damped),
            belt: BeltSurvey::default(),
        }
    }

    /// Takes in what the belt does to the pulleys at `motion`.
    pub fn look<E: Element, L: PulleyLaw<E>>(&mut self, system: &System<E, L>, motion: &Motion) {
        system.law.resultants(state(motion), &mut self.contacts);
    }

    /// Takes in every point of the belt at `motion` as well.
    pub fn survey<E: Element, L: PulleyLaw<E>>(&mut self, system: &System<E, L>, motion: &Motion) {
        self.look(system, motion);
        self.belt.take(system, motion);
    }

    /// Takes in the belt of `mesh` at `q` as seen at `points`, all around it in order, and by `contacts` what it does
    /// to `pulleys`.
    pub(crate) fn take_points<E: LineElement>(
        &mut self,
        mesh: &Mesh<E>,
        pulleys: &[ContactPulley],
        q: &[f64],
        points: &[BeltPoint],
        contacts: Vec<PulleyContact>,
    ) {
        self.contacts = contacts;
        self.belt.take_points(mesh, pulleys, q, points);
    }

    /// Angle, speed and external torque of pulley `p` at `motion`, which was looked at last.
    fn rotor<E: Element, L: PulleyLaw<E>>(
        &self,
        system: &System<E, L>,
        motion: &Motion,
        p: usize,
    ) -> (f64, f64, f64) {
        let at = system.structure().chain() + p;
        let (inertia, prescribed) = self.rotors[p];
        let external = if prescribed {
            inertia * motion.a[at] - self.contacts[p].torque
        } else {
            let external = system.law.external(p);
            external.value(motion.time, motion.v[at])
        };
        (motion.q[at], motion.v[at], external)
    }

    /// Speed and torque (of the belt and external together) of pulley `p` at the state looked at last.
    pub fn momentum<E: Element, L: PulleyLaw<E>>(
        &self,
        system: &System<E, L>,
        motion: &Motion,
        p: usize,
    ) -> (f64, f64) {
        let (_, speed, external) = self.rotor(system, motion, p);
        (speed, self.contacts[p].torque + external)
    }

    /// Every pulley of the state surveyed last, into `out`.
    pub fn pulleys<E: Element, L: PulleyLaw<E>>(
        &self,
        system: &System<E, L>,
        motion: &Motion,
        out: &mut [PulleyState],
    ) {
        for (p, pulley) in out.iter_mut().enumerate() {
            let contact = &self.contacts[p];
            let (angle, speed, external_torque) = self.rotor(system, motion, p);
            let arc = self.belt.arc(p);
            *pulley = PulleyState {
                angle,
                speed,
                torque: contact.torque,
                external_torque,
                hub_force: contact.hub_force,
                lateral: contact.lateral,
                slip_speed: contact.slip_speed,
                contact_angle: arc.contact_angle,
                slip_angle: arc.slip_angle,
                tension_in: arc.tension_in,
                tension_out: arc.tension_out,
                friction_loss: contact.friction_loss,
            };
        }
    }

    /// The powers at `motion`, which was looked at last.
    pub fn powers<E: Element, L: PulleyLaw<E>>(
        &self,
        system: &System<E, L>,
        motion: &Motion,
    ) -> Powers {
        let mut powers = Powers::default();
        for (p, contact) in self.contacts.iter().enumerate() {
            let (_, speed, external) = self.rotor(system, motion, p);
            if self.rotors[p].1 {
                powers.input += external * speed;
            } else {
                powers.load += external * speed;
            }
            powers.turnover += (external * speed).abs();
            // Whoever moves the hub holds it against the belt.
            let [fx, fy] = contact.hub_force;
            let [vx, vy, vz] = system.law.hub_velocity(p, motion.time);
            let moving = -(fx * vx + fy * vy + contact.lateral.hub_force * vz);
            powers.input += moving;
            powers.turnover += moving.abs();
            powers.friction += contact.friction_loss;
            powers.contact += contact.contact_loss;
        }
        if self.damped {
            powers.damping = system.mesh().damping_power(&motion.q, &motion.v);
        }
        powers
    }

    /// The stored energies at `motion`, which was looked at last.
    pub fn stored<E: Element, L: PulleyLaw<E>>(
        &self,
        system: &System<E, L>,
        motion: &Motion,
    ) -> Stored {
        Stored {
            kinetic: system.kinetic_energy(&motion.v),
            strain: system.strain_energy(&motion.q),
            potential: system.constant_potential(&motion.q)
                + self.contacts.iter().map(|c| c.stored_energy).sum::<f64>(),
        }
    }

    /// The free spans of the state surveyed last, on the path `layout`.
    pub fn spans(&self, layout: &Layout, out: &mut [SpanState]) {
        self.belt.spans(layout, out);
    }

    /// The belt at every contact integration point of the state surveyed last, in order of material
    /// coordinate.
    pub fn profile(&self, time: f64, element_start: &[f64]) -> Vec<ProfileRow> {
        self.belt.profile(time, element_start, &self.names)
    }

    /// The edges of a belt that is a surface, in order as [`Observer::profile`]; empty for others.
    pub fn edges(&self, time: f64, element_start: &[f64]) -> Vec<EdgeRow> {
        self.belt.edges(time, element_start)
    }

    /// Largest penetration of the state looked at last [m].
    pub fn penetration(&self) -> f64 {
        self.contacts
            .iter()
            .fold(0.0, |largest, c| f64::max(largest, c.penetration))
    }

    /// Mean true axial force around the belt of the state surveyed last [N].
    pub fn mean_tension(&self) -> f64 {
        self.belt.mean_tension()
    }
}

/// The state of a motion.
fn state(motion: &Motion) -> State<'_> {
    State {
        time: motion.time,
        q: &motion.q,
        v: &motion.v,
    }
}
