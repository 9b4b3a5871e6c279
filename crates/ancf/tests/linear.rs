//! The bordered matrix and both solvers: closed forms, properties, comparison with each other.

use ancf::linear::{
    BorderedMatrix, CyclicSolver, DenseInverse, SectionPanels, Singular, Solver, SparseSolver,
    Structure,
};
use proptest::prelude::*;

const EPSILON: f64 = f64::EPSILON;

fn structure(sections: usize, block: usize, closed: bool, border: usize) -> Structure {
    Structure {
        sections,
        block,
        closed,
        border,
    }
}

fn pairs(structure: Structure) -> usize {
    if structure.closed {
        structure.sections
    } else {
        structure.sections - 1
    }
}

fn solvers(structure: Structure) -> [Box<dyn Solver>; 2] {
    [
        Box::new(CyclicSolver::new(structure)),
        Box::new(SparseSolver::new(structure)),
    ]
}

/// Solves with both solvers.
fn solve(matrix: &BorderedMatrix, right: &[f64]) -> [Vec<f64>; 2] {
    solvers(matrix.structure()).map(|mut solver| {
        solver.factor(matrix).unwrap();
        let mut x = right.to_vec();
        solver.solve(&mut x);
        x
    })
}

/// The rows that both solvers call singular.
fn singular_rows(matrix: &BorderedMatrix) -> [usize; 2] {
    solvers(matrix.structure()).map(|mut solver| solver.factor(matrix).unwrap_err().row)
}

fn assert_close(x: &[f64], exact: &[f64], tolerance: f64) {
    for (i, (x, exact)) in x.iter().zip(exact).enumerate() {
        assert!(
            (x - exact).abs() <= tolerance,
            "unknown {i}: {x} is not {exact}"
        );
    }
}

/// Numbers in -1..1 that look random, always the same for a seed (splitmix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn take(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

/// Every entry of the pattern in -1..1, and a diagonal twice as large as the rest of a row can be.
fn dominant_matrix(structure: Structure, numbers: &mut Numbers) -> BorderedMatrix {
    let mut matrix = BorderedMatrix::new(structure);
    let places: Vec<_> = matrix
        .triplets()
        .map(|(row, column, _)| (row, column))
        .collect();
    let mut row_sums = vec![0.0; structure.size()];
    for (row, column) in places {
        let value = numbers.next();
        row_sums[row] += value.abs();
        matrix.add(row, column, value);
    }
    for (row, sum) in row_sums.iter().enumerate() {
        matrix.add(row, row, 2.0 * sum + 1.0);
    }
    matrix
}

/// A chain of unit springs between sections of one unknown, free at both ends.
fn springs(sections: usize, closed: bool, border: usize) -> BorderedMatrix {
    let structure = structure(sections, 1, closed, border);
    let mut matrix = BorderedMatrix::new(structure);
    for section in 0..pairs(structure) {
        matrix.add_pair(section, 1.0, &[1.0, -1.0, -1.0, 1.0]);
    }
    matrix
}

fn any_structure() -> impl Strategy<Value = Structure> {
    let block = prop_oneof![1_usize..=9, Just(12)];
    (block, 1_usize..=9, any::<bool>(), 0_usize..=5).prop_map(
        |(block, sections, closed, border)| {
            structure(
                if closed { sections.max(3) } else { sections },
                block,
                closed,
                border,
            )
        },
    )
}

// Closed forms

/// Springs between two walls under a unit load at `j`: the inverse of the tridiagonal matrix
/// (-1, 2, -1) of order n is `min(i,j) (n + 1 - max(i,j)) / (n + 1)`, indices from 1. Values are
/// of order n/4 and the condition is about 4 n²/pi² = 160, roundings of 2 per row: 1e-13 is
/// several times that.
#[test]
fn springs_between_walls_match_the_inverse_in_closed_form() {
    let n = 20;
    let mut matrix = springs(n, false, 0);
    matrix.add(0, 0, 1.0);
    matrix.add(n - 1, n - 1, 1.0);
    for load in [0, 7, n - 1] {
        let mut right = vec![0.0; n];
        right[load] = 1.0;
        let exact: Vec<f64> = (0..n)
            .map(|i| ((i.min(load) + 1) * (n - i.max(load))) as f64 / (n + 1) as f64)
            .collect();
        for x in solve(&matrix, &right) {
            assert_close(&x, &exact, 1e-13);
        }
    }
}

