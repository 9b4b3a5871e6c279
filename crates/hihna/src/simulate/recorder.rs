//! Records of a run: rows of the history, profiles of the belt, and the balances.

use std::time::Duration;

use ancf::dynamics::{Motion, Pace, Window};
use ancf::element::Element;
use ancf::statics::Settled;
use ancf::system::{Mechanics, System};

use super::control::nominal_speed;
use super::pacing::Pacing;
use super::{Audit, StartState};
use crate::assemble::{Assembly, Mounting};
use crate::drive::Drive;
use crate::history::History;
use crate::layout::Layout;
use crate::observe::{
    EdgeRow, Observer, Powers, ProfileRow, PulleyLaw, PulleyState, SpanState, Stored,
};

/// A pulley that hardly takes a torque is judged by this part of the tension at rest times its radius: what
/// accuracy means for the drive as a whole.
const LEAST_TORQUE: f64 = 0.01;

/// Collects history, profile and balances while the run goes on.
pub(super) struct Recorder {
    observer: Observer,
    layout: Layout,
    element_start: Vec<f64>,
    pulleys: Vec<PulleyState>,
    spans: Vec<SpanState>,
    pub history: History,
    pub profile: Vec<ProfileRow>,
    pub frames: Vec<ProfileRow>,
    pub edges: Vec<EdgeRow>,
    /// CPU time that rows and profiles took.
    pub recording: Duration,
    state: Motion,
    output_times: Vec<f64>,
    next_output: usize,
    profile_times: Vec<f64>,
    next_profile: usize,
    frame_times: Vec<f64>,
    next_frame: usize,
    initial: Stored,
    /// Powers at the last accepted state and work since the start.
    powers: Powers,
    work: Powers,
    largest_residual: f64,
    pacing: Pacing,
    /// Time of the last accepted state [s].
    last_time: f64,
    /// Kinetic energy at nominal speed [J].
    kinetic: f64,
    tolerance: f64,
    /// Mean tension at rest [N].
    rest_tension: f64,
    /// For each pulley: torque last, its integral, the integral of its magnitude, first speed, now.
    momenta: Vec<Momentum>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Momentum {
    torque: f64,
    impulse: f64,
    moved: f64,
    /// Change of speed that the scheme has made beyond the impulse [rad/s].
    lagging: f64,
    first_speed: f64,
    speed: f64,
}

impl Momentum {
    /// Lets the torque act for `time` [s].
    fn push(&mut self, time: f64) {
        self.impulse += time * self.torque;
        self.moved += time * self.torque.abs();
    }
}

impl Recorder {
    pub fn new<E: Element, L: PulleyLaw<E>>(drive: &Drive, assembly: &Assembly<E, L>) -> Self {
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
            layout: assembly.layout.clone(),
            element_start: assembly.element_start.clone(),
            recording: Duration::ZERO,
            pulleys: vec![PulleyState::default(); names.len()],
            spans: vec![SpanState::default(); names.len()],
            history: History::new(&names, drive.belt.element.is_spatial()),
            profile: Vec::new(),
            frames: Vec::new(),
            edges: Vec::new(),
            state: assembly.motion.clone(),
            output_times: output_times(0.0, end, drive.run.output_interval),
            next_output: 0,
            profile_times,
            next_profile: 0,
            frame_times: drive.run.frame_interval.map_or_else(Vec::new, |interval| {
                output_times(drive.run.frame_start, end, interval)
            }),
            next_frame: 0,
            initial: Stored::default(),
            powers: Powers::default(),
            work: Powers::default(),
            largest_residual: 0.0,
            pacing: Pacing::new(0.1 * drive.run.accuracy),
            last_time: 0.0,
            kinetic: 0.0,
            tolerance: 0.1 * drive.run.accuracy,
            rest_tension: 0.0,
            momenta: vec![Momentum::default(); names.len()],
        }
    }

