//! Numbers computed side by side equal numbers computed alone.

use super::{damping_force, damping_tangent, deformed_state, force, random_rate, stiffness};
use crate::element::Element;
use crate::scalar::{EightLanes, LaneKernel, Lanes, Scalar, dispatch};

/// Factors of the damping tangent that is compared.
const FACTORS: [f64; 2] = [0.7, 1.3];

/// Four and eight lanes, and the widest registers of the processor, compute bit for bit what plain
/// numbers do.
pub fn lanes_equal_plain_numbers<E: Element>(element: &E) {
    let states: [Vec<f64>; 8] = std::array::from_fn(|i| deformed_state(element, i as u64));
    let rates: [Vec<f64>; 8] = std::array::from_fn(|i| random_rate(element, i as u64));
    let plain: [Vec<f64>; 8] =
        std::array::from_fn(|lane| everything(element, &states[lane], &rates[lane]));

    compare(&plain, &lanes::<E, 4>(element, &states, &rates));
    compare(&plain, &lanes::<E, 8>(element, &states, &rates));
    let wide = dispatch(Everything {
        element,
        states: &states,
        rates: &rates,
    });
    compare(&plain, &wide);
}

/// `values[i][lane]` against `plain[lane][i]`.
fn compare<const L: usize>(plain: &[Vec<f64>; 8], values: &[[f64; L]]) {
    for lane in 0..L {
        let lane_values: Vec<f64> = values.iter().map(|value| value[lane]).collect();
        assert_eq!(lane_values, plain[lane], "lane {lane} of {L}");
    }
}

/// Energy, force, stiffness, damping force and damping tangent in a row.
#[inline(always)]
fn everything<E: Element, S: Scalar>(element: &E, e: &[S], rate: &[S]) -> Vec<S> {
    let mut values = vec![element.energy(e)];
    values.extend(force(element, e));
    values.extend(stiffness(element, e));
    if element.is_damped() {
        values.extend(damping_force(element, e, rate));
        values.extend(damping_tangent(element, e, rate, FACTORS[0], FACTORS[1]));
    }
    values
}

fn lanes<E: Element, const L: usize>(
    element: &E,
    states: &[Vec<f64>; 8],
    rates: &[Vec<f64>; 8],
) -> Vec<[f64; L]> {
    let gather = |vectors: &[Vec<f64>; 8]| -> Vec<Lanes<L>> {
        (0..E::DOF)
            .map(|i| Lanes(std::array::from_fn(|lane| vectors[lane][i])))
            .collect()
    };
    everything(element, &gather(states), &gather(rates))
        .into_iter()
        .map(|value| value.0)
        .collect()
}

struct Everything<'a, E> {
    element: &'a E,
    states: &'a [Vec<f64>; 8],
    rates: &'a [Vec<f64>; 8],
}

impl<E: Element> LaneKernel for Everything<'_, E> {
    type Output = Vec<[f64; 8]>;

    #[inline(always)]
    fn run<S: EightLanes>(self) -> Self::Output {
        let [e, rate] = [self.states, self.rates].map(|vectors| -> Vec<S> {
            (0..E::DOF)
                .map(|i| S::load(&std::array::from_fn(|lane| vectors[lane][i])))
                .collect()
        });
        everything(self.element, &e, &rate)
            .into_iter()
            .map(S::store)
            .collect()
    }
}
