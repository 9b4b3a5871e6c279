//! The belt of a steadily running drive, point by point: the rows of `profile.csv`.
//!
//! Rows follow the belt from mid-wrap of the first pulley in the order of the drive's list. Where a
//! force jumps (inlet, exit, beginning of a slip zone) there are two rows, one for each side. With
//! the stretch `lambda` the strain measures of the string are
//! ```text
//! Green (lambda² - 1)/2,   engineering lambda - 1,   true 1 - 1/lambda (4.10),   Almansi (1 - 1/lambda²)/2,   jacobian lambda.
//! ```
//! Contact forces are per length of the unstretched belt, as the finite elements have them (THEORY
//! 2.2, eq. 3.20): lambda times those per length of the running belt. Friction and slip are
//! positive counter-clockwise around the pulley, the speed of the belt along growing material
//! coordinate. Time is zero.

use crate::layout::Arc;
use crate::observe::ProfileRow;
use crate::steady::drive_string::DriveString;
use crate::steady::string::{BeltState, Running};

/// A part of an arc in which nothing jumps, `from` and `to` measured from the arc's first point of
/// the path [rad].
struct Zone {
    from: f64,
    to: f64,
    slips: bool,
}

impl DriveString {
    /// About `points` rows along the whole belt, both ends of every zone among them.
    pub fn profile(&self, running: &Running, points: usize) -> Vec<ProfileRow> {
        let spacing = self.layout.length / points.max(1) as f64;
        let mut rows = Rows {
            drive: self,
            running,
            spacing,
            material: 0.0,
            done: Vec::new(),
        };
        let count = self.names.len();
        let half = 0.5 * self.layout.arcs[0].sweep.abs();
        rows.arc(0, half, 2.0 * half);
        for i in 0..count {
            rows.span(i);
            if i + 1 < count {
                rows.arc(i + 1, 0.0, self.layout.arcs[i + 1].sweep.abs());
            }
        }
        rows.arc(0, 0.0, half);
        rows.done
    }
}

struct Rows<'a> {
    drive: &'a DriveString,
    running: &'a Running,
    /// Distance of rows [m].
    spacing: f64,
    /// Material coordinate where the next piece begins [m].
    material: f64,
    done: Vec<ProfileRow>,
}

impl Rows<'_> {
    fn span(&mut self, span: usize) {
        let line = &self.drive.layout.spans[span];
        let state = &self.running.spans[self.drive.string_span(span)];
        let stretch = 1.0 + state.strain;
        let free = BeltState {
            strain: state.strain,
            tension: state.tension,
            speed: state.speed,
            normal_force: 0.0,
            friction_force: 0.0,
            slip_speed: 0.0,
            unstretched_length: 0.0,
        };
        for along in between(0.0, line.length, self.spacing) {
            self.push(
                line.at + along,
                self.material + along / stretch,
                &free,
                None,
            );
        }
        self.material += line.length / stretch;
    }

    /// The part of an arc between two angles from its first point of the path.
    fn arc(&mut self, pulley: usize, from: f64, to: f64) {
        let drive = self.drive;
        let arc = &drive.layout.arcs[pulley];
        let wrap = arc.sweep.abs();
        let begin = self.length_before(pulley, from);
        for zone in self.zones(pulley) {
            let (a, b) = (zone.from.max(from), zone.to.min(to));
            if a >= b {
                continue;
            }
            for angle in between(a, b, self.spacing / arc.radius) {
                let state = self.state(pulley, wrap, angle, zone.slips);
                let material = self.material + self.length_before(pulley, angle) - begin;
                self.push(path_coordinate(arc, angle), material, &state, Some(pulley));
            }
        }
        self.material += self.length_before(pulley, to) - begin;
    }

    fn zones(&self, pulley: usize) -> [Zone; 2] {
        let state = &self.running.pulleys[self.drive.string_pulley(pulley)];
        let (slip, stick) = (state.slip_angle, state.stick_angle);
        if self.drive.direction > 0.0 {
            [
                Zone {
                    from: 0.0,
                    to: stick,
                    slips: false,
                },
                Zone {
                    from: stick,
                    to: stick + slip,
                    slips: true,
                },
            ]
        } else {
            [
                Zone {
                    from: 0.0,
                    to: slip,
                    slips: true,
                },
                Zone {
                    from: slip,
                    to: slip + stick,
                    slips: false,
                },
            ]
        }
    }

    fn state(&self, pulley: usize, wrap: f64, angle: f64, slips: bool) -> BeltState {
        let string = self.drive.string_pulley(pulley);
        let passed = if self.drive.direction > 0.0 {
            angle
        } else {
            wrap - angle
        };
        if slips {
            let stick = self.running.pulleys[string].stick_angle;
            self.running.in_slip_zone(string, (passed - stick).max(0.0))
        } else {
            self.running
                .on_pulley(string, passed.min(self.running.pulleys[string].stick_angle))
        }
    }

    /// Unstretched length between the arc's first point of the path and an angle.
    fn length_before(&self, pulley: usize, angle: f64) -> f64 {
        let string = self.drive.string_pulley(pulley);
        let wrap = self.drive.layout.arcs[pulley].sweep.abs();
        let passed = |angle: f64| self.running.on_pulley(string, angle).unstretched_length;
        if self.drive.direction > 0.0 {
            passed(angle)
        } else {
            passed(wrap) - passed(wrap - angle)
        }
    }

    fn push(&mut self, s: f64, material: f64, state: &BeltState, pulley: Option<usize>) {
        let point = self.drive.layout.point(s);
        let stretch = 1.0 + state.strain;
        let along = self.drive.direction;
        let counter_clockwise = pulley.map_or(0.0, |i| self.drive.rotation(i));
        self.done.push(ProfileRow {
            time: 0.0,
            material_coordinate: material,
            x: point.position[0],
            y: point.position[1],
            z: 0.0,
            tension: state.tension,
            element_tension: state.tension,
            strain_green: state.strain * (1.0 + 0.5 * state.strain),
            strain_engineering: state.strain,
            strain_true: state.strain / stretch,
            strain_almansi: state.strain * (1.0 + 0.5 * state.strain) / (stretch * stretch),
            jacobian: stretch,
            speed: along * state.speed,
            normal_force: stretch * state.normal_force,
            friction_force: counter_clockwise * stretch * state.friction_force,
            slip_speed: counter_clockwise * state.slip_speed,
            pulley: pulley.map_or_else(String::new, |i| self.drive.names[i].clone()),
        });
    }
}

fn path_coordinate(arc: &Arc, angle: f64) -> f64 {
    arc.start + angle * arc.radius
}

/// Values from `from` to `to`, both included, evenly spaced, no further apart than `spacing`.
fn between(from: f64, to: f64, spacing: f64) -> impl Iterator<Item = f64> {
    let steps = ((to - from) / spacing).ceil().max(1.0);
    std::iter::successors(Some(0.0), move |i| (i + 1.0 < steps).then_some(i + 1.0))
        .map(move |i| from + (to - from) * i / steps)
        .chain(std::iter::once(to))
}