    /// Observes the state before the first step.
    pub fn start<E: Element, L: PulleyLaw<E>>(
        &mut self,
        drive: &Drive,
        assembly: &Assembly<E, L>,
        settled: Settled,
    ) -> StartState {
        let system = &assembly.system;
        // The prescribed speeds may start with a jump: stored energy counts from just after it.
        let mut begun = assembly.motion.clone();
        system.prescribe(begun.time, &mut begun.q, &mut begun.v, &mut begun.a);
        self.observer.survey(system, &begun);
        self.initial = self.observer.stored(system, &begun);
        self.kinetic = kinetic_at_nominal_speed(drive, &assembly.mounting);
        self.powers = self.observer.powers(system, &begun);
        for (p, momentum) in self.momenta.iter_mut().enumerate() {
            let (speed, torque) = self.observer.momentum(system, &begun, p);
            momentum.torque = torque;
            momentum.first_speed = speed;
            momentum.speed = speed;
        }
        self.rest_tension = self.observer.mean_tension();
        StartState {
            tension: self.rest_tension,
            penetration: self.observer.penetration(),
            iterations: settled.iterations,
        }
    }

    /// Takes the step of `window` in: balances first, then rows at the output times within it. Returns the
    /// pace that keeps the energy balance, of a drive that has moved with `slowness` times its nominal speed at most.
    pub fn step<E: Element, L: PulleyLaw<E>>(
        &mut self,
        system: &System<E, L>,
        window: Window<'_>,
        slowness: f64,
    ) -> Pace {
        let (t0, t1) = (window.from.time, window.to.time);
        let step = t1 - t0;

        if t0 > self.last_time {
            // Forces have jumped since the last step.
            self.take(system, window.from);
        }
        self.last_time = t1;
        // Integrated as the scheme does. Simpson's rule on interpolated states left forty times the residual on
        // the base case, probably because accelerations carry the noise of fast modes into velocities
        // interpolated with them.
        let [start, between, end] = window.rule.weights;
        let first = self.powers;
        let work_before = self.work;
        self.gather(step * start);
        if let Some(middle) = window.rule.middle {
            self.take(system, middle);
            self.gather(step * between);
        }
        self.take(system, window.to);
        self.gather(step * end);
        let rotors = system.structure().chain();
        for (p, momentum) in self.momenta.iter_mut().enumerate() {
            let ahead = |state: &Motion| state.a[rotors + p] - state.algorithmic[rotors + p];
            momentum.lagging += window.rule.lag * step * (ahead(window.to) - ahead(window.from));
        }
        let (work_after, last) = (self.work, self.powers);
        // Up to the part `s` of the step: the integral of the line through the powers at both ends, and of the
        // whole step's the part beyond that.
        let work_until = |s: f64| {
            let line = 0.5 * step * (s * s - s);
            work_before
                .plus(s, &work_after)
                .plus(-s, &work_before)
                .plus(line, &last)
                .plus(-line, &first)
        };

        let stored = self.observer.stored(system, window.to);
        let residual = self.residual(&stored, &self.work);
        // What the drive holds at its fastest counts as turned over, as every work has a start.
        let held = self.turned() + self.kinetic * slowness * slowness;
        let pace = self.pacing.pace(t1, residual, held);
        self.largest_residual = self.largest_residual.max(residual.abs());

        let slack = 1.0e-9 * step;
        let due = |times: &[f64], next: usize| times.get(next).is_some_and(|t| *t <= t1 + slack);
        if !due(&self.output_times, self.next_output)
            && !due(&self.profile_times, self.next_profile)
            && !due(&self.frame_times, self.next_frame)
        {
            return pace;
        }
        let cpu = cpu_time::ThreadTime::now();
        let mut state = std::mem::replace(&mut self.state, Motion::zero(0));
        while due(&self.output_times, self.next_output) {
            let time = self.output_times[self.next_output];
            within(system, window, time, &mut state);
            self.row(system, &state, &work_until((time - t0) / step));
            self.next_output += 1;
        }
        while due(&self.profile_times, self.next_profile) {
            within(
                system,
                window,
                self.profile_times[self.next_profile],
                &mut state,
            );
            self.observer.survey(system, &state);
            let rows = self.observer.profile(state.time, &self.element_start);
            self.profile.extend(rows);
            self.next_profile += 1;
        }
        while due(&self.frame_times, self.next_frame) {
            within(
                system,
                window,
                self.frame_times[self.next_frame],
                &mut state,
            );
            self.observer.survey(system, &state);
            let rows = self.observer.profile(state.time, &self.element_start);
            self.frames.extend(rows);
            let edges = self.observer.edges(state.time, &self.element_start);
            self.edges.extend(edges);
            self.next_frame += 1;
        }
        self.state = state;
        self.recording += cpu.elapsed();
        pace
    }

