//! The friction laws on their own: derivatives, closed forms, dissipation, memory.

use ancf::scalar::Scalar;
use hihna::friction::{
    Coulomb, CreepRate, Developed, ElasticPlastic, FrictionLaw, Frictionless, Law, Slip, Stribeck,
};
use num_dual::Dual64;

const CREEP: CreepRate = CreepRate {
    coefficient: 1.2,
    slope: 1.0e5,
};
const COULOMB: Coulomb = Coulomb {
    coefficient: 0.6,
    velocity: 0.1,
};
const STRIBECK: Stribeck = Stribeck {
    static_coefficient: 0.9,
    sliding_coefficient: 0.5,
    stribeck_velocity: 0.2,
    velocity: 0.1,
};
const BRISTLES: ElasticPlastic = ElasticPlastic {
    coefficient: 0.8,
    stiffness: 4.0e6,
    damping: 2.0e3,
};
const LAWS: [Law; 5] = [
    Law::Frictionless(Frictionless),
    Law::CreepRate(CREEP),
    Law::Coulomb(COULOMB),
    Law::Stribeck(STRIBECK),
    Law::ElasticPlastic(BRISTLES),
];

const VELOCITIES: [f64; 8] = [-0.9, -0.1001, -0.05, -1.0e-4, 3.0e-5, 0.02, 0.0999, 0.4];
const DISPLACEMENTS: [f64; 4] = [-2.0e-3, -1.0e-5, 3.0e-6, 4.0e-4];
const NORMALS: [f64; 4] = [0.3, 25.0, 4.0e3, 9.0e4];

fn at<S: Scalar>(law: &Law, velocity: S, displacement: S, normal: S) -> Developed<S> {
    law.develop(
        Slip {
            velocity,
            displacement,
        },
        normal,
    )
}

/// The laws' own derivatives against dual numbers: the same few products, so to round-off. Bristles add
/// two terms that may cancel, so errors are relative to the largest term.
#[test]
fn derivatives_are_those_of_dual_numbers() {
    let constant = Dual64::constant;
    for law in &LAWS {
        for v in VELOCITIES {
            for z in DISPLACEMENTS {
                for n in NORMALS {
                    let plain = at(law, v, z, n);
                    let by_velocity = at(law, Dual64::new(v, 1.0), constant(z), constant(n));
                    let by_displacement = at(law, constant(v), Dual64::new(z, 1.0), constant(n));
                    let by_normal = at(law, constant(v), constant(z), Dual64::new(n, 1.0));
                    for (name, ours, theirs) in [
                        ("force", plain.force, by_velocity.force.re),
                        ("by velocity", plain.by_velocity, by_velocity.force.eps),
                        (
                            "by displacement",
                            plain.by_displacement,
                            by_displacement.force.eps,
                        ),
                        ("by normal", plain.by_normal, by_normal.force.eps),
                    ] {
                        let scale = ours.abs().max(theirs.abs());
                        assert!(
                            (ours - theirs).abs() <= 1.0e-14 * scale,
                            "{law:?} at {v}, {z}, {n}: {name} is {ours}, dual numbers give {theirs}"
                        );
                    }
                }
            }
        }
    }
}

/// Friction of the laws without memory takes energy from any slip, is odd in it, vanishes without
/// normal force and never exceeds its coefficient.
#[test]
fn laws_without_memory_are_odd_bounded_and_dissipative() {
    for (law, coefficient) in LAWS.iter().zip([0.0, 1.2, 0.6, 0.9]) {
        for v in VELOCITIES {
            for n in NORMALS {
                let (ahead, back) = (at(law, v, 0.0, n), at(law, -v, 0.0, n));
                assert!(ahead.force * v >= 0.0, "{law:?} drives the slip {v}");
                assert!(ahead.force.abs() <= coefficient * n * (1.0 + 1.0e-15));
                assert!((ahead.force + back.force).abs() <= 1.0e-15 * ahead.force.abs());
            }
            assert!(at(law, v, 0.0, 0.0).force == 0.0);
        }
    }
}

/// Closed forms, products of a few numbers, so to round-off.
#[test]
fn closed_forms() {
    let near = |ours: f64, exact: f64| {
        assert!(
            (ours - exact).abs() <= 1.0e-14 * exact.abs(),
            "{ours} {exact}"
        );
    };
    let force = |law: &Law, v: f64, z: f64| at(law, v, z, 500.0).force;
    // creep: limit 600 N/m, reached at a slip of 6 mm/s
    let creep = Law::CreepRate(CREEP);
    near(force(&creep, 0.003, 0.0), 300.0);
    near(force(&creep, 0.05, 0.0), 600.0);
    // Coulomb: limit 300 N/m, reached at 0.1 m/s
    let coulomb = Law::Coulomb(COULOMB);
    near(force(&coulomb, 0.025, 0.0), 75.0);
    near(force(&coulomb, 2.0, 0.0), 300.0);
    // Stribeck: half of the drop is gone at 0.2 m/s
    let stribeck = Law::Stribeck(STRIBECK);
    near(force(&stribeck, 0.2, 0.0), 350.0);
    near(
        force(&stribeck, 0.05, 0.0),
        0.5 * 500.0 * (0.5 + 0.4 / 1.0625),
    );
    // bristles: 4 N/m per micrometre and 2 N/m per mm/s up to 400 N/m
    let bristles = Law::ElasticPlastic(BRISTLES);
    near(force(&bristles, 0.0, 5.0e-5), 200.0);
    near(force(&bristles, 0.01, 5.0e-5), 220.0);
    near(force(&bristles, 0.0, 5.0e-3), 400.0);
    near(BRISTLES.elastic_limit(500.0).expect("memory"), 1.0e-4);
}

/// Coulomb's law is the Stribeck curve without a drop: the same products in another order.
#[test]
fn stribeck_without_a_drop_is_coulomb() {
    let flat = Law::Stribeck(Stribeck {
        static_coefficient: 0.6,
        sliding_coefficient: 0.6,
        ..STRIBECK
    });
    for v in VELOCITIES {
        let (a, b) = (
            at(&flat, v, 0.0, 70.0),
            at(&Law::Coulomb(COULOMB), v, 0.0, 70.0),
        );
        assert!((a.force - b.force).abs() <= 1.0e-14 * b.force.abs());
        assert!((a.by_velocity - b.by_velocity).abs() <= 1.0e-14 * b.by_velocity.abs());
    }
}
