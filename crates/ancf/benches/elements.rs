//! Cost of element kernels: force alone and force with tangent, plain numbers and eight SIMD lanes.
//!
//! `cargo bench -p ancf --bench elements`. The throughput column is elements per second; each time
//! printed is that of [`COUNT`] elements. Elements are gathered, computed and scattered as an
//! assembly does, inside `pulp`'s dispatch to the widest instruction set the processor has.

use std::hint::black_box;
use std::marker::PhantomData;

use ancf::element::{BeltBeam2, CubicBeam2, Element, LinearBeam2};
use ancf::material::Isotropic;
use ancf::scalar::{Lanes, Scalar};
use ancf::section::PlanarSection;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};

/// Elements of a batch.
const COUNT: usize = 64;

/// Most coordinates of an element here.
const MOST: usize = 12;

#[derive(Clone, Copy)]
enum Work {
    Force,
    ForceAndTangent,
}

fn benches(criterion: &mut Criterion) {
    let section = PlanarSection::rectangle(0.01, 0.01);
    let material = Isotropic {
        youngs_modulus: 1e8,
        poisson_ratio: 0.3,
        density: 1036.0,
    };
    let belt = BeltBeam2::new(0.05, &section, &material, 1.0, 0.01, 0.0);
    element(criterion, "belt_beam", &belt);
    let linear = LinearBeam2::new(0.05, &section, &material);
    element(criterion, "linear_beam", &linear);
    let cubic = CubicBeam2::new(0.05, &section, &material);
    element(criterion, "cubic_beam", &cubic);
}

fn element<E: Element>(criterion: &mut Criterion, name: &str, element: &E) {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(COUNT as u64));
    let states: Vec<Vec<f64>> = (0..COUNT)
        .map(|i| ancf::checks::deformed_state(element, i as u64))
        .collect();
    for (label, work) in [
        ("force", Work::Force),
        ("force_and_tangent", Work::ForceAndTangent),
    ] {
        group.bench_function(format!("{label}/plain"), |bencher| {
            bencher.iter(|| {
                Arch::new().dispatch(Batch::<E, f64, 1>::new(element, &states, work));
            });
        });
        group.bench_function(format!("{label}/lanes"), |bencher| {
            bencher.iter(|| {
                Arch::new().dispatch(Batch::<E, Lanes<8>, 8>::new(element, &states, work));
            });
        });
    }
    group.finish();
}

/// All states, `L` at a time. A type of its own, not a closure: only a function that is always inlined
/// is compiled with the instructions that the dispatch found.
struct Batch<'a, E, S, const L: usize> {
    element: &'a E,
    states: &'a [Vec<f64>],
    work: Work,
    scalar: PhantomData<S>,
}

impl<'a, E, S, const L: usize> Batch<'a, E, S, L> {
    fn new(element: &'a E, states: &'a [Vec<f64>], work: Work) -> Self {
        Self {
            element,
            states,
            work,
            scalar: PhantomData,
        }
    }
}

impl<E: Element, S: Packed<L>, const L: usize> WithSimd for Batch<'_, E, S, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let mut e = [S::zero(); MOST];
        let mut force = [S::zero(); MOST];
        let mut tangent = [S::zero(); MOST * MOST];
        for group in self.states.chunks_exact(L) {
            S::gather(group, &mut e[..E::DOF]);
            let e = black_box(&e[..E::DOF]);
            self.element.force(e, &mut force[..E::DOF]);
            black_box(&force);
            if matches!(self.work, Work::ForceAndTangent) {
                self.element.stiffness(e, &mut tangent[..E::DOF * E::DOF]);
                black_box(&tangent);
            }
        }
    }
}

/// Numbers that hold `L` elements side by side.
trait Packed<const L: usize>: Scalar {
    fn gather(states: &[Vec<f64>], e: &mut [Self]);
}

impl Packed<1> for f64 {
    #[inline(always)]
    fn gather(states: &[Vec<f64>], e: &mut [Self]) {
        e.copy_from_slice(&states[0]);
    }
}

impl<const L: usize> Packed<L> for Lanes<L> {
    #[inline(always)]
    fn gather(states: &[Vec<f64>], e: &mut [Self]) {
        for (i, value) in e.iter_mut().enumerate() {
            for lane in 0..L {
                value.0[lane] = states[lane][i];
            }
        }
    }
}

criterion_group!(elements, benches);
criterion_main!(elements);
