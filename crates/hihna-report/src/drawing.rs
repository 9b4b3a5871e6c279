//! The drive drawn to scale, as SVG: pulleys with their names, spans with letters, wrap and slip arcs.

use std::fmt::Write;

use askama::filters::{Html, escape};
use hihna::drive::{Drive, Pulley};
use hihna::layout::{Arc, Layout};
use hihna::observe::ProfileRow;
use hihna::quantities::with_prefix;
use hihna::simulate::nominal_speed;

/// Width of the drawing's content in its own units.
const WIDTH: f64 = 860.0;
/// Largest height of the content.
const HEIGHT: f64 = 460.0;
const MARGIN: f64 = 48.0;

/// A curve is exhausted where friction is this part of what the normal force allows; the rest is rounding.
const EXHAUSTED: f64 = 1.0 - 1.0e-6;

/// A surface that moves slower than this part of the drive's nominal speed stands; the rest is rounding.
const STANDING: f64 = 1.0e-6;

/// Colours are those of the page, or of the notebook (JupyterLab, VS Code) that shows the drawing.
const STYLE: &str = "\
.hihna-drive{--hihna-paper:var(--page,var(--jp-layout-color0,var(--vscode-editor-background,#fff)))}\
.hihna-drive{max-width:100%;height:auto;font:500 14px system-ui,sans-serif}\
.hihna-drive{overflow:visible}\
.hihna-drive text{fill:currentColor;paint-order:stroke;stroke:var(--hihna-paper);stroke-width:4px;stroke-linejoin:round}\
.hihna-drive .inside{stroke:none}\
.hihna-drive .pulley{fill:var(--pulley,#8883);stroke:currentColor;stroke-width:1}\
.hihna-drive .thin{stroke:currentColor;stroke-width:1.2;fill:none}\
.hihna-drive .belt{stroke:var(--belt,#777);stroke-width:4;fill:none}\
.hihna-drive .wrap{stroke:var(--wrap,#0072b2);stroke-width:6;fill:none}\
.hihna-drive .slip{stroke:var(--slip,#d55e00);stroke-width:9;fill:none}\
.hihna-drive .letter{fill:var(--hihna-paper);stroke:currentColor;stroke-width:1}";

/// `A` of the first span, `B` of the second, `AA` after `Z`.
pub fn letter(mut index: usize) -> String {
    let mut letters = Vec::new();
    loop {
        // A remainder of 26 is a letter.
        letters.push(char::from(b'A' + u8::try_from(index % 26).unwrap_or(0)));
        if index < 26 {
            break;
        }
        index = index / 26 - 1;
    }
    letters.iter().rev().collect()
}

/// Text that is safe within a page.
pub fn escaped(text: &str) -> String {
    match escape(text, Html) {
        Ok(safe) => safe.to_string(),
        Err(never) => match never {},
    }
}

