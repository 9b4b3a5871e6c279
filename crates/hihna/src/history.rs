//! The history of a run: one row of numbers per output time.

use crate::observe::{Powers, PulleyState, SpanState, Stored};

/// A table of numbers with named columns (`history.csv`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    columns: Vec<String>,
    values: Vec<f64>,
    spatial: bool,
}

const PULLEY_COLUMNS: [&str; 13] = [
    "angle",
    "speed",
    "torque",
    "external_torque",
    "hub_force_x",
    "hub_force_y",
    "slip_speed",
    "contact_angle",
    "slip_angle",
    "tension_in",
    "tension_out",
    "power",
    "friction_loss",
];
/// Further columns of a belt in space.
const LATERAL_COLUMNS: [&str; 5] = [
    "hub_force_z",
    "hub_moment_x",
    "hub_moment_y",
    "hub_moment_z",
    "belt_offset",
];
const SPAN_COLUMNS: [&str; 4] = ["tension", "strain", "speed", "deflection"];
const ENERGY_COLUMNS: [&str; 9] = [
    "energy.kinetic",
    "energy.strain",
    "energy.potential",
    "energy.input",
    "energy.friction_loss",
    "energy.contact_loss",
    "energy.damping_loss",
    "energy.load_work",
    "energy.residual",
];

impl History {
    /// An empty history of a drive with pulleys `names` and a belt in the plane or in space.
    #[must_use]
    pub fn new(names: &[String], spatial: bool) -> Self {
        let mut columns = vec!["time".to_owned()];
        for name in names {
            columns.extend(PULLEY_COLUMNS.iter().map(|c| format!("{name}.{c}")));
            if spatial {
                columns.extend(LATERAL_COLUMNS.iter().map(|c| format!("{name}.{c}")));
            }
        }
        for (i, name) in names.iter().enumerate() {
            let to = &names[(i + 1) % names.len()];
            columns.extend(SPAN_COLUMNS.iter().map(|c| format!("{name}-{to}.{c}")));
        }
        columns.extend(ENERGY_COLUMNS.iter().map(ToString::to_string));
        Self {
            columns,
            values: Vec::new(),
            spatial,
        }
    }

    /// A history of the given rows; `None` if `values` do not fill whole rows.
    #[must_use]
    pub fn from_values(columns: Vec<String>, values: Vec<f64>) -> Option<Self> {
        let whole = !columns.is_empty() && values.len().is_multiple_of(columns.len());
        let spatial = columns.iter().any(|name| name.ends_with(".hub_force_z"));
        whole.then_some(Self {
            columns,
            values,
            spatial,
        })
    }

    /// Adds a row.
    pub(crate) fn push(
        &mut self,
        time: f64,
        pulleys: &[PulleyState],
        spans: &[SpanState],
        stored: &Stored,
        work: &Powers,
        residual: f64,
    ) {
        let values = &mut self.values;
        values.push(time);
        for p in pulleys {
            values.extend([
                p.angle,
                p.speed,
                p.torque,
                p.external_torque,
                p.hub_force[0],
                p.hub_force[1],
                p.slip_speed,
                p.contact_angle,
                p.slip_angle,
                p.tension_in,
                p.tension_out,
                p.torque * p.speed,
                p.friction_loss,
            ]);
            if self.spatial {
                values.push(p.lateral.hub_force);
                values.extend(p.lateral.hub_moment);
                values.push(p.lateral.belt_offset);
            }
        }
        for s in spans {
            values.extend([s.tension, s.strain, s.speed, s.deflection]);
        }
        values.extend([
            stored.kinetic,
            stored.strain,
            stored.potential,
            work.input,
            work.friction,
            work.contact,
            work.damping,
            work.load,
            residual,
        ]);
    }

    /// Names of the columns.
    #[must_use]
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The rows in order of time.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.columns.len().max(1))
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows().len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The column `name`, or `None` if there is none of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|c| c == name)?;
        Some(self.rows().map(|row| row[index]).collect())
    }

    /// Column `name` at `time`, linear between the rows and constant outside.
    #[must_use]
    pub fn at(&self, name: &str, time: f64) -> Option<f64> {
        let index = self.columns.iter().position(|c| c == name)?;
        let after = self.rows().position(|row| row[0] >= time);
        let row = |i: usize| self.rows().nth(i);
        let (first, last) = match after {
            None => return self.rows().next_back().map(|row| row[index]),
            Some(0) => return row(0).map(|row| row[index]),
            Some(i) => (row(i - 1)?, row(i)?),
        };
        let part = (time - first[0]) / (last[0] - first[0]);
        Some(first[index] + part * (last[index] - first[index]))
    }

    /// Mean of column `name` over times in `[from, to]`, by the rows.
    #[must_use]
    pub fn mean(&self, name: &str, from: f64, to: f64) -> Option<f64> {
        let index = self.columns.iter().position(|c| c == name)?;
        let (sum, count) = self
            .rows()
            .filter(|row| row[0] >= from && row[0] <= to)
            .fold((0.0, 0_usize), |(sum, n), row| (sum + row[index], n + 1));
        (count > 0).then(|| sum / count as f64)
    }

    /// Mean in time over `[from, to]` of what `of` makes of a row, linear between the rows; at one time the last row until then.
    #[must_use]
    pub fn average(&self, from: f64, to: f64, of: impl Fn(&[f64]) -> f64) -> Option<f64> {
        let mut rows = self.rows().map(|row| (row[0], of(row)));
        let mut before = rows.next()?;
        let (mut integral, mut duration) = (0.0, 0.0);
        for after in rows {
            let (start, end) = (before.0.max(from), after.0.min(to));
            if start < end {
                let slope = (after.1 - before.1) / (after.0 - before.0);
                let middle = 0.5 * (start + end);
                integral += (end - start) * (before.1 + slope * (middle - before.0));
                duration += end - start;
            }
            before = after;
        }
        if duration > 0.0 {
            return Some(integral / duration);
        }
        self.rows().rfind(|row| row[0] <= to).map(of)
    }

    /// Standard deviation of column `name` over times in `[from, to]`, by the rows.
    #[must_use]
    pub fn deviation(&self, name: &str, from: f64, to: f64) -> Option<f64> {
        let index = self.columns.iter().position(|c| c == name)?;
        let mean = self.mean(name, from, to)?;
        let (sum, count) = self
            .rows()
            .filter(|row| row[0] >= from && row[0] <= to)
            .fold((0.0, 0_usize), |(sum, n), row| {
                (sum + (row[index] - mean).powi(2), n + 1)
            });
        (count > 0).then(|| (sum / count as f64).sqrt())
    }

    /// Mean rate of change of column `name` over times in `[from, to]`, from the row before the
    /// first if there is only one.
    #[must_use]
    pub fn mean_rate(&self, name: &str, from: f64, to: f64) -> Option<f64> {
        let index = self.columns.iter().position(|c| c == name)?;
        let last = self.rows().rfind(|row| row[0] <= to)?;
        let first = self
            .rows()
            .find(|row| row[0] >= from && row[0] < last[0])
            .or_else(|| self.rows().rfind(|row| row[0] < last[0]))?;
        Some((last[index] - first[index]) / (last[0] - first[0]))
    }
}
