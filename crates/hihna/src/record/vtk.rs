//! The frames for ParaView: a collection `belt.pvd` of VTK's unstructured grids, two for each frame.
//!
//! Part 0 of a frame is the belt, a ribbon as wide as the belt along its centre line with the columns of the
//! profile as point data; part 1 the pulleys, rims and discs that turn. Format: Kitware's "VTK XML file
//! formats", binary data appended raw, lengths as UInt64, little-endian.

use std::f64::consts::TAU;
use std::ffi::OsStr;
use std::fmt::Write;

use super::{Folder, RecordError};
use crate::drive::{Drive, Pulley};
use crate::history::History;
use crate::observe::{EdgeRow, ProfileRow};
use crate::simulate::Outcome;

const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

/// Facets around a pulley.
const FACETS: u32 = 96;

/// Writes the frames of `outcome` to `folder`.
pub(super) fn write(folder: &Folder, drive: &Drive, outcome: &Outcome) -> Result<(), RecordError> {
    let mut index = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    let frames = outcome
        .frames
        .chunk_by(|a, b| a.time.to_bits() == b.time.to_bits());
    let mut begun = 0;
    for (i, frame) in frames.enumerate() {
        let time = frame[0].time;
        let edges = outcome.edges.get(begun..begun + frame.len());
        begun += frame.len();
        let parts = [
            ("belt", belt(frame, edges.unwrap_or_default(), drive)),
            ("pulleys", pulleys(drive, &outcome.history, time)),
        ];
        for (part, (name, grid)) in parts.iter().enumerate() {
            let file = format!("{name}_{i:05}.vtu");
            folder.bytes(&file, &grid.to_vtu(time))?;
            // Writing to a string cannot fail.
            let _ = writeln!(
                index,
                "<DataSet timestep=\"{time}\" part=\"{part}\" name=\"{name}\" file=\"{file}\"/>"
            );
        }
    }
    index.push_str("</Collection>\n</VTKFile>\n");
    folder.text("belt.pvd", &index)
}

