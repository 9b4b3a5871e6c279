//! The belt point by point, as `profile.csv` has it.

use super::belt::BeltSurvey;
use super::station::Station;

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
    pub element_tension: f64,
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

/// One row of `edges.csv`: the edges of a belt that is a surface, beside the row of `frames.csv` of the same time and
/// material coordinate. Edge 0 is that of the lesser z on a drive in its plane. SI units.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[expect(
    missing_docs,
    reason = "columns of edges.csv, described in the user guide"
)]
pub struct EdgeRow {
    pub time: f64,
    pub material_coordinate: f64,
    pub x0: f64,
    pub y0: f64,
    pub z0: f64,
    pub x1: f64,
    pub y1: f64,
    pub z1: f64,
}

impl BeltSurvey {
    /// The edges at every integration point that has any, in order of material coordinate.
    pub fn edges(&self, time: f64, element_start: &[f64]) -> Vec<EdgeRow> {
        let stations = &self.stations;
        let row = |point: &Station| {
            let [[x0, y0, z0], [x1, y1, z1]] = point.edges?;
            Some(EdgeRow {
                time,
                material_coordinate: element_start[point.element]
                    + point.xi * stations.element_length[point.element],
                x0,
                y0,
                z0,
                x1,
                y1,
                z1,
            })
        };
        stations.points.iter().filter_map(row).collect()
    }

    /// Every integration point, in order of material coordinate.
    pub fn profile(&self, time: f64, element_start: &[f64], names: &[String]) -> Vec<ProfileRow> {
        self.stations
            .points
            .iter()
            .map(|point| {
                let stretch = point.stretch;
                let mut row = ProfileRow {
                    time,
                    material_coordinate: element_start[point.element]
                        + point.xi * self.stations.element_length[point.element],
                    x: point.position[0],
                    y: point.position[1],
                    z: point.position[2],
                    tension: point.tension,
                    element_tension: self.element_tension[point.element],
                    strain_green: 0.5 * (stretch * stretch - 1.0),
                    strain_engineering: stretch - 1.0,
                    strain_true: 1.0 - 1.0 / stretch,
                    strain_almansi: 0.5 * (1.0 - 1.0 / (stretch * stretch)),
                    jacobian: point.jacobian,
                    speed: point.speed,
                    ..ProfileRow::default()
                };
                if let Some(touch) = point.touch {
                    row.normal_force = touch.normal_force;
                    row.friction_force = touch.friction_force;
                    row.slip_speed = touch.slip;
                    row.pulley.clone_from(&names[touch.pulley]);
                }
                row
            })
            .collect()
    }
}
