//! States that the checks look at: deformed by a seeded generator, moved rigidly.

use crate::element::Element;

/// The undeformed nodal coordinates of an element.
pub fn reference<E: Element>(element: &E) -> Vec<f64> {
    let mut e = vec![f64::NAN; E::DOF];
    element.reference(&mut e);
    e
}

/// A random state of moderate strain: the reference, turned and translated, with every position moved
/// by up to a fifth of the shortest side and every slope by up to three tenths.
pub fn deformed_state<E: Element>(element: &E, seed: u64) -> Vec<f64> {
    let length = length_scale(element);
    let motion = RigidMotion::random(E::DIMENSION, length, seed + 1000);
    let mut e = motion.apply::<E>(&reference(element));
    let side = shortest_side(element);
    let mut random = Random::new(seed);
    for (i, value) in e.iter_mut().enumerate() {
        let change = if is_position::<E>(i) { 0.2 * side } else { 0.3 };
        *value += change * random.symmetric();
    }
    e
}

/// A random rate of every coordinate, in its unit per second.
pub(super) fn random_rate<E: Element>(element: &E, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed + 2000);
    units(element)
        .iter()
        .map(|unit| unit * random.symmetric())
        .collect()
}

fn is_position<E: Element>(coordinate: usize) -> bool {
    coordinate % E::NODE_DOF < E::DIMENSION
}

/// Largest distance between the first node and another.
pub(super) fn length_scale<E: Element>(element: &E) -> f64 {
    let e = reference(element);
    (1..E::NODES)
        .map(|node| distance::<E>(&e, 0, node))
        .fold(0.0, f64::max)
}

/// Smallest distance between two nodes; moves of a part of it strain no side extremely.
fn shortest_side<E: Element>(element: &E) -> f64 {
    let e = reference(element);
    let mut shortest = f64::INFINITY;
    for a in 0..E::NODES {
        for b in 0..a {
            shortest = shortest.min(distance::<E>(&e, a, b));
        }
    }
    shortest
}

/// Distance between two nodes of the configuration `e`.
fn distance<E: Element>(e: &[f64], a: usize, b: usize) -> f64 {
    let position = |node: usize| &e[node * E::NODE_DOF..][..E::DIMENSION];
    let square: f64 = (position(a).iter().zip(position(b)))
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    square.sqrt()
}

/// The unit of each coordinate: length for a position, one for a slope.
pub(super) fn units<E: Element>(element: &E) -> Vec<f64> {
    let length = length_scale(element);
    (0..E::DOF)
        .map(|i| if is_position::<E>(i) { length } else { 1.0 })
        .collect()
}

/// A rotation and a translation of space.
pub(super) struct RigidMotion {
    rotation: Vec<Vec<f64>>,
    translation: Vec<f64>,
}

impl RigidMotion {
    pub(super) fn random(dimension: usize, length: f64, seed: u64) -> Self {
        let mut random = Random::new(seed + 3000);
        let rotation = if dimension == 2 {
            let (sine, cosine) = (3.0 * random.symmetric()).sin_cos();
            vec![vec![cosine, -sine], vec![sine, cosine]]
        } else {
            let q: [f64; 4] = std::array::from_fn(|_| random.symmetric());
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let [w, x, y, z] = q.map(|value| value / norm);
            vec![
                vec![
                    1.0 - 2.0 * (y * y + z * z),
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                vec![
                    2.0 * (x * y + w * z),
                    1.0 - 2.0 * (x * x + z * z),
                    2.0 * (y * z - w * x),
                ],
                vec![
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    1.0 - 2.0 * (x * x + y * y),
                ],
            ]
        };
        Self {
            rotation,
            translation: (0..dimension)
                .map(|_| length * random.symmetric())
                .collect(),
        }
    }

    /// Turns every vector.
    pub(super) fn turn(&self, vectors: &[f64]) -> Vec<f64> {
        let d = self.translation.len();
        vectors
            .chunks(d)
            .flat_map(|vector| {
                self.rotation
                    .iter()
                    .map(move |row| row.iter().zip(vector).map(|(r, v)| r * v).sum::<f64>())
            })
            .collect()
    }

    /// Turns every vector and translates the positions.
    pub(super) fn apply<E: Element>(&self, e: &[f64]) -> Vec<f64> {
        let mut moved = self.turn(e);
        for (i, value) in moved.iter_mut().enumerate() {
            if is_position::<E>(i) {
                *value += self.translation[i % E::DIMENSION];
            }
        }
        moved
    }

    /// The rates of a rigid motion of the state `e`: the skew part of the rotation as spin.
    pub(super) fn rate<E: Element>(&self, e: &[f64]) -> Vec<f64> {
        let d = E::DIMENSION;
        let spin = |i: usize, j: usize| self.rotation[i][j] - self.rotation[j][i];
        (0..E::DOF)
            .map(|k| {
                let vector = &e[k - k % d..k - k % d + d];
                let turning: f64 = (0..d).map(|j| spin(k % d, j) * vector[j]).sum();
                let moving = if is_position::<E>(k) {
                    self.translation[k % d]
                } else {
                    0.0
                };
                turning + moving
            })
            .collect()
    }
}

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d).wrapping_add(1))
    }

    /// The next number in [-1, 1).
    fn symmetric(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