    /// Takes powers and torques at `state`.
    fn take<E: Element, L: PulleyLaw<E>>(&mut self, system: &System<E, L>, state: &Motion) {
        self.observer.look(system, state);
        self.powers = self.observer.powers(system, state);
        for (p, momentum) in self.momenta.iter_mut().enumerate() {
            (momentum.speed, momentum.torque) = self.observer.momentum(system, state, p);
        }
    }

    /// Lets the powers and torques last taken act for `time` [s].
    fn gather(&mut self, time: f64) {
        self.work = self.work.plus(time, &self.powers);
        for momentum in &mut self.momenta {
            momentum.push(time);
        }
    }

    /// Ends the records at `state`, before the time that `drive` names: the profile of the end is due now.
    pub fn finish<E: Element, L: PulleyLaw<E>>(
        &mut self,
        drive: &Drive,
        system: &System<E, L>,
        state: &Motion,
    ) {
        if drive.run.profile_times.is_empty() && self.next_profile < self.profile_times.len() {
            self.observer.survey(system, state);
            self.profile = self.observer.profile(state.time, &self.element_start);
        }
    }

    /// Time of the last accepted state [s].
    pub fn end_time(&self) -> f64 {
        self.last_time
    }

    fn row<E: Element, L: PulleyLaw<E>>(
        &mut self,
        system: &System<E, L>,
        state: &Motion,
        work: &Powers,
    ) {
        self.observer.survey(system, state);
        self.observer.pulleys(system, state, &mut self.pulleys);
        let stored = self.observer.stored(system, state);
        self.observer.spans(&self.layout, &mut self.spans);
        let residual = self.residual(&stored, work);
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

    /// What was turned over and what was held at the start, of which a balance cannot close all the parts [J].
    fn turned(&self) -> f64 {
        self.work.turnover + self.initial.kinetic + self.initial.strain
    }

    pub fn audit(&self, drive: &Drive) -> Audit {
        let torque_residual = self
            .momenta
            .iter()
            .zip(&drive.pulley)
            .filter(|(_, pulley)| !pulley.is_driver())
            .map(|(momentum, pulley)| {
                let gained =
                    pulley.inertia * (momentum.speed - momentum.first_speed - momentum.lagging);
                let least = LEAST_TORQUE * self.rest_tension * pulley.radius * self.state.time;
                let held = pulley.inertia * momentum.first_speed.abs();
                (gained - momentum.impulse).abs() / (momentum.moved.max(least) + held)
            })
            .fold(0.0, f64::max);
        Audit {
            energy_input: self.work.input,
            turnover: self.work.turnover,
            energy_residual: self.largest_residual / self.turned(),
            torque_residual,
            tolerance: self.tolerance,
        }
    }
}

/// The state at `time` within a step, with the prescribed coordinates as prescribed: a kink of theirs ends a
/// step, and interpolation would bend it with the acceleration behind the kink.
fn within<E: Element, L: PulleyLaw<E>>(
    system: &System<E, L>,
    window: Window<'_>,
    time: f64,
    state: &mut Motion,
) {
    window.interpolate(time, state);
    system.prescribe(time, &mut state.q, &mut state.v, &mut state.a);
}

/// Kinetic energy [J] of belt and pulleys without slip at the speed of the fastest driver.
fn kinetic_at_nominal_speed(drive: &Drive, mounting: &Mounting) -> f64 {
    let rotors = drive
        .pulley
        .iter()
        .map(|p| p.inertia / (p.radius * p.radius));
    let mass = drive.belt.density * drive.area() * mounting.length + rotors.sum::<f64>();
    0.5 * mass * nominal_speed(drive).powi(2)
}

/// `start` and multiples of `interval` after it, and the end.
fn output_times(start: f64, end: f64, interval: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count of rows"
    )]
    let count = ((end - start) / interval * (1.0 + 1.0e-12)).floor() as usize;
    let mut times: Vec<f64> = (0..=count)
        .map(|i| (start + i as f64 * interval).min(end))
        .collect();
    if times
        .last()
        .is_some_and(|last| end - last > 1.0e-9 * interval)
    {
        times.push(end);
    }
    times
}