/// A ring of springs on a foundation of stiffness s: a wave of w periods is an eigenvector with
/// eigenvalue `s + 2 - 2 cos(2 pi w / n)`. The condition is 4.5 / 0.5, so 20 roundings are ample.
#[test]
fn a_ring_of_springs_answers_waves_by_its_eigenvalue() {
    let n = 24;
    let mut matrix = springs(n, true, 0);
    for i in 0..n {
        matrix.add(i, i, 0.5);
    }
    for waves in 0..4 {
        let angle = std::f64::consts::TAU * f64::from(waves) / n as f64;
        let eigenvalue = 2.5 - 2.0 * angle.cos();
        let exact: Vec<f64> = (0..n).map(|i| (angle * i as f64).cos()).collect();
        let right: Vec<f64> = exact.iter().map(|value| eigenvalue * value).collect();
        for x in solve(&matrix, &right) {
            assert_close(&x, &exact, 20.0 * EPSILON);
        }
    }
}

/// A free chain that only a multiplier holds: the position of the first unknown is 3, a force of 2
/// pulls at the end. All springs carry 2, the reaction is 2, all numbers are small integers, so
/// roundings do not enter except through the scaling by powers of two.
#[test]
fn a_multiplier_holds_a_free_chain() {
    for (sections, held) in [(1, 0), (2, 1), (6, 0), (6, 3), (6, 5)] {
        let mut matrix = springs(sections, false, 1);
        matrix.add_border_column(0, held, &[1.0]);
        matrix.add_border_row(0, held, &[1.0]);
        let mut right = vec![0.0; sections + 1];
        right[sections - 1] = 2.0;
        right[sections] = 3.0;
        let stretch = |i: usize| 2.0 * (i as f64 - held as f64).max(0.0);
        let mut exact: Vec<f64> = (0..sections).map(|i| 3.0 + stretch(i)).collect();
        exact.push(2.0);
        for x in solve(&matrix, &right) {
            assert_close(&x, &exact, 1e-13);
        }
    }
}

/// The same chain closed to a ring, which is stiff in itself but free to move.
#[test]
fn a_multiplier_holds_a_free_ring() {
    let mut matrix = springs(5, true, 1);
    matrix.add_border_column(0, 2, &[1.0]);
    matrix.add_border_row(0, 2, &[1.0]);
    let right = [1.0, 1.0, 1.0, 1.0, 1.0, 3.0];
    for x in solve(&matrix, &right) {
        // The reaction balances all loads; neighbours of the held point feel 4 over two springs.
        assert_close(&x, &[6.0, 5.0, 3.0, 5.0, 6.0, 5.0], 1e-13);
    }
}

/// Diagonal blocks (0 1; 1 0) have no pivot on the diagonal: the solution swaps the neighbours,
/// exactly.
#[test]
fn blocks_pivot_within_themselves() {
    let structure = structure(4, 2, true, 0);
    let mut matrix = BorderedMatrix::new(structure);
    for section in 0..4 {
        matrix.add(2 * section, 2 * section + 1, 1.0);
        matrix.add(2 * section + 1, 2 * section, 1.0);
    }
    let right = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    for x in solve(&matrix, &right) {
        assert_eq!(x, [2.0, 1.0, 4.0, 3.0, 6.0, 5.0, 8.0, 7.0]);
    }
}

// Properties