/// Draws `drive` and its path; `belt` is its state at one time, whose slip is marked, or empty. `speeds` are those of
/// the pulleys [rad/s], zero or missing where they do not turn.
pub fn drawing(drive: &Drive, layout: &Layout, belt: &[ProfileRow], speeds: &[f64]) -> String {
    let view = View::of(drive, layout);
    let least_speed = STANDING * nominal_speed(drive);
    let mut svg = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"hihna-drive\" viewBox=\"0 0 {:.0} {:.0}\" width=\"{:.0}\" role=\"img\" aria-label=\"Drawing of the drive, to scale: {} pulleys\"><style>{STYLE}</style>",
        view.width,
        view.height,
        view.width,
        drive.pulley.len(),
    );
    for (i, pulley) in drive.pulley.iter().enumerate() {
        let [x, y] = view.place(pulley.center);
        let _ = write!(
            svg,
            "<circle class=\"pulley\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{:.2}\"/>",
            pulley.radius * view.scale
        );
        let speed = speeds.get(i).copied().unwrap_or(0.0);
        let turns = speed.abs() * pulley.radius > least_speed;
        svg.push_str(&hub(&view, pulley, if turns { speed } else { 0.0 }));
    }
    for span in &layout.spans {
        let ([x1, y1], [x2, y2]) = (view.place(span.start), view.place(span.end));
        let _ = write!(
            svg,
            "<line class=\"belt\" x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\"/>"
        );
    }
    for arc in &layout.arcs {
        let path = view.arc(arc.center, arc.radius, arc.start_angle, arc.sweep);
        let _ = write!(svg, "<path class=\"wrap\" d=\"{path}\"/>");
    }
    let slip = slip_arcs(drive, layout, belt, &view);
    if !slip.is_empty() {
        let _ = write!(svg, "<path class=\"slip\" d=\"{slip}\"/>");
    }
    for (i, span) in layout.spans.iter().enumerate() {
        // Outside of the loop, on the right of a walk that keeps it on the left.
        let side = layout.sense * 20.0 / span.length;
        let along = [span.end[0] - span.start[0], span.end[1] - span.start[1]];
        let middle = [
            0.5 * (span.start[0] + span.end[0]),
            0.5 * (span.start[1] + span.end[1]),
        ];
        let [x, y] = view.place(middle);
        let (x, y) = (x + side * along[1], y + side * along[0]);
        let _ = write!(
            svg,
            "<circle class=\"letter\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"11\"/><text class=\"inside\" x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{}</text>",
            y + 5.0,
            letter(i)
        );
    }
    for (i, pulley) in drive.pulley.iter().enumerate() {
        svg.push_str(&name(&view, pulley, free_side(layout, i)));
    }
    svg.push_str(&view.scale_bar());
    svg.push_str("</svg>");
    svg
}

/// The hub's cross and, if the pulley turns, an arrow about it.
fn hub(view: &View, pulley: &Pulley, speed: f64) -> String {
    let [x, y] = view.place(pulley.center);
    let radius = pulley.radius * view.scale;
    let arm = (0.12 * radius).min(6.0);
    let mut svg = format!(
        "<path class=\"thin\" d=\"M{:.2} {y:.2}h{:.2}M{x:.2} {:.2}v{:.2}\"/>",
        x - arm,
        2.0 * arm,
        y - arm,
        2.0 * arm
    );
    if speed == 0.0 || !speed.is_finite() {
        return svg;
    }
    let at = 0.74 * pulley.radius;
    let (start, sweep) = (-0.75 * std::f64::consts::PI, 1.2 * speed.signum());
    let start = if speed > 0.0 { start } else { start + 1.2 };
    let path = view.arc(pulley.center, at, start, sweep);
    let end = start + sweep;
    let [tip_x, tip_y] = view.place([
        pulley.center[0] + at * end.cos(),
        pulley.center[1] + at * end.sin(),
    ]);
    // The head points along the tangent; the drawing's y grows downwards.
    let heading = (-speed.signum() * end.cos()).atan2(-speed.signum() * end.sin());
    let size = (0.16 * radius).clamp(4.0, 9.0);
    let _ = write!(
        svg,
        "<path class=\"thin\" d=\"{path}\"/><path fill=\"currentColor\" transform=\"translate({tip_x:.2} {tip_y:.2}) rotate({:.1})\" d=\"M{size:.1} 0L{:.1} {:.1}V{:.1}z\"/>",
        heading.to_degrees(),
        -0.3 * size,
        0.6 * size,
        -0.6 * size,
    );
    svg
}

/// The direction from a pulley's centre in which no belt lies around it.
pub fn free_side(layout: &Layout, pulley: usize) -> [f64; 2] {
    let arc = layout.arcs.iter().find(|arc| arc.pulley == pulley);
    arc.map_or([0.0, -1.0], |arc| {
        let (sine, cosine) = (arc.start_angle + 0.5 * arc.sweep).sin_cos();
        [-cosine, -sine]
    })
}

