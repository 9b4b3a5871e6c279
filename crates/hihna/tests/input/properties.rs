//! Properties of reading and writing drives: what is written reads back bit for bit, and no text panics.

use hihna::drive::{
    AutoStep, Belt, BeltElement, Contact, Displacement, Drive, Friction, FrictionDirections,
    Harmonic, Integration, Integrator, Joint, PlateBending, Pulley, Run, SlipAt, Start, Step,
    Surface, Until, Wrap,
};
use hihna::input::{self, Override};
use hihna::layout::Layout;
use hihna::load::Load;
use hihna::profile::{Profile, Varying};
use proptest::prelude::*;

use super::EXAMPLE;

/// Positive numbers of any size that leave room for products.
fn positive() -> impl Strategy<Value = f64> {
    (0.1_f64..10.0, -30_i32..30).prop_map(|(digits, exponent)| digits * 10.0_f64.powi(exponent))
}

fn any_sign() -> impl Strategy<Value = f64> {
    (positive(), any::<bool>()).prop_map(|(value, negative)| if negative { -value } else { value })
}

fn profile() -> impl Strategy<Value = Profile> {
    let change = || (any_sign(), any_sign(), -1.0..1.0, 0.1..2.0);
    prop_oneof![
        any_sign().prop_map(Profile::Constant),
        change().prop_map(|(from, to, start, duration)| {
            Profile::Varying(Varying::Ramp {
                from,
                to,
                start,
                end: start + duration,
            })
        }),
        change().prop_map(|(from, to, start, duration)| {
            Profile::Varying(Varying::HalfCosine {
                from,
                to,
                start,
                end: start + duration,
            })
        }),
        prop::collection::vec((0.01..1.0, any_sign()), 1..5).prop_map(|steps| {
            let mut time = 0.0;
            let (time, value) = steps
                .into_iter()
                .map(|(step, value)| {
                    time += step;
                    (time, value)
                })
                .unzip();
            Profile::Varying(Varying::Table { time, value })
        }),
    ]
}

fn belt() -> impl Strategy<Value = Belt> {
    let sizes = (
        positive(),
        positive(),
        positive(),
        positive(),
        positive(),
        positive(),
    );
    (
        3_usize..1000,
        0..3,
        sizes,
        -0.99..0.49,
        positive(),
        any_sign(),
    )
        .prop_map(
            |(
                elements,
                tightness,
                (tight, width, thickness, density, youngs_modulus, factor),
                poisson_ratio,
                damping_time,
                first_node,
            )| Belt {
                element: BeltElement::BeltBeam,
                elements,
                elements_across: 1,
                bending: PlateBending::Standard,
                length: (tightness == 0).then_some(tight),
                tension: (tightness == 1).then_some(tight),
                strain: (tightness == 2).then_some(tight),
                width,
                thickness,
                density,
                youngs_modulus,
                poisson_ratio,
                axial_factor: factor,
                bending_factor: width,
                torsion_factor: 1.0,
                flank_angle: None,
                damping_time,
                joint: if elements % 2 == 0 {
                    Joint::Shared
                } else {
                    Joint::Multipliers
                },
                first_node,
            },
        )
}

fn contact() -> impl Strategy<Value = Contact> {
    (
        positive(),
        positive(),
        positive(),
        positive(),
        1_usize..20,
        any::<bool>(),
    )
        .prop_map(
            |(stiffness, damping, coefficient, second, points, flag)| Contact {
                stiffness,
                damping,
                friction: friction(points, coefficient, second),
                back_friction: flag.then(|| friction(points + 1, second, coefficient)),
                surface: if flag {
                    Surface::Face
                } else {
                    Surface::CentreLine
                },
                points,
                points_across: 3,
                integration: if flag {
                    Integration::Trapezoidal
                } else {
                    Integration::Gauss
                },
                friction_directions: FrictionDirections::Circumferential,
                slip_at: if flag { SlipAt::Depth } else { SlipAt::Surface },
                clamp_normal_force: flag,
            },
        )
}

