//! The equations of steady running and their tangent.

use ancf::element::LineElement;
use ancf::linear::{BorderedMatrix, Structure};
use ancf::mesh::Mesh;

use super::contact::{By, SteadyContact};
use super::inertia::ConvectiveInertia;
use super::motion::Motion;

/// What holds the belt from sliding along itself through the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phase {
    /// First coordinate of the node held.
    pub at: usize,
    /// Where it is held [m].
    pub position: [f64; 2],
    /// Unit vector along which it is held.
    pub tangent: [f64; 2],
}

/// What the load factor follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Control {
    /// The factor is given: torques are prescribed.
    Load(f64),
    /// The slip is given: torques are found.
    Slip(f64),
}

/// The equations of [`super`] for the unknowns `[chain, omega of every pulley, c, load factor]` and, with friction that
/// remembers, the phase of the bristles on every pulley.
#[derive(Debug)]
pub(super) struct Equations<E> {
    pub mesh: Mesh<E>,
    pub contact: SteadyContact,
    pub inertia: ConvectiveInertia,
    /// Gravity.
    pub constant_force: Vec<f64>,
    /// Speeds of the pulleys that have them prescribed.
    pub prescribed: Vec<Option<f64>>,
    pub phase: Phase,
    pub control: Control,
    /// Weight of each pulley's speed in the slip [m].
    pub slip_weights: Vec<f64>,
    /// Length of the unknowns' units in norms [m].
    pub scales: Vec<f64>,
    rest: Vec<f64>,
}

impl<E: LineElement> Equations<E> {
    pub fn new(
        mesh: Mesh<E>,
        contact: SteadyContact,
        constant_force: Vec<f64>,
        prescribed: Vec<Option<f64>>,
        phase: Phase,
        scales: Vec<f64>,
    ) -> Self {
        Self {
            inertia: ConvectiveInertia::new(&mesh),
            rest: vec![0.0; mesh.dof()],
            slip_weights: vec![0.0; prescribed.len()],
            mesh,
            contact,
            constant_force,
            prescribed,
            phase,
            control: Control::Load(1.0),
            scales,
        }
    }

    pub fn structure(&self) -> Structure {
        Structure {
            sections: self.mesh.sections(),
            block: self.mesh.section_dof(),
            closed: true,
            border: self.prescribed.len() + 2 + self.phases(),
        }
    }

    /// Number of coordinates of the belt: index of the first pulley's speed.
    pub fn chain(&self) -> usize {
        self.mesh.dof()
    }

    /// Index of the circulation speed; its row is the phase.
    pub fn circulation(&self) -> usize {
        self.chain() + self.prescribed.len()
    }

    /// Index of the load factor.
    pub fn load(&self) -> usize {
        self.circulation() + 1
    }

    /// Number of phases of bristles, which follow the load factor.
    pub fn phases(&self) -> usize {
        (self.contact.bristles.as_ref()).map_or(0, |bristles| bristles.arcs.len())
    }

    pub fn motion<'a>(&self, z: &'a [f64]) -> Motion<'a> {
        let (chain, border) = z.split_at(self.chain());
        Motion {
            chain,
            circulation: z[self.circulation()],
            speeds: &border[..self.prescribed.len()],
            phases: &border[self.prescribed.len() + 2..],
        }
    }

    /// The slip that [`Control::Slip`] prescribes [m/s].
    pub fn slip(&self, z: &[f64]) -> f64 {
        let speeds = self.motion(z).speeds;
        speeds
            .iter()
            .zip(&self.slip_weights)
            .map(|(w, r)| w * r)
            .sum()
    }

    /// Writes what is left of the balances at `z` to `out`.
    pub fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        let (chain, circulation, load) = (self.chain(), self.circulation(), self.load());
        let motion = self.motion(z);
        let c = motion.circulation;
        let (force, border) = out.split_at_mut(chain);
        force.copy_from_slice(&self.constant_force);
        self.mesh.add_force(motion.chain, &self.rest, force);
        self.inertia
            .add_product(&self.mesh, c * c, motion.chain, force);
        let torques = &mut border[..self.prescribed.len()];
        self.contact.add_force(&self.mesh, motion, force, torques);
        for (p, torque) in torques.iter_mut().enumerate() {
            if let Some(speed) = self.prescribed[p] {
                *torque = speed - motion.speeds[p];
            } else {
                let external = &self.contact.pulleys[p].external;
                *torque += z[load] * external.value(0.0, motion.speeds[p]);
            }
        }
        let Phase {
            at,
            position,
            tangent,
        } = self.phase;
        out[circulation] =
            (position[0] - z[at]) * tangent[0] + (position[1] - z[at + 1]) * tangent[1];
        out[load] = match self.control {
            Control::Load(factor) => factor - z[load],
            Control::Slip(slip) => slip - self.slip(z),
        };
        if let Some(bristles) = &self.contact.bristles {
            for (p, arc) in bristles.arcs.iter().enumerate() {
                out[load + 1 + p] = arc.main_phase() - arc.unknown;
            }
        }
    }

    /// Writes minus the derivative of the residual at `z` to `matrix`.
    pub fn tangent(&mut self, z: &[f64], matrix: &mut BorderedMatrix) {
        let (circulation, load, pulleys) = (self.circulation(), self.load(), self.prescribed.len());
        let motion = self.motion(z);
        let c = motion.circulation;
        matrix.clear();
        self.mesh
            .add_tangent(motion.chain, &self.rest, 1.0, 0.0, matrix);
        self.inertia.add_to(-c * c, matrix);
        let mut by_circulation = vec![0.0; self.chain()];
        self.inertia
            .add_product(&self.mesh, -2.0 * c, motion.chain, &mut by_circulation);
        matrix.add_border_column(pulleys, 0, &by_circulation);
        self.contact
            .add_tangent(&self.mesh, motion, By::Unknowns, pulleys, matrix);
        for p in 0..pulleys {
            let row = self.chain() + p;
            if self.prescribed[p].is_some() {
                matrix.set_unit_row(row);
                continue;
            }
            let external = &self.contact.pulleys[p].external;
            let (speed, factor) = (motion.speeds[p], z[load]);
            matrix.add_corner(p, p, -factor * external.derivative(0.0, speed));
            matrix.add_corner(p, pulleys + 1, -external.value(0.0, speed));
        }
        let Phase { at, tangent, .. } = self.phase;
        matrix.add_border_row(pulleys, at, &tangent);
        match self.control {
            Control::Load(_) => matrix.add(load, load, 1.0),
            Control::Slip(_) => {
                for (p, weight) in self.slip_weights.iter().enumerate() {
                    matrix.add(load, self.chain() + p, *weight);
                }
            }
        }
        debug_assert_eq!(circulation, self.chain() + pulleys);
    }
}
