//! The free spans between the pulleys.

use std::ops::Range;

use super::belt::BeltSurvey;
use crate::layout::{Layout, Span};

/// A free span at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpanState {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Mean engineering strain [-].
    pub strain: f64,
    /// Mean speed along the belt, in the order of the pulleys [m/s].
    pub speed: f64,
    /// Distance of the belt's centre line from the middle of the path's straight span, positive to the
    /// left of the way from the first pulley to the second [m].
    pub deflection: f64,
}

impl BeltSurvey {
    /// The free spans: span `i` runs from pulley `i` to the next, and its values are means over the
    /// belt between the last contact with the one and the first contact with the other. Where a
    /// pulley has lost the belt, the spans beside it share one piece of belt.
    pub fn spans(&self, layout: &Layout, out: &mut [SpanState]) {
        let count = out.len();
        let points = self.stations.points.len();
        out.fill(SpanState::default());
        let on = |i: usize| {
            let touch = self.stations.points[i % points].touch;
            touch.map(|touch| touch.pulley)
        };
        let Some(start) = (0..points).find(|i| on(*i).is_some()) else {
            for (span, out) in layout.spans.iter().zip(out) {
                *out = self.span(0..points, span);
            }
            return;
        };
        let mut i = start;
        let end = start + points;
        while i < end {
            let Some(from) = on(i) else { break };
            let mut next = i + 1;
            while next <= end && on(next).is_none() {
                next += 1;
            }
            if let Some(to) = on(next)
                && next > i + 1
                && to != from
            {
                let mut span = from;
                while span != to {
                    out[span] = self.span(i + 1..next, &layout.spans[span]);
                    span = (span + 1) % count;
                }
            }
            i = next;
        }
    }

    /// Means over a range of integration points (cyclic) that make the span `span` of the path.
    fn span(&self, range: Range<usize>, span: &Span) -> SpanState {
        let mut state = SpanState::default();
        let mut length = 0.0;
        for i in range.clone() {
            let points = &self.stations.points;
            let point = &points[i % points.len()];
            state.tension += point.weight * point.tension;
            state.strain += point.weight * (point.stretch - 1.0);
            state.speed += point.weight * point.speed;
            length += point.weight;
        }
        SpanState {
            tension: state.tension / length,
            strain: state.strain / length,
            speed: state.speed / length,
            deflection: self.deflection(range, span),
        }
    }

    /// Where the belt crosses the perpendicular through the middle of `span`, by the line between the
    /// points beside it; zero if it does not.
    fn deflection(&self, range: Range<usize>, span: &Span) -> f64 {
        let along = [
            (span.end[0] - span.start[0]) / span.length,
            (span.end[1] - span.start[1]) / span.length,
        ];
        let middle = [
            0.5 * (span.start[0] + span.end[0]),
            0.5 * (span.start[1] + span.end[1]),
        ];
        // Along and left of the span, from its middle.
        let seen = |i: usize| {
            let points = &self.stations.points;
            let [x, y, _] = points[i % points.len()].position;
            let arm = [x - middle[0], y - middle[1]];
            (
                arm[0] * along[0] + arm[1] * along[1],
                along[0] * arm[1] - along[1] * arm[0],
            )
        };
        range
            .clone()
            .zip(range.skip(1))
            .find_map(|(i, j)| {
                let ((s0, left0), (s1, left1)) = (seen(i), seen(j));
                (s0 <= 0.0 && s1 > 0.0).then(|| left0 - s0 * (left1 - left0) / (s1 - s0))
            })
            .unwrap_or(0.0)
    }
}
