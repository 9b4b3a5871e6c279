//! The belt point by point, and what lies on each pulley.

use ancf::dynamics::Motion;
use ancf::element::LineElement;

use super::{BeltSystem, state};
use crate::contact::BeltPoint;

/// The belt at one integration point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    /// True axial force [N].
    pub tension: f64,
    /// Present over unstretched length [-].
    pub stretch: f64,
    /// Area ratio det J [-].
    pub jacobian: f64,
    /// Speed along the belt, in the order of the path [m/s].
    pub speed: f64,
    /// Turn of the point per length of belt about the pulley it touches, unsigned [rad/m].
    turn: f64,
}

/// The belt on one pulley.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Arc {
    pub contact_angle: f64,
    pub slip_angle: f64,
    pub tension_in: f64,
    pub tension_out: f64,
}

/// All integration points of a state.
#[derive(Debug, Default)]
pub(super) struct BeltSurvey {
    pub points: Vec<BeltPoint>,
    pub samples: Vec<Sample>,
    /// Mean true axial force of each element [N].
    pub element_tension: Vec<f64>,
    /// Undeformed length of an element [m], by element.
    pub element_length: Vec<f64>,
    /// Coordinates of an element.
    e: Vec<f64>,
}

impl BeltSurvey {
    pub fn take<E: LineElement>(&mut self, system: &BeltSystem<E>, motion: &Motion) {
        system.law.points(state(motion), &mut self.points);
        self.examine(system, &motion.q);
    }

    /// Works out what the points of the configuration `q` show.
    pub fn examine<E: LineElement>(&mut self, system: &BeltSystem<E>, q: &[f64]) {
        let mesh = system.mesh();
        self.e.resize(E::DOF, 0.0);
        self.samples.clear();
        self.element_tension.clear();
        self.element_tension.resize(mesh.elements().len(), 0.0);
        self.element_length.clear();
        self.element_length
            .extend(mesh.elements().iter().map(LineElement::length));
        let mut gathered = usize::MAX;
        for point in &self.points {
            if point.element != gathered {
                mesh.gather(point.element, q, &mut self.e);
                gathered = point.element;
            }
            let element = &mesh.elements()[point.element];
            let slope = element.slope(&self.e, point.xi);
            let stretch = slope[0].hypot(slope[1]);
            let turn = point.contact.map_or(0.0, |(p, contact)| {
                let [nx, ny] = contact.normal;
                let distance = system.law.pulleys[p].radius - contact.penetration;
                (nx * slope[1] - ny * slope[0]).abs() / distance
            });
            let sample = Sample {
                tension: element.axial_force(&self.e, point.xi),
                stretch,
                jacobian: element.jacobian(&self.e, point.xi),
                speed: (slope[0] * point.velocity[0] + slope[1] * point.velocity[1]) / stretch,
                turn,
            };
            self.element_tension[point.element] += point.weight * sample.tension / element.length();
            self.samples.push(sample);
        }
    }

    /// Whether the belt runs in the order of the path; a belt at rest is taken to.
    pub fn runs_forwards(&self) -> bool {
        self.points
            .iter()
            .zip(&self.samples)
            .map(|(point, sample)| point.weight * sample.speed)
            .sum::<f64>()
            >= 0.0
    }

    /// The belt on pulley `p`.
    pub fn arc(&self, p: usize) -> Arc {
        let mut arc = Arc::default();
        let count = self.points.len();
        let on = |i: usize| {
            self.points[i]
                .contact
                .is_some_and(|(touched, _)| touched == p)
        };
        let (mut first, mut last) = (None, None);
        for i in 0..count {
            let Some((_, contact)) = self.points[i].contact.filter(|_| on(i)) else {
                continue;
            };
            let angle = self.points[i].weight * self.samples[i].turn;
            arc.contact_angle += angle;
            if contact.slides() {
                arc.slip_angle += angle;
            }
            if !on((i + count - 1) % count) && first.is_none() {
                first = Some(i);
            }
            if !on((i + 1) % count) {
                last = Some(i);
            }
        }
        // A patch that runs over the end of the list of points has its first point behind its last.
        if let (Some(first), Some(last)) = (first, last) {
            let tension = |i: usize| self.element_tension[self.points[i].element];
            let (on, off) = if self.runs_forwards() {
                (first, last)
            } else {
                (last, first)
            };
            arc.tension_in = tension(on);
            arc.tension_out = tension(off);
        }
        arc
    }

    pub fn mean_tension(&self) -> f64 {
        let length: f64 = self.element_length.iter().sum();
        self.element_tension
            .iter()
            .zip(&self.element_length)
            .map(|(tension, length)| tension * length)
            .sum::<f64>()
            / length
    }
}
