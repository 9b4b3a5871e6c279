//! Cost of element kernels: force alone and force with tangent, plain numbers and eight SIMD lanes.
//!
//! `cargo bench -p ancf --bench elements`. The throughput column is elements per second; each time
//! printed is that of [`COUNT`] elements. Elements are gathered, computed and scattered as an
//! assembly does, in the widest registers the processor has.

use std::hint::black_box;

use ancf::element::{
    BeltBeam2, BeltBeam3, BendingRigidity, CubicBeam2, Element, LinearBeam2, LinearBeam3,
    PlateQuadrature, ThinPlate,
};
use ancf::material::Isotropic;
use ancf::scalar::{EightLanes, LaneKernel, Scalar, dispatch};
use ancf::section::{PlanarSection, SpatialSection};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

/// Elements of a batch.
const COUNT: usize = 64;

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
    let section = SpatialSection::rectangle(0.02, 0.01);
    let linear = LinearBeam3::new(0.05, &section, &material);
    element(criterion, "spatial_linear_beam", &linear);
    let belt = BeltBeam3::new(0.05, &section, &material, 1.0, 0.01);
    element(criterion, "spatial_belt_beam", &belt);
    let plate = ThinPlate::new(0.05, 0.04, 0.01, &material, BendingRigidity::Kirchhoff);
    element(criterion, "thin_plate", &plate);
    let every_point = PlateQuadrature {
        membrane: 5,
        bending: 5,
    };
    element(
        criterion,
        "thin_plate_5x5",
        &plate.with_quadrature(every_point),
    );
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
            let mut output = Output::new::<E>();
            bencher.iter(|| {
                for e in &states {
                    output.compute(element, e, work);
                }
            });
        });
        group.bench_function(format!("{label}/lanes"), |bencher| {
            bencher.iter(|| {
                dispatch(Batch {
                    element,
                    states: &states,
                    work,
                });
            });
        });
    }
    group.finish();
}

/// All states, eight at a time.
struct Batch<'a, E> {
    element: &'a E,
    states: &'a [Vec<f64>],
    work: Work,
}

impl<E: Element> LaneKernel for Batch<'_, E> {
    type Output = ();

    #[inline(always)]
    fn run<S: EightLanes>(self) {
        let mut e = vec![S::zero(); E::DOF];
        let mut output = Output::new::<E>();
        for group in self.states.chunks_exact(8) {
            for (i, value) in e.iter_mut().enumerate() {
                let mut lanes = [0.0; 8];
                for lane in 0..8 {
                    lanes[lane] = group[lane][i];
                }
                *value = S::load(&lanes);
            }
            output.compute(self.element, &e, self.work);
        }
    }
}

/// Where results go.
struct Output<S> {
    force: Vec<S>,
    tangent: Vec<S>,
}

impl<S: Scalar> Output<S> {
    fn new<E: Element>() -> Self {
        Self {
            force: vec![S::zero(); E::DOF],
            tangent: vec![S::zero(); E::DOF * E::DOF],
        }
    }

    #[inline(always)]
    fn compute<E: Element>(&mut self, element: &E, e: &[S], work: Work) {
        element.force(black_box(e), &mut self.force);
        black_box(&self.force);
        if matches!(work, Work::ForceAndTangent) {
            element.stiffness(black_box(e), &mut self.tangent);
            black_box(&self.tangent);
        }
    }
}

criterion_group!(elements, benches);
criterion_main!(elements);
