//! Modes over a range of one number of the drive, most often a speed: a Campbell diagram.
//!
//! Modes are followed from value to value by what they look like, not by their order: frequencies cross. With velocities
//! `s u` of the nodes and `w` of the pulleys the kinetic energy makes an inner product, and two modes a, b are similar by
//!
//! ```text
//! |<a, b>|² / (<a, a> <b, b>)      <a, b> = sum m_k conj(s_a u_a) . (s_b u_b) + sum I_p conj(w_a) w_b
//! ```
//!
//! with the mass `m_k` of half the elements beside node k: one for the same motion, whatever its scale and phase, zero for motions
//! that share no energy. The most similar pairs belong together. A mode that resembles none before by half ends there; where two
//! modes of equal frequency mix, as those of two equal spans do, only their plane is followed.

use super::map::{Axis, at_values};
use super::modes::Mode;
use super::{Answer, Running, RunningBelt, RunningError};
use crate::assemble::BeltElementType;
use crate::drive::Drive;

/// Modes found beside those asked for: others may come down among them at the next value.
const SPARE: usize = 4;
/// How many times as many are looked through at most for the modes that are followed: creep has many of low frequency that hardly swing.
const MOST_TIMES: usize = 8;
/// Least similarity of two modes that are taken for one.
const SIMILAR: f64 = 0.5;

/// Modes over a range of one number.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// The field.
    pub key: String,
    /// Its unit.
    pub unit: &'static str,
    /// One a value of it.
    pub points: Vec<CampbellPoint>,
}

/// The modes at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct CampbellPoint {
    /// The value, SI.
    pub value: f64,
    /// `running`, `gross-slip` or `slack`; `none` where the drive has no answer.
    pub answer: &'static str,
    /// The modes in the order of those at the first value that runs; nothing where one is not found.
    pub modes: Vec<Option<FollowedMode>>,
}

/// A mode that is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowedMode {
    /// Circular frequency [rad/s].
    pub frequency: f64,
    /// Rate of growth [1/s].
    pub growth: f64,
    /// Damping relative to the critical one [-].
    pub damping_ratio: f64,
    /// Part of the pulleys in the kinetic energy [-].
    pub pulley_share: f64,
    /// Similarity to the mode at the value before that it was found at [-]; one at the first.
    pub similarity: f64,
}

/// Finds the first `count` modes of `drive` at the first value of `axis` at which it runs, and follows them, telling `done` of every value.
pub fn campbell(
    drive: &Drive,
    axis: &Axis,
    count: usize,
    done: impl Fn(),
) -> Result<Campbell, RunningError> {
    with_belt_element!(drive, Element => of_elements::<Element>(drive, axis, count, &done))
}

fn of_elements<E: BeltElementType>(
    drive: &Drive,
    axis: &Axis,
    count: usize,
    done: &dyn Fn(),
) -> Result<Campbell, RunningError> {
    let mut points = Vec::with_capacity(axis.values.len());
    // Of every mode that is followed, how it looked last.
    let mut known: Vec<Velocities> = Vec::new();
    let mut refused = None;
    for &value in &axis.values {
        let mut point = CampbellPoint {
            value,
            answer: "none",
            modes: vec![None; count],
        };
        let there = at_values(drive, std::slice::from_ref(axis), &[value]);
        match there.and_then(|there| running::<E>(&there)) {
            Ok((mut belt, Answer::Running(found))) => {
                point.answer = "running";
                let (modes, looks) = find(&mut belt, &found, &known, count)?;
                follow(&modes, looks, &mut known, &mut point);
            }
            Ok((_, Answer::GrossSlip(_))) => point.answer = "gross-slip",
            Ok((_, Answer::Slack(_))) => point.answer = "slack",
            // One value without an answer does not spoil the others.
            Err(error) => refused = refused.or(Some(error)),
        }
        points.push(point);
        done();
    }
    match refused {
        Some(error) if points.iter().all(|point| point.answer == "none") => Err(error),
        _ => Ok(Campbell {
            key: axis.field.key.clone(),
            unit: axis.field.unit,
            points,
        }),
    }
}

