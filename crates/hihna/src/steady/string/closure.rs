//! The one equation of the string: which stretch of the span before the speed-controlled pulley
//! closes the belt, (S7)-(S11).

use num_dual::Dual64;

use super::{Closure, Model, Number, Role, StringDrive, StringError, Tightness};

/// The belt from the speed-controlled pulley around to it, everything divided by the axial stiffness.
pub(super) struct Loop<D> {
    /// The pulleys, the speed-controlled one first.
    pub(super) stations: Vec<Station<D>>,
    /// Index of the speed-controlled pulley in the drive.
    pub(super) driver: usize,
    /// m V²/k: the inertia parameter c times the squared stretch at the speed-controlled pulley.
    inertia: D,
    /// Strain at rest, equal all around without friction: T_init/k = (L - L0)/L0.
    pub(super) rest_strain: D,
    /// Length of the path.
    length: D,
    model: Model,
    closure: Closure,
}

/// A pulley, the span behind it, and its force balance.
#[derive(Clone, Copy)]
pub(super) struct Station<D> {
    pub(super) radius: D,
    pub(super) wrap: D,
    pub(super) friction: D,
    span: D,
    /// M/(R k).
    pub(super) pull: D,
    /// (P - P_t)/k before and behind the pulley, P_t being the one before the speed-controlled pulley.
    pub(super) before: D,
    behind: D,
}

/// The numbers that hold everywhere, once the strain before the speed-controlled pulley is known.
#[derive(Clone, Copy)]
pub(super) struct Level<D> {
    /// Strain before the speed-controlled pulley.
    pub(super) strain: D,
    /// c = m v0²/k.
    pub(super) inertia: D,
    /// 1 - c_n.
    pub(super) pressing: D,
    /// 1 - c_p.
    pub(super) pulling: D,
    /// Factor on all torques.
    pub(super) torques: D,
}

/// What happens on one pulley.
pub(super) struct Passage<D> {
    pub(super) strain_in: D,
    pub(super) strain_out: D,
    /// ±mu'.
    pub(super) growth: D,
    pub(super) slip_angle: D,
}

/// A solved root: strain before the speed-controlled pulley, and the slope of the residual there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    pub(super) strain: f64,
    slope: f64,
}

/// The roots of a drive. `capacity` is missing where no torque is transmitted.
pub(super) enum Roots {
    Running {
        running: Root,
        capacity: Option<Root>,
    },
    /// `formal` has a stick zone of negative length; missing where a span would be slack.
    GrossSlip {
        formal: Option<Root>,
        capacity: Root,
    },
    /// The belt does not press on the pulleys even without torque.
    Slack,
}

/// Newton's method stops at steps below this, relative: the next step would be far below round-off.
const LAST_STEP: f64 = 1.0e-12;
/// Where the slackest span barely presses, the residual is so steep that steps are short far from
/// the root; a root also has a residual below this, relative to the strain at rest.
const LARGEST_RESIDUAL: f64 = 1.0e-8;
/// Bisection alone needs 60 to 1100 halvings from any start; Newton takes over after a few.
const MOST_ITERATIONS: usize = 1200;

impl<D: Number> Loop<D> {
    pub(super) fn new(drive: &StringDrive<D>, driver: usize) -> Self {
        let count = drive.pulleys.len();
        let k = drive.axial_stiffness;
        let mut stations = Vec::with_capacity(count);
        let mut speed = D::zero();
        for i in 0..count {
            let p = &drive.pulleys[(driver + i) % count];
            let pull = match p.role {
                Role::SpeedControlled(angular) => {
                    speed = angular * p.radius;
                    D::zero()
                }
                Role::Torque(torque) => torque / (p.radius * k),
            };
            stations.push(Station {
                radius: p.radius,
                wrap: p.wrap_angle,
                friction: p.friction,
                span: p.span,
                pull,
                before: D::zero(),
                behind: D::zero(),
            });
        }
        // P falls by `pull` over each pulley and is zero, relative, when it arrives at the first
        // one again.
        let mut level = D::zero();
        for station in stations.iter_mut().skip(1).rev() {
            station.behind = level;
            level += station.pull;
            station.before = level;
        }
        stations[0].behind = level;
        stations[0].pull = -level;
        let length = drive.path_length();
        let rest_strain = match drive.tightness {
            Tightness::UnstretchedLength(unstretched) => (length - unstretched) / unstretched,
            Tightness::InitialTension(force) => force / k,
        };
        Self {
            stations,
            driver,
            inertia: drive.line_density * speed * speed / k,
            rest_strain,
            length,
            model: drive.model,
            closure: drive.closure,
        }
    }

