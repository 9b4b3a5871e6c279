//! The time run: settle on the pulleys, integrate, observe.

use std::ops::ControlFlow;
use std::time::Instant;

use ancf::dynamics::{Control, IntegrationError, Method, Motion, Statistics, Window, integrate};
use ancf::element::BeltBeam2;
use ancf::statics::{Settle, Settled, StaticsError, settle};
use ancf::system::Mechanics;
use thiserror::Error;

use crate::assemble::{Assembly, AssemblyError, BeltElementType, Mounting, Warning};
use crate::drive::{BeltElement, Drive, Friction, Integrator, Step};
use crate::friction::{Coulomb, CreepRate, FrictionLaw, Frictionless};
use crate::history::History;
use crate::layout::Layout;
use crate::observe::{Observer, Powers, ProfileRow, PulleyState, SpanState, Stored};
use crate::profile::Profile;

/// Accuracy at which the constants below hold.
const REFERENCE_ACCURACY: f64 = 1.0e-3;

/// Accepted error of predicted belt velocities, relative to the nominal speed. Of 0.01, 0.02 and 0.03,
/// tried on the base case with 20, 30 and 60 elements, the coarsest: the peak of the driven speed moves
/// by less than 1e-4 of it between them.
const PREDICTION_TOLERANCE: f64 = 0.03;

/// Largest step relative to the slowest swing's `1 / omega`: its second-order dispersion
/// `(omega h)² / 12` is 2e-4 then.
const SWING_STEP: f64 = 0.05;

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time [s].
    pub time: f64,
    /// End of the run [s].
    pub end_time: f64,
    /// Steps made.
    pub steps: usize,
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop; nothing is kept.
    Stop,
}

/// What a run found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The belt's path.
    pub layout: Layout,
    /// How tight the belt is on its path.
    pub mounting: Mounting,
    /// Things to tell the user.
    pub warnings: Vec<Warning>,
    /// The state from which the clock started.
    pub start: StartState,
    /// One row per output time.
    pub history: History,
    /// The belt at the profile times.
    pub profile: Vec<ProfileRow>,
    /// What the stepping cost.
    pub statistics: Statistics,
    /// CPU time of the stepping alone [s].
    pub cpu_seconds: f64,
    /// Wall time of the whole run [s].
    pub wall_seconds: f64,
    /// Number of coordinates.
    pub dofs: usize,
    /// The integrator used.
    pub integrator: &'static str,
    /// Energy and torque balance.
    pub audit: Audit,
}

/// The equilibrium at rest on the pulleys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartState {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Largest penetration into a pulley [m].
    pub penetration: f64,
    /// Newton iterations.
    pub iterations: usize,
}

/// The balance of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Audit {
    /// Work of the drivers [J].
    pub energy_input: f64,
    /// Energy turned over: the work put in or taken out, summed without sign [J].
    pub turnover: f64,
    /// Largest energy residual in the rows of the history, relative to the turnover.
    pub energy_residual: f64,
    /// Largest residual of the torque balance of a free pulley, relative to the angular momentum
    /// that its torques moved.
    pub torque_residual: f64,
    /// Largest residuals allowed.
    pub tolerance: f64,
}

impl Audit {
    /// Whether both balances close.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.energy_residual <= self.tolerance && self.torque_residual <= self.tolerance
    }
}

/// A run that failed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// The drive cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// No equilibrium at rest was found.
    #[error("the belt finds no equilibrium at rest on the pulleys, {place}: {cause}")]
    Start {
        /// Where.
        place: String,
        /// Why.
        cause: StaticsError,
    },
    /// A step did not converge.
    #[error("the run stops at t = {time:.6} s, {place}: {cause}")]
    Step {
        /// When [s].
        time: f64,
        /// Where.
        place: String,
        /// Why.
        cause: IntegrationError,
    },
    /// The observer asked to stop.
    #[error("stopped at t = {time:.6} s")]
    Stopped {
        /// When [s].
        time: f64,
    },
}

/// Runs `drive`, telling `observer` how far it is after every step.
pub fn simulate(
    drive: &Drive,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    match drive.belt.element {
        BeltElement::BeltBeam => with_element::<BeltBeam2>(drive, observer),
    }
}

fn with_element<E: BeltElementType>(
    drive: &Drive,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    match drive.contact.friction {
        Friction::CreepRate { coefficient, slope } => {
            run::<E, _>(drive, CreepRate { coefficient, slope }, observer)
        }
        Friction::Coulomb {
            coefficient,
            velocity,
        } => run::<E, _>(
            drive,
            Coulomb {
                coefficient,
                velocity,
            },
            observer,
        ),
    }
}

