//! From a drive to the equations of its steady running and a first guess.
//!
//! Profiles in time count with the value they end with; loads that depend on the speed are taken at the speed
//! found. The belt settles without friction ([`crate::simulate`] starts from the same state), and the guess is a
//! belt that does not slip at its mean stretch `f`: `c = omega_1 R_1 / f`, `omega_p = omega_1 R_1 / R_p`.

use std::num::NonZeroUsize;

use ancf::element::LineElement;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::system::Mechanics;

use super::bristles::Bristles;
use super::contact::SteadyContact;
use super::equations::{Equations, Phase};
use super::line::{ContactLine, MOST_DOF};
use super::newton::Newton;
use super::{RunningBelt, RunningError, mesh};
use crate::assemble::{
    Assembly, AssemblyError, BeltElementType, Warning, coarse_mesh, penalty, short_arcs,
};
use crate::contact::ContactPulley;
use crate::drive::{Drive, Friction, Integration, Pulley, SteadyMesh};
use crate::friction::Law;
use crate::layout::Layout;
use crate::load::ExternalTorque;
use crate::observe::Observer;
use crate::profile::Profile;
use crate::simulate::{Flow, StartState, settle_on_pulleys};
use crate::steady::drive_string::{SteadyError, final_value};

/// Correction, in smallest radii, at which the belt is close enough to rest: Newton's method goes on from there.
const REST: f64 = 1.0e-7;

/// Points at which the stretch is averaged over an element.
const STRETCH_POINTS: NonZeroUsize = match NonZeroUsize::new(4) {
    Some(points) => points,
    None => NonZeroUsize::MIN,
};

impl<E: BeltElementType> RunningBelt<E> {
    /// Puts `drive` together, lets its belt settle and guesses how it runs.
    pub fn new(drive: &Drive) -> Result<Self, RunningError> {
        let starts = mesh::starts(drive, &Layout::of(drive).map_err(AssemblyError::from)?);
        Self::on_mesh(drive, &starts)
    }

    /// The same with elements that begin at the parts `starts` of the belt, rising from 0.
    pub fn on_mesh(drive: &Drive, starts: &[f64]) -> Result<Self, RunningError> {
        let mut belt = Self::unsettled(drive, starts)?;
        belt.settle(drive)?;
        Ok(belt)
    }