/// One law after the other, by `kind`.
fn friction(kind: usize, coefficient: f64, second: f64) -> Friction {
    match kind % 4 {
        0 => Friction::CreepRate {
            coefficient,
            slope: second,
        },
        1 => Friction::Coulomb {
            coefficient,
            velocity: second,
        },
        2 => Friction::Stribeck {
            static_coefficient: coefficient,
            sliding_coefficient: 0.5 * coefficient,
            stribeck_velocity: second,
            velocity: 0.1 * second,
        },
        _ => Friction::ElasticPlastic {
            coefficient,
            stiffness: second,
            damping: coefficient,
        },
    }
}

/// Pulleys on a circle so that each is a corner of the belt's path, each with its own motion; the belt
/// around two may be crossed.
fn pulleys() -> impl Strategy<Value = Vec<Pulley>> {
    let pulley = (0.01..1.0, profile(), positive(), any::<bool>());
    (prop::collection::vec(pulley, 2..6), any::<bool>()).prop_map(|(pulleys, crossed)| {
        let count = pulleys.len();
        let pulleys = pulleys.into_iter().enumerate();
        pulleys
            .map(|(i, (radius, profile, inertia, flag))| {
                let angle = std::f64::consts::TAU * i as f64 / count as f64;
                Pulley {
                    name: format!("pulley_{i}"),
                    center: [10.0 * angle.cos(), 10.0 * angle.sin()],
                    radius,
                    displacement: flag.then_some(Displacement {
                        x: Profile::Varying(Varying::HalfCosine {
                            from: 0.0,
                            to: radius,
                            start: 0.0,
                            end: inertia,
                        }),
                        y: Profile::Constant(0.0),
                        z: Profile::Constant(0.0),
                    }),
                    offset: 0.0,
                    tilt: [0.0; 2],
                    taper: 0.0,
                    crown: None,
                    wrap: if crossed && count == 2 && i == 1 {
                        Wrap::Outside
                    } else {
                        Wrap::Inside
                    },
                    speed: (i == 0 && flag).then(|| profile.clone()),
                    angle: (i == 0 && !flag).then(|| profile.clone()),
                    inertia,
                    groove_angle: flag.then_some(0.5 + radius),
                    load: (i > 0 && flag).then_some(Load::Fan {
                        torque: inertia,
                        speed: inertia,
                    }),
                    irregularity: if i == 0 && flag {
                        vec![Harmonic {
                            order: 2.0,
                            amplitude: radius,
                            phase: 0.1,
                        }]
                    } else {
                        Vec::new()
                    },
                    torque: if i == 0 {
                        Profile::Constant(0.0)
                    } else {
                        profile
                    },
                }
            })
            .collect()
    })
}

/// Makes the belt as tight as a mounted belt can be: `strain` from 0 to 1, given in one of three ways.
fn tighten(belt: &mut Belt, pulleys: &[Pulley], strain: f64) {
    if belt.length.is_some() {
        belt.length = Layout::new(pulleys)
            .ok()
            .map(|layout| layout.length / (1.0 + strain));
    } else if belt.tension.is_some() {
        belt.tension =
            Some(strain * belt.axial_factor * belt.youngs_modulus * belt.width * belt.thickness);
    } else {
        belt.strain = Some(strain);
    }
}

fn run() -> impl Strategy<Value = Run> {
    (positive(), 0.001..1.0, 1e-9..0.1, any::<bool>(), 0.0..1.0).prop_map(
        |(end_time, part, accuracy, flag, when)| Run {
            end_time,
            output_interval: end_time * part,
            accuracy,
            step: if flag {
                Step::Fixed(end_time * part)
            } else {
                Step::Named(AutoStep::Auto)
            },
            integrator: if flag {
                Integrator::TrBdf2
            } else {
                Integrator::GeneralizedAlpha
            },
            start: if flag { Start::Steady } else { Start::Rest },
            until: if flag { Until::End } else { Until::Steady },
            profile_times: if flag {
                vec![end_time * when, end_time]
            } else {
                Vec::new()
            },
            profile_line: Run::default().profile_line,
            frame_interval: flag.then_some(end_time * part),
            frame_start: if flag { end_time * when } else { 0.0 },
        },
    )
}