/// Whether a file of this name is one of those that [`write`] makes for a frame.
pub(super) fn is_frame(name: &OsStr) -> bool {
    let stem = name.to_str().and_then(|name| name.strip_suffix(".vtu"));
    let number = stem.and_then(|stem| {
        stem.strip_prefix("belt_")
            .or_else(|| stem.strip_prefix("pulleys_"))
    });
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

/// The belt of one frame between its edges; without them as a flat strip of its width, its rows in the middle.
fn belt(rows: &[ProfileRow], edges: &[EdgeRow], drive: &Drive) -> Grid {
    let half = 0.5 * drive.belt.width;
    let points = if edges.is_empty() {
        (rows.iter())
            .flat_map(|row| [-half, half].map(|side| [row.x, row.y, row.z + side]))
            .collect()
    } else {
        (edges.iter())
            .flat_map(|row| [[row.x0, row.y0, row.z0], [row.x1, row.y1, row.z1]])
            .collect()
    };
    let edges =
        |value: fn(&ProfileRow) -> f64| rows.iter().flat_map(|row| [value(row); 2]).collect();
    let mut grid = Grid {
        points,
        fields: vec![
            ("material_coordinate", edges(|row| row.material_coordinate)),
            ("tension", edges(|row| row.tension)),
            ("element_tension", edges(|row| row.element_tension)),
            ("strain_green", edges(|row| row.strain_green)),
            ("strain_engineering", edges(|row| row.strain_engineering)),
            ("strain_true", edges(|row| row.strain_true)),
            ("strain_almansi", edges(|row| row.strain_almansi)),
            ("speed", edges(|row| row.speed)),
            ("normal_force", edges(|row| row.normal_force)),
            ("friction_force", edges(|row| row.friction_force)),
            ("slip_speed", edges(|row| row.slip_speed)),
        ],
        ..Grid::default()
    };
    let count = rows.len();
    for i in 0..count {
        let j = (i + 1) % count;
        grid.cell(QUAD, &[2 * i, 2 * j, 2 * j + 1, 2 * i + 1]);
    }
    grid
}

/// The pulleys at `time`: for each a rim across the belt's width and a disc in the middle.
fn pulleys(drive: &Drive, history: &History, time: f64) -> Grid {
    let mut grid = Grid::default();
    let mut fields: [(&str, Vec<f64>); 5] = [
        ("pulley", Vec::new()),
        ("material_angle", Vec::new()),
        ("angle", Vec::new()),
        ("speed", Vec::new()),
        ("torque", Vec::new()),
    ];
    for (p, pulley) in drive.pulley.iter().enumerate() {
        let of = |what: &str| {
            history
                .at(&format!("{}.{what}", pulley.name), time)
                .unwrap_or(f64::NAN)
        };
        let angle = of("angle");
        let marks = add_pulley(&mut grid, pulley, (time, angle), drive.belt.width);
        let count = marks.len();
        fields[0].1.extend(std::iter::repeat_n(p as f64, count));
        fields[1].1.extend(marks);
        for (field, value) in fields[2..]
            .iter_mut()
            .zip([angle, of("speed"), of("torque")])
        {
            field.1.extend(std::iter::repeat_n(value, count));
        }
    }
    grid.fields = fields.into();
    grid
}

/// Adds a pulley at a time and an angle, as far along its axis as the belt is wide; returns for each of its points the
/// angle on the pulley itself [rad].
fn add_pulley(grid: &mut Grid, pulley: &Pulley, (time, angle): (f64, f64), width: f64) -> Vec<f64> {
    let middle = pulley.middle(time);
    let axis = pulley.axis();
    // x turned by the tilt about y, and what completes the base: x and y of a pulley that is not tilted.
    let (sine, cosine) = pulley.tilt[1].sin_cos();
    let across = [cosine, 0.0, -sine];
    let upwards = [
        axis[1] * across[2] - axis[2] * across[1],
        axis[2] * across[0] - axis[0] * across[2],
        axis[0] * across[1] - axis[1] * across[0],
    ];
    let [slope, curvature] = pulley.shape();
    let first = grid.points.len();
    grid.points.push(middle);
    let mut marks = vec![0.0];
    // The first column comes twice, so that the angle need not jump back within a facet.
    for k in 0..=FACETS {
        let mark = TAU * f64::from(k) / f64::from(FACETS);
        let (sine, cosine) = (angle + mark).sin_cos();
        for side in [-0.5, 0.0, 0.5] {
            let along = side * width;
            let radius = pulley.radius + along * (slope - 0.5 * curvature * along);
            grid.points.push(std::array::from_fn(|i| {
                middle[i] + along * axis[i] + radius * (cosine * across[i] + sine * upwards[i])
            }));
            marks.push(mark);
        }
    }
    for k in 0..FACETS as usize {
        let at = first + 1 + 3 * k;
        grid.cell(QUAD, &[at, at + 3, at + 5, at + 2]);
        grid.cell(TRIANGLE, &[first, at + 1, at + 4]);
    }
    marks
}

/// Points, cells and point data.
#[derive(Default)]
struct Grid {
    points: Vec<[f64; 3]>,
    /// Point numbers of all cells, one cell after another.
    connectivity: Vec<usize>,
    /// Where each cell ends in `connectivity`.
    offsets: Vec<usize>,
    kinds: Vec<u8>,
    fields: Vec<(&'static str, Vec<f64>)>,
}

impl Grid {
    fn cell(&mut self, kind: u8, points: &[usize]) {
        self.connectivity.extend(points);
        self.offsets.push(self.connectivity.len());
        self.kinds.push(kind);
    }

    fn to_vtu(&self, time: f64) -> Vec<u8> {
        let mut data = Appended::default();
        let mut head = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            head,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <UnstructuredGrid>\n<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time}</DataArray></FieldData>\n\
             <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
            self.points.len(),
            self.kinds.len()
        );
        data.numbers(
            &mut head,
            "Points\" NumberOfComponents=\"3",
            self.points.iter().flatten(),
        );
        head.push_str("</Points>\n<Cells>\n");
        data.indices(&mut head, "connectivity", &self.connectivity);
        data.indices(&mut head, "offsets", &self.offsets);
        data.array(&mut head, "UInt8", "types", &self.kinds);
        head.push_str("</Cells>\n<PointData>\n");
        for (name, values) in &self.fields {
            data.numbers(&mut head, name, values.iter());
        }
        head.push_str(
            "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
        );
        let mut file = head.into_bytes();
        file.append(&mut data.bytes);
        file.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}

/// The binary part of a file: arrays, each behind its length in bytes.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    fn numbers<'a>(
        &mut self,
        head: &mut String,
        name: &str,
        values: impl Iterator<Item = &'a f64>,
    ) {
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.array(head, "Float64", name, &bytes);
    }

    fn indices(&mut self, head: &mut String, name: &str, values: &[usize]) {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| (*value as u64).to_le_bytes())
            .collect();
        self.array(head, "UInt64", name, &bytes);
    }

    fn array(&mut self, head: &mut String, kind: &str, name: &str, bytes: &[u8]) {
        // Writing to a string cannot fail.
        let _ = writeln!(
            head,
            "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"appended\" offset=\"{}\"/>",
            self.bytes.len()
        );
        self.bytes.extend((bytes.len() as u64).to_le_bytes());
        self.bytes.extend(bytes);
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "numbers are copied, not computed")]
mod tests {
    use super::*;