    /// The belt on its path, without a guess.
    pub(super) fn unsettled(drive: &Drive, starts: &[f64]) -> Result<Self, RunningError> {
        let prescribed = prescribed_speeds(drive)?;
        let mut assembly = Assembly::<E>::graded(drive, starts)?;
        assembly
            .warnings
            .extend(coarse_mesh(drive, &assembly.mounting));
        if drive.steady.mesh == SteadyMesh::Uniform {
            let short = short_arcs(drive, &assembly.layout, &assembly.mounting);
            assembly.warnings.extend(short);
        }
        if drive.contact.integration == Integration::Trapezoidal {
            assembly.warnings.push(Warning::SplitIntegration);
        }
        let frictionless = (assembly.system.law.pulleys.iter()).map(|p| p.friction.clone());
        let frictionless: Vec<_> = frictionless.collect();
        assembly.release(drive);
        for (contact, pulley) in assembly.system.law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.external = final_torque(pulley);
        }
        let laws: Vec<Law> = (assembly.system.law.pulleys.iter())
            .map(|p| p.friction.clone())
            .collect();
        let equations = equations(drive, &assembly, prescribed, &laws);
        assembly.system.law.set_friction(frictionless);
        let newton = Newton::new(equations.structure());
        let names: Vec<String> = drive.pulley.iter().map(|p| p.name.clone()).collect();
        let inertias: Vec<f64> = drive.pulley.iter().map(|p| p.inertia).collect();
        let observer = Observer::new(&assembly.system, names.clone(), &inertias);
        Ok(Self {
            start: StartState {
                tension: 0.0,
                penetration: 0.0,
                iterations: 0,
            },
            starts: starts.to_vec(),
            guess: vec![0.0; equations.structure().size()],
            line_density: drive.belt.density * drive.belt.width * drive.belt.thickness,
            bending_waves: (drive.belt.bending_factor * drive.belt.youngs_modulus
                / drive.belt.density)
                .sqrt(),
            names,
            inertias,
            observer,
            assembly,
            laws,
            equations,
            newton,
        })
    }

    /// Lets the belt settle without friction and makes the guess.
    pub(super) fn settle(&mut self, drive: &Drive) -> Result<(), RunningError> {
        let assembly = &mut self.assembly;
        let torques: Vec<_> = (assembly.system.law.pulleys.iter_mut())
            .map(|p| std::mem::replace(&mut p.external, Profile::Constant(0.0).into()))
            .collect();
        let settled = settle_on_pulleys(drive, assembly, REST, &mut |_| Flow::Continue);
        for (pulley, torque) in assembly.system.law.pulleys.iter_mut().zip(torques) {
            pulley.external = torque;
        }
        self.start.iterations = settled?.iterations;
        self.equations.phase = phase(&self.equations.mesh, &self.assembly.motion.q);
        self.guess_no_slip();
        let guess = std::mem::take(&mut self.guess);
        self.observe(&guess);
        self.guess = guess;
        self.start.tension = self.observer.mean_tension();
        self.start.penetration = self.observer.penetration();
        self.assembly.judge(drive, self.start.rest());
        Ok(())
    }

    /// Takes over the speeds and torques of `drive`, which is that of this belt in all other things.
    pub(super) fn redirect(&mut self, drive: &Drive) -> Result<(), RunningError> {
        self.equations.prescribed = prescribed_speeds(drive)?;
        let contacts =
            (self.assembly.system.law.pulleys.iter_mut()).zip(&mut self.equations.contact.pulleys);
        for ((known, pulley), stated) in contacts.zip(&drive.pulley) {
            known.external = final_torque(stated);
            pulley.external = known.external.clone();
        }
        self.guess_no_slip();
        Ok(())
    }

    /// The belt of `drive` in the place of `other`, which runs in the state `z`: that makes the guess. Nothing where it has
    /// other unknowns.
    pub(super) fn beside(
        drive: &Drive,
        other: &Self,
        z: &[f64],
    ) -> Result<Option<Self>, RunningError> {
        let starts = mesh::starts(drive, &Layout::of(drive).map_err(AssemblyError::from)?);
        let mut belt = Self::unsettled(drive, &starts)?;
        if belt.guess.len() != z.len() {
            return Ok(None);
        }
        let chain = belt.equations.chain();
        belt.assembly.motion.q[..chain].copy_from_slice(&z[..chain]);
        belt.equations.phase = phase(&belt.equations.mesh, &z[..chain]);
        belt.guess_no_slip();
        belt.start = other.start;
        Ok(Some(belt))
    }

    /// Sets the guess of a belt that does not slip, the weights of the slip and the scales of the speeds.
    fn guess_no_slip(&mut self) {
        let (chain, load) = (self.equations.chain(), self.equations.load());
        let circulation = self.equations.circulation();
        let mut z = vec![0.0; self.guess.len().max(load + 1)];
        z[..chain].copy_from_slice(&self.assembly.motion.q[..chain]);
        let arcs = &self.assembly.layout.arcs;
        let (driver, speed) = (self.equations.prescribed.iter().enumerate())
            .find_map(|(p, speed)| speed.map(|speed| (p, speed)))
            // `prescribed_speeds` has seen to one.
            .unwrap_or((0, 1.0));
        let travel = speed * arcs[driver].radius * arcs[driver].sweep.signum();
        let stretch = mean_stretch(&self.equations.mesh, &z[..chain]);
        z[circulation] = travel / stretch;
        z[load] = 1.0;
        let smallest = arcs.iter().fold(f64::INFINITY, |r, arc| r.min(arc.radius));
        self.equations.scales[circulation] = smallest / z[circulation].abs();
        self.equations.scales[load] = smallest;
        for (p, arc) in arcs.iter().enumerate() {
            let omega = travel / (arc.radius * arc.sweep.signum());
            z[chain + p] = self.equations.prescribed[p].unwrap_or(omega);
            self.equations.scales[chain + p] = smallest / omega.abs();
            if self.equations.prescribed[p].is_none() {
                let torque = self.equations.contact.pulleys[p].external.value(0.0, omega);
                let sign = if torque == 0.0 { 0.0 } else { torque.signum() };
                self.equations.slip_weights[p] = sign * arc.radius;
            }
        }
        self.guess_phases(&mut z);
        self.guess = z;
    }
}

