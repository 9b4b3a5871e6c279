//! The loaded drive at 120 rad/s: Figs 3.10-3.20.

use super::time_run::{Line, Section, TimeRun, range};
use super::{CaseError, Quantities};

const DRIVE: &str = include_str!("../../../../examples/figures_3_10_to_3_20.toml");

const TIGHT: &str = "driven-driver";
const SLACK: &str = "driver-driven";
const DRIVEN: usize = 1;
/// Of the driver [rad/s].
const FINAL_SPEED: f64 = 120.0;
/// The ramp of speed and torque, a part of it as long as [`STEADY`], and one around Fig. 3.12's 0.428 s [s].
const RAMP: [f64; 2] = [0.05, 0.60];
const LATE_RAMP: [f64; 2] = [0.40, 0.60];
const ACCELERATION: [f64; 2] = [0.40, 0.456];
/// Parts of the ramp whose swings make the envelope of a vibration.
const ENVELOPE: usize = 11;
/// Speed and torque are constant and the ramp's end has rung down [s].
const STEADY: [f64; 2] = [0.80, 1.0];
/// The first tenth of a second with constant speed, and the last.
const FIRST: [f64; 2] = [0.60, 0.70];
const LAST: [f64; 2] = [0.90, 1.0];
/// Parts of an arc for means over time, and how far they reach beyond the path's arc [rad]: the belt
/// sinks in by 2.2 mm, so that it touches from sqrt(2 · 2.2 / 81) = 0.23 rad before it.
const SECTIONS: usize = 24;
const BEYOND: f64 = 0.2;
/// Ends of an arc left out where the rest is asked to be straight [rad]: what the belt sinks in over.
const END_ZONE: f64 = 0.4;

/// The drive with one mesh and one creep slope.
struct Loaded {
    run: TimeRun,
    /// Time means along both arcs.
    sections: [Vec<Section>; 2],
}

impl Loaded {
    fn new(elements: &str, slope: &str) -> Result<Self, CaseError> {
        // 40 times that no element's passing fits; the last five of the file's own are among them.
        let times: Vec<String> = (0..40)
            .map(|i| format!("{:.5}", 0.80 + 0.005 * f64::from(i)))
            .collect();
        let run = TimeRun::new(
            DRIVE,
            &[
                &format!("belt.elements={elements}"),
                &format!("contact.friction.slope={slope}"),
                &format!("run.profile_times=[{}]", times.join(", ")),
                "run.output_interval=5e-4",
            ],
        )?;
        let sections = [0, DRIVEN].map(|p| run.sections(p, SECTIONS, BEYOND));
        Ok(Self { run, sections })
    }

    fn mean(&self, column: &str) -> Result<f64, CaseError> {
        self.run.mean(column, STEADY)
    }

    fn tension_difference(&self) -> Result<f64, CaseError> {
        Ok(self.mean(&format!("{TIGHT}.tension"))? - self.mean(&format!("{SLACK}.tension"))?)
    }

    /// Moment [N m] of the spans' T - rho A v² about a pulley's centre. The spans run inside the path by
    /// their deflection, and straight: their mean lever about both centres is the radius less the
    /// deflection in the middle.
    fn moment(&self, window: [f64; 2]) -> Result<f64, CaseError> {
        let radius = self.run.drive.pulley[DRIVEN].radius;
        let moment = |span: &str| -> Result<f64, CaseError> {
            let deflection = self.run.mean(&format!("{span}.deflection"), window)?;
            Ok(self.run.pressing_tension(span, window)? * (radius - deflection))
        };
        Ok(moment(TIGHT)? - moment(SLACK)?)
    }

    /// Mean of both pulleys' torques over the moment of the spans.
    fn moment_balance(&self) -> Result<f64, CaseError> {
        let torque = 0.5 * (self.mean("driven.torque")? - self.mean("driver.torque")?);
        Ok(torque / self.moment(STEADY)?)
    }