/// The pulley's name, within it or, if it is too small, on its free side.
fn name(view: &View, pulley: &Pulley, free: [f64; 2]) -> String {
    let [x, y] = view.place(pulley.center);
    let radius = pulley.radius * view.scale;
    let width = 7.6 * pulley.name.chars().count() as f64;
    let (class, anchor, x, y) = if width < 1.5 * radius {
        (" class=\"inside\"", "middle", x, y - 0.14 * radius - 6.0)
    } else {
        let away = radius + 10.0;
        let anchor = match free[0] {
            right if right > 0.5 => "start",
            right if right < -0.5 => "end",
            _ => "middle",
        };
        // Letters stand on their line: below the pulley they need their height, beside it half of it.
        let y = y - away * free[1] + 5.0 - 5.0 * free[1];
        ("", anchor, x + away * free[0], y)
    };
    format!(
        "<text{class} x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{}</text>",
        escaped(&pulley.name)
    )
}

/// Whether friction at a point of the belt is exhausted.
pub fn slides(drive: &Drive, row: &ProfileRow) -> bool {
    let pulley = drive.pulley.iter().find(|pulley| pulley.name == row.pulley);
    pulley.is_some_and(|pulley| {
        let limit = drive.coefficient_on(pulley) * row.normal_force.abs();
        row.friction_force != 0.0 && row.friction_force.abs() >= EXHAUSTED * limit
    })
}

/// Arcs around the points whose friction is exhausted, each half-way to its neighbours in contact.
fn slip_arcs(drive: &Drive, layout: &Layout, belt: &[ProfileRow], view: &View) -> String {
    let count = belt.len();
    let mut path = String::new();
    for i in (0..count).filter(|i| slides(drive, &belt[*i])) {
        let row = &belt[i];
        let Some(arc) = arc_of(drive, layout, row) else {
            continue;
        };
        let angle = |row: &ProfileRow| (row.y - arc.center[1]).atan2(row.x - arc.center[0]);
        let here = angle(row);
        let half_way = |other: &ProfileRow| {
            if other.pulley == row.pulley {
                0.5 * nearest_turn(angle(other) - here)
            } else {
                0.0
            }
        };
        let from = half_way(&belt[(i + count - 1) % count]);
        let to = half_way(&belt[(i + 1) % count]);
        path.push_str(&view.arc(arc.center, arc.radius, here + from, to - from));
    }
    path
}

fn arc_of<'a>(drive: &Drive, layout: &'a Layout, row: &ProfileRow) -> Option<&'a Arc> {
    let index = drive.pulley.iter().position(|p| p.name == row.pulley)?;
    layout.arcs.iter().find(|arc| arc.pulley == index)
}

/// An angle brought between -pi and pi.
fn nearest_turn(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    (angle + 0.5 * turn).rem_euclid(turn) - 0.5 * turn
}

/// From metres to the drawing.
struct View {
    /// Left and upper end of the content [m].
    corner: [f64; 2],
    /// Units of the drawing per metre.
    scale: f64,
    width: f64,
    height: f64,
}

impl View {
    fn of(drive: &Drive, layout: &Layout) -> Self {
        let radii = layout.arcs.iter().map(|arc| (arc.center, arc.radius));
        let own = drive.pulley.iter().map(|p| (p.center, p.radius));
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for (center, radius) in radii.chain(own) {
            for k in 0..2 {
                low[k] = low[k].min(center[k] - radius);
                high[k] = high[k].max(center[k] + radius);
            }
        }
        let size = [high[0] - low[0], high[1] - low[1]];
        let scale = (WIDTH / size[0]).min(HEIGHT / size[1]);
        Self {
            corner: [low[0], high[1]],
            scale,
            width: size[0] * scale + 2.0 * MARGIN,
            height: size[1] * scale + 2.0 * MARGIN + 24.0,
        }
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        [
            MARGIN + (point[0] - self.corner[0]) * self.scale,
            MARGIN + (self.corner[1] - point[1]) * self.scale,
        ]
    }

