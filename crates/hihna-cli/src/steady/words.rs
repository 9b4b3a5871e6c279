//! What `hihna steady` found, in words and tables.

use std::f64::consts::PI;
use std::fmt::Write;

use hihna::drive::{Drive, Friction};
use hihna::steady::running::summary::CapacitySummary;

use super::ClosureName;
use super::summary::{ModelSummary, Steady, Summary};
use crate::quantities::{degrees, percent, plain, with_prefix};
use crate::tables::columns;

/// Radians per second of one turn per minute.
const RPM: f64 = PI / 30.0;

impl Summary {
    pub fn in_words(&self, drive: &Drive) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", title(&self.title));
        let _ = writeln!(text, "{}", self.model.in_words(drive));
        match &self.steady {
            Some(steady) => text.push_str(&steady.in_words()),
            None => {
                let _ = writeln!(text, "{}\n", capitalised(&self.message));
            }
        }
        if let Some(capacity) = &self.capacity {
            text.push_str(&capacity_in_words(capacity));
        }
        if let Some(loads) = &self.largest_load {
            let _ = writeln!(
                text,
                "Safety against gross slip: without bound, no torque is transmitted"
            );
            for (pulley, torque) in &loads.0 {
                let _ = writeln!(
                    text,
                    "Largest torque: {} on `{pulley}` as the only load",
                    with_prefix(*torque, "N m")
                );
            }
        }
        if let Some(fields) = &self.sensitivity {
            let _ = write!(text, "\n{}", super::sensitivity::in_words(fields));
        }
        if let Some(folder) = &self.folder {
            let _ = writeln!(text, "Results: {folder}");
        }
        text
    }
}

pub(super) fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

impl ModelSummary {
    fn in_words(&self, drive: &Drive) -> String {
        let closure = match self.closure {
            ClosureName::Length => "the unstretched length",
            ClosureName::TensionSum => "the mean tension",
        };
        let unused = match drive.contact.friction {
            Friction::CreepRate { .. } => "the slope of law `creep-rate`",
            Friction::Coulomb { .. } => "the velocity of law `coulomb`",
            Friction::Stribeck { .. } => "the static coefficient and velocities of law `stribeck`",
            Friction::ElasticPlastic { .. } => "the bristles of law `elastic-plastic`",
        };
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "Steady running of an extensible string, {}, {closure} kept",
            self.inertia.in_words()
        );
        let _ = writeln!(
            text,
            "Friction coefficient {}; {unused} plays no part",
            self.friction_coefficient
        );
        let _ = writeln!(
            text,
            "Axial stiffness {}, {} per unstretched length, {} at rest",
            with_prefix(self.axial_stiffness, "N"),
            plain(self.line_density, "kg/m"),
            with_prefix(self.rest_tension, "N"),
        );
        text
    }
}

/// What is told of a running drive, whatever the theory.
pub(super) struct RunningWords<'a> {
    /// Which arc of a pulley the theory knows.
    pub arc: &'static str,
    pub pulleys: Vec<PulleyWords<'a>>,
    /// Name, tension, belt speed, strain.
    pub spans: Vec<(&'a str, f64, f64, f64)>,
    pub speed_loss: f64,
    /// In, out, lost.
    pub powers: [f64; 3],
    pub efficiency: Option<f64>,
}

pub(super) struct PulleyWords<'a> {
    pub name: &'a str,
    pub speed: f64,
    pub external_torque: f64,
    pub slip_angle: f64,
    pub stick_angle: f64,
    pub arc: f64,
    pub hub_force: [f64; 2],
    pub power: f64,
    pub speed_loss: f64,
}

impl RunningWords<'_> {
    pub fn in_words(&self) -> String {
        let header = [
            "pulley",
            "speed",
            "",
            "external torque",
            "slip",
            "stick",
            self.arc,
            "hub force",
            "power taken",
            "speed loss",
        ];
        let mut pulleys = columns(&header, &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        for pulley in &self.pulleys {
            pulleys.add_row([
                pulley.name.to_owned(),
                plain(pulley.speed, "rad/s"),
                plain(pulley.speed / RPM, "rpm"),
                with_prefix(pulley.external_torque, "N m"),
                degrees(pulley.slip_angle),
                degrees(pulley.stick_angle),
                degrees(pulley.arc),
                with_prefix(pulley.hub_force[0].hypot(pulley.hub_force[1]), "N"),
                with_prefix(pulley.power, "W"),
                percent(pulley.speed_loss),
            ]);
        }
        let mut spans = columns(&["span", "tension", "belt speed", "strain"], &[1, 2, 3]);
        for (name, tension, speed, strain) in &self.spans {
            spans.add_row([
                (*name).to_owned(),
                with_prefix(*tension, "N"),
                plain(*speed, "m/s"),
                percent(*strain),
            ]);
        }
        let efficiency =
            (self.efficiency).map_or_else(|| "none, no power is transmitted".to_owned(), percent);
        let [put_in, taken_out, lost] = self.powers.map(|power| with_prefix(power, "W"));
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}\n", pulleys.trim_fmt());
        let _ = writeln!(text, "{}\n", spans.trim_fmt());
        let _ = writeln!(text, "Speed loss: {}", percent(self.speed_loss));
        let _ = writeln!(text, "Power: {put_in} in, {taken_out} out, {lost} lost");
        let _ = writeln!(text, "Efficiency: {efficiency}");
        text
    }
}

impl Steady {
    fn in_words(&self) -> String {
        let pulleys = self.pulley.0.iter().map(|(name, pulley)| PulleyWords {
            name,
            speed: pulley.speed,
            external_torque: pulley.external_torque,
            slip_angle: pulley.slip_angle,
            stick_angle: pulley.stick_angle,
            arc: pulley.wrap_angle,
            hub_force: pulley.hub_force,
            power: pulley.power,
            speed_loss: pulley.speed_loss,
        });
        let spans = (self.span.0.iter())
            .map(|(name, span)| (name.as_str(), span.tension, span.speed, span.strain));
        RunningWords {
            arc: "wrap",
            pulleys: pulleys.collect(),
            spans: spans.collect(),
            speed_loss: self.speed_loss,
            powers: [self.power_in, self.power_out, self.power_lost],
            efficiency: self.efficiency,
        }
        .in_words()
    }
}

/// The drive's title, or what stands for it.
pub(super) fn title(title: &str) -> &str {
    if title.is_empty() {
        "Belt drive"
    } else {
        title
    }
}

/// What the drive carries.
pub(super) fn capacity_in_words(capacity: &CapacitySummary) -> String {
    let torques: Vec<_> = (capacity.torque.0.iter())
        .map(|(pulley, torque)| format!("{} on `{pulley}`", with_prefix(*torque, "N m")))
        .collect();
    format!(
        "Safety against gross slip: {}, then `{}` slips first\nLargest torque: {}\n",
        plain(capacity.factor, "times the torques"),
        capacity.pulley,
        if torques.is_empty() {
            "none".to_owned()
        } else {
            torques.join(", ")
        },
    )
}