    /// The opposing torque and that of the driven pulley's inertia over the moment of the spans, while the drive
    /// accelerates.
    fn acceleration_balance(&self) -> Result<f64, CaseError> {
        let speed = self.run.window("driven.speed", ACCELERATION)?;
        let [first, .., last] = speed.as_slice() else {
            return Err(CaseError::DoesNotRun);
        };
        let acceleration = (last - first) / (ACCELERATION[1] - ACCELERATION[0]);
        let opposing = self.run.mean("driven.external_torque", ACCELERATION)?;
        let inertia = self.run.drive.pulley[DRIVEN].inertia;
        Ok((inertia * acceleration - opposing) / self.moment(ACCELERATION)?)
    }

    /// Tension difference times radius over the driven pulley's torque.
    fn literal_balance(&self) -> Result<f64, CaseError> {
        let radius = self.run.drive.pulley[DRIVEN].radius;
        Ok(self.tension_difference()? * radius / self.mean("driven.torque")?)
    }

    fn swing(&self, span: &str, window: [f64; 2]) -> Result<f64, CaseError> {
        self.run.swing(&format!("{span}.deflection"), window)
    }

    /// Swing of a span in the last 0.1 s over that in the first after the driver has its final speed.
    fn decay(&self, span: &str) -> Result<f64, CaseError> {
        Ok(self.swing(span, LAST)? / self.swing(span, FIRST)?)
    }

    /// Swing of a span in the last 0.1 s over its largest in 0.1 s of the ramp, in windows half of which overlap.
    fn dying(&self, span: &str) -> Result<f64, CaseError> {
        let mut largest = 0.0;
        for i in 0..ENVELOPE - 1 {
            let from = RAMP[0] + 0.05 * i as f64;
            largest = f64::max(largest, self.swing(span, [from, from + 0.1])?);
        }
        Ok(self.swing(span, LAST)? / largest)
    }

    /// Mean of a span's swings in equal parts of the ramp [m].
    fn envelope(&self, span: &str) -> Result<f64, CaseError> {
        let width = (RAMP[1] - RAMP[0]) / ENVELOPE as f64;
        let mut sum = 0.0;
        for i in 0..ENVELOPE {
            let from = RAMP[0] + width * i as f64;
            sum += self.swing(span, [from, from + width])?;
        }
        Ok(sum / ENVELOPE as f64)
    }

    /// Scatter of the tension where the belt runs on and off, against that of the span beside it, in the
    /// steady part over that in the ramp.
    fn ripple(&self, end: &str, span: &str) -> Result<f64, CaseError> {
        let scatter = |window| -> Result<f64, CaseError> {
            let at_end = self.run.window(end, window)?;
            let in_span = self.run.window(&format!("{span}.tension"), window)?;
            let less = at_end.iter().zip(&in_span).enumerate();
            let points: Vec<_> = less.map(|(i, (a, b))| (i as f64, a - b)).collect();
            Ok(Line::through(&points).deviation)
        };
        Ok(scatter(STEADY)? / scatter(LATE_RAMP)?)
    }

    /// Part of the arc without its ends.
    fn inner(&self, p: usize) -> impl Iterator<Item = &Section> {
        let sweep = self.run.outcome.layout.arcs[p].sweep.abs();
        let within = move |s: &&Section| s.angle > END_ZONE && s.angle < sweep - END_ZONE;
        self.sections[p].iter().filter(within)
    }

    /// Deviation of a force from a straight line over the inner arc, by its mean.
    fn curvature(&self, p: usize, force: fn(&Section) -> f64) -> f64 {
        let points: Vec<_> = self.inner(p).map(|s| (s.angle, force(s))).collect();
        let line = Line::through(&points);
        line.deviation / line.mean.abs()
    }

    /// Largest friction force at one end over that in the middle of the arc.
    fn peak(&self, p: usize, at_exit: bool) -> f64 {
        let sweep = self.run.outcome.layout.arcs[p].sweep.abs();
        let at_end = |s: &&Section| {
            if at_exit {
                s.angle > sweep - END_ZONE
            } else {
                s.angle < END_ZONE
            }
        };
        let largest = self.sections[p].iter().filter(at_end);
        let largest = largest.map(|s| s.friction_force.abs()).fold(0.0, f64::max);
        let middle = |s: &&Section| (s.angle - 0.5 * sweep).abs() < 0.5 * END_ZONE;
        let middle: Vec<_> = self.sections[p].iter().filter(middle).collect();
        let sum: f64 = middle.iter().map(|s| s.friction_force.abs()).sum();
        largest / (sum / middle.len() as f64)
    }

