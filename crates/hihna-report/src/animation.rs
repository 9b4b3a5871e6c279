//! What the animation of the moving belt needs, as small as eyes allow.

use hihna::drive::Drive;
use hihna::history::History;
use hihna::layout::Layout;
use hihna::observe::{EdgeRow, ProfileRow};
use serde::Serialize;

use crate::drawing::free_side;
use crate::packed::text;
use crate::path::feet;
use crate::series::short;
use crate::strip::{Sides, Strip};

/// Points of the belt drawn at most: one for every pixel or two.
const MOST_POINTS: usize = 600;
/// Points of all frames together kept at most; each takes 20 bytes, a third more as text.
const MOST_NUMBERS: usize = 250_000;

/// The moving belt. Lists of numbers are 32-bit floats, little-endian, as base64.
#[derive(Serialize)]
pub struct Animation {
    /// Time of each frame [s].
    times: Vec<f64>,
    /// Points of the belt in a frame.
    points: usize,
    /// For each frame and point `x, y` of the nearest place on the rigid path [m].
    path: String,
    /// For each frame and point the way from there to the belt `x, y` [m].
    offset: String,
    /// For each frame and point the mean true axial force of the element [N].
    tension: String,
    /// Least and greatest tension of all.
    range: [f64; 2],
    pulleys: Vec<Disc>,
    /// The rigid path, to show what the belt's shape is magnified from.
    outline: Vec<[f32; 2]>,
    /// What else a belt with a width needs.
    #[serde(skip_serializing_if = "Option::is_none")]
    strip: Option<Strip>,
}

#[derive(Serialize)]
struct Disc {
    name: String,
    center: [f64; 2],
    radius: f64,
    /// Direction in which no belt lies around it: where its name has room.
    free: [f64; 2],
    /// Angle at each frame [rad].
    angle: Vec<f32>,
    /// Centre at each frame [m], of a pulley that moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    centers: Option<Vec<[f32; 2]>>,
}

impl Animation {
    /// Whether the belt has a width.
    pub fn is_in_space(&self) -> bool {
        self.strip.is_some()
    }
}

/// The animation of `frames`; `None` if there are fewer than two.
pub fn animation(
    drive: &Drive,
    layout: &Layout,
    history: &History,
    frames: &[ProfileRow],
    edges: &[EdgeRow],
) -> Option<Animation> {
    let all: Vec<&[ProfileRow]> = frames
        .chunk_by(|a, b| a.time.to_bits() == b.time.to_bits())
        .collect();
    let count = all.first()?.len();
    let stride = count.div_ceil(MOST_POINTS).max(1);
    let points = count.div_ceil(stride);
    let step = (all.len() * points).div_ceil(MOST_NUMBERS).max(1);
    let mut begin = 0;
    let (shown, edges): (Vec<&[ProfileRow]>, Vec<&[EdgeRow]>) = all
        .into_iter()
        .map(|frame| {
            let edges = edges.get(begin..begin + frame.len()).unwrap_or_default();
            begin += frame.len();
            (frame, edges)
        })
        .step_by(step)
        .filter(|(frame, _)| frame.len() == count)
        .unzip();
    if shown.len() < 2 {
        return None;
    }
    let (mut path, mut offset, mut tension) = (Vec::new(), Vec::new(), Vec::new());
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut sides = Sides::of_width(drive.belt.width);
    for (frame, edges) in shown.iter().zip(&edges) {
        let feet = feet(layout, frame);
        for (foot, edge) in feet.iter().zip(*edges).step_by(stride) {
            sides.add(foot.point, edge);
        }
        for (foot, row) in feet.iter().zip(*frame).step_by(stride) {
            let [x, y] = foot.point;
            path.extend([short(x), short(y)]);
            offset.extend([short(row.x - x), short(row.y - y)]);
            tension.push(short(row.element_tension));
            if row.element_tension.is_finite() {
                range = [
                    range[0].min(row.element_tension),
                    range[1].max(row.element_tension),
                ];
            }
        }
    }
    if range[0] > range[1] {
        // No tension is a number.
        range = [0.0; 2];
    }
    let times: Vec<f64> = shown.iter().map(|frame| frame[0].time).collect();
    let pulleys = drive
        .pulley
        .iter()
        .enumerate()
        .map(|(i, pulley)| Disc {
            name: pulley.name.clone(),
            free: free_side(layout, i),
            center: pulley.center,
            radius: pulley.radius,
            angle: angles(history, &pulley.name, &times),
            centers: pulley.displacement.as_ref().map(|_| {
                let middles = times.iter().map(|time| pulley.middle(*time));
                middles.map(|[x, y, _]| [short(x), short(y)]).collect()
            }),
        })
        .collect();
    // Every frame has its edges, or none is shown with them.
    let strip =
        (edges.iter().all(|edges| edges.len() == count)).then(|| Strip::new(drive, &sides, &times));
    Some(Animation {
        times,
        points,
        strip,
        path: text(&path),
        offset: text(&offset),
        tension: text(&tension),
        range,
        pulleys,
        outline: outline(layout),
    })
}

/// Angles brought below a turn before they lose digits.
fn angles(history: &History, pulley: &str, times: &[f64]) -> Vec<f32> {
    let name = format!("{pulley}.angle");
    times
        .iter()
        .map(|time| history.at(&name, *time).unwrap_or(0.0))
        .map(|angle| short(angle.rem_euclid(std::f64::consts::TAU)))
        .collect()
}

fn outline(layout: &Layout) -> Vec<[f32; 2]> {
    let count = 400;
    (0..count)
        .map(|i| {
            layout
                .point(layout.length * f64::from(i) / f64::from(count))
                .position
        })
        .map(|[x, y]| [short(x), short(y)])
        .collect()
}
