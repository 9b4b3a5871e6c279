//! What `hihna steady` found, in words and tables.

use std::f64::consts::PI;
use std::fmt::Write;

use hihna::drive::{Drive, Friction};

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
        let _ = writeln!(
            text,
            "{}",
            if self.title.is_empty() {
                "Belt drive"
            } else {
                &self.title
            }
        );
        let _ = writeln!(text, "{}", self.model.in_words(drive));
        match &self.steady {
            Some(steady) => text.push_str(&steady.in_words()),
            None => {
                let _ = writeln!(text, "{}\n", capitalised(&self.message));
            }
        }
        if let Some(capacity) = &self.capacity {
            let torques = capacity.torque.0.iter();
            let torques: Vec<_> = torques
                .map(|(pulley, torque)| format!("{} on `{pulley}`", with_prefix(*torque, "N m")))
                .collect();
            let _ = writeln!(
                text,
                "Safety against gross slip: {}, then `{}` slips first\nLargest torque: {}",
                plain(capacity.factor, "times the torques"),
                capacity.pulley,
                if torques.is_empty() {
                    "none".to_owned()
                } else {
                    torques.join(", ")
                },
            );
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

fn capitalised(sentence: &str) -> String {
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

impl Steady {
    fn in_words(&self) -> String {
        let header = [
            "pulley",
            "speed",
            "",
            "external torque",
            "slip",
            "stick",
            "wrap",
            "hub force",
            "power taken",
            "speed loss",
        ];
        let mut pulleys = columns(&header, &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        for (name, pulley) in &self.pulley.0 {
            pulleys.add_row([
                name.clone(),
                plain(pulley.speed, "rad/s"),
                plain(pulley.speed / RPM, "rpm"),
                with_prefix(pulley.external_torque, "N m"),
                degrees(pulley.slip_angle),
                degrees(pulley.stick_angle),
                degrees(pulley.wrap_angle),
                with_prefix(pulley.hub_force[0].hypot(pulley.hub_force[1]), "N"),
                with_prefix(pulley.power, "W"),
                percent(pulley.speed_loss),
            ]);
        }
        let mut spans = columns(&["span", "tension", "belt speed", "strain"], &[1, 2, 3]);
        for (name, span) in &self.span.0 {
            spans.add_row([
                name.clone(),
                with_prefix(span.tension, "N"),
                plain(span.speed, "m/s"),
                percent(span.strain),
            ]);
        }
        let efficiency = self
            .efficiency
            .map_or_else(|| "none, no power is fed in".to_owned(), percent);
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}\n", pulleys.trim_fmt());
        let _ = writeln!(text, "{}\n", spans.trim_fmt());
        let _ = writeln!(text, "Speed loss: {}", percent(self.speed_loss));
        let _ = writeln!(
            text,
            "Power: {} in, {} out, {} lost",
            with_prefix(self.power_in, "W"),
            with_prefix(self.power_out, "W"),
            with_prefix(self.power_lost, "W"),
        );
        let _ = writeln!(text, "Efficiency: {efficiency}");
        text
    }
}