impl<E: BeltElementType> RunningBelt<E> {
    /// Sets the phases of the bristles in `z` to what they are at its other unknowns.
    fn guess_phases(&mut self, z: &mut [f64]) {
        let load = self.equations.load();
        let equations = &mut self.equations;
        let motion = equations.motion(z);
        equations.contact.transport(&equations.mesh, motion);
        let Some(bristles) = &equations.contact.bristles else {
            return;
        };
        let radii = self.assembly.layout.arcs.iter().map(|arc| arc.radius);
        for (p, (arc, radius)) in bristles.arcs.iter().zip(radii).enumerate() {
            z[load + 1 + p] = arc.main_phase();
            equations.scales[load + 1 + p] = radius;
        }
    }
}

/// The speeds that `drive` ends with, of the pulleys that have one.
fn prescribed_speeds(drive: &Drive) -> Result<Vec<Option<f64>>, SteadyError> {
    if drive.belt.element.is_spatial() {
        return Err(SteadyError::Spatial);
    }
    if let Some(moving) = drive.pulley.iter().find(|p| p.displacement.is_some()) {
        let pulley = moving.name.clone();
        return Err(SteadyError::Displaced { pulley });
    }
    if drive.belt.damping_time > 0.0 {
        return Err(SteadyError::Damped {
            time: drive.belt.damping_time,
        });
    }
    friction_holds(drive)?;
    let speeds = (drive.pulley.iter())
        .map(prescribed_speed)
        .collect::<Result<Vec<_>, _>>()?;
    if speeds.iter().all(Option::is_none) {
        return Err(SteadyError::NoSpeed);
    }
    Ok(speeds)
}

/// Without friction on a driver nothing fixes the speed of the belt, without it on another pulley nothing that pulley's.
fn friction_holds(drive: &Drive) -> Result<(), SteadyError> {
    let slips = |pulley: &&Pulley| match drive.friction_on(pulley) {
        Friction::Stribeck {
            static_coefficient,
            sliding_coefficient,
            ..
        } => *static_coefficient == 0.0 && *sliding_coefficient == 0.0,
        friction => friction.coefficient() == 0.0,
    };
    let mut drivers = drive.pulley.iter().filter(|p| p.is_driver()).peekable();
    let idle = drivers
        .peek()
        .copied()
        .filter(|_| drivers.clone().all(|p| slips(&p)));
    let free = (drive.pulley.iter()).find(|p| !p.is_driver() && slips(p));
    match idle.or(free) {
        Some(pulley) => Err(SteadyError::NoFriction {
            pulley: pulley.name.clone(),
        }),
        None => Ok(()),
    }
}

fn prescribed_speed(pulley: &Pulley) -> Result<Option<f64>, SteadyError> {
    let name = || pulley.name.clone();
    if pulley.angle.is_some() {
        return Err(SteadyError::AngleDriven { pulley: name() });
    }
    let Some(speed) = pulley.speed.as_ref().map(final_value) else {
        return Ok(None);
    };
    if pulley.irregularity.iter().any(|h| h.amplitude > 0.0) {
        return Err(SteadyError::Irregular { pulley: name() });
    }
    if speed == 0.0 || !speed.is_finite() {
        return Err(SteadyError::AtRest {
            pulley: name(),
            speed,
        });
    }
    Ok(Some(speed))
}

/// What acts on a pulley in the end.
fn final_torque(pulley: &Pulley) -> ExternalTorque {
    ExternalTorque {
        by_time: Profile::Constant(final_value(&pulley.torque)),
        by_speed: pulley.load.clone(),
        stated: None,
    }
}