fn run<E: BeltElementType, F: FrictionLaw>(
    drive: &Drive,
    friction: F,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    let wall = Instant::now();
    let mut resting = Assembly::<E, _>::new(drive, Frictionless)?;
    let settled = settle_on_pulleys(drive, &mut resting)?;
    let mut assembly = resting.with_friction(friction);
    let start_motion = assembly.motion.clone();
    let control = control(drive, &assembly.mounting);

    let mut recorder = Recorder::new(drive, &assembly);
    let start = recorder.start(&assembly, &start_motion, settled);
    let mut steps = 0;
    let mut stopped = None;
    let mut motion = start_motion;
    let end = drive.run.end_time;
    let cpu = cpu_time::ThreadTime::now();
    let element_start = std::mem::take(&mut assembly.element_start);
    let statistics = integrate(
        &mut assembly.system,
        &mut motion,
        end,
        &control,
        |system, window| {
            recorder.step(system, &element_start, window);
            steps += 1;
            let progress = Progress {
                time: window.to.time,
                end_time: end,
                steps,
            };
            match observer(&progress) {
                Flow::Continue => ControlFlow::Continue(()),
                Flow::Stop => {
                    stopped = Some(window.to.time);
                    ControlFlow::Break(())
                }
            }
        },
    )
    .map_err(|cause| {
        let IntegrationError::StepFailed {
            time,
            cause: failure,
            ..
        } = &cause;
        RunError::Step {
            time: *time,
            place: place(
                drive,
                &assembly.layout,
                &motion,
                failure.coordinate,
                E::NODE_DOF,
            ),
            cause,
        }
    })?;
    if let Some(time) = stopped {
        return Err(RunError::Stopped { time });
    }
    let cpu_seconds = cpu.elapsed().as_secs_f64();
    let audit = recorder.audit(drive);
    Ok(Outcome {
        start,
        audit,
        history: recorder.history,
        profile: recorder.profile,
        statistics,
        cpu_seconds,
        wall_seconds: wall.elapsed().as_secs_f64(),
        dofs: assembly.system.structure().size(),
        integrator: integrator_name(control.method),
        layout: assembly.layout,
        mounting: assembly.mounting,
        warnings: assembly.warnings,
    })
}

/// Moves the belt from its path to its equilibrium on the frictionless pulleys (THEORY of the
/// dissertation's start, see the guide).
fn settle_on_pulleys<E: BeltElementType>(
    drive: &Drive,
    resting: &mut Assembly<E, Frictionless>,
) -> Result<Settled, RunError> {
    // The contact's own frequency sets how strongly the first steps are held back.
    let belt = &drive.belt;
    let line_density = belt.density * belt.width * belt.thickness;
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    settle(
        &mut resting.system,
        0.0,
        &mut resting.motion.q,
        Settle {
            shift: drive.contact.stiffness / line_density,
            shrink: 0.3,
            step_limit: 0.1 * smallest,
            tolerance: 1.0e-10 * smallest,
            max_iterations: 200,
        },
    )
    .map_err(|cause| {
        let (StaticsError::NotConverged { coordinate, .. }
        | StaticsError::Singular { coordinate }) = cause;
        RunError::Start {
            place: place(
                drive,
                &resting.layout,
                &resting.motion,
                coordinate,
                E::NODE_DOF,
            ),
            cause,
        }
    })
}

/// Where on the drive a coordinate is, in words.
fn place(drive: &Drive, layout: &Layout, motion: &Motion, coordinate: usize, dof: usize) -> String {
    let chain = drive.belt.elements * dof;
    if coordinate >= chain {
        return format!("at pulley `{}`", drive.pulley[coordinate - chain].name);
    }
    let node = coordinate / dof;
    let position = [motion.q[node * dof], motion.q[node * dof + 1]];
    let (from, to) = nearest_pulleys(layout, position);
    let at = format!("node {node} at ({:.4}, {:.4}) m", position[0], position[1]);
    if from == to {
        format!("on pulley `{}`, {at}", drive.pulley[from].name)
    } else {
        format!(
            "between pulleys `{}` and `{}`, {at}",
            drive.pulley[from].name, drive.pulley[to].name
        )
    }
}

