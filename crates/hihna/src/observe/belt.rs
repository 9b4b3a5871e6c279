//! The belt point by point, and what lies on each pulley.

use ancf::dynamics::Motion;
use ancf::element::{Element, LineElement};
use ancf::mesh::Mesh;
use ancf::system::System;

use super::station::{PulleyLaw, Stations, stations_at};
use crate::contact::{BeltPoint, ContactPulley};

/// The belt on one pulley.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Arc {
    pub contact_angle: f64,
    pub slip_angle: f64,
    pub tension_in: f64,
    pub tension_out: f64,
}

/// All sections of a state.
#[derive(Debug, Default)]
pub(super) struct BeltSurvey {
    pub stations: Stations,
    /// Mean true axial force of each element [N].
    pub element_tension: Vec<f64>,
}

impl BeltSurvey {
    pub fn take<E: Element, L: PulleyLaw<E>>(&mut self, system: &System<E, L>, motion: &Motion) {
        (system.law).stations(system.mesh(), motion, &mut self.stations);
        self.sum_tensions();
    }

    /// Takes in the belt of `mesh` at `q` as seen at `points`.
    pub fn take_points<E: LineElement>(
        &mut self,
        mesh: &Mesh<E>,
        pulleys: &[ContactPulley],
        q: &[f64],
        points: &[BeltPoint],
    ) {
        stations_at(mesh, pulleys, q, points, &mut self.stations);
        self.sum_tensions();
    }

    fn sum_tensions(&mut self) {
        let stations = &self.stations;
        self.element_tension.clear();
        self.element_tension
            .resize(stations.element_length.len(), 0.0);
        for point in &stations.points {
            self.element_tension[point.element] +=
                point.weight * point.tension / stations.element_length[point.element];
        }
    }

    /// Whether the belt runs in the order of the path; a belt at rest is taken to.
    pub fn runs_forwards(&self) -> bool {
        self.stations
            .points
            .iter()
            .map(|point| point.weight * point.speed)
            .sum::<f64>()
            >= 0.0
    }

    /// The belt on pulley `p`.
    pub fn arc(&self, p: usize) -> Arc {
        let mut arc = Arc::default();
        let points = &self.stations.points;
        let count = points.len();
        let on = |i: usize| points[i].touch.is_some_and(|touch| touch.pulley == p);
        let (mut first, mut last) = (None, None);
        for i in 0..count {
            let Some(touch) = points[i].touch.filter(|_| on(i)) else {
                continue;
            };
            let angle = points[i].weight * points[i].turn;
            arc.contact_angle += angle;
            if touch.slides {
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
            let tension = |i: usize| self.element_tension[points[i].element];
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
        let lengths = &self.stations.element_length;
        let length: f64 = lengths.iter().sum();
        self.element_tension
            .iter()
            .zip(lengths)
            .map(|(tension, length)| tension * length)
            .sum::<f64>()
            / length
    }
}
