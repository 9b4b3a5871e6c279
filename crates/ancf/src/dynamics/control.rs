//! Step control: which step, which scheme, and what to do when a step fails.
//!
//! Time is cut at the kinks of the prescribed profiles. Within a segment all steps are `h0 / 2^k` on
//! a dyadic grid, so that a stored factor stays usable and kinks are hit exactly. A step whose
//! equations are not solved is halved; where halving does not help, TR-BDF2 takes over for a while.
//! An unconverged step is never accepted.

use std::ops::ControlFlow;

use thiserror::Error;

use super::stage::{NotConverged, Stage};
use super::{GeneralizedAlpha, Motion, RungeKutta4, Scheme, Statistics, StepRule, TrBdf2};
use crate::norm::VectorNorm;
use crate::system::{Mechanics, State};
use crate::unsound::{Unsound, positive, within};

/// Damping at infinite frequency: more (0.6) costs energy balance, less (0.9) Newton iterations.
const SPECTRAL_RADIUS: f64 = 0.8;
/// Finest step: `h0 / 2^LEVELS`.
const LEVELS: u32 = 24;
/// Halvings before generalized-alpha hands over to TR-BDF2.
const HALVINGS_BEFORE_FALLBACK: u32 = 3;
/// Halvings of a failing step before the run is given up.
const MAX_HALVINGS: u32 = 10;
/// Steps that the fall-back makes before generalized-alpha is tried again.
const FALLBACK_STEPS: usize = 32;
/// How far before a jump of the forces a step ends, by the length of a step: nothing moves in that time.
const BEFORE_A_JUMP: f64 = 1.0e-9;
/// Steps in which motion settles after a jump: doubled as they are, the last is a thousand times the first.
const AFTER_A_JUMP: usize = 32;
/// Steps of a run: with [`LEVELS`] halvings of each they must be counted in 64 bits.
const MOST_STEPS: f64 = 1.0e11;
/// Good steps before the step is doubled.
const PATIENCE: usize = 3;
/// Error of a good step, by the accepted one: predictions err with the square of the step, so that a step twice as
/// long is just accepted.
const GOOD: f64 = 0.25;
/// Halvings that an observer may ask for beyond what errors of prediction call for.
const MOST_ASKED: u32 = 6;

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Generalized-alpha, with TR-BDF2 where its steps keep failing.
    #[default]
    Auto,
    /// Generalized-alpha alone.
    GeneralizedAlpha,
    /// TR-BDF2 alone.
    TrBdf2,
    /// The classical explicit Runge-Kutta scheme.
    RungeKutta,
}

/// How to integrate.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// The integrator.
    pub method: Method,
    /// Largest step [s]; the only one if `error_tolerance` is `None`.
    pub step: f64,
    /// Accepted difference [m/s] between predicted and found velocities; `None` for a fixed step.
    pub error_tolerance: Option<f64>,
    /// Until these times [s], in order, `error_tolerance` is multiplied by these factors: where motion begins slowly.
    pub tightened: Vec<(f64, f64)>,
    /// Error of the velocities [m/s] at which Newton stops.
    pub newton_tolerance: f64,
    /// Times that steps must hit [s].
    pub kinks: Vec<f64>,
    /// Times at which forces jump [s], and what `error_tolerance` is multiplied by while motion settles after it: a
    /// step ends just before, the next begins at the jump with new accelerations.
    pub jumps: Vec<(f64, f64)>,
}

impl Control {
    /// Steps of fixed length [s], halved only where one fails; velocities solved to 1e-9 m/s.
    #[must_use]
    pub fn fixed(method: Method, step: f64) -> Self {
        Self {
            method,
            step,
            error_tolerance: None,
            tightened: Vec::new(),
            newton_tolerance: 1.0e-9,
            kinks: Vec::new(),
            jumps: Vec::new(),
        }
    }

    /// Refuses what cannot choose steps, an `end` before the start, and a motion of other than `size` coordinates.
    fn check(&self, motion: &Motion, size: usize, end: f64) -> Result<(), IntegrationError> {
        positive("the step [s]", self.step)?;
        positive(
            "the tolerance of Newton's method [m/s]",
            self.newton_tolerance,
        )?;
        if let Some(tolerance) = self.error_tolerance {
            positive("the error tolerance of the steps [m/s]", tolerance)?;
        }
        let fits = end >= motion.time && end.is_finite();
        within(
            "the end of the motion [s]",
            end,
            fits,
            "finite and not before its start",
        )?;
        let fits = (end - motion.time) / self.step < MOST_STEPS;
        within(
            "the step [s]",
            self.step,
            fits,
            "longer, for fewer than 1e11 steps",
        )?;
        match motion.wrong_size(size) {
            Some(given) => Err(IntegrationError::Size {
                given,
                wanted: size,
            }),
            None => Ok(()),
        }
    }