    /// Places along an arc where the mean slip velocity changes its sign [rad].
    fn sign_changes(&self, p: usize) -> Vec<f64> {
        let pairs = self.sections[p].windows(2);
        pairs
            .filter(|pair| pair[0].slip_speed * pair[1].slip_speed < 0.0)
            .map(|pair| 0.5 * (pair[0].angle + pair[1].angle))
            .collect()
    }

    /// How far the first and the last point in contact move along the arcs over five times [rad].
    fn wandering(&self) -> f64 {
        let mut widest = 0.0;
        for p in [0, DRIVEN] {
            let mut ends = [Vec::new(), Vec::new()];
            for time in [0.80, 0.85, 0.90, 0.95, 0.995] {
                let at = self
                    .run
                    .rows_on(p)
                    .filter(|row| (row.time - time).abs() < 1.0e-6);
                let angles: Vec<f64> = at.map(|row| self.run.angle(p, row)).collect();
                ends[0].push(angles.iter().copied().fold(f64::INFINITY, f64::min));
                ends[1].push(angles.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            }
            widest = ends.iter().map(|end| range(end)).fold(widest, f64::max);
        }
        widest
    }
}

/// All of Figs 3.10-3.20.
pub(super) fn figures_3_10_to_3_20() -> Result<Quantities, CaseError> {
    let loads = [
        ("30 elements, slope 1e5", Loaded::new("30", "1e5")?),
        ("30 elements, slope 1e4", Loaded::new("30", "1e4")?),
        ("60 elements, slope 1e5", Loaded::new("60", "1e5")?),
        ("60 elements, slope 1e4", Loaded::new("60", "1e4")?),
        ("120 elements, slope 1e5", Loaded::new("120", "1e5")?),
        ("120 elements, slope 1e4", Loaded::new("120", "1e4")?),
    ];
    let mut quantities = Quantities::new();
    for (name, loaded) in &loads {
        quantities.extend(balances(name, loaded)?);
        quantities.extend(ripples(name, loaded)?);
        quantities.extend(spans(name, loaded)?);
        quantities.push((
            format!("inlet and exit over five times, {name}"),
            loaded.wandering(),
        ));
    }
    quantities.extend(points("slope 1e5", &loads[0].1)?);
    quantities.extend(points("slope 1e4", &loads[1].1)?);
    let [(_, steep), (_, flat)] = [&loads[2], &loads[3]];
    quantities.extend(arcs(steep, flat));
    quantities.push((
        "driven speed with slope 1e5 less that with 1e4".to_owned(),
        steep.mean("driven.speed")? - flat.mean("driven.speed")?,
    ));
    Ok(quantities)
}

/// Driven speed with 5 and 11 integration points against that with 7, the largest difference by the final speed [%].
fn points(slope: &str, seven: &Loaded) -> Result<Quantities, CaseError> {
    let law = slope.replace("slope ", "contact.friction.slope=");
    let speeds = seven.run.column("driven.speed")?;
    let mut quantities = Quantities::new();
    for count in ["5", "11"] {
        let points = format!("contact.points={count}");
        let changes = [
            "belt.elements=30",
            &law,
            &points,
            "run.output_interval=5e-4",
        ];
        let other = TimeRun::new(DRIVE, &changes)?.column("driven.speed")?;
        let apart = speeds.iter().zip(&other).map(|(a, b)| (a - b).abs());
        quantities.push((
            format!("7 from {count} points, 30 elements, {slope}"),
            apart.fold(0.0, f64::max) / FINAL_SPEED * 100.0,
        ));
    }
    Ok(quantities)
}

/// Torque, tensions and hub forces in steady means.
fn balances(name: &str, loaded: &Loaded) -> Result<Quantities, CaseError> {
    Ok(vec![
        (
            format!("torque on the driven pulley, {name}"),
            loaded.mean("driven.torque")?,
        ),
        (
            format!("torque over moment of the spans' tensions, {name}"),
            loaded.moment_balance()?,
        ),
        (
            format!("load and inertia over moment of the spans' tensions in the ramp, {name}"),
            loaded.acceleration_balance()?,
        ),
        (
            format!("tension difference times radius over torque, {name}"),
            loaded.literal_balance()?,
        ),
        (
            format!("hub forces from the spans' T - rho A v2, {name}"),
            loaded.run.hub_force_error(STEADY)?,
        ),
    ])
}

/// Ripples of the tension at both ends of both arcs.
fn ripples(name: &str, loaded: &Loaded) -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    for (pulley, on, off) in [("driver", TIGHT, SLACK), ("driven", SLACK, TIGHT)] {
        for (end, column, span) in [("inlet", "tension_in", on), ("exit", "tension_out", off)] {
            quantities.push((
                format!("ripple at the {pulley}'s {end}, steady over ramp, {name}"),
                loaded.ripple(&format!("{pulley}.{column}"), span)?,
            ));
        }
    }
    Ok(quantities)
}

