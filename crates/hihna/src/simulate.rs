//! The time run: settle on the pulleys, integrate, observe.

mod control;
mod pacing;
mod place;
mod recorder;
mod settling;
mod steady_start;

use std::ops::ControlFlow;
use std::time::Instant;

use ancf::dynamics::{IntegrationError, Statistics, integrate};
use ancf::element::{BeltBeam2, BeltBeam3, CubicBeam2, Element, LinearBeam2, LinearBeam3};
use ancf::statics::{Settle, Settled, StaticsError, settle_watched};
use ancf::system::Mechanics;
use thiserror::Error;

use crate::assemble::{
    Assembly, AssemblyError, BeltElementType, Mounting, PlateAssembly, Rest, SpaceBeamAssembly,
    Warning,
};
use crate::contact::surface::SurfaceContact;
use crate::drive::{BeltElement, Drive, Joint, Start, Until};
use crate::history::History;
use crate::layout::Layout;
use crate::observe::{EdgeRow, ProfileRow, PulleyLaw};
use crate::user_laws::{UserLawError, UserLaws};

pub use control::nominal_speed;
use place::place;
use recorder::Recorder;
pub use settling::Settling;
use settling::Watch;
pub(crate) use settling::last_kink;
pub use steady_start::NoSteadyStart;

/// Correction, in smallest radii, at which the belt is at rest.
const REST: f64 = 1.0e-10;

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
    /// The belt at the times of the frames.
    pub frames: Vec<ProfileRow>,
    /// The edges of a belt of plates at the same times and places; empty for other belts.
    pub edges: Vec<EdgeRow>,
    /// What the stepping cost.
    pub statistics: Statistics,
    /// CPU time of the stepping alone, without the rows of the records [s].
    pub cpu_seconds: f64,
    /// Wall time of the whole run [s].
    pub wall_seconds: f64,
    /// Number of coordinates.
    pub dofs: usize,
    /// The integrator used.
    pub integrator: &'static str,
    /// Energy and torque balance.
    pub audit: Audit,
    /// When the run ended [s].
    pub end_time: f64,
    /// Of a run until its means settle: whether and when they have.
    pub settling: Option<Settling>,
}

/// The equilibrium at rest on the pulleys, or the steady running from which the clock started.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartState {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Largest penetration into a pulley [m].
    pub penetration: f64,
    /// Newton iterations.
    pub iterations: usize,
}

impl StartState {
    /// How the belt rests.
    pub(crate) fn rest(&self) -> Rest {
        Rest {
            tension: self.tension,
            penetration: self.penetration,
        }
    }
}

/// The balance of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Audit {
    /// Work of the drivers [J].
    pub energy_input: f64,
    /// Energy turned over: the work put in or taken out, summed without sign [J].
    pub turnover: f64,
    /// Largest energy residual at any step, relative to the turnover and the kinetic and strain energy at the start.
    pub energy_residual: f64,
    /// Largest residual of the torque balance of a free pulley, relative to the angular momentum
    /// that its torques moved, or a hundredth of the tension at rest would have, and that held at the start.
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

/// Most steps of a run: hours to days of computing.
pub(crate) const MOST_STEPS: f64 = 1.0e9;