fn drive() -> impl Strategy<Value = Drive> {
    (
        "\\PC{0,20}",
        belt(),
        contact(),
        pulleys(),
        any_sign(),
        run(),
        0.001..0.999,
    )
        .prop_map(|(title, mut belt, contact, pulley, gravity, run, strain)| {
            // The path of a thin belt's centre line is that around the pulleys, to a part in a thousand.
            if contact.surface == Surface::Face {
                belt.thickness = 1.0e-6;
            }
            let smallest = pulley.iter().fold(f64::INFINITY, |r, p| r.min(p.radius));
            belt.thickness = belt.thickness.min(smallest);
            tighten(&mut belt, &pulley, 0.99 * strain);
            // An element turns by less than half a turn around the smallest pulley.
            let path = Layout::new(&pulley).map_or(0.0, |layout| layout.length);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a positive count of some thousands"
            )]
            let needed = (path / smallest).ceil() as usize;
            belt.elements += needed;
            Drive {
                steady: hihna::drive::Steady::default(),
                title,
                gravity: [0.0, gravity],
                belt,
                contact,
                pulley,
                run,
            }
        })
}

/// A drive with its numbers as bits, in which even zeros of different sign differ.
fn bits(drive: &Drive) -> String {
    format!("{drive:?}")
}

proptest! {
    /// `Debug` of a float is its shortest text that reads back, so equal text is equal bits.
    #[test]
    fn what_is_written_reads_back_bit_for_bit(drive in drive()) {
        let text = input::to_toml(&drive);
        match input::parse("written", &text, &[]) {
            Ok(read) => prop_assert_eq!(bits(&read), bits(&drive)),
            Err(errors) => prop_assert!(false, "{}\n{}", errors, text),
        }
    }

    /// Characters of the example replaced by others that mean something in TOML, or by anything.
    #[test]
    fn no_change_of_the_example_panics(
        changes in prop::collection::vec((0..EXAMPLE.len(), 0_usize..12, "[\\[\\]{}=\"'.,#0-9a-z\\-+é\n µ²]{0,3}|\\PC{0,3}"), 1..12)
    ) {
        let mut text = EXAMPLE.to_owned();
        for (at, length, new) in changes {
            let start = text.floor_char_boundary(at.min(text.len()));
            let end = text.floor_char_boundary((start + length).min(text.len()));
            text.replace_range(start..end, &new);
        }
        if let Err(errors) = input::parse("changed", &text, &[]) {
            prop_assert!(!errors.to_string().is_empty());
        }
    }

    /// Values of the example replaced by values of any other kind.
    #[test]
    fn no_value_panics(
        line in 0..EXAMPLE.lines().count(),
        value in prop_oneof![
            Just("[]".to_owned()), Just("{}".to_owned()), Just("[[{}], {a=[1, {}]}]".to_owned()), Just("-0".to_owned()),
            Just("99999999999999999999".to_owned()), Just("-1e-400".to_owned()), Just("0xffff_ffff_ffff_ffff_ffff".to_owned()), Just("1_000.0".to_owned()),
            Just("{ kind = 1 }".to_owned()), Just("{ kind = \"table\", time = [[]], value = {} }".to_owned()),
            Just("1979-05-27T07:32:00Z".to_owned()), "\"\\PC{0,8}\"",
        ],
    ) {
        let lines = EXAMPLE.lines().enumerate().map(|(i, text)| match text.split_once('=') {
            Some((key, _)) if i == line => format!("{key}= {value}"),
            _ => text.to_owned(),
        });
        let text = lines.collect::<Vec<_>>().join("\n");
        let _ = input::parse("changed", &text, &[]);
    }

    #[test]
    fn no_override_panics(
        key in prop_oneof![Just("pulley.driver.speed"), Just("belt"), Just("pulley.1"), Just("contact.friction.law"), Just("pulley"), Just("run.step")],
        value in "\\PC{0,12}|[\\[\\]{}=\"'.,#0-9a-z\\-+µ² ]{0,12}",
        any_text in "\\PC{0,12}",
    ) {
        for text in [format!("{key}={value}"), any_text] {
            if let Ok(change) = text.parse::<Override>() {
                let _ = input::parse("example", EXAMPLE, &[change]);
            }
        }
    }
}
