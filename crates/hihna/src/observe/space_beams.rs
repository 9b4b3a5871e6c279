//! The sections of a belt of spatial beams: forces of the whole section, strains on the line that is shown.

use ancf::dynamics::Motion;
use ancf::mesh::Mesh;
use ancf::system::State;

use super::state;
use super::station::{PulleyLaw, Station, Stations, Touch};
use super::surface::{Band, cross, dot};
use crate::assemble::SpaceBeltElement;
use crate::contact::PulleyContact;
use crate::contact::surface::SurfaceContact;
use crate::load::ExternalTorque;

/// Most coordinates and vectors of a spatial beam.
const DOF: usize = 24;
const VECTORS: usize = DOF / 3;

impl<E: SpaceBeltElement> PulleyLaw<E> for SurfaceContact {
    fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]) {
        Self::resultants(self, state, out);
    }

    fn external(&self, p: usize) -> &ExternalTorque {
        &self.pulleys[p].external
    }

    fn hub_velocity(&self, p: usize, time: f64) -> [f64; 3] {
        self.pulleys[p].hub(time)[1]
    }

    fn stations(&self, mesh: &Mesh<E>, motion: &Motion, stations: &mut Stations) {
        const { assert!(E::DOF <= DOF && E::DIMENSION == 3) }
        stations.points.clear();
        stations.element_length.clear();
        for (i, element) in mesh.elements().iter().enumerate() {
            stations.element_length.push(element.length());
            let (mut e, mut rate) = ([0.0; DOF], [0.0; DOF]);
            mesh.gather(i, &motion.q, &mut e[..E::DOF]);
            mesh.gather(i, &motion.v, &mut rate[..E::DOF]);
            for k in 0..self.rule().points.len() {
                let touch = touch(self, motion, i, k, element.length());
                let xi = self.rule().points[k];
                let beside = |line: f64| OnLine::new(element, xi, (line - 0.5) * self.width);
                let line = beside(self.line);
                let (position, velocity) = (combine(&line.at, &e), combine(&line.at, &rate));
                let slope = combine(&line.slope, &e);
                let stretch = dot(slope, slope).sqrt();
                stations.points.push(Station {
                    element: i,
                    xi,
                    weight: self.rule().weights[k] * element.length(),
                    position,
                    touch,
                    tension: element.axial_force(&e[..E::DOF], xi),
                    stretch,
                    jacobian: element.jacobian(&e[..E::DOF], xi),
                    speed: dot(slope, velocity) / stretch,
                    turn: touch.map_or(0.0, |touch| {
                        self.turn(touch.pulley, motion, position, slope)
                    }),
                    edges: Some([0.0, 1.0].map(|line| combine(&beside(line).at, &e))),
                });
            }
        }
    }
}

impl SurfaceContact {
    /// Turn of a line with this `slope` at `position` about a pulley, per length of belt [rad/m].
    pub(super) fn turn(
        &self,
        pulley: usize,
        motion: &Motion,
        position: [f64; 3],
        slope: [f64; 3],
    ) -> f64 {
        let pulley = &self.pulleys[pulley];
        let [center, _] = pulley.hub(motion.time);
        let arm: [f64; 3] = std::array::from_fn(|axis| position[axis] - center[axis]);
        // p.(arm x r_x) over the square of the distance from the axis
        let along = dot(arm, pulley.axis);
        let distance = dot(arm, arm) - along * along;
        dot(pulley.axis, cross(arm, slope)).abs() / distance
    }
}

/// What the points across the section at contact point `k` along an element sum up to: of a V-belt, both flanks.
fn touch(
    contact: &SurfaceContact,
    motion: &Motion,
    element: usize,
    k: usize,
    length: f64,
) -> Option<Touch> {
    let weight = contact.rule().weights[k] * length;
    let mut band = Band::default();
    for p in 0..contact.pulleys.len() {
        for j in 0..contact.across(p, element) {
            if let Some(touch) = contact.touch_on(p, state(motion), element, [k, j]) {
                band.add(&touch, contact.area(p, element, [k, j]) / weight);
            }
        }
    }
    band.touch()
}

/// Weights of position and slope on a line along the beam.
struct OnLine {
    at: [f64; VECTORS],
    slope: [f64; VECTORS],
}

impl OnLine {
    /// The line `z` [m] beside the centre line.
    fn new<E: SpaceBeltElement>(element: &E, xi: f64, z: f64) -> Self {
        let (mut at, mut slope) = ([0.0; VECTORS], [0.0; VECTORS]);
        element.centre_line(xi, &mut at);
        element.centre_line_slope(xi, &mut slope);
        let [first, second] = E::SECTION_VECTORS.map(|vector| vector + 1);
        at[first] += z * (1.0 - xi);
        at[second] += z * xi;
        slope[first] -= z / element.length();
        slope[second] += z / element.length();
        Self { at, slope }
    }
}

fn combine(weights: &[f64; VECTORS], e: &[f64; DOF]) -> [f64; 3] {
    std::array::from_fn(|axis| (0..VECTORS).map(|k| weights[k] * e[3 * k + axis]).sum())
}