proptest! {
    /// Diagonally dominant by a factor of 2, so the condition in the maximum norm is below 3 for
    /// rows of any scale, elimination does not amplify, and each unknown is a sum over at most
    /// 3 blocks and the border, a few times over: 8 roundings per term of a row and unit of x.
    #[test]
    fn both_solvers_reproduce_the_solution(structure in any_structure(), seed: u64) {
        let mut numbers = Numbers(seed);
        let matrix = dominant_matrix(structure, &mut numbers);
        let exact = numbers.take(structure.size());
        let mut right = vec![0.0; structure.size()];
        matrix.multiply(&exact, &mut right);
        let terms = (4 * structure.block + structure.border) as f64;
        for x in solve(&matrix, &right) {
            assert_close(&x, &exact, 8.0 * terms * EPSILON);
        }
    }

    /// An effective matrix of implicit integration with constraints: M + g K with M = 1 and K
    /// symmetric indefinite with norm up to 2, g up to 0.4, and independent constraint rows with
    /// a zero corner. The chain has eigenvalues in 0.2..1.8 and the constraints singular values
    /// of about 2, the saddle hence a condition below 100, and the solvers must agree to 100
    /// times the tolerance of well-conditioned ones.
    #[test]
    fn both_solvers_agree_on_shifted_stiffness_with_multipliers(
        structure in any_structure(), g in 0.0..0.4, seed: u64,
    ) {
        let structure = Structure { border: structure.border.min(structure.chain()), ..structure };
        let mut numbers = Numbers(seed);
        let mut matrix = BorderedMatrix::new(structure);
        let n = 2 * structure.block;
        for section in 0..pairs(structure) {
            let random = numbers.take(n * n);
            let symmetric: Vec<f64> = (0..n * n)
                .map(|i| (random[i] + random[i % n * n + i / n]) / (2 * n) as f64)
                .collect();
            matrix.add_pair(section, g, &symmetric);
        }
        for i in 0..structure.chain() {
            matrix.add(i, i, 1.0);
        }
        for k in 0..structure.border {
            let mut row: Vec<f64> =
                (numbers.take(structure.chain()).iter()).map(|v| 0.2 * v / n as f64).collect();
            row[k * structure.chain() / structure.border] += 2.0;
            matrix.add_border_row(k, 0, &row);
            matrix.add_border_column(k, 0, &row);
        }
        let right = numbers.take(structure.size());
        let [cyclic, sparse] = solve(&matrix, &right);
        let terms = (4 * structure.block + structure.border) as f64;
        assert_close(&cyclic, &sparse, 800.0 * terms * EPSILON);
    }

    /// Adding a pair is adding its entries one by one; both multiply by the factor once, so the
    /// entries are equal to the last bit.
    #[test]
    fn a_pair_is_its_entries(structure in any_structure(), factor in -2.0..2.0, seed: u64) {
        let (mut whole, mut single) =
            (BorderedMatrix::new(structure), BorderedMatrix::new(structure));
        let mut numbers = Numbers(seed);
        let b = structure.block;
        for section in 0..pairs(structure) {
            let local = numbers.take(4 * b * b);
            whole.add_pair(section, factor, &local);
            let global = |i: usize| {
                if i < b { section * b + i } else { (section + 1) % structure.sections * b + i - b }
            };
            for (i, value) in local.iter().enumerate() {
                single.add(global(i / (2 * b)), global(i % (2 * b)), factor * value);
            }
        }
        prop_assert!(whole.triplets().eq(single.triplets()));
    }

    /// The product is the sum over the triplets; the sums run in different orders, one rounding a
    /// term of size up to 1.
    #[test]
    fn the_product_is_the_sum_of_triplets(structure in any_structure(), seed: u64) {
        let mut numbers = Numbers(seed);
        let mut matrix = BorderedMatrix::new(structure);
        let places: Vec<_> = matrix.triplets().map(|(row, column, _)| (row, column)).collect();
        for (row, column) in places {
            matrix.add(row, column, numbers.next());
        }
        let x = numbers.take(structure.size());
        let mut sum = vec![0.0; structure.size()];
        for (row, column, value) in matrix.triplets() {
            sum[row] += value * x[column];
        }
        let mut product = vec![1.0; structure.size()];
        matrix.multiply(&x, &mut product);
        let terms = structure.size() as f64;
        assert_close(&product, &sum, terms * terms * EPSILON);
        product.fill(1.0);
        let mut panels = SectionPanels::new(&matrix);
        let known = numbers.take(structure.size());
        let left: Vec<f64> = sum.iter().zip(&known).map(|(sum, known)| sum - known).collect();
        panels.residual(&x, &known, &mut product);
        assert_close(&product, &left, terms * terms * EPSILON);
        let form: f64 = x.iter().zip(&sum).map(|(x, y)| x * y).sum();
        assert!((panels.quadratic(&x) - form).abs() <= terms * terms * terms * EPSILON);
    }

    /// A unit row returns its right-hand side, whatever the other rows say: exact but for the
    /// products with zeros, one rounding.
    #[test]
    fn a_unit_row_prescribes_its_unknown(structure in any_structure(), seed: u64, row: prop::sample::Index) {
        let mut numbers = Numbers(seed);
        let mut matrix = dominant_matrix(structure, &mut numbers);
        let row = row.index(structure.size());
        matrix.set_unit_row(row);
        for (i, column, value) in matrix.triplets().filter(|(i, _, _)| *i == row) {
            prop_assert!(value.to_bits() == f64::from(u8::from(i == column)).to_bits());
        }
        let right = numbers.take(structure.size());
        for x in solve(&matrix, &right) {
            let terms = (4 * structure.block + structure.border) as f64;
            prop_assert!((x[row] - right[row]).abs() <= 8.0 * terms * EPSILON);
        }
    }
}

