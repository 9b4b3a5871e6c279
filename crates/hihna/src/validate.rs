//! Published values against what this program computes: the cases of `hihna validate`.
//!
//! The published side is data: TOML files in the folder `validation/` of the repository, built into
//! the library. Each row of a case names a quantity, the value as printed or a statement in words,
//! and a tolerance with its reason. The computed side is a function a case, in a file a topic below
//! this module, which returns the quantities of its rows by name. [`catalogue`] joins the two,
//! [`select`] picks cases by name, [`run`] computes and judges them in parallel.
//!
//! A row is judged by one of
//! ```text
//! |computed - (reference, or published where there is none)| <= tolerance
//! at_least <= computed <= at_most
//! ```
//! or is only shown. A misprint keeps its printed value in `published`, with the value judged
//! against in `reference` and the reason in `note`.

mod base_drive;
mod data;
mod loaded_drive;
mod markdown;
mod other_drives;
mod pendulum;
mod planar_beams;
mod plate_belt;
mod plates;
mod princeton_beam;
mod ring_down;
mod selection;
mod spatial_beams;
mod spin_up;
mod static_circle;
mod string_drive;
mod time_run;
mod v_belt;
mod verdict;

use ancf::dynamics::IntegrationError;
use ancf::structure::StructureError;
use rayon::prelude::*;
use thiserror::Error;

use crate::free_belt::FreeBeltError;
use crate::input::InputErrors;
use crate::simulate::RunError;
use crate::steady::drive_string::SteadyError;

pub use data::{Case, CatalogueError, Row, catalogue};
pub use markdown::markdown;
pub use selection::{UnknownCase, select};
pub use verdict::{Finding, Verdict};

/// The quantities of a case, by the names that its data gives them, in SI or in the row's unit.
pub(crate) type Quantities = Vec<(String, f64)>;

/// Computes the quantities of a case.
pub(crate) type Compute = fn() -> Result<Quantities, CaseError>;

/// Every case with its computation: adding one touches this list, its data and its topic's file.
const COMPUTATIONS: &[(&str, Compute)] = &[
    ("chapter-2/table-2.1", planar_beams::table_2_1),
    ("chapter-2/table-2.2", planar_beams::table_2_2),
    ("chapter-2/table-2.3", planar_beams::table_2_3),
    ("chapter-2/table-2.4", planar_beams::table_2_4),
    ("chapter-2/pendulum", pendulum::pendulum),
    ("chapter-2/table-2.5", pendulum::costs),
    ("chapter-2/spin-up", spin_up::spin_up),
    ("chapter-3/figures-3.4-3.5", static_circle::figures_3_4_3_5),
    ("chapter-3/figure-3.7", base_drive::figure_3_7),
    ("chapter-3/figure-3.8", base_drive::figure_3_8),
    ("chapter-3/figure-3.9", base_drive::figure_3_9),
    (
        "chapter-3/figures-3.10-3.20",
        loaded_drive::figures_3_10_to_3_20,
    ),
    ("chapter-3/figure-3.21", base_drive::figure_3_21),
    ("chapter-3/ring-down", base_drive::ring_downs),
    ("chapter-3/three-pulleys", other_drives::three_pulleys),
    ("chapter-3/stick-and-slip", other_drives::stick_and_slip),
    ("chapter-4-analytical/figures-4.4-4.5", string_drive::stiff),
    (
        "chapter-4-analytical/figures-4.11-4.14",
        string_drive::compliant,
    ),
    (
        "chapter-4-analytical/speed-loss",
        string_drive::speed_losses,
    ),
    (
        "chapter-4-analytical/figures-4.17-4.18",
        string_drive::contact_forces,
    ),
    ("chapter-4-plate/figure-4.10", plate_belt::figure_4_10),
    ("chapter-4-plate/planar", plate_belt::planar_drives),
    (
        "chapter-4-plate/figures-4.12-4.18",
        plate_belt::figures_4_12_to_4_18,
    ),
    ("plates/square", plates::square_plate),
    ("plates/frequencies", plates::frequencies),
    ("plates/strips", plates::strips),
    ("chapter-4-beams/cantilevers", spatial_beams::cantilevers),
    (
        "chapter-4-beams/large-deflection",
        spatial_beams::large_deflection,
    ),
    (
        "chapter-4-beams/bending-and-torsion",
        spatial_beams::bending_and_torsion,
    ),
    ("chapter-4-beams/princeton-beam", princeton_beam::tips),
    ("chapter-4-v-belt/sink", v_belt::sink),
    (
        "chapter-4-v-belt/transmissible-torque",
        v_belt::transmissible_torque,
    ),
];

/// The data files, in the order of the program's output.
const DATA: &[&str] = &[
    include_str!("../../../validation/chapter-2.toml"),
    include_str!("../../../validation/chapter-3.toml"),
    include_str!("../../../validation/chapter-4-analytical.toml"),
    include_str!("../../../validation/chapter-4-plate.toml"),
    include_str!("../../../validation/plates.toml"),
    include_str!("../../../validation/chapter-4-beams.toml"),
    include_str!("../../../validation/chapter-4-v-belt.toml"),
];

/// Why a case could not be computed: all its judged rows fail.
#[derive(Debug, Error)]
pub enum CaseError {
    /// The case's drive is not read.
    #[error(transparent)]
    Input(#[from] InputErrors),
    /// The string theory refuses the case's drive.
    #[error(transparent)]
    Steady(#[from] SteadyError),
    /// A beam of the case has no answer.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// A motion of the case cannot be followed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
    /// A drive of the case does not run through.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The case's belt off its pulleys finds no rest.
    #[error(transparent)]
    FreeBelt(#[from] FreeBeltError),
    /// Energy or torque balance of a run does not close.
    #[error("the audit of a run of the case fails")]
    Audit,
    /// The case asks for a column that histories do not have.
    #[error("the history of a run has no column `{0}`, or no row at these times")]
    NoColumn(String),
    /// The case's drive slips or is slack.
    #[error("the drive of the case does not run")]
    DoesNotRun,
}

/// Computes and judges `cases` in parallel; findings come in the order of the cases and their rows.
/// `done` is called after each case, from any thread.
pub fn run(cases: &[&Case], done: impl Fn(&Case) + Sync) -> Vec<Finding> {
    let findings: Vec<Vec<Finding>> = cases
        .par_iter()
        .map(|case| {
            let findings = case.findings();
            done(case);
            findings
        })
        .collect();
    findings.into_iter().flatten().collect()
}

/// Whether no finding failed.
pub fn passed(findings: &[Finding]) -> bool {
    findings.iter().all(|finding| finding.passed != Some(false))
}

#[cfg(test)]
mod tests;