    /// Solves the closure for the drive and for its capacity.
    pub(super) fn roots(&self) -> Result<Roots, StringError> {
        let belt = self.map(|number| Dual64::from_re(number.re()));
        let rest = belt.rest_strain.re;
        let loaded = belt.stations.iter().any(|station| station.pull.re != 0.0);
        let at_rest = belt.level(Dual64::from_re(rest), Dual64::from_re(1.0));
        if !(rest > 0.0 && belt.pressure(&at_rest, at_rest.strain).re > 0.0) {
            return Ok(Roots::Slack);
        }
        if !loaded {
            let one = Dual64::from_re(1.0);
            let slope = belt.residual(&belt.level(Dual64::new(rest, 1.0), one)).eps;
            return Ok(Roots::Running {
                running: Root {
                    strain: rest,
                    slope,
                },
                capacity: None,
            });
        }
        let capacity = find_root(rest, rest, |strain| {
            belt.capacity_residual(strain).map(|r| (r.re, r.eps))
        })
        .map_err(|strain| StringError::NotConverged { strain })?;
        let start = belt.starting_strain();
        let one = Dual64::from_re(1.0);
        let evaluate = |strain: f64| {
            let level = belt.level(Dual64::new(strain, 1.0), one);
            let defined = belt.presses_everywhere(&level);
            defined
                .then(|| belt.residual(&level))
                .map(|r| (r.re, r.eps))
        };
        let running = find_root(start, rest, evaluate);
        let factor = belt
            .limit(&belt.level(Dual64::from_re(capacity.strain), one))
            .0
            .re;
        match running {
            Ok(root) if factor < 1.0 => Ok(Roots::GrossSlip {
                formal: Some(root),
                capacity,
            }),
            Ok(root) => Ok(Roots::Running {
                running: root,
                capacity: Some(capacity),
            }),
            Err(_) if factor < 1.0 => Ok(Roots::GrossSlip {
                formal: None,
                capacity,
            }),
            Err(strain) => Err(StringError::NotConverged { strain }),
        }
    }

    /// The level at a root, with the derivatives that the inputs carry: chord steps with the real
    /// slope, each gains one order.
    pub(super) fn running_level(&self, root: Root) -> Level<D> {
        let mut strain = D::from(root.strain);
        for _ in 0..D::NDERIV {
            strain -= self.residual(&self.level(strain, D::one())) / root.slope;
        }
        self.level(strain, D::one())
    }

    /// The level at gross slip under all torques times its factor, and the limiting station.
    pub(super) fn capacity_level(&self, root: Root) -> (Level<D>, usize) {
        let mut strain = D::from(root.strain);
        for _ in 0..D::NDERIV {
            if let Some(residual) = self.capacity_residual_at(strain) {
                strain -= residual / root.slope;
            }
        }
        let (factor, station) = self.limit(&self.level(strain, D::one()));
        (self.level(strain, factor), station)
    }

    /// (S2), (S3).
    pub(super) fn level(&self, strain: D, torques: D) -> Level<D> {
        let stretch = strain + 1.0;
        let inertia = self.inertia / (stretch * stretch);
        let kept = D::one() - inertia;
        let (pressing, pulling) = match self.model {
            Model::Full => (kept, kept),
            Model::Centrifugal => (kept, D::one()),
            Model::Capstan => (D::one(), D::one()),
        };
        Level {
            strain,
            inertia,
            pressing,
            pulling,
            torques,
        }
    }

    /// N/k where the strain is `strain`, (S3).
    pub(super) fn pressure(&self, level: &Level<D>, strain: D) -> D {
        match self.model {
            Model::Capstan => strain,
            Model::Full | Model::Centrifugal => strain - level.inertia * (strain + 1.0),
        }
    }