/// Sections of plates run on the path with block sizes of the run; as dominant as above.
#[test]
fn wide_sections() {
    for block in [18, 27, 36] {
        for closed in [false, true] {
            let structure = structure(5, block, closed, 3);
            let mut numbers = Numbers(block as u64);
            let matrix = dominant_matrix(structure, &mut numbers);
            let exact = numbers.take(structure.size());
            let mut right = vec![0.0; structure.size()];
            matrix.multiply(&exact, &mut right);
            for x in solve(&matrix, &right) {
                assert_close(&x, &exact, 8.0 * (4 * block + 3) as f64 * EPSILON);
            }
        }
    }
}

/// The whole inverse solves as the factor does that it was made from; of more than 64 unknowns there is none. Rows
/// are dominated by their diagonal, so that the inverse has norm one at most: a few roundings of sums of 38 terms.
#[test]
fn a_small_matrix_may_be_inverted_whole() {
    let mut numbers = Numbers(11);
    for (sections, exists) in [(9, true), (16, false)] {
        let structure = structure(sections, 4, false, 2);
        let matrix = dominant_matrix(structure, &mut numbers);
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&matrix).unwrap();
        let inverse = DenseInverse::new(&mut solver, structure.size());
        assert_eq!(inverse.is_some(), exists);
        if let Some(mut inverse) = inverse {
            let right = numbers.take(structure.size());
            let (mut by_inverse, mut by_factor) = (vec![0.0; right.len()], right.clone());
            inverse.solve(&right, &mut by_inverse);
            solver.solve(&mut by_factor);
            assert_close(&by_inverse, &by_factor, 16.0 * EPSILON);
        }
    }
}

/// A solver carries nothing over from matrix to matrix, failed ones included: bytes repeat.
#[test]
fn a_factor_replaces_the_one_before() {
    let structure = structure(6, 6, true, 2);
    let mut numbers = Numbers(1);
    let (first, other) = (
        dominant_matrix(structure, &mut numbers),
        dominant_matrix(structure, &mut numbers),
    );
    let right = numbers.take(structure.size());
    for mut solver in solvers(structure) {
        let mut solve = |matrix: &BorderedMatrix| {
            solver.factor(matrix).map(|()| {
                let mut x = right.clone();
                solver.solve(&mut x);
                x
            })
        };
        let once = solve(&first);
        let _ = solve(&other);
        let _ = solve(&BorderedMatrix::new(structure));
        assert_eq!(solve(&first), once);
    }
}

// Singular matrices

/// A coordinate without any stiffness: its row and column are zero, and it is named.
#[test]
fn a_free_coordinate_is_named() {
    for closed in [false, true] {
        let structure = structure(4, 3, closed, 2);
        for free in 0..structure.size() {
            let mut numbers = Numbers(7);
            let full = dominant_matrix(structure, &mut numbers);
            let mut matrix = BorderedMatrix::new(structure);
            for (row, column, value) in full.triplets() {
                if row != free && column != free {
                    matrix.add(row, column, value);
                }
            }
            assert_eq!(singular_rows(&matrix), [free; 2], "closed: {closed}");
        }
    }
}

/// A chain that nothing holds: every coordinate is free to move with the others. Elimination
/// finds it when only the last is left; sparse LU names any of the chain.
#[test]
fn a_free_chain_is_singular() {
    for closed in [false, true] {
        let mut matrix = springs(9, closed, 0);
        assert_eq!(singular_rows(&matrix)[0], 8);
        matrix.add(3, 3, 1e-3);
        solve(&matrix, &[1.0; 9]);
    }
}

/// Two multipliers for one constraint cannot share the reaction; the second is named.
#[test]
fn a_repeated_constraint_is_singular() {
    let mut matrix = springs(6, false, 2);
    for k in 0..2 {
        matrix.add_border_column(k, 2, &[1.0]);
        matrix.add_border_row(k, 2, &[1.0]);
    }
    let [cyclic, sparse] = singular_rows(&matrix);
    assert_eq!(cyclic, 7);
    assert!(sparse >= 6, "a multiplier, not the coordinate {sparse}");
}

/// A value that is not finite is reported with its row and never becomes a solution, wherever it
/// stands.
#[test]
fn values_that_are_not_finite_are_reported() {
    for closed in [false, true] {
        let structure = structure(4, 2, closed, 1);
        let healthy = dominant_matrix(structure, &mut Numbers(3));
        let places: Vec<_> = healthy
            .triplets()
            .map(|(row, column, _)| (row, column))
            .collect();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for &(row, column) in &places {
                let mut matrix = healthy.clone();
                matrix.add(row, column, bad);
                assert_eq!(
                    singular_rows(&matrix),
                    [row; 2],
                    "{bad} at ({row}, {column})"
                );
            }
        }
    }
}