    fn arc(&self, center: [f64; 2], radius: f64, start: f64, sweep: f64) -> String {
        let at = |angle: f64| {
            self.place([
                center[0] + radius * angle.cos(),
                center[1] + radius * angle.sin(),
            ])
        };
        let ([x1, y1], [x2, y2]) = (at(start), at(start + sweep));
        format!(
            "M{x1:.2} {y1:.2}A{r:.2} {r:.2} 0 {} {} {x2:.2} {y2:.2}",
            u8::from(sweep.abs() > std::f64::consts::PI),
            u8::from(sweep < 0.0),
            r = radius * self.scale,
        )
    }

    /// A bar of a round length, about a fifth of the drawing.
    fn scale_bar(&self) -> String {
        let about = 0.2 * (self.width - 2.0 * MARGIN) / self.scale;
        let decade = 10.0_f64.powf(about.log10().floor());
        let length = [5.0, 2.0, 1.0]
            .map(|step| step * decade)
            .into_iter()
            .find(|length| *length <= about)
            .unwrap_or(decade);
        let (x, y) = (MARGIN, self.height - 14.0);
        let end = x + length * self.scale;
        format!(
            "<path class=\"thin\" d=\"M{x:.2} {:.2}v8M{x:.2} {y:.2}H{end:.2}m0 -4v8\"/><text x=\"{:.2}\" y=\"{:.2}\">{}</text>",
            y - 4.0,
            end + 8.0,
            y + 5.0,
            with_prefix(length, "m")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_go_on_after_z() {
        assert_eq!(
            [0, 1, 25, 26, 27, 701, 702].map(letter),
            ["A", "B", "Z", "AA", "AB", "ZZ", "AAA"]
        );
    }

    /// The arrow's head is the only thing that is rotated.
    #[test]
    fn a_standing_pulley_has_no_arrow() {
        let text = include_str!("../../../examples/two_pulley.toml");
        let drive = hihna::input::parse("drive", text, &[]).unwrap();
        let layout = Layout::new(&drive.pulley).unwrap();
        let arrows = |speeds| {
            drawing(&drive, &layout, &[], speeds)
                .matches("rotate(")
                .count()
        };
        assert_eq!(arrows(&[12.0, -0.01]), 2);
        assert_eq!(arrows(&[12.0, 3.0e-13]), 1);
        assert_eq!(arrows(&[0.0, f64::NAN]), 0);
    }

    /// A name that does not fit its pulley stands where the belt does not.
    #[test]
    fn long_names_stand_on_the_free_side() {
        let text = include_str!("../../../examples/two_pulley.toml");
        let drive = hihna::input::parse("drive", text, &[]).unwrap();
        let layout = Layout::new(&drive.pulley).unwrap();
        // The belt is around the left of the left pulley and the right of the right one.
        let sides = [0, 1].map(|i| free_side(&layout, i));
        for (side, expected) in sides.into_iter().zip([1.0, -1.0]) {
            assert!((side[0] - expected).abs() < 1e-12 && side[1].abs() < 1e-12);
        }
        let view = View::of(&drive, &layout);
        let mut pulley = drive.pulley[0].clone();
        assert!(name(&view, &pulley, sides[0]).contains("class=\"inside\""));
        pulley.name = "a pulley with quite a long name indeed".into();
        let outside = name(&view, &pulley, sides[0]);
        assert!(outside.contains("text-anchor=\"start\"") && !outside.contains("class"));
    }

    #[test]
    fn names_cannot_carry_markup() {
        let text = include_str!("../../../examples/two_pulley.toml");
        let mut drive = hihna::input::parse("drive", text, &[]).unwrap();
        drive.pulley[0].name = "<script>alert(1)</script>".into();
        let layout = Layout::new(&drive.pulley).unwrap();
        let svg = drawing(&drive, &layout, &[], &[12.0, -3.0]);
        assert!(!svg.contains("<script>"));
        // Saved to a file of its own it is a picture, too.
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    }
}
