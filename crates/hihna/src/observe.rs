//! What the user wants to know of a state: speeds, torques, tensions, slip, hub loads, energies.

use ancf::dynamics::Motion;
use ancf::element::{Element, LineElement};
use ancf::mesh::Mesh;
use ancf::system::{Mechanics, State, System};

use crate::contact::{BeltContact, BeltPoint, PulleyContact};
use crate::friction::FrictionLaw;

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
    /// Mean velocity of the belt against the pulley's surface over the contact [m/s].
    pub slip_speed: f64,
    /// Undeformed length of belt in contact [m].
    pub contact_length: f64,
    /// Power that friction takes on the pulley [W].
    pub friction_loss: f64,
}

/// A free span at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpanState {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Mean engineering strain [-].
    pub strain: f64,
    /// Mean speed along the belt [m/s].
    pub speed: f64,
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
    /// Put in by the drivers.
    pub input: f64,
    /// Put in by external torques on the other pulleys (negative: taken out).
    pub load: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by the damping of the contact.
    pub contact: f64,
    /// Taken by the damping of the belt.
    pub damping: f64,
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
        }
    }
}

/// One row of the belt's profile; fields as in `profile.csv`, SI units.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[expect(
    missing_docs,
    reason = "columns of profile.csv, described in the user guide"
)]
pub struct ProfileRow {
    pub time: f64,
    pub material_coordinate: f64,
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub tension: f64,
    pub strain_green: f64,
    pub strain_engineering: f64,
    pub strain_true: f64,
    pub strain_almansi: f64,
    pub jacobian: f64,
    pub speed: f64,
    pub normal_force: f64,
    pub friction_force: f64,
    pub slip_speed: f64,
    pub pulley: String,
}

/// Reads states of one system; holds its working memory.
#[derive(Debug)]
pub struct Observer {
    contacts: Vec<PulleyContact>,
    /// For each pulley: inertia and whether its motion is prescribed.
    rotors: Vec<(f64, bool)>,
    names: Vec<String>,
    damped: bool,
}

