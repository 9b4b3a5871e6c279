//! Ring-down of a two-pulley drive by a linear model: string on two spans and two creeping arcs, with the
//! compliance of the contact (`docs/src/theory/ring_down.md`, equations R1-R8).

use std::f64::consts::PI;

use num_complex::Complex64;

use crate::drive::{Drive, Friction};
use crate::layout::Layout;

/// Small motions about steady running without load, proportional to exp(p t).
#[derive(Clone, Copy, Debug)]
pub(super) struct RingDown {
    /// Radius of both pulleys R [m].
    radius: f64,
    /// Inertia of the driven pulley I [kg m²].
    inertia: f64,
    /// Line density of the unstretched belt m [kg/m].
    line_density: f64,
    /// Speed in unstretched length U [m/s].
    speed: f64,
    /// Creep slope v_s [N s/m²].
    slope: f64,
    /// Unstretched lengths of an arc and of a span [m].
    arc: f64,
    span: f64,
    /// dT/d stretch in the spans and on the arcs [N].
    span_stiffness: f64,
    arc_stiffness: f64,
}

/// Displacement [m] and tension less momentum flow [N].
type Values = [Complex64; 2];
type Transfer = [Values; 2];

impl RingDown {
    /// The model of two equal pulleys under creep-rate friction, the second one free, with the `tension` [N] at
    /// rest on the path `layout`; `None` for another drive.
    pub fn new(drive: &Drive, tension: f64, layout: &Layout) -> Option<Self> {
        let ([driver, driven], Friction::CreepRate { slope, .. }) =
            (drive.pulley.as_slice(), &drive.contact.friction)
        else {
            return None;
        };
        let belt = &drive.belt;
        let axial = belt.axial_factor * belt.youngs_modulus * belt.width * belt.thickness;
        // T = E A (f² - 1) f / 2, solved for f by Newton from the right, where it is convex.
        let mut stretch = 1.0 + tension / axial;
        for _ in 0..20 {
            let found = 0.5 * axial * (stretch * stretch - 1.0) * stretch;
            stretch -= (found - tension) / (axial * (1.5 * stretch * stretch - 0.5));
        }
        let radius = driven.radius;
        let span_stiffness = axial * (1.5 * stretch * stretch - 0.5);
        let seat = drive.contact.stiffness * radius * radius;
        let distance = layout.spans[0].length;
        let speed = driver.speed.as_ref()?.value(f64::MAX);
        Some(Self {
            radius,
            inertia: driven.inertia,
            line_density: belt.density * belt.width * belt.thickness,
            speed: radius * speed / stretch,
            slope: *slope,
            arc: PI * radius / stretch,
            span: distance / stretch,
            span_stiffness,
            arc_stiffness: (span_stiffness.recip() + seat.recip()).recip(),
        })
    }

    /// The root of (R8) that the secant method reaches from `rate + i frequency`: decay [1/s] and frequency
    /// [rad/s] of the free motion; `None` if it reaches none.
    pub fn root(&self, rate: f64, frequency: f64) -> Option<Complex64> {
        let mut before = Complex64::new(rate, frequency);
        let mut p = before * 1.001;
        let mut value = self.residual(before);
        for _ in 0..50 {
            let new = self.residual(p);
            let step = new * (p - before) / (new - value);
            // Round-off of the way around, which grows by 1e5, leaves 1e-8.
            if step.norm() < 1.0e-6 * p.norm() {
                return Some(p - step);
            }
            (before, value, p) = (p, new, p - step);
        }
        None
    }

    /// I p² + R [q] over the driven arc for a turn of 1 rad (R8) [N m].
    fn residual(&self, p: Complex64) -> Complex64 {
        let arc = self.transfer(p, self.arc, self.arc_stiffness, self.slope);
        let span = self.transfer(p, self.span, self.span_stiffness, 0.0);
        // On the driven arc the displacement is measured from a w that stands still against the pulley (R5).
        let carried = self.radius * self.slope / (self.slope + self.line_density * p);
        let offset = [carried, -self.momentum_flow(p, carried)];
        let moved = apply(&arc, offset);
        let shift = [offset[0] - moved[0], offset[1] - moved[1]];
        let rest = multiply(&span, &multiply(&arc, &span));
        let around = multiply(&rest, &arc);
        let source = apply(&rest, shift);
        // y = around y + source where the driven arc begins.
        let one = Complex64::new(1.0, 0.0);
        let matrix = [
            [one - around[0][0], -around[0][1]],
            [-around[1][0], one - around[1][1]],
        ];
        let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
        let begin = [
            (source[0] * matrix[1][1] - matrix[0][1] * source[1]) / determinant,
            (matrix[0][0] * source[1] - matrix[1][0] * source[0]) / determinant,
        ];
        let end = apply(&arc, begin);
        let end = [end[0] + shift[0], end[1] + shift[1]];
        self.inertia * p * p - self.friction(p, begin, end) * self.radius
    }

    /// Force of the belt on the driven pulley along its arc [N], from (R4) integrated over the arc: it is
    /// v_s ∫ (p w + U w' - R p) dx, and ∫ w dx follows from the change of q.
    fn friction(&self, p: Complex64, begin: Values, end: Values) -> Complex64 {
        let (gain, passed) = (end[1] - begin[1], end[0] - begin[0]);
        let (m, u, vs) = (self.line_density, self.speed, self.slope);
        let driven = p * (vs * self.radius * self.arc);
        // gain = (m p² + v_s p) ∫w + (m U p + v_s U) [w] - v_s R p arc
        let integral = (gain - passed * (u * (m * p + vs)) + driven) / (p * (m * p + vs));
        vs * (p * integral + u * passed) - driven
    }