/// Figs 3.10 and 3.11.
fn spans(name: &str, loaded: &Loaded) -> Result<Quantities, CaseError> {
    Ok(vec![
        (
            format!("tight over slack swing in the ramp, {name}"),
            loaded.envelope(TIGHT)? / loaded.envelope(SLACK)?,
        ),
        (
            format!("tight span's swing after the ramp, end over begin, {name}"),
            loaded.decay(TIGHT)?,
        ),
        (
            format!("slack span's swing after the ramp, end over begin, {name}"),
            loaded.decay(SLACK)?,
        ),
        (
            format!("tight span's swing at the end over that in the ramp, {name}"),
            loaded.dying(TIGHT)?,
        ),
        (
            format!("slack span's swing at the end over that in the ramp, {name}"),
            loaded.dying(SLACK)?,
        ),
    ])
}

/// Figs 3.13-3.17: forces and slip along the arcs.
fn arcs(steep: &Loaded, flat: &Loaded) -> Quantities {
    let mut quantities = Quantities::new();
    let friction = |s: &Section| s.friction_force;
    for (p, pulley) in [(0, "driver"), (DRIVEN, "driven")] {
        quantities.extend([
            (
                format!("friction from a straight line, slope 1e4, {pulley}"),
                flat.curvature(p, friction),
            ),
            (
                format!("normal force from a straight line, slope 1e4, {pulley}"),
                flat.curvature(p, |s| s.normal_force),
            ),
            (
                format!("friction from a straight line, slope 1e5 over 1e4, {pulley}"),
                steep.curvature(p, friction) / flat.curvature(p, friction),
            ),
            (
                format!("friction at the inlet over mid-arc, slope 1e5, {pulley}"),
                steep.peak(p, false),
            ),
            (
                format!("friction at the exit over mid-arc, slope 1e5, {pulley}"),
                steep.peak(p, true),
            ),
            (
                format!("sign changes of the slip, slope 1e4, {pulley}"),
                flat.sign_changes(p).len() as f64,
            ),
        ]);
    }
    let on_driver = steep.sign_changes(0);
    let on_driven = steep.sign_changes(DRIVEN);
    let sweep = steep.run.outcome.layout.arcs[DRIVEN].sweep.abs();
    let from_end = |angle: &f64| angle.min(sweep - angle);
    quantities.extend([
        (
            "sign changes of the slip, slope 1e5, driver".to_owned(),
            on_driver.len() as f64,
        ),
        (
            "sign changes of the slip, slope 1e5, driven".to_owned(),
            on_driven.len() as f64,
        ),
        (
            "farthest sign change from inlet or exit, slope 1e5, driven".to_owned(),
            on_driven.iter().map(from_end).fold(0.0, f64::max),
        ),
    ]);
    quantities
}
