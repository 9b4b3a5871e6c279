//! Section 4.1 and the analytical half of section 4.6: the extensible string with inertia, from the
//! drive file of Model 2 (Table 4.1) to the rows of its belt profile.

use super::{CaseError, Quantities};
use crate::input::{self, Override};
use crate::observe::ProfileRow;
use crate::steady::drive_string::DriveString;
use crate::steady::string::{Answer, Closure, Model, Running};

const MODEL_2: &str = include_str!("../../../../examples/string_model_2.toml");
/// E A = 25 kN instead of 0.2 kN.
const STIFF: &str = "belt.youngs_modulus=250 MPa";
/// Rows of the profile, about: 1.6e-4 m or 3e-3 rad apart.
const ROWS: usize = 4000;
/// Position of the driven pulley in the drive.
const DRIVEN: usize = 1;

/// A solved drive.
struct Solved {
    drive: DriveString,
    running: Running,
    rows: Vec<ProfileRow>,
}

impl Solved {
    fn new(changes: &[&str], model: Model, closure: Closure) -> Result<Self, CaseError> {
        let changes = changes
            .iter()
            .map(|change| change.parse())
            .collect::<Result<Vec<Override>, _>>()?;
        let drive = input::parse("string_model_2.toml", MODEL_2, &changes)?;
        let drive = DriveString::new(&drive, model, closure)?;
        let Answer::Running(running) = drive.solve()? else {
            return Err(CaseError::DoesNotRun);
        };
        let rows = drive.profile(&running, ROWS);
        Ok(Self {
            drive,
            running,
            rows,
        })
    }

    fn speed_loss(&self) -> f64 {
        self.drive.pulleys(&self.running)[DRIVEN].speed_loss
    }

    /// The rows in pieces in which nothing jumps: free spans, stick arcs, slip arcs.
    fn pieces(&self) -> impl Iterator<Item = &[ProfileRow]> {
        self.rows
            .chunk_by(|a, b| a.pulley == b.pulley && is_slip(a) == is_slip(b))
    }

    /// T - G v [N].
    fn pressing(&self, row: &ProfileRow) -> f64 {
        row.tension - self.running.mass_flow * row.speed
    }

    /// Angle between two rows on one pulley [rad].
    fn turn(&self, pair: &[ProfileRow]) -> f64 {
        let names = self.drive.names.iter().zip(&self.drive.layout.arcs);
        let radius = names
            .filter(|(name, _)| **name == pair[0].pulley)
            .map(|(_, arc)| arc.radius)
            .next();
        let chord = (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y);
        radius.map_or(f64::NAN, |radius| 2.0 * (0.5 * chord / radius).asin())
    }

    /// Integral of friction force times radius over the pulley [N m]: trapezoid rule in the angle, in
    /// which the force per running length grows by exp(±mu theta).
    fn friction_torque(&self, pulley: usize) -> f64 {
        let name = &self.drive.names[pulley];
        let radius = self.drive.layout.arcs[pulley].radius;
        let force = |row: &ProfileRow| row.friction_force / row.jacobian;
        let pieces = self.pieces().filter(|piece| piece[0].pulley == *name);
        let sum: f64 = pieces
            .flat_map(|piece| piece.windows(2))
            .map(|pair| 0.5 * (force(&pair[0]) + force(&pair[1])) * self.turn(pair))
            .sum();
        // Friction on the belt turns the pulley the other way.
        -radius * radius * sum
    }

    /// Of `|friction| / normal force` in slip arcs, the value farthest from `coefficient`.
    fn friction_ratio(&self, coefficient: f64) -> f64 {
        let slip = self.rows.iter().filter(|row| is_slip(row));
        farthest(
            coefficient,
            slip.map(|row| row.friction_force.abs() / row.normal_force),
        )
    }

    /// Angle from the largest friction force on the driven pulley to its exit [rad].
    fn peak_to_exit(&self) -> f64 {
        let arc = &self.drive.layout.arcs[DRIVEN];
        let on = self
            .rows
            .iter()
            .filter(|row| row.pulley == self.drive.names[DRIVEN]);
        let angle = |row: &ProfileRow| {
            let turned = (row.y - arc.center[1]).atan2(row.x - arc.center[0]) - arc.start_angle;
            arc.sweep - turned.rem_euclid(std::f64::consts::TAU)
        };
        on.max_by(|a, b| a.friction_force.abs().total_cmp(&b.friction_force.abs()))
            .map_or(f64::NAN, angle)
    }
}

fn is_slip(row: &ProfileRow) -> bool {
    row.friction_force != 0.0
}

/// The value farthest from `target`; not a number without values.
fn farthest(target: f64, values: impl Iterator<Item = f64>) -> f64 {
    values
        .max_by(|a, b| (a - target).abs().total_cmp(&(b - target).abs()))
        .unwrap_or(f64::NAN)
}

/// Largest less least value, relative; not a number without values.
fn variation(values: impl Iterator<Item = f64>) -> f64 {
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| {
        (v.min(least), v.max(most))
    });
    (most - least) / most.abs()
}