    /// (S4)-(S6) on one pulley.
    pub(super) fn passage(&self, level: &Level<D>, station: &Station<D>) -> Passage<D> {
        let share = level.torques / level.pulling;
        let strain_in = level.strain + station.before * share;
        let strain_out = level.strain + station.behind * share;
        let pressure_in = self.pressure(level, strain_in);
        let gain = -station.pull * share * level.pressing;
        let pressure_rise = (gain / pressure_in).ln_1p();
        let sign = if gain.re() < 0.0 { -1.0 } else { 1.0 };
        let growth = station.friction * level.pressing / level.pulling * sign;
        // A pulley without friction carries no torque: no slip zone either, and no 0/0.
        let slip_angle = if station.friction.re() > 0.0 {
            pressure_rise / growth
        } else {
            D::zero()
        };
        Passage {
            strain_in,
            strain_out,
            growth,
            slip_angle,
        }
    }

    /// Whether all spans press, on the branch of positive strain.
    fn presses_everywhere(&self, level: &Level<D>) -> bool {
        let share = level.torques / level.pulling;
        let presses = |s: &Station<D>| {
            let strain = level.strain + s.behind * share;
            strain.re() > 0.0 && self.pressure(level, strain).re() > 0.0
        };
        self.stations.iter().all(presses)
    }

    /// Index in the drive of the span with the least P.
    pub(super) fn slackest_span(&self) -> usize {
        let least = |best: usize, i: usize| {
            let lower = self.stations[i].behind.re() < self.stations[best].behind.re();
            if lower { i } else { best }
        };
        ((0..self.stations.len()).fold(0, least) + self.driver) % self.stations.len()
    }

    /// (S7) over the path length, or (S8) over the stiffness, minus its value at rest (S9).
    fn residual(&self, level: &Level<D>) -> D {
        let share = level.torques / level.pulling;
        match self.closure {
            Closure::TensionSum => {
                let sum = self
                    .stations
                    .iter()
                    .fold(D::zero(), |sum, s| sum + s.behind);
                level.strain + sum * share / self.stations.len() as f64 - self.rest_strain
            }
            Closure::UnstretchedLength => {
                let lengthening = self.lengthening(level) / self.length;
                lengthening - self.rest_strain / (self.rest_strain + 1.0)
            }
        }
    }

    /// Length of the path less the unstretched length of the belt on it: ∮ eps/lambda ds.
    pub(super) fn lengthening(&self, level: &Level<D>) -> D {
        self.stations.iter().fold(D::zero(), |sum, station| {
            let passage = self.passage(level, station);
            let span = station.span * passage.strain_out / (passage.strain_out + 1.0);
            sum + span + self.lengthening_on_pulley(level, station, &passage)
        })
    }

    /// (S10).
    fn lengthening_on_pulley(
        &self,
        level: &Level<D>,
        station: &Station<D>,
        passage: &Passage<D>,
    ) -> D {
        let stretch_in = passage.strain_in + 1.0;
        let stick = (station.wrap - passage.slip_angle) * passage.strain_in / stretch_in;
        if station.friction.re() <= 0.0 {
            return station.radius * stick;
        }
        let rise = ((passage.strain_out - passage.strain_in) / stretch_in).ln_1p();
        let slip = match self.model {
            Model::Capstan => rise / passage.growth,
            Model::Full | Model::Centrifugal => {
                level.inertia * passage.slip_angle + level.pressing * rise / passage.growth
            }
        };
        station.radius * (stick + slip)
    }

    /// (S11): the factor on all torques at which the first pulley slips over its whole wrap, and
    /// that pulley's station.
    fn limit(&self, level: &Level<D>) -> (D, usize) {
        let pressure = self.pressure(level, level.strain);
        let mut least = (D::from(f64::INFINITY), 0);
        for (i, station) in self.stations.iter().enumerate() {
            let (low, high) = if station.pull.re() > 0.0 {
                (station.behind, station.before)
            } else {
                (station.before, station.behind)
            };
            let ratio = level.pressing / level.pulling;
            let remaining = (-station.friction * ratio * station.wrap).exp();
            let room = (remaining * high - low) * ratio;
            if station.pull.re() != 0.0 && room.re() > 0.0 {
                let factor = pressure * (D::one() - remaining) / room;
                if factor.re() < least.0.re() {
                    least = (factor, i);
                }
            }
        }
        least
    }