    /// The factor of a jump at `time`.
    fn jump_at(&self, time: f64) -> Option<f64> {
        (self.jumps.iter())
            .find(|(jump, _)| jump.to_bits() == time.to_bits())
            .map(|(_, factor)| *factor)
    }

    /// What the error tolerance of a step up to `time` is multiplied by.
    #[must_use]
    pub fn tightening(&self, time: f64) -> f64 {
        (self.tightened.iter())
            .find(|(until, _)| time <= *until)
            .map_or(1.0, |(_, factor)| *factor)
    }
}

/// What an observer wants of the steps to come, where they are chosen automatically.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Pace {
    /// No wish.
    #[default]
    Free,
    /// No longer steps than now.
    Hold,
    /// Steps of half the length.
    Finer,
}

impl From<()> for Pace {
    fn from((): ()) -> Self {
        Self::Free
    }
}

/// Two accepted states, one step apart.
#[derive(Clone, Copy, Debug)]
pub struct Window<'a> {
    /// The state before the step.
    pub from: &'a Motion,
    /// The state after it.
    pub to: &'a Motion,
    /// How the scheme has integrated from one to the other.
    pub rule: StepRule<'a>,
}

impl Window<'_> {
    /// Writes the state at `time` within the step: cubic Hermite in `q` (from `v`) and in `v` (from
    /// `a`), linear in `a`.
    pub fn interpolate(&self, time: f64, state: &mut Motion) {
        let (from, to) = (self.from, self.to);
        let h = to.time - from.time;
        let s = (time - from.time) / h;
        let (s2, s3) = (s * s, s * s * s);
        let start = 1.0 - 3.0 * s2 + 2.0 * s3;
        let end = 1.0 - start;
        let start_slope = h * (s - 2.0 * s2 + s3);
        let end_slope = h * (s3 - s2);
        for i in 0..from.q.len() {
            state.q[i] =
                start * from.q[i] + end * to.q[i] + start_slope * from.v[i] + end_slope * to.v[i];
            state.v[i] =
                start * from.v[i] + end * to.v[i] + start_slope * from.a[i] + end_slope * to.a[i];
            state.a[i] = (1.0 - s) * from.a[i] + s * to.a[i];
        }
        state.time = time;
    }
}

/// A run that could not go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IntegrationError {
    /// A number that steps cannot be chosen by.
    #[error(transparent)]
    Control(#[from] Unsound),
    /// A state of another system.
    #[error("the motion has {given} coordinates, the system has {wanted}")]
    Size {
        /// Coordinates of the motion.
        given: usize,
        /// Coordinates of the system.
        wanted: usize,
    },
    /// The equations of a step could not be solved at any step length tried.
    #[error("no step from t = {time} s converges, down to {step:.1e} s: {cause}")]
    StepFailed {
        /// Time of the last accepted state [s].
        time: f64,
        /// Shortest step tried [s].
        step: f64,
        /// What happened in the last try.
        cause: NotConverged,
    },
}

