//! The sections of a belt of plates: forces of the whole width, strains on the line that is shown.

use ancf::dynamics::Motion;
use ancf::element::{Element, SurfaceElement, ThinPlate};
use ancf::mesh::Mesh;
use ancf::strain::SurfaceGradient;
use ancf::system::State;

use super::section_table::{DOF, SectionTable, VECTORS};
use super::state;
use super::station::{PulleyLaw, Station, Stations, Touch};
use crate::contact::PulleyContact;
use crate::contact::surface::{SurfaceContact, SurfaceTouch};
use crate::load::ExternalTorque;

impl PulleyLaw<ThinPlate> for SurfaceContact {
    fn resultants(&self, state: State<'_>, out: &mut [PulleyContact]) {
        Self::resultants(self, state, out);
    }

    fn external(&self, p: usize) -> &ExternalTorque {
        &self.pulleys[p].external
    }

    fn hub_velocity(&self, p: usize, time: f64) -> [f64; 3] {
        self.pulleys[p].hub(time)[1]
    }

    fn stations(&self, mesh: &Mesh<ThinPlate>, motion: &Motion, stations: &mut Stations) {
        let across = mesh.section_dof() / ThinPlate::NODE_DOF - 1;
        let place = SectionPlaces::new(self, across);
        stations.points.clear();
        stations.element_length.clear();
        for (i, row) in mesh.elements().chunks_exact(across).enumerate() {
            let tables = stations.tables.of(&row[0], self.rule(), place.eta);
            let sections = Sections {
                contact: self,
                mesh,
                motion,
                row: i,
                across,
                beside: place.beside,
                tables,
            };
            stations.element_length.push(row[0].length());
            let points = (0..self.rule().points.len()).map(|k| sections.station(k));
            stations.points.extend(points);
        }
    }
}

/// Where the line that is shown lies: which element across, and where in it.
struct SectionPlaces {
    beside: usize,
    eta: f64,
}

impl SectionPlaces {
    fn new(contact: &SurfaceContact, across: usize) -> Self {
        let place = contact.line * across as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between zero and the number of elements across"
        )]
        let beside = (place.floor() as usize).min(across - 1);
        Self {
            beside,
            eta: place - beside as f64,
        }
    }
}

/// Reads the sections of one row of elements.
struct Sections<'a> {
    contact: &'a SurfaceContact,
    mesh: &'a Mesh<ThinPlate>,
    motion: &'a Motion,
    row: usize,
    across: usize,
    /// The element of the row on which the line lies that is shown.
    beside: usize,
    tables: &'a SectionTable,
}

/// What the points across a section in contact sum up to.
#[derive(Default)]
pub(super) struct Band {
    pulley: Option<usize>,
    normal_force: f64,
    friction_force: f64,
    slip: f64,
    width: f64,
    sliding: f64,
}

impl Band {
    pub(super) fn add(&mut self, touch: &SurfaceTouch, width: f64) {
        if *self.pulley.get_or_insert(touch.pulley) != touch.pulley {
            return;
        }
        self.normal_force += touch.normal_force * width;
        self.friction_force += touch.friction[0] * width;
        self.slip += touch.slip[0] * width;
        self.width += width;
        self.sliding += if touch.slides { width } else { 0.0 };
    }

    pub(super) fn touch(&self) -> Option<Touch> {
        self.pulley.map(|pulley| Touch {
            pulley,
            normal_force: self.normal_force,
            friction_force: self.friction_force,
            slip: self.slip / self.width,
            slides: self.sliding > 0.5 * self.width,
        })
    }
}

impl Sections<'_> {
    /// The section at contact point `k` along the row.
    fn station(&self, k: usize) -> Station {
        let rule = self.contact.rule();
        let first = self.row * self.across;
        let mut band = Band::default();
        let mut tension = 0.0;
        let mut e = [0.0; DOF];
        for j in first..first + self.across {
            let element = &self.mesh.elements()[j];
            self.mesh.gather(j, &self.motion.q, &mut e);
            for (slopes, width) in self.tables.across[k].iter().zip(self.tables.widths) {
                tension += width * force_per_width(element, gradient(slopes, &e));
            }
            for (m, weight) in rule.weights.iter().enumerate() {
                if let Some(touch) = self.contact.touch(state(self.motion), j, [k, m]) {
                    band.add(&touch, weight * element.width());
                }
            }
        }
        let touch = band.touch();
        let mut station = self.on_the_line(k, touch.map(|touch| touch.pulley));
        station.element = self.row;
        station.xi = rule.points[k];
        station.weight = rule.weights[k] * self.mesh.elements()[first].length();
        station.touch = touch;
        station.tension = tension;
        station.edges = Some(self.edges(k));
        station
    }

    /// Positions on the belt's edges, of the first and of the last element across.
    fn edges(&self, k: usize) -> [[f64; 3]; 2] {
        let first = self.row * self.across;
        std::array::from_fn(|side| {
            let mut e = [0.0; DOF];
            let element = first + side * (self.across - 1);
            self.mesh.gather(element, &self.motion.q, &mut e);
            combine(&self.tables.edges[k][side], &e)
        })
    }

    /// Position, strains and speed on the line that is shown.
    fn on_the_line(&self, k: usize, pulley: Option<usize>) -> Station {
        let element = self.row * self.across + self.beside;
        let (mut e, mut rate) = ([0.0; DOF], [0.0; DOF]);
        self.mesh.gather(element, &self.motion.q, &mut e);
        self.mesh.gather(element, &self.motion.v, &mut rate);
        let [shape, by_x, by_y] = &self.tables.line[k];
        let (position, velocity) = (combine(shape, &e), combine(shape, &rate));
        let gradient = gradient(&[*by_x, *by_y], &e);
        let stretch = gradient.fibre([1.0, 0.0]).stretch();
        let turn = pulley.map_or(0.0, |p| {
            self.contact.turn(p, self.motion, position, gradient.x)
        });
        Station {
            position,
            stretch,
            jacobian: gradient.jacobian(),
            speed: dot(gradient.x, velocity) / stretch,
            turn,
            ..Station::default()
        }
    }
}

/// True axial force per unstretched width [N/m] on a cut across the belt: with the second Piola-Kirchhoff forces N,
/// the traction `N_xx r_x + N_xy r_y` along the fibre.
fn force_per_width(element: &ThinPlate, gradient: SurfaceGradient) -> f64 {
    let [xx, _, xy] = element.membrane_forces(&gradient);
    let stretch = gradient.fibre([1.0, 0.0]).stretch();
    xx * stretch + xy * dot(gradient.x, gradient.y) / stretch
}

fn combine(weights: &[f64; VECTORS], e: &[f64; DOF]) -> [f64; 3] {
    std::array::from_fn(|axis| (0..VECTORS).map(|k| weights[k] * e[3 * k + axis]).sum())
}

fn gradient([by_x, by_y]: &[[f64; VECTORS]; 2], e: &[f64; DOF]) -> SurfaceGradient {
    SurfaceGradient {
        x: combine(by_x, e),
        y: combine(by_y, e),
    }
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
