//! Factor and solve times of the chain solver on shapes of belts, and of the general sparse path.
//!
//! `cargo bench -p ancf --bench linear`

use ancf::linear::{BorderedMatrix, CyclicSolver, Solver, SparseSolver, Structure};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Positive definite chain blocks, multiplier-like border rows: an effective matrix in shape.
fn belt_matrix(structure: Structure) -> BorderedMatrix {
    let mut matrix = BorderedMatrix::new(structure);
    let b = structure.block;
    let pairs = if structure.closed {
        structure.sections
    } else {
        structure.sections - 1
    };
    let local: Vec<f64> = (0..4 * b * b)
        .map(|i| {
            let (row, column) = (i / (2 * b), i % (2 * b));
            let diagonal = if row == column { 2.0 * b as f64 } else { 0.0 };
            diagonal + (1.0 + (row * column) as f64).sin()
        })
        .collect();
    for section in 0..pairs {
        matrix.add_pair(section, 1.0, &local);
    }
    for k in 0..structure.border {
        for row in (k..structure.chain()).step_by(3) {
            matrix.add_border_column(k, row, &[1.0]);
            matrix.add_border_row(k, row, &[1.0]);
        }
    }
    matrix
}

fn bench(criterion: &mut Criterion) {
    let shapes = [
        (
            "30x6+2",
            Structure {
                sections: 30,
                block: 6,
                closed: true,
                border: 2,
            },
        ),
        (
            "30x6+8",
            Structure {
                sections: 30,
                block: 6,
                closed: true,
                border: 8,
            },
        ),
        (
            "30x12+2",
            Structure {
                sections: 30,
                block: 12,
                closed: true,
                border: 2,
            },
        ),
        (
            "2000x6+2",
            Structure {
                sections: 2000,
                block: 6,
                closed: true,
                border: 2,
            },
        ),
        (
            "100x36+2",
            Structure {
                sections: 100,
                block: 36,
                closed: true,
                border: 2,
            },
        ),
    ];
    for (name, structure) in shapes {
        let matrix = belt_matrix(structure);
        let right: Vec<f64> = (0..structure.size()).map(|i| (i as f64).cos()).collect();
        run(
            criterion,
            &format!("cyclic {name}"),
            CyclicSolver::new(structure),
            &matrix,
            &right,
        );
    }
    let structure = shapes[0].1;
    let matrix = belt_matrix(structure);
    let right: Vec<f64> = (0..structure.size()).map(|i| (i as f64).cos()).collect();
    run(
        criterion,
        "sparse 30x6+2",
        SparseSolver::new(structure),
        &matrix,
        &right,
    );
}

fn run(
    criterion: &mut Criterion,
    name: &str,
    mut solver: impl Solver,
    matrix: &BorderedMatrix,
    right: &[f64],
) {
    criterion.bench_function(&format!("{name} factor"), |bencher| {
        bencher.iter(|| solver.factor(black_box(matrix)));
    });
    let mut x = right.to_vec();
    criterion.bench_function(&format!("{name} solve"), |bencher| {
        bencher.iter(|| {
            x.copy_from_slice(right);
            solver.solve(black_box(&mut x));
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