    fn capacity_residual_at(&self, strain: D) -> Option<D> {
        let level = self.level(strain, D::one());
        if strain.re() <= 0.0 || self.pressure(&level, strain).re() <= 0.0 {
            return None;
        }
        let (factor, _) = self.limit(&level);
        Some(self.residual(&Level {
            torques: factor,
            ..level
        }))
    }

    fn map<E: Number>(&self, convert: impl Fn(D) -> E) -> Loop<E> {
        Loop {
            stations: self
                .stations
                .iter()
                .map(|s| Station {
                    radius: convert(s.radius),
                    wrap: convert(s.wrap),
                    friction: convert(s.friction),
                    span: convert(s.span),
                    pull: convert(s.pull),
                    before: convert(s.before),
                    behind: convert(s.behind),
                })
                .collect(),
            driver: self.driver,
            inertia: convert(self.inertia),
            rest_strain: convert(self.rest_strain),
            length: convert(self.length),
            model: self.model,
            closure: self.closure,
        }
    }
}

impl Loop<Dual64> {
    fn capacity_residual(&self, strain: f64) -> Option<Dual64> {
        self.capacity_residual_at(Dual64::new(strain, 1.0))
    }

    /// The strain at which the mean tension of the spans is that at rest, moved to where every span
    /// presses: with `b = m V²/k` and `d` the least of (P - P_t)/k, `lambda - b/lambda - 1 + d > 0`
    /// suffices in all models.
    fn starting_strain(&self) -> f64 {
        let behind =
            |pick: fn(f64, f64) -> f64| self.stations.iter().map(|s| s.behind.re).fold(0.0, pick);
        let mean = behind(|sum, d| sum + d) / self.stations.len() as f64;
        let (least, most) = (behind(f64::min), behind(f64::max));
        let q = 1.0 - least;
        let inertia = if self.model == Model::Capstan {
            0.0
        } else {
            self.inertia.re
        };
        let bound = 0.5 * (q + (q * q + 4.0 * inertia).sqrt()) - 1.0;
        (self.rest_strain.re - mean).max(bound + 0.01 * (most - least))
    }
}

/// Newton's method inside a shrinking bracket, until its step or the bracket is a matter of
/// round-off. `evaluate` gives residual and slope, nothing below the domain; the residual rises
/// through zero and is of the size of `scale` away from it. The error is the last strain tried: the
/// residual jumps over zero there.
fn find_root(
    start: f64,
    scale: f64,
    evaluate: impl Fn(f64) -> Option<(f64, f64)>,
) -> Result<Root, f64> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut strain = start;
    let mut root = Err(start);
    for _ in 0..MOST_ITERATIONS {
        let value = evaluate(strain);
        let below = value.is_none_or(|(residual, _)| residual < 0.0);
        *(if below { &mut low } else { &mut high }) = strain;
        let mut next = between(low, high, strain);
        if let Some((residual, slope)) = value {
            let newton = strain - residual / slope;
            let fits = residual.abs() <= LARGEST_RESIDUAL * scale;
            root = if fits {
                Ok(Root { strain, slope })
            } else {
                Err(strain)
            };
            if fits && (newton - strain).abs() <= LAST_STEP * strain.abs() {
                return Ok(Root {
                    strain: newton,
                    slope,
                });
            }
            if newton > low && newton < high {
                next = newton;
            }
        }
        if next <= low || next >= high || !next.is_finite() {
            return root;
        }
        strain = next;
    }
    root
}

/// The middle of a bracket; a doubled or halved distance from zero where one end is still missing.
fn between(low: f64, high: f64, strain: f64) -> f64 {
    if low.is_finite() && high.is_finite() {
        0.5 * (low + high)
    } else if low.is_finite() {
        2.0 * strain.abs().max(f64::MIN_POSITIVE)
    } else {
        0.5 * strain
    }
}