/// k = 25 kN: Figs 4.4 and 4.5.
pub(super) fn stiff() -> Result<Quantities, CaseError> {
    let solved = Solved::new(&[STIFF], Model::Full, Closure::UnstretchedLength)?;
    let mut quantities = distributions(&solved);
    let loss = solved.speed_loss();
    quantities.push(("speed loss".into(), loss));
    quantities.push(("speed loss, to more digits".into(), loss));
    Ok(quantities)
}

/// k = 0.2 kN: Figs 4.11 and 4.14.
pub(super) fn compliant() -> Result<Quantities, CaseError> {
    let solved = Solved::new(&[], Model::Full, Closure::UnstretchedLength)?;
    Ok(distributions(&solved))
}

/// What (4.1)-(4.4) and (4.48) say about speed and tension along the belt.
fn distributions(solved: &Solved) -> Quantities {
    let flatness = |kind: fn(&ProfileRow) -> bool| {
        let pieces = solved.pieces().filter(|piece| kind(&piece[0]));
        pieces.fold(f64::NAN, |worst: f64, piece| {
            let speed = variation(piece.iter().map(|row| row.speed));
            worst
                .max(speed)
                .max(variation(piece.iter().map(|row| row.tension)))
        })
    };
    let friction = solved.drive.string.pulleys[0].friction;
    let slip_arcs = solved.pieces().filter(|piece| is_slip(&piece[0]));
    let growth = slip_arcs.flat_map(|piece| piece.windows(2)).map(|pair| {
        (solved.pressing(&pair[1]) / solved.pressing(&pair[0])).ln() / solved.turn(pair)
    });
    let growth = farthest(friction, growth.map(f64::abs));
    let stick_behind_slip = solved
        .rows
        .windows(2)
        .filter(|pair| pair[0].pulley == pair[1].pulley && is_slip(&pair[0]) && !is_slip(&pair[1]))
        .count();
    let (pulleys, spans) = (
        solved.drive.pulleys(&solved.running),
        solved.drive.spans(&solved.running),
    );
    let surface = pulleys[DRIVEN].speed * solved.drive.layout.arcs[DRIVEN].radius;
    vec![
        (
            "variation of speed and tension in free spans".into(),
            flatness(|row| row.pulley.is_empty()),
        ),
        (
            "variation of speed and tension in stick arcs".into(),
            flatness(|row| !row.pulley.is_empty() && !is_slip(row)),
        ),
        (
            "stick behind slip, seen along the motion".into(),
            stick_behind_slip as f64,
        ),
        (
            "growth of ln(T - G v) per angle in slip arcs".into(),
            growth,
        ),
        ("speed of the tight span".into(), spans[DRIVEN].speed),
        (
            "surface speed of the driven pulley over speed of the slack span".into(),
            surface / spans[0].speed,
        ),
        (
            "friction force times radius on the driven pulley".into(),
            solved.friction_torque(DRIVEN),
        ),
    ]
}

/// How much slower the driven pulley is, by model and closure, k = 0.2 kN.
pub(super) fn speed_losses() -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    for (model, name) in [
        (Model::Full, "full"),
        (Model::Centrifugal, "centrifugal"),
        (Model::Capstan, "capstan"),
    ] {
        for (closure, kept) in [
            (Closure::UnstretchedLength, "unstretched length"),
            (Closure::TensionSum, "sum of tensions"),
        ] {
            let loss = Solved::new(&[], model, closure)?.speed_loss();
            let name = format!("{name} model, {kept} kept");
            quantities.push((format!("{name}, to more digits"), loss));
            quantities.push((name, loss));
        }
    }
    Ok(quantities)
}

/// Friction and normal force on the driven pulley, k = 0.2 kN: Figs 4.17 and 4.18.
pub(super) fn contact_forces() -> Result<Quantities, CaseError> {
    let full = Solved::new(&[], Model::Full, Closure::UnstretchedLength)?;
    let capstan = Solved::new(&[], Model::Capstan, Closure::UnstretchedLength)?;
    let mut quantities = Quantities::new();
    for (solved, model) in [(&full, "full"), (&capstan, "capstan")] {
        let coefficient = solved.drive.string.pulleys[0].friction;
        quantities.extend([
            (
                format!("friction force times radius on the driven pulley, {model} model"),
                solved.friction_torque(DRIVEN),
            ),
            (
                format!("friction over normal force in slip arcs, {model} model"),
                solved.friction_ratio(coefficient),
            ),
            (
                format!("angle from the peak of friction to the exit, {model} model"),
                solved.peak_to_exit(),
            ),
        ]);
    }
    let (wrap, points) = (full.drive.layout.arcs[DRIVEN].sweep.abs(), 1000);
    let excess = (0..=points).map(|i| {
        let angle = wrap * f64::from(i) / f64::from(points);
        let force = |solved: &Solved| {
            let pulley = solved.drive.string_pulley(DRIVEN);
            solved.running.on_pulley(pulley, angle).normal_force
        };
        force(&capstan) - force(&full)
    });
    quantities.push((
        "least excess of the capstan model's normal force over the full model's".into(),
        excess.fold(f64::INFINITY, f64::min),
    ));
    Ok(quantities)
}