/// Integrates `motion` to time `end`, calling `observe` after every accepted step; stops early when
/// it breaks, and otherwise goes on at the [`Pace`] it returns (`()` for any). `motion` starts with time,
/// coordinates and velocities and ends with the last state.
pub fn integrate<S: Mechanics, P: Into<Pace>>(
    system: &mut S,
    motion: &mut Motion,
    end: f64,
    control: &Control,
    mut observe: impl FnMut(&mut S, Window<'_>) -> ControlFlow<(), P>,
) -> Result<Statistics, IntegrationError> {
    let size = motion.q.len();
    control.check(motion, system.structure().size(), end)?;
    // Where forces jump at the end, the last step ends before: what they are behind it is no part of the run.
    let end = match control.jump_at(end) {
        Some(_) => end * (1.0 - 8.0 * f64::EPSILON),
        None => end,
    };
    let mut stage = Stage::new(system, control.newton_tolerance);
    stage.accelerations(system, motion);
    motion.algorithmic.copy_from_slice(&motion.a);
    if end <= motion.time {
        return Ok(stage.statistics);
    }
    let mut next = motion.clone();
    let mut schemes = Schemes::new(control.method, size);
    let positions = VectorNorm::of_positions(system);
    let mut difference = vec![0.0; size];

    let jumps = Jumps::within(control, motion.time, end);
    let mut level = 0;
    let mut asked = Asked::default();
    for boundary in jumps.boundaries(control, motion.time, end) {
        let mut grid = Grid::new(motion.time, boundary, control.step, level);
        let tightening = control.tightening(boundary);
        let after_jump = control.jump_at(motion.time);
        let mut settling = after_jump.map_or(0, |_| AFTER_A_JUMP);
        let mut good = 0;
        let mut failures = 0;
        while !grid.is_done() {
            let step = grid.step();
            match schemes.step(system, &mut stage, motion, step, &mut next) {
                Err(cause) => {
                    stage.statistics.halved_steps += 1;
                    good = 0;
                    failures += 1;
                    if failures > HALVINGS_BEFORE_FALLBACK && schemes.fall_back() {
                        grid.coarsen_by(failures - 1);
                        failures = 0;
                    } else if failures > MAX_HALVINGS || !grid.refine() {
                        return Err(IntegrationError::StepFailed {
                            time: motion.time,
                            step,
                            cause,
                        });
                    }
                    continue;
                }
                Ok(()) => failures = 0,
            }
            let mut may_double = true;
            if let Some(most) = control.error_tolerance {
                let after_jump = after_jump.filter(|_| settling > 0).unwrap_or(1.0);
                let tolerance = most * tightening.min(after_jump);
                let error =
                    prediction_error(&positions, motion, &next, &mut difference) / tolerance;
                if error > 1.0 && grid.refine() {
                    stage.statistics.halved_steps += 1;
                    good = 0;
                    continue;
                }
                may_double = error < GOOD;
            }
            settling = settling.saturating_sub(1);
            grid.advance();
            next.time = grid.time();
            stage.statistics.steps += 1;
            let flow = observe(system, schemes.window(motion, &next));
            stage.statistics.fallback_steps += usize::from(schemes.accepted());
            system.accept(State {
                time: next.time,
                q: &next.q,
                v: &next.v,
            });
            std::mem::swap(motion, &mut next);
            let pace = match flow {
                ControlFlow::Continue(pace) if control.error_tolerance.is_some() => pace.into(),
                ControlFlow::Continue(_) => Pace::Free,
                ControlFlow::Break(()) => return Ok(stage.statistics),
            };
            good = if may_double { good + 1 } else { 0 };
            if asked.finer(pace) && !grid.is_done() && grid.refine() {
                good = 0;
            } else if good >= PATIENCE && pace == Pace::Free && grid.coarsen() {
                asked.coarsened();
                good = 0;
            }
        }
        motion.time = boundary;
        level = grid.level;
        if let Some(after) = jumps.after(boundary) {
            motion.time = after;
            stage.accelerations(system, motion);
            motion.algorithmic.copy_from_slice(&motion.a);
        }
    }
    Ok(stage.statistics)
}

/// Jumps of the forces: the last time before each, and its own.
struct Jumps(Vec<(f64, f64)>);

impl Jumps {
    fn within(control: &Control, start: f64, end: f64) -> Self {
        let before = |jump: f64| jump - BEFORE_A_JUMP * control.step;
        let jumps = control.jumps.iter().map(|(jump, _)| *jump);
        Self(
            jumps
                .filter(|jump| before(*jump) > start && *jump < end)
                .map(|jump| (before(jump), jump))
                .collect(),
        )
    }

    /// Where segments of smooth motion end, in order: at kinks, just before jumps, at `end`.
    fn boundaries(&self, control: &Control, start: f64, end: f64) -> Vec<f64> {
        let mut boundaries: Vec<f64> = (control.kinks.iter().copied())
            .filter(|kink| *kink > start && *kink < end && !self.hold(*kink))
            .chain(self.0.iter().map(|(before, _)| *before))
            .chain([end])
            .collect();
        boundaries.sort_by(f64::total_cmp);
        boundaries.dedup();
        boundaries
    }

    /// Whether `time` is a jump.
    fn hold(&self, time: f64) -> bool {
        self.0
            .iter()
            .any(|(_, jump)| jump.to_bits() == time.to_bits())
    }

    /// The jump that `time` is just before.
    fn after(&self, time: f64) -> Option<f64> {
        let found = self
            .0
            .iter()
            .find(|(before, _)| before.to_bits() == time.to_bits());
        found.map(|(_, jump)| *jump)
    }
}

/// Largest difference [m/s] between the velocities of nodes found and those predicted by constant
/// acceleration.
fn prediction_error(norm: &VectorNorm, from: &Motion, to: &Motion, difference: &mut [f64]) -> f64 {
    let h = to.time - from.time;
    let accelerated = from.v.iter().zip(&from.a).map(|(v, a)| v + h * a);
    for ((value, predicted), found) in difference.iter_mut().zip(accelerated).zip(&to.v) {
        *value = found - predicted;
    }
    norm.size(difference)
}

/// Halvings that the observer asked for.
#[derive(Default)]
struct Asked {
    halvings: u32,
    /// Steps since the last of them.
    waited: usize,
}

impl Asked {
    /// Whether to halve now: some steps must show what the last halving did, and there is an end to it.
    fn finer(&mut self, pace: Pace) -> bool {
        self.waited += 1;
        let yes = pace == Pace::Finer && self.waited > PATIENCE && self.halvings < MOST_ASKED;
        if yes {
            self.halvings += 1;
            self.waited = 0;
        }
        yes
    }

    fn coarsened(&mut self) {
        self.halvings = self.halvings.saturating_sub(1);
    }
}

/// The scheme in use and its stand-in.
struct Schemes {
    main: Box<dyn Scheme>,
    fallback: Option<TrBdf2>,
    /// Steps that the fall-back has still to make.
    remaining: usize,
}

impl Schemes {
    fn new(method: Method, size: usize) -> Self {
        let main: Box<dyn Scheme> = match method {
            Method::Auto | Method::GeneralizedAlpha => {
                Box::new(GeneralizedAlpha::new(SPECTRAL_RADIUS))
            }
            Method::TrBdf2 => Box::new(TrBdf2::new(size)),
            Method::RungeKutta => Box::new(RungeKutta4::new(size)),
        };
        Self {
            main,
            fallback: (method == Method::Auto).then(|| TrBdf2::new(size)),
            remaining: 0,
        }
    }

    fn step(
        &mut self,
        system: &mut dyn Mechanics,
        stage: &mut Stage,
        from: &Motion,
        step: f64,
        to: &mut Motion,
    ) -> Result<(), NotConverged> {
        match &mut self.fallback {
            Some(fallback) if self.remaining > 0 => fallback.step(system, stage, from, step, to),
            _ => self.main.step(system, stage, from, step, to),
        }
    }

    /// The step just made.
    fn window<'a>(&'a self, from: &'a Motion, to: &'a Motion) -> Window<'a> {
        let scheme = match &self.fallback {
            Some(fallback) if self.remaining > 0 => fallback,
            _ => self.main.as_ref(),
        };
        let rule = scheme.rule();
        Window { from, to, rule }
    }

    /// Hands over to the fall-back; false if there is none or it is at work already.
    fn fall_back(&mut self) -> bool {
        let possible = self.fallback.is_some() && self.remaining == 0;
        if possible {
            self.remaining = FALLBACK_STEPS;
        }
        possible
    }

    /// Counts an accepted step; says whether the fall-back made it.
    fn accepted(&mut self) -> bool {
        let by_fallback = self.remaining > 0;
        self.remaining = self.remaining.saturating_sub(1);
        by_fallback
    }
}