    #[test]
    fn only_frames_are_taken_for_frames() {
        for name in ["belt_00000.vtu", "pulleys_123456.vtu"] {
            assert!(is_frame(OsStr::new(name)), "{name}");
        }
        for name in [
            "belt_.vtu",
            "belt_1.vtk",
            "belt_x1.vtu",
            "my_00000.vtu",
            "belt.vtu",
        ] {
            assert!(!is_frame(OsStr::new(name)), "{name}");
        }
    }

    /// The rim of a tilted pulley that moves lies around its axis, at its radius.
    #[test]
    fn pulleys_in_space_are_where_they_are() {
        let text = include_str!("../../../../examples/two_pulley.toml");
        let drive = crate::input::parse("drive", text, &[]).unwrap();
        let mut pulley = drive.pulley[0].clone();
        pulley.tilt = [0.1, -0.2];
        pulley.offset = 0.03;
        let mut grid = Grid::default();
        add_pulley(&mut grid, &pulley, (0.0, 1.0), 0.02);
        let (axis, middle) = (pulley.axis(), pulley.middle(0.0));
        assert_eq!(middle, [pulley.center[0], pulley.center[1], 0.03]);
        for (i, point) in grid.points[1..].iter().enumerate() {
            let arm: [f64; 3] = std::array::from_fn(|k| point[k] - middle[k]);
            let along: f64 = arm.iter().zip(axis).map(|(a, p)| a * p).sum();
            let square: f64 = arm.iter().map(|a| a * a).sum();
            assert!((along - [-0.01, 0.0, 0.01][i % 3]).abs() < 1e-15);
            assert!(((square - along * along).sqrt() - pulley.radius).abs() < 1e-15);
        }
    }

    /// A file holds as many bytes as its arrays announce, each where its head says.
    #[test]
    fn arrays_lie_at_their_offsets() {
        let row = |x: f64| ProfileRow {
            x,
            tension: 10.0 + x,
            ..ProfileRow::default()
        };
        let text = include_str!("../../../../examples/two_pulley.toml");
        let mut drive = crate::input::parse("drive", text, &[]).unwrap();
        drive.belt.width = 0.5;
        let grid = belt(&[row(0.0), row(1.0), row(2.0)], &[], &drive);
        assert_eq!(grid.points[1], [0.0, 0.0, 0.25]);
        let file = grid.to_vtu(0.5);
        let start = file.windows(3).position(|w| w == b"\n_\x90").unwrap() + 2;
        let length =
            |at: usize| u64::from_le_bytes(file[start + at..start + at + 8].try_into().unwrap());
        // Six points of three doubles: 144 = 0x90 bytes.
        assert_eq!(length(0), 144);
        let text = String::from_utf8_lossy(&file[..start]).into_owned();
        let at: usize = text
            .split("Name=\"tension\" format=\"appended\" offset=\"")
            .nth(1)
            .and_then(|rest| rest.split('"').next())
            .and_then(|number| number.parse().ok())
            .unwrap();
        assert_eq!(length(at), 48);
        let last = start + at + 8 + 40;
        assert_eq!(
            f64::from_le_bytes(file[last..last + 8].try_into().unwrap()),
            12.0
        );
    }
}