/// The pulley nearest to `position`, twice, or the two at the ends of the span that is nearer.
fn nearest_pulleys(layout: &Layout, position: [f64; 2]) -> (usize, usize) {
    let to_arc = layout.arcs.iter().map(|arc| {
        let (dx, dy) = (position[0] - arc.center[0], position[1] - arc.center[1]);
        ((dx.hypot(dy) - arc.radius).abs(), (arc.pulley, arc.pulley))
    });
    let to_span = layout.spans.iter().map(|span| {
        let along = [span.end[0] - span.start[0], span.end[1] - span.start[1]];
        let arm = [position[0] - span.start[0], position[1] - span.start[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let part = ((arm[0] * along[0] + arm[1] * along[1]) / square).clamp(0.0, 1.0);
        let off = [arm[0] - part * along[0], arm[1] - part * along[1]];
        (off[0].hypot(off[1]), (span.from, span.to))
    });
    to_arc
        .chain(to_span)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or((0, 0), |(_, pulleys)| pulleys)
}

/// Surface speed of the fastest driver [m/s]; where nothing is driven, a hundredth of the belt's
/// longitudinal wave speed.
#[must_use]
pub fn nominal_speed(drive: &Drive) -> f64 {
    let driven = drive
        .pulley
        .iter()
        .map(|pulley| {
            let speed = pulley.speed.as_ref().map_or(0.0, Profile::bound);
            let turning = pulley.angle.as_ref().map_or(0.0, slope_bound);
            speed.max(turning) * pulley.radius
        })
        .fold(0.0, f64::max);
    if driven > 0.0 {
        driven
    } else {
        0.01 * (drive.belt.axial_factor * drive.belt.youngs_modulus / drive.belt.density).sqrt()
    }
}

/// Greatest magnitude of the derivative: every kind of piece has it at its start or in its middle.
fn slope_bound(profile: &Profile) -> f64 {
    let kinks = profile.kinks();
    let middles = kinks.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    kinks
        .iter()
        .copied()
        .chain(middles)
        .fold(0.0, |bound, t| f64::max(bound, profile.derivative(t).abs()))
}

/// Step, tolerances and kinks of a run.
///
/// The belt's velocity turns by `h v / R` per step where it meets a pulley; a prediction by constant
/// acceleration misses the step of the centripetal acceleration there by `h v² / R`. The largest step
/// lets the belt turn by a fiftieth of a radian; [`PREDICTION_TOLERANCE`] finds smaller ones. Both go
/// with the square root of the accuracy, as the schemes are of second order.
fn control(drive: &Drive, mounting: &Mounting) -> Control {
    let run = &drive.run;
    let speed = nominal_speed(drive);
    let fineness = (run.accuracy / REFERENCE_ACCURACY).sqrt();
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    let method = match run.integrator {
        Integrator::Auto => Method::Auto,
        Integrator::GeneralizedAlpha => Method::GeneralizedAlpha,
        Integrator::TrBdf2 => Method::TrBdf2,
        Integrator::RungeKutta => Method::RungeKutta,
    };
    let (step, error_tolerance) = match (run.step, method) {
        (Step::Fixed(step), _) => (step, None),
        (Step::Named(_), Method::RungeKutta) => (explicit_step(drive, mounting), None),
        (Step::Named(_), _) => (
            (0.02 * smallest / speed * fineness)
                .min(SWING_STEP * fineness / slowest_swing(drive, mounting))
                .min(run.end_time),
            Some(PREDICTION_TOLERANCE * speed * fineness),
        ),
    };
    let mut kinks: Vec<f64> = drive
        .pulley
        .iter()
        .flat_map(|p| [Some(&p.torque), p.speed.as_ref(), p.angle.as_ref()])
        .flatten()
        .flat_map(crate::profile::Profile::kinks)
        .collect();
    kinks.sort_by(f64::total_cmp);
    Control {
        method,
        step,
        error_tolerance,
        newton_tolerance: 1.0e-6 * speed * (run.accuracy / REFERENCE_ACCURACY),
        kinks,
    }
}

/// Angular frequency [rad/s] of the slowest swing of a free pulley on the two spans beside it, zero if
/// no pulley is free: the vibration that a changing speed excites first.
fn slowest_swing(drive: &Drive, mounting: &Mounting) -> f64 {
    let belt = &drive.belt;
    let stiffness = belt.axial_factor * belt.youngs_modulus * belt.width * belt.thickness;
    // Spans are no longer than the belt: the estimate is on the slow side.
    let per_length = drive.pulley.len() as f64 / mounting.length;
    drive
        .pulley
        .iter()
        .filter(|pulley| !pulley.is_driver())
        .map(|p| p.radius * (2.0 * stiffness * per_length / p.inertia).sqrt())
        .reduce(f64::min)
        .unwrap_or(0.0)
}

/// A stable step of the explicit scheme: half its real stability limit 2.78 for friction at full
/// creep and contact damping, and half its imaginary one 2.83 for the fastest elastic mode. The
/// consistent mass of a cubic element lets modes be up to four times faster than the local rates.
fn explicit_step(drive: &Drive, mounting: &Mounting) -> f64 {
    let belt = &drive.belt;
    let line_density = belt.density * belt.width * belt.thickness;
    let slope = match drive.contact.friction {
        Friction::CreepRate { slope, .. } => slope,
        Friction::Coulomb {
            coefficient,
            velocity,
        } => {
            let smallest = drive
                .pulley
                .iter()
                .fold(f64::INFINITY, |r, p| r.min(p.radius));
            coefficient * mounting.tension.max(1.0) / smallest / velocity
        }
    };
    let rate = 4.0 * (slope + drive.contact.damping) / line_density;
    let wave = (belt.youngs_modulus / belt.density).sqrt();
    let thickness_mode = wave * 12.0_f64.sqrt() / belt.thickness;
    let length = mounting.length / belt.elements as f64;
    let axial_mode = 4.0 * wave * belt.axial_factor.sqrt() * 3.5 / length;
    let frequency = (3.0_f64.sqrt() * thickness_mode).max(axial_mode);
    (0.5 * 2.78 / rate).min(0.5 * 2.83 / frequency)
}

fn integrator_name(method: Method) -> &'static str {
    match method {
        Method::Auto | Method::GeneralizedAlpha => "generalized-alpha",
        Method::TrBdf2 => "tr-bdf2",
        Method::RungeKutta => "runge-kutta",
    }
}

/// Collects history, profile and balances while the run goes on.
struct Recorder {
    observer: Observer,
    pulleys: Vec<PulleyState>,
    spans: Vec<SpanState>,
    history: History,
    profile: Vec<ProfileRow>,
    state: Motion,
    output_times: Vec<f64>,
    next_output: usize,
    profile_times: Vec<f64>,
    next_profile: usize,
    initial: Stored,
    /// Powers at the last accepted state and work since the start.
    powers: Powers,
    work: Powers,
    turnover: f64,
    largest_residual: f64,
    /// For each pulley: torque last, its integral, the integral of its magnitude, first speed, now.
    momenta: Vec<Momentum>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Momentum {
    torque: f64,
    impulse: f64,
    moved: f64,
    first_speed: f64,
    speed: f64,
}

impl Recorder {
    fn new<E: BeltElementType, F: FrictionLaw>(drive: &Drive, assembly: &Assembly<E, F>) -> Self {
        let names: Vec<String> = drive.pulley.iter().map(|p| p.name.clone()).collect();
        let inertias: Vec<f64> = drive.pulley.iter().map(|p| p.inertia).collect();
        let end = drive.run.end_time;
        let mut profile_times = drive.run.profile_times.clone();
        if profile_times.is_empty() {
            profile_times.push(end);
        }
        profile_times.sort_by(f64::total_cmp);
        Self {
            observer: Observer::new(&assembly.system, names.clone(), &inertias),
            pulleys: vec![PulleyState::default(); names.len()],
            spans: vec![SpanState::default(); names.len()],
            history: History::new(&names),
            profile: Vec::new(),
            state: assembly.motion.clone(),
            output_times: output_times(end, drive.run.output_interval),
            next_output: 0,
            profile_times,
            next_profile: 0,
            initial: Stored::default(),
            powers: Powers::default(),
            work: Powers::default(),
            turnover: 0.0,
            largest_residual: 0.0,
            momenta: vec![Momentum::default(); names.len()],
        }
    }

    /// Observes the state before the first step.
    fn start<E: BeltElementType, F: FrictionLaw>(
        &mut self,
        assembly: &Assembly<E, F>,
        motion: &Motion,
        settled: Settled,
    ) -> StartState {
        let system = &assembly.system;
        // The prescribed speeds may start with a jump: stored energy counts from just after it.
        let mut begun = motion.clone();
        system.prescribe(begun.time, &mut begun.q, &mut begun.v, &mut begun.a);
        self.observer.pulleys(system, &begun, &mut self.pulleys);
        self.initial = self.observer.stored(system, &begun);
        self.powers = self.observer.powers(system, &begun, &self.pulleys);
        for (momentum, pulley) in self.momenta.iter_mut().zip(&self.pulleys) {
            momentum.torque = pulley.torque + pulley.external_torque;
            momentum.first_speed = pulley.speed;
            momentum.speed = pulley.speed;
        }
        StartState {
            tension: self.observer.mean_tension(system, &begun),
            penetration: self.observer.penetration(),
            iterations: settled.iterations,
        }
    }

    /// Takes the step of `window` in: balances first, then rows at the output times within it.
    fn step<E: BeltElementType, F: FrictionLaw>(
        &mut self,
        system: &ancf::system::System<E, crate::contact::BeltContact<E, F>>,
        element_start: &[f64],
        window: Window<'_>,
    ) {
        let (t0, t1) = (window.from.time, window.to.time);
        let step = t1 - t0;

        // The trapezoidal rule is of second order as the schemes are. Simpson's rule on interpolated
        // states left forty times the residual on the base case, probably because accelerations carry
        // the noise of fast modes into velocities interpolated with them.
        self.observer.pulleys(system, window.to, &mut self.pulleys);
        let last = self.observer.powers(system, window.to, &self.pulleys);
        for (momentum, pulley) in self.momenta.iter_mut().zip(&self.pulleys) {
            let torque = pulley.torque + pulley.external_torque;
            momentum.impulse += 0.5 * step * (momentum.torque + torque);
            momentum.moved += 0.5 * step * (momentum.torque.abs() + torque.abs());
            momentum.torque = torque;
            momentum.speed = pulley.speed;
        }
        let first = self.powers;
        let work_before = self.work;
        // Integral of the line through the powers at both ends up to the part `s` of the step.
        let work_until = |s: f64| {
            work_before
                .plus(step * (s - 0.5 * s * s), &first)
                .plus(step * 0.5 * s * s, &last)
        };
        self.work = work_until(1.0);
        self.turnover += 0.5
            * step
            * (first.input.abs() + first.load.abs() + last.input.abs() + last.load.abs());
        self.powers = last;

        let mut state = std::mem::replace(&mut self.state, Motion::zero(0));
        let slack = 1.0e-9 * step;
        while self
            .output_times
            .get(self.next_output)
            .is_some_and(|t| *t <= t1 + slack)
        {
            let time = self.output_times[self.next_output];
            window.interpolate(time, &mut state);
            self.row(system, &state, &work_until((time - t0) / step));
            self.next_output += 1;
        }
        while self
            .profile_times
            .get(self.next_profile)
            .is_some_and(|t| *t <= t1 + slack)
        {
            window.interpolate(self.profile_times[self.next_profile], &mut state);
            self.profile
                .extend(self.observer.profile(system, &state, element_start));
            self.next_profile += 1;
        }
        self.state = state;
    }

    fn row<E: BeltElementType, F: FrictionLaw>(
        &mut self,
        system: &ancf::system::System<E, crate::contact::BeltContact<E, F>>,
        state: &Motion,
        work: &Powers,
    ) {
        self.observer.pulleys(system, state, &mut self.pulleys);
        let stored = self.observer.stored(system, state);
        self.observer.spans(system, state, &mut self.spans);
        let residual = self.residual(&stored, work);
        self.largest_residual = self.largest_residual.max(residual.abs());
        self.history.push(
            state.time,
            &self.pulleys,
            &self.spans,
            &stored,
            work,
            residual,
        );
    }

    /// What is stored beyond what was put in and not taken out [J].
    fn residual(&self, stored: &Stored, work: &Powers) -> f64 {
        stored.total() - self.initial.total() - work.input - work.load
            + work.friction
            + work.contact
            + work.damping
    }

    fn audit(&self, drive: &Drive) -> Audit {
        // A drive at rest turns nothing over: compare with what the belt has stored.
        let scale = self.turnover.max(1.0e-6 * self.initial.total());
        let torque_residual = self
            .momenta
            .iter()
            .zip(&drive.pulley)
            .filter(|(momentum, pulley)| !pulley.is_driver() && momentum.moved > 0.0)
            .map(|(momentum, pulley)| {
                let gained = pulley.inertia * (momentum.speed - momentum.first_speed);
                (gained - momentum.impulse).abs() / momentum.moved
            })
            .fold(0.0, f64::max);
        Audit {
            energy_input: self.work.input,
            turnover: self.turnover,
            energy_residual: self.largest_residual / scale,
            torque_residual,
            tolerance: 0.1 * drive.run.accuracy,
        }
    }
}

/// Multiples of `interval` from zero, and the end.
fn output_times(end: f64, interval: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count of rows"
    )]
    let count = (end / interval * (1.0 + 1.0e-12)).floor() as usize;
    let mut times: Vec<f64> = (0..=count)
        .map(|i| (i as f64 * interval).min(end))
        .collect();
    if times
        .last()
        .is_some_and(|last| end - last > 1.0e-9 * interval)
    {
        times.push(end);
    }
    times
}