/// Stiff springs and constraints in other units: multipliers have pivots as small as
/// `constraint² / stiffness = 1e-28` next to 1e12, yet nothing is singular: the sum of the
/// coordinates of a ring on a foundation is prescribed, so they all are the sixth part of it. The
/// springs take no force, hence the condition is that of the foundation alone: 100 roundings are
/// ample. Sparse LU scales by rows and columns only and joins in where constraints do not
/// outweigh the springs by more than half the digits.
#[test]
fn singularity_does_not_depend_on_units() {
    for stiffness in [1e-12, 1.0, 1e12] {
        for constraint in [1e-8, 1.0, 1e8] {
            let structure = structure(6, 1, true, 1);
            let mut matrix = BorderedMatrix::new(structure);
            matrix.add_scaled(stiffness, &springs(6, true, 1));
            for i in 0..6 {
                matrix.add(i, i, stiffness);
                matrix.add_border_column(0, i, &[constraint]);
                matrix.add_border_row(0, i, &[constraint]);
            }
            let sparse_too = constraint / stiffness <= 1e8;
            for mut solver in solvers(structure)
                .into_iter()
                .take(if sparse_too { 2 } else { 1 })
            {
                let mut x = [0.0; 7];
                x[6] = 6.0 * constraint;
                solver.factor(&matrix).unwrap();
                solver.solve(&mut x);
                assert_close(&x[..6], &[1.0; 6], 100.0 * EPSILON);
                assert!((x[6] * constraint / stiffness + 1.0).abs() < 100.0 * EPSILON);
            }
        }
    }
}

#[test]
fn the_error_says_what_is_free() {
    let text = Singular { row: 17 }.to_string();
    assert!(text.contains("row 17") && text.contains("holds"), "{text}");
}

// The matrix itself

/// Whole-matrix operations act entry by entry.
#[test]
fn matrices_copy_scale_and_clear() {
    let structure = structure(5, 3, true, 2);
    let mut numbers = Numbers(11);
    let (first, second) = (
        dominant_matrix(structure, &mut numbers),
        dominant_matrix(structure, &mut numbers),
    );
    let mut sum = BorderedMatrix::new(structure);
    sum.copy_from(&first);
    assert!(sum.triplets().eq(first.triplets()));
    sum.add_scaled(-0.5, &second);
    for ((sum, first), second) in sum.triplets().zip(first.triplets()).zip(second.triplets()) {
        assert_eq!(sum.2.to_bits(), (first.2 - 0.5 * second.2).to_bits());
    }
    sum.clear();
    assert!(sum.triplets().all(|(_, _, value)| value == 0.0));
}

/// Border values that pass the end of a closed chain go on at its start.
#[test]
fn border_columns_and_rows_wrap_in_closed_chains() {
    let structure = structure(3, 2, true, 2);
    let mut matrix = BorderedMatrix::new(structure);
    matrix.add_border_column(1, 5, &[1.0, 2.0]);
    matrix.add_border_row(0, 4, &[3.0, 4.0, 5.0]);
    matrix.add_corner(1, 0, 6.0);
    let entries: Vec<_> = matrix
        .triplets()
        .filter(|(_, _, value)| *value != 0.0)
        .collect();
    let expected = [
        (0, 7, 2.0),
        (5, 7, 1.0),
        (6, 0, 5.0),
        (6, 4, 3.0),
        (6, 5, 4.0),
        (7, 6, 6.0),
    ];
    assert_eq!(entries, expected);
}

#[test]
#[should_panic(expected = "outside the pattern")]
fn entries_outside_the_pattern_are_refused() {
    BorderedMatrix::new(structure(4, 2, false, 0)).add(0, 7, 1.0);
}

#[test]
#[should_panic(expected = "has no successor")]
fn an_open_chain_ends_at_its_last_section() {
    BorderedMatrix::new(structure(4, 1, false, 0)).add_pair(3, 1.0, &[0.0; 4]);
}

#[test]
#[should_panic(expected = "leave the chain")]
fn border_values_stay_in_an_open_chain() {
    BorderedMatrix::new(structure(4, 1, false, 1)).add_border_row(0, 3, &[1.0, 1.0]);
}

#[test]
#[should_panic(expected = "at least 3 sections")]
fn closed_chains_need_three_sections() {
    CyclicSolver::new(structure(2, 6, true, 0));
}

#[test]
#[should_panic(expected = "successful factor")]
fn a_failed_factor_solves_nothing() {
    let structure = structure(3, 1, true, 0);
    let mut solver = CyclicSolver::new(structure);
    solver.factor(&BorderedMatrix::new(structure)).unwrap_err();
    solver.solve(&mut [1.0; 3]);
}