    /// m U p w: what w alone adds to q [N].
    fn momentum_flow(&self, p: Complex64, w: Complex64) -> Complex64 {
        p * w * (self.line_density * self.speed)
    }

    /// (R6): takes (w, q) from the beginning to the end of a piece of `length`.
    fn transfer(&self, p: Complex64, length: f64, stiffness: f64, slope: f64) -> Transfer {
        let (m, u) = (self.line_density, self.speed);
        let a = stiffness - m * u * u;
        let b = -(p * (2.0 * m * u) + slope * u);
        let c = -(p * p * m + p * slope);
        let root = (b * b - 4.0 * a * c).sqrt();
        let exponents = [(-b + root) / (2.0 * a), (-b - root) / (2.0 * a)];
        let grown = exponents.map(|lambda| (lambda * length).exp());
        // q = a w' - m U p w for each exponential
        let flows = exponents.map(|lambda| lambda * a - p * (m * u));
        let scale = (flows[1] - flows[0]).inv();
        [
            [
                (flows[1] * grown[0] - flows[0] * grown[1]) * scale,
                (grown[1] - grown[0]) * scale,
            ],
            [
                flows[0] * flows[1] * (grown[0] - grown[1]) * scale,
                (flows[1] * grown[1] - flows[0] * grown[0]) * scale,
            ],
        ]
    }
}

fn apply(transfer: &Transfer, values: Values) -> Values {
    transfer.map(|row| row[0] * values[0] + row[1] * values[1])
}

fn multiply(a: &Transfer, b: &Transfer) -> Transfer {
    a.map(|row| std::array::from_fn(|j| row[0] * b[0][j] + row[1] * b[1][j]))
}

#[cfg(test)]
mod tests {
    use ancf::element::BeltBeam2;

    use super::*;
    use crate::steady::running::{Answer, RunningBelt};

    /// Half period and decay of the torsional mode of the finite elements about steady running: 1 % for the belt of Table 3.1. The
    /// stiff belt sinks in over 6 mm at the ends of its arcs, which the model leaves out: 2 % and 5 %, as where time runs are compared
    /// with it (`chapter-3/ring-down`).
    #[test]
    fn torsional_mode_of_the_finite_elements() {
        for (text, period, decay) in [
            (
                include_str!("../../../../examples/figure_3_7.toml"),
                0.01,
                0.01,
            ),
            (
                include_str!("../../../../examples/figure_3_8.toml"),
                0.02,
                0.05,
            ),
        ] {
            let elements = "belt.elements=80".parse().unwrap();
            let drive = crate::input::parse("drive.toml", text, &[elements]).unwrap();
            let mut belt = RunningBelt::<BeltBeam2>::new(&drive).unwrap();
            let Answer::Running(running) = belt.solve().unwrap() else {
                panic!("it does not run");
            };
            let modes = belt.modes(&running, 8).unwrap();
            let mode = modes.iter().find(|mode| mode.pulley_share > 0.9).unwrap();
            let root = RingDown::new(&drive, belt.start.tension, belt.layout())
                .and_then(|model| model.root(mode.growth, mode.frequency))
                .unwrap();
            assert!(
                (root.im / mode.frequency - 1.0).abs() < period
                    && (mode.growth / root.re - 1.0).abs() < decay,
                "{} {}, not {root}",
                mode.growth,
                mode.frequency
            );
        }
    }

    /// A belt almost without inertia (1e-7 of the pulley's; less would lose digits in the spans' waves,
    /// which the arcs then amplify) that hardly moves: relative to its pulley each arc of length L creeps by
    /// cosh(lambda x), lambda = sqrt(v_s p/k), so each span is a spring of length l + 2 coth(lambda L/2)/lambda,
    /// and `I p² + 2 k R²/(l + 2 coth(lambda L/2)/lambda) = 0`.
    #[test]
    fn long_arcs_and_spans_are_springs_in_series() {
        let model = RingDown {
            radius: 0.08,
            inertia: 0.1,
            line_density: 1.0e-6,
            speed: 1.0e-9,
            slope: 3.0e5,
            arc: 0.25,
            span: 0.4,
            span_stiffness: 1.0e4,
            arc_stiffness: 1.0e4,
        };
        let mut expected = Complex64::new(-1.0, 55.0);
        for _ in 0..50 {
            let lambda = (expected * 3.0e5 / 1.0e4).sqrt();
            let length = 0.4 + 2.0 / (lambda * (lambda * 0.125).tanh());
            expected = (-2.0 * 1.0e4 * 0.08 * 0.08 / 0.1 / length).sqrt();
            if expected.im < 0.0 {
                expected = -expected;
            }
        }
        let root = model.root(-3.0, 50.0).unwrap();
        assert!(
            (root - expected).norm() < 1.0e-5 * expected.norm(),
            "{root} {expected}"
        );
        assert!(root.re < 0.0);
    }

    /// A creeping belt takes energy: the motion decays, and the smaller v_s, the softer the
    /// drive.
    #[test]
    fn creep_damps_and_softens() {
        let model = |slope: f64| RingDown {
            radius: 0.08,
            inertia: 0.1,
            line_density: 0.1,
            speed: 1.0,
            slope,
            arc: 0.25,
            span: 0.4,
            span_stiffness: 1.0e4,
            arc_stiffness: 0.9e4,
        };
        let mut frequency = f64::INFINITY;
        for slope in [4.0e5, 2.0e5, 1.0e5] {
            let root = model(slope).root(-3.0, 55.0).unwrap();
            assert!(root.re < 0.0 && root.im < frequency, "{slope}: {root}");
            frequency = root.im;
        }
    }
}