fn equations<E: BeltElementType>(
    drive: &Drive,
    assembly: &Assembly<E>,
    prescribed: Vec<Option<f64>>,
    laws: &[Law],
) -> Equations<E> {
    let mesh = assembly.system.mesh().clone();
    let points = NonZeroUsize::new(drive.contact.points).unwrap_or(NonZeroUsize::MIN);
    let penalty = penalty(&drive.contact);
    let pulleys: Vec<ContactPulley> = assembly.system.law.pulleys.clone();
    let mut contact = SteadyContact::new(pulleys, penalty, Rule::gauss(points), E::DOF);
    if laws.iter().any(Law::has_memory) {
        contact.bristles = Some(Bristles::new(
            &mesh,
            &assembly.layout,
            drive.belt.first_node,
        ));
    }
    let phase = phase(&mesh, &assembly.motion.q);
    let constant = gravity(drive, assembly, mesh.dof());
    let border = prescribed.len() + 2;
    let scales = scales(
        drive,
        &mesh,
        border + contact.bristles.as_ref().map_or(0, |b| b.arcs.len()),
    );
    Equations::new(mesh, contact, constant, prescribed, phase, scales)
}

/// The first node, held where it lies: once the belt has settled, as it creeps along itself while it does.
fn phase<E: LineElement>(mesh: &Mesh<E>, q: &[f64]) -> Phase {
    let mut e = [0.0; MOST_DOF];
    mesh.gather(0, q, &mut e[..E::DOF]);
    let slope = ContactLine::new(&mesh.elements()[0], &e, 0.0).slope(0.0);
    let length = slope[0].hypot(slope[1]);
    Phase {
        at: 0,
        position: [q[0], q[1]],
        tangent: slope.map(|s| s / length),
    }
}

fn gravity<E: BeltElementType>(drive: &Drive, assembly: &Assembly<E>, chain: usize) -> Vec<f64> {
    let mass = assembly.system.mass();
    let size = mass.structure().size();
    let (mut field, mut force) = (vec![0.0; size], vec![0.0; size]);
    for node in field[..chain].chunks_exact_mut(E::NODE_DOF) {
        node[..2].copy_from_slice(&drive.gravity);
    }
    mass.multiply(&field, &mut force);
    force.truncate(chain);
    force
}

/// 1 for positions, a quarter of the shorter element at a node for slopes along the belt, the thickness for those
/// across; those of the border follow from the guess.
fn scales<E: LineElement>(drive: &Drive, mesh: &Mesh<E>, border: usize) -> Vec<f64> {
    let count = mesh.elements().len();
    let length = |i: usize| mesh.elements()[i % count].length();
    let mut scales = Vec::with_capacity(mesh.dof() + border);
    for node in 0..count {
        let shorter = length(node).min(length(node + count - 1));
        let mut own = [drive.belt.thickness; MOST_DOF];
        own[..2].fill(1.0);
        if E::CENTRE_VECTORS.len() == 4 {
            own[2..4].fill(0.25 * shorter);
        }
        scales.extend_from_slice(&own[..E::NODE_DOF]);
    }
    scales.resize(mesh.dof() + border, 1.0);
    scales
}

/// Present over unstretched length of the whole belt.
fn mean_stretch<E: LineElement>(mesh: &Mesh<E>, q: &[f64]) -> f64 {
    let rule = Rule::gauss(STRETCH_POINTS);
    let mut e = [0.0; MOST_DOF];
    let (mut present, mut unstretched) = (0.0, 0.0);
    for (i, element) in mesh.elements().iter().enumerate() {
        mesh.gather(i, q, &mut e[..E::DOF]);
        let line = ContactLine::new(element, &e, 0.0);
        for (xi, weight) in rule.points.iter().zip(&rule.weights) {
            let [x, y] = line.slope(*xi);
            present += weight * line.length * x.hypot(y);
        }
        unstretched += line.length;
    }
    present / unstretched
}

/// The friction laws of a drive's pulleys as they are.
pub(super) fn set_laws<E: LineElement>(equations: &mut Equations<E>, laws: &[Law]) {
    for (pulley, law) in equations.contact.pulleys.iter_mut().zip(laws) {
        pulley.friction.clone_from(law);
    }
}