/// The first modes and how they look: as many as it takes to find all that are `known` among them, within bounds.
fn find<E: BeltElementType>(
    belt: &mut RunningBelt<E>,
    running: &Running,
    known: &[Velocities],
    count: usize,
) -> Result<(Vec<Mode>, Vec<Velocities>), RunningError> {
    let masses = belt.nodal_masses();
    let mut wanted = count + SPARE;
    let most = MOST_TIMES * wanted;
    loop {
        let modes = belt.modes(running, wanted)?;
        let looks: Vec<_> = (modes.iter())
            .map(|mode| Velocities::new(mode, &masses, belt))
            .collect();
        let complete = pairs(known, &looks).len() == known.len();
        if complete || modes.len() < wanted || wanted >= most {
            return Ok((modes, looks));
        }
        wanted *= 2;
    }
}

/// Takes the modes of a point for those that they resemble among the `known`, which move with them; the first point's are followed.
fn follow(
    modes: &[Mode],
    looks: Vec<Velocities>,
    known: &mut Vec<Velocities>,
    point: &mut CampbellPoint,
) {
    if known.is_empty() {
        for (slot, mode) in point.modes.iter_mut().zip(modes) {
            *slot = Some(FollowedMode::new(mode, 1.0));
        }
        known.extend(looks.into_iter().take(point.modes.len()));
    } else {
        for (old, new, similarity) in pairs(known, &looks) {
            point.modes[old] = Some(FollowedMode::new(&modes[new], similarity));
            known[old] = looks[new].clone();
        }
    }
}

fn running<E: BeltElementType>(drive: &Drive) -> Result<(RunningBelt<E>, Answer), RunningError> {
    let mut belt = RunningBelt::<E>::new(drive)?;
    let answer = belt.solve()?;
    Ok((belt, answer))
}

impl FollowedMode {
    fn new(mode: &Mode, similarity: f64) -> Self {
        Self {
            frequency: mode.frequency,
            growth: mode.growth,
            damping_ratio: mode.damping_ratio(),
            pulley_share: mode.pulley_share,
            similarity,
        }
    }
}

/// Velocities of a mode, each times the root of its mass, of norm one.
#[derive(Clone, Debug)]
struct Velocities(Vec<[f64; 2]>);

impl Velocities {
    fn new<E: BeltElementType>(mode: &Mode, masses: &[f64], belt: &RunningBelt<E>) -> Self {
        let exponent = mode.growth.hypot(mode.frequency);
        let turn = [mode.growth / exponent, mode.frequency / exponent];
        let times =
            |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
        let nodes = (mode.shape.iter().zip(masses)).flat_map(|(node, mass)| {
            let factor = exponent * mass.sqrt();
            node.map(|u| times(turn, u).map(|part| factor * part))
        });
        let pulleys = (mode.pulleys.iter().zip(&belt.inertias))
            .map(|(w, inertia)| w.map(|part| inertia.sqrt() * part));
        let mut velocities: Vec<_> = nodes.chain(pulleys).collect();
        let square: f64 = velocities.iter().flatten().map(|x| x * x).sum();
        for part in velocities.iter_mut().flatten() {
            *part /= square.sqrt();
        }
        Self(velocities)
    }

    fn similarity(&self, other: &Self) -> f64 {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (a, b) in self.0.iter().zip(&other.0) {
            real += a[0] * b[0] + a[1] * b[1];
            imaginary += a[0] * b[1] - a[1] * b[0];
        }
        real * real + imaginary * imaginary
    }
}

/// Indices of modes that belong together, with their similarity, the most similar first.
fn pairs(known: &[Velocities], found: &[Velocities]) -> Vec<(usize, usize, f64)> {
    let mut all: Vec<(usize, usize, f64)> = (0..known.len())
        .flat_map(|old| (0..found.len()).map(move |new| (old, new)))
        .map(|(old, new)| (old, new, known[old].similarity(&found[new])))
        .filter(|pair| pair.2 >= SIMILAR)
        .collect();
    all.sort_by(|a, b| b.2.total_cmp(&a.2));
    let mut chosen: Vec<(usize, usize, f64)> = Vec::new();
    for pair in all {
        if chosen.iter().all(|c| c.0 != pair.0 && c.1 != pair.1) {
            chosen.push(pair);
        }
    }
    chosen
}

impl<E: BeltElementType> RunningBelt<E> {
    /// Half the mass of the elements beside every node [kg].
    fn nodal_masses(&self) -> Vec<f64> {
        let elements = self.equations.mesh.elements();
        let count = elements.len();
        (0..count)
            .map(|node| {
                let beside =
                    elements[node].length() + elements[(node + count - 1) % count].length();
                0.5 * self.line_density * beside
            })
            .collect()
    }
}