/// A run that failed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// The drive cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A law of the program's has no pulley to act on.
    #[error(transparent)]
    UserLaw(#[from] UserLawError),
    /// No equilibrium at rest was found.
    #[error("the belt finds no equilibrium at rest on the pulleys, {place}: {cause}")]
    Start {
        /// Where.
        place: String,
        /// Why.
        cause: StaticsError,
    },
    /// The run cannot begin in steady running.
    #[error(transparent)]
    SteadyStart(#[from] Box<NoSteadyStart>),
    /// The run would never end.
    #[error("the run of {end} s would take {count:.1e} steps of {step:.1e} s")]
    TooManySteps {
        /// Time to run [s].
        end: f64,
        /// Number of steps.
        count: f64,
        /// Longest step [s].
        step: f64,
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

impl RunError {
    fn step(
        drive: &Drive,
        layout: &Layout,
        q: &[f64],
        belt: (usize, usize),
        cause: IntegrationError,
    ) -> Self {
        let (time, place) = match &cause {
            IntegrationError::StepFailed {
                time,
                cause: failure,
                ..
            } => (*time, place(drive, layout, q, failure.coordinate, belt)),
            // Not the drive's case: its checked fields choose the steps.
            IntegrationError::Control(_) | IntegrationError::Size { .. } => {
                (0.0, "before the first step".to_owned())
            }
        };
        Self::Step { time, place, cause }
    }

    fn start(
        drive: &Drive,
        layout: &Layout,
        q: &[f64],
        belt: (usize, usize),
        cause: StaticsError,
    ) -> Self {
        let coordinate = match cause {
            StaticsError::Stopped { .. } => return Self::Stopped { time: 0.0 },
            StaticsError::NotConverged { coordinate, .. }
            | StaticsError::Singular { coordinate } => coordinate,
            // Not the belt's case: its joint is opened after it has settled.
            StaticsError::Constrained => 0,
        };
        Self::Start {
            place: place(drive, layout, q, coordinate, belt),
            cause,
        }
    }
}

/// Runs `drive`, telling `observer` how far it is after every step.
pub fn simulate(
    drive: &Drive,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    simulate_with(drive, &UserLaws::default(), observer)
}

/// Runs `drive` with laws of the caller's.
pub fn simulate_with(
    drive: &Drive,
    laws: &UserLaws,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    laws.check(drive)?;
    match drive.belt.element {
        BeltElement::BeltBeam => planar::<BeltBeam2>(drive, laws, observer),
        BeltElement::CubicBeam => planar::<CubicBeam2>(drive, laws, observer),
        BeltElement::LinearBeam => planar::<LinearBeam2>(drive, laws, observer),
        BeltElement::BeltBeam3d => in_space(
            drive,
            laws,
            observer,
            || SpaceBeamAssembly::<BeltBeam3>::of_beams(drive),
            |assembly| assembly.release_beams(drive),
        ),
        BeltElement::LinearBeam3d => in_space(
            drive,
            laws,
            observer,
            || SpaceBeamAssembly::<LinearBeam3>::of_beams(drive),
            |assembly| assembly.release_beams(drive),
        ),
        BeltElement::Plate => in_space(
            drive,
            laws,
            observer,
            || PlateAssembly::of_plates(drive),
            |assembly| assembly.release_plates(drive),
        ),
    }
}

fn planar<E: BeltElementType>(
    drive: &Drive,
    laws: &UserLaws,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Outcome, RunError> {
    run(
        drive,
        laws,
        observer,
        || Assembly::<E>::new(drive),
        |assembly| {
            if drive.belt.joint == Joint::Multipliers {
                assembly.open_joint(drive)?;
            }
            assembly.release(drive);
            let pulleys = assembly.system.law.pulleys.iter_mut();
            laws.put_on(drive, pulleys.map(|p| (&mut p.friction, &mut p.external)));
            if drive.run.start == Start::Steady {
                steady_start::set_running(drive, assembly).map_err(Box::new)?;
            }
            Ok(())
        },
    )
}

fn in_space<E: Element>(
    drive: &Drive,
    laws: &UserLaws,
    observer: &mut dyn FnMut(&Progress) -> Flow,
    assemble: impl FnOnce() -> Result<Assembly<E, SurfaceContact>, AssemblyError>,
    release: impl FnOnce(&mut Assembly<E, SurfaceContact>),
) -> Result<Outcome, RunError>
where
    SurfaceContact: PulleyLaw<E>,
{
    if drive.run.start == Start::Steady {
        return Err(Box::new(NoSteadyStart::Spatial).into());
    }
    run(drive, laws, observer, assemble, |assembly| {
        release(assembly);
        let pulleys = assembly.system.law.pulleys.iter_mut();
        laws.put_on(drive, pulleys.map(|p| (&mut p.friction, &mut p.external)));
        Ok(())
    })
}

/// Runs what `assemble` puts together; `release` gives the settled belt its friction, the pulleys their
/// torques, and both the motion that they start with.
fn run<E: Element, L: PulleyLaw<E>>(
    drive: &Drive,
    laws: &UserLaws,
    observer: &mut dyn FnMut(&Progress) -> Flow,
    assemble: impl FnOnce() -> Result<Assembly<E, L>, AssemblyError>,
    release: impl FnOnce(&mut Assembly<E, L>) -> Result<(), RunError>,
) -> Result<Outcome, RunError> {
    let wall = Instant::now();
    let end = drive.run.end_time;
    let mut assembly = assemble()?;
    let settled = settle_on_pulleys(drive, &mut assembly, REST, observer)?;
    release(&mut assembly)?;
    assembly.warnings.extend(laws.warnings());
    let control = control::control(drive, laws, &assembly.mounting);
    let count = end / control.step;
    if count.is_nan() || count > MOST_STEPS {
        let step = control.step;
        return Err(RunError::TooManySteps { end, count, step });
    }

    let mut recorder = Recorder::new(drive, &assembly);
    let start = recorder.start(drive, &assembly, settled);
    judge_rest(drive, &mut assembly, start);
    tracing::info!(
        iterations = start.iterations,
        tension = start.tension,
        penetration = start.penetration,
        "settled on the pulleys"
    );
    tracing::info!(
        integrator = control::name(control.method),
        step = control.step,
        newton_tolerance = control.newton_tolerance,
        "stepping"
    );
    let mut steps = 0;
    let mut stopped = None;
    let mut watch = (drive.run.until == Until::Steady)
        .then(|| Watch::new(drive, &assembly.mounting, &recorder.history));
    let mut motion = assembly.motion.clone();
    let cpu = cpu_time::ThreadTime::now();
    let statistics = integrate(
        &mut assembly.system,
        &mut motion,
        end,
        &control,
        |system, window| {
            let slowness = control.tightening(window.to.time);
            let pace = recorder.step(system, window, slowness);
            steps += 1;
            let progress = Progress {
                time: window.to.time,
                end_time: end,
                steps,
            };
            match observer(&progress) {
                Flow::Continue => {
                    let settled = watch
                        .as_mut()
                        .is_some_and(|watch| watch.settled(&recorder.history));
                    if settled {
                        recorder.finish(drive, system, window.to);
                        return ControlFlow::Break(());
                    }
                    ControlFlow::Continue(pace)
                }
                Flow::Stop => {
                    stopped = Some(window.to.time);
                    ControlFlow::Break(())
                }
            }
        },
    )
    .map_err(|cause| {
        let belt = (assembly.system.structure().chain(), E::NODE_DOF);
        RunError::step(drive, &assembly.layout, &motion.q, belt, cause)
    })?;
    if let Some(time) = stopped {
        return Err(RunError::Stopped { time });
    }
    let cpu_seconds = (cpu.elapsed().saturating_sub(recorder.recording)).as_secs_f64();
    let audit = recorder.audit(drive);
    tracing::info!(
        steps = statistics.steps,
        halved = statistics.halved_steps,
        fallback = statistics.fallback_steps,
        energy_residual = audit.energy_residual,
        torque_residual = audit.torque_residual,
        "done"
    );
    Ok(Outcome {
        start,
        audit,
        end_time: recorder.end_time(),
        settling: watch.map(|watch| watch.settling()),
        history: recorder.history,
        profile: recorder.profile,
        frames: recorder.frames,
        edges: recorder.edges,
        statistics,
        cpu_seconds,
        wall_seconds: wall.elapsed().as_secs_f64(),
        dofs: assembly.system.structure().size(),
        integrator: control::name(control.method),
        layout: assembly.layout,
        mounting: assembly.mounting,
        warnings: assembly.warnings,
    })
}

/// Warns of what the belt at rest is like, where that is how the run starts.
fn judge_rest<E, L>(drive: &Drive, assembly: &mut Assembly<E, L>, start: StartState) {
    if drive.run.start == Start::Rest {
        assembly.judge(drive, start.rest());
    }
}

/// Moves the belt from its path to its equilibrium on the frictionless pulleys (see the guide), to a correction below
/// `accuracy` times the smallest radius.
pub(crate) fn settle_on_pulleys<E: Element, L: PulleyLaw<E>>(
    drive: &Drive,
    assembly: &mut Assembly<E, L>,
    accuracy: f64,
    observer: &mut dyn FnMut(&Progress) -> Flow,
) -> Result<Settled, RunError> {
    // The contact's own frequency sets how strongly the first steps are held back.
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    let settling = Progress {
        time: 0.0,
        end_time: drive.run.end_time,
        steps: 0,
    };
    settle_watched(
        &mut assembly.system,
        0.0,
        &mut assembly.motion.q,
        &assembly.holds,
        Settle {
            shift: drive.contact.stiffness / drive.contact_mass(),
            shrink: 0.3,
            step_limit: 0.1 * smallest,
            tolerance: accuracy * smallest,
            max_iterations: 200,
        },
        &mut |_, _| match observer(&settling) {
            Flow::Continue => ControlFlow::Continue(()),
            Flow::Stop => ControlFlow::Break(()),
        },
    )
    .map_err(|cause| {
        let (layout, q) = (&assembly.layout, &assembly.motion.q);
        let belt = (assembly.system.structure().chain(), E::NODE_DOF);
        RunError::start(drive, layout, q, belt, cause)
    })
}