/// The dyadic grid of one segment of time.
struct Grid {
    start: f64,
    /// Length of a step at level 0 [s].
    base: f64,
    /// Present position and end, in units of `base / 2^LEVELS`.
    position: u64,
    end: u64,
    level: u32,
}

impl Grid {
    fn new(start: f64, end: f64, step: f64, level: u32) -> Self {
        let count = ((end - start) / step * (1.0 - 1.0e-9)).ceil().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive, and at most MOST_STEPS < 2^40"
        )]
        let units = (count as u64) << LEVELS;
        Self {
            start,
            base: (end - start) / count,
            position: 0,
            end: units,
            level,
        }
    }

    fn units(&self) -> u64 {
        1 << (LEVELS - self.level)
    }

    fn step(&self) -> f64 {
        self.base / f64::from(1_u32 << self.level)
    }

    fn time(&self) -> f64 {
        self.start + self.base * (self.position as f64 / (1_u64 << LEVELS) as f64)
    }

    fn advance(&mut self) {
        self.position += self.units();
    }

    fn is_done(&self) -> bool {
        self.position >= self.end
    }

    fn refine(&mut self) -> bool {
        let possible = self.level < LEVELS;
        self.level += u32::from(possible);
        possible
    }

    /// Doubles the step if the grid allows it here.
    fn coarsen(&mut self) -> bool {
        let possible = self.level > 0
            && self.position.is_multiple_of(2 * self.units())
            && self.position + 2 * self.units() <= self.end;
        self.level -= u32::from(possible);
        possible
    }

    /// Takes back up to `halvings` halvings.
    fn coarsen_by(&mut self, halvings: u32) {
        for _ in 0..halvings {
            if !self.coarsen() {
                break;
            }
        }
    }
}