impl Observer {
    /// An observer of `system` whose pulleys are named `names`.
    pub fn new<E: LineElement, F: FrictionLaw>(
        system: &System<E, BeltContact<E, F>>,
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
        }
    }

    /// Every pulley, into `out`.
    pub fn pulleys<E: LineElement, F: FrictionLaw>(
        &mut self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
        out: &mut [PulleyState],
    ) {
        system.law.resultants(state(motion), &mut self.contacts);
        let first = system.structure().chain();
        for (p, pulley) in out.iter_mut().enumerate() {
            let contact = &self.contacts[p];
            let (inertia, prescribed) = self.rotors[p];
            let external_torque = if prescribed {
                inertia * motion.a[first + p] - contact.torque
            } else {
                system.law.pulleys[p].torque.value(motion.time)
            };
            *pulley = PulleyState {
                angle: motion.q[first + p],
                speed: motion.v[first + p],
                torque: contact.torque,
                external_torque,
                hub_force: contact.hub_force,
                slip_speed: contact.slip_speed,
                contact_length: contact.length,
                friction_loss: contact.friction_loss,
            };
        }
    }

    /// The powers at `motion`; `pulleys` must be of the same state and freshly observed.
    pub fn powers<E: LineElement, F: FrictionLaw>(
        &self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
        pulleys: &[PulleyState],
    ) -> Powers {
        let mut powers = Powers::default();
        for ((pulley, contact), (_, prescribed)) in
            pulleys.iter().zip(&self.contacts).zip(&self.rotors)
        {
            let power = pulley.external_torque * pulley.speed;
            if *prescribed {
                powers.input += power;
            } else {
                powers.load += power;
            }
            powers.friction += contact.friction_loss;
            powers.contact += contact.contact_loss;
        }
        if self.damped {
            powers.damping = system.mesh().damping_power(&motion.q, &motion.v);
        }
        powers
    }

    /// The stored energies at `motion`, whose pulleys were observed last.
    pub fn stored<E: LineElement, F: FrictionLaw>(
        &self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
    ) -> Stored {
        Stored {
            kinetic: system.kinetic_energy(&motion.v),
            strain: system.strain_energy(&motion.q),
            potential: system.constant_potential(&motion.q)
                + self.contacts.iter().map(|c| c.stored_energy).sum::<f64>(),
        }
    }

    /// The free spans: span `i` runs from pulley `i` to the next, and its values are means over the
    /// belt between the last contact with the one and the first contact with the other. Where a
    /// pulley has lost the belt, the spans beside it share one piece of belt.
    pub fn spans<E: LineElement, F: FrictionLaw>(
        &self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
        out: &mut [SpanState],
    ) {
        let points = system.law.points(state(motion));
        let count = out.len();
        out.fill(SpanState::default());
        let on = |i: usize| points[i % points.len()].contact.map(|(p, _)| p);
        let Some(start) = (0..points.len()).find(|i| on(*i).is_some()) else {
            let whole = mean(system.mesh(), motion, &points, 0..points.len());
            out.fill(whole);
            return;
        };
        let mut i = start;
        let end = start + points.len();
        while i < end {
            let Some(from) = on(i) else { break };
            let mut next = i + 1;
            while next <= end && on(next).is_none() {
                next += 1;
            }
            if let Some(to) = on(next)
                && next > i + 1
                && to != from
            {
                let mean = mean(system.mesh(), motion, &points, i + 1..next);
                let mut span = from;
                while span != to {
                    out[span] = mean;
                    span = (span + 1) % count;
                }
            }
            i = next;
        }
    }

    /// The belt at every contact integration point, in order of material coordinate.
    pub fn profile<E: LineElement, F: FrictionLaw>(
        &self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
        element_start: &[f64],
    ) -> Vec<ProfileRow> {
        let mesh = system.mesh();
        let mut e = vec![0.0; E::DOF];
        system
            .law
            .points(state(motion))
            .into_iter()
            .map(|point| {
                mesh.gather(point.element, &motion.q, &mut e);
                let element = &mesh.elements()[point.element];
                let slope = element.slope(&e, point.xi);
                let stretch = slope[0].hypot(slope[1]);
                let mut row = ProfileRow {
                    time: motion.time,
                    material_coordinate: element_start[point.element] + point.xi * element.length(),
                    x: point.position[0],
                    y: point.position[1],
                    z: 0.0,
                    tension: element.axial_force(&e, point.xi),
                    strain_green: 0.5 * (stretch * stretch - 1.0),
                    strain_engineering: stretch - 1.0,
                    strain_true: 1.0 - 1.0 / stretch,
                    strain_almansi: 0.5 * (1.0 - 1.0 / (stretch * stretch)),
                    jacobian: element.jacobian(&e, point.xi),
                    speed: (slope[0] * point.velocity[0] + slope[1] * point.velocity[1]) / stretch,
                    ..ProfileRow::default()
                };
                if let Some((p, contact)) = point.contact {
                    row.normal_force = contact.normal_force;
                    row.friction_force = contact.friction_force;
                    row.slip_speed = contact.slip;
                    row.pulley.clone_from(&self.names[p]);
                }
                row
            })
            .collect()
    }

    /// Largest penetration of the state observed last [m].
    pub fn penetration(&self) -> f64 {
        self.contacts
            .iter()
            .fold(0.0, |largest, c| f64::max(largest, c.penetration))
    }

    /// Mean true axial force around the belt [N].
    pub fn mean_tension<E: LineElement, F: FrictionLaw>(
        &self,
        system: &System<E, BeltContact<E, F>>,
        motion: &Motion,
    ) -> f64 {
        let points = system.law.points(state(motion));
        mean(system.mesh(), motion, &points, 0..points.len()).tension
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

/// Means over a range of integration points (cyclic).
fn mean<E: LineElement>(
    mesh: &Mesh<E>,
    motion: &Motion,
    points: &[BeltPoint],
    range: std::ops::Range<usize>,
) -> SpanState {
    let mut sum = SpanState::default();
    let mut length = 0.0;
    let mut e = vec![0.0; E::DOF];
    let mut gathered = usize::MAX;
    for i in range {
        let point = &points[i % points.len()];
        if point.element != gathered {
            mesh.gather(point.element, &motion.q, &mut e);
            gathered = point.element;
        }
        let element = &mesh.elements()[point.element];
        let slope = element.slope(&e, point.xi);
        let stretch = slope[0].hypot(slope[1]);
        let along = (slope[0] * point.velocity[0] + slope[1] * point.velocity[1]) / stretch;
        sum.tension += point.weight * element.axial_force(&e, point.xi);
        sum.strain += point.weight * (stretch - 1.0);
        sum.speed += point.weight * along;
        length += point.weight;
    }
    SpanState {
        tension: sum.tension / length,
        strain: sum.strain / length,
        speed: sum.speed / length,
    }
}
