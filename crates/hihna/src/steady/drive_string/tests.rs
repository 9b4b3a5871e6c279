//! Drives in, names and signs out.

use super::*;
use crate::drive::{
    Belt, BeltElement, Contact, Friction, FrictionDirections, Integration, Joint, PlateBending,
    Run, SlipAt, Surface, Wrap,
};
use crate::steady::string::Running;

/// The closure is solved to 1e-12; sums of a dozen terms.
const ROUND_OFF: f64 = 1.0e-10;

fn pulley(name: &str, center: [f64; 2], radius: f64) -> Pulley {
    Pulley {
        name: name.into(),
        center,
        radius,
        wrap: Wrap::Inside,
        speed: None,
        angle: None,
        inertia: 0.0,
        torque: Profile::Constant(0.0),
        load: None,
        irregularity: Vec::new(),
        groove_angle: None,
        displacement: None,
        offset: 0.0,
        tilt: [0.0; 2],
        taper: 0.0,
        crown: None,
    }
}

fn drive(tension: f64, youngs_modulus: f64, pulley: Vec<Pulley>) -> Drive {
    Drive {
        steady: crate::drive::Steady::default(),
        title: String::new(),
        belt: Belt {
            element: BeltElement::BeltBeam,
            elements: 20,
            elements_across: 1,
            bending: PlateBending::Standard,
            length: None,
            tension: Some(tension),
            strain: None,
            width: 0.04,
            thickness: 0.003,
            density: 166.667,
            youngs_modulus,
            poisson_ratio: 0.3,
            axial_factor: 1.0,
            bending_factor: 1.0,
            torsion_factor: 1.0,
            flank_angle: None,
            damping_time: 0.0,
            joint: Joint::Shared,
            first_node: 0.0,
        },
        contact: Contact {
            stiffness: 1.0e7,
            damping: 0.0,
            friction: Friction::CreepRate {
                coefficient: 0.6,
                slope: 1.0e5,
            },
            back_friction: None,
            surface: Surface::CentreLine,
            points: 7,
            points_across: 3,
            integration: Integration::Gauss,
            friction_directions: FrictionDirections::Circumferential,
            slip_at: SlipAt::Surface,
            clamp_normal_force: false,
        },
        pulley,
        gravity: [0.0; 2],
        run: Run::default(),
    }
}

/// Model 2 of Kerkkänen (2006), Table 4.1: EA = 200 N, spans pi R, the load a half cosine up to 2 N m.
fn model_2() -> Drive {
    let half = 0.025 * std::f64::consts::PI;
    let mut driver = pulley("driver", [-half, 0.0], 0.05);
    driver.speed = Some(Profile::Constant(500.0));
    let mut driven = pulley("driven", [half, 0.0], 0.05);
    driven.torque = Profile::Varying(Varying::HalfCosine {
        from: 0.0,
        to: -2.0,
        start: 0.05,
        end: 1.0,
    });
    drive(50.0, 1.666_67e6, vec![driver, driven])
}

/// Crank, alternator with a back-side idler before it, pump; listed clockwise.
fn serpentine() -> Drive {
    let mut crank = pulley("crank", [0.0, 0.0], 0.07);
    crank.speed = Some(Profile::Constant(300.0));
    let mut pump = pulley("pump", [-0.05, 0.3], 0.05);
    pump.torque = Profile::Constant(-4.0);
    let mut idler = pulley("idler", [0.08, 0.22], 0.03);
    idler.wrap = Wrap::Outside;
    let mut alternator = pulley("alternator", [0.25, 0.2], 0.03);
    alternator.torque = Profile::Constant(-2.0);
    drive(300.0, 3.0e8, vec![crank, pump, idler, alternator])
}

fn runs(prepared: &DriveString) -> Running {
    match prepared.solve().unwrap() {
        Answer::Running(running) => running,
        other => panic!("does not run: {other:?}"),
    }
}

fn full(drive: &Drive) -> DriveString {
    DriveString::new(drive, Model::Full, Closure::UnstretchedLength).unwrap()
}

/// All torques and speeds negated: the drive run backwards.
fn backwards(drive: &Drive) -> Drive {
    let mut drive = drive.clone();
    let negate = |profile: &Profile| Profile::Constant(-final_value(profile));
    for pulley in &mut drive.pulley {
        pulley.speed = pulley.speed.as_ref().map(negate);
        pulley.torque = negate(&pulley.torque);
    }
    drive
}

fn mirrored(drive: &Drive) -> Drive {
    let mut drive = backwards(drive);
    for pulley in &mut drive.pulley {
        pulley.center[1] *= -1.0;
    }
    drive
}

/// The speed loss printed for Model 2, and the tight span: the driver at the left turns
/// counter-clockwise, so the upper span runs towards it (THEORY 2.2): in belt order that is
/// "driven-driver".
#[test]
fn model_2_from_a_drive_file() {
    let prepared = full(&model_2());
    let running = runs(&prepared);
    let (pulleys, spans) = (prepared.pulleys(&running), prepared.spans(&running));
    assert!((pulleys[1].speed_loss - 0.1516).abs() < 0.5e-4);
    assert!((pulleys[1].external_torque + 2.0).abs() < ROUND_OFF);
    assert!((pulleys[1].torque - 2.0).abs() < ROUND_OFF);
    assert!(pulleys[0].external_torque > 0.0 && pulleys[0].speed > 0.0);
    assert_eq!(spans[1].name, "driven-driver");
    assert!(spans[1].tension > spans[0].tension);
    assert!(pulleys[0].hub_force[0] > 0.0);
}

/// Mirrored in the x axis and run backwards: the same tensions, mirrored hub forces, opposite
/// speeds and torques.
#[test]
fn a_mirrored_drive_gives_the_mirrored_answer() {
    for drive in [model_2(), serpentine()] {
        let (here, there) = (full(&drive), full(&mirrored(&drive)));
        let (a, b) = (runs(&here), runs(&there));
        for (p, q) in here.pulleys(&a).iter().zip(&there.pulleys(&b)) {
            assert!((p.speed + q.speed).abs() < ROUND_OFF * p.speed.abs());
            assert!((p.torque + q.torque).abs() < ROUND_OFF * 10.0);
            assert!((p.slip_angle - q.slip_angle).abs() < ROUND_OFF * 10.0);
        }
        // Two pulleys keep their sense of listing, so their spans change places.
        let hub = |p: &[PulleySummary]| p.iter().map(|p| p.hub_force).collect::<Vec<_>>();
        for (p, q) in hub(&here.pulleys(&a)).iter().zip(hub(&there.pulleys(&b))) {
            assert!((p[0] - q[0]).abs() < 1.0e-8 && (p[1] + q[1]).abs() < 1.0e-8);
        }
    }
}

/// The belt is in steady motion on a closed path: forces and moments of the pulleys on it sum to
/// zero, run either way.
#[test]
fn hub_forces_and_torques_balance() {
    for drive in [model_2(), serpentine(), backwards(&serpentine())] {
        let prepared = full(&drive);
        let running = runs(&prepared);
        let (mut force, mut moment) = ([0.0; 2], 0.0);
        for (p, at) in prepared.pulleys(&running).iter().zip(&drive.pulley) {
            force = [force[0] + p.hub_force[0], force[1] + p.hub_force[1]];
            moment += at.center[0] * p.hub_force[1] - at.center[1] * p.hub_force[0] + p.torque;
        }
        assert!(
            force[0].abs() < 1.0e-9 && force[1].abs() < 1.0e-9,
            "{force:?}"
        );
        assert!(moment.abs() < 1.0e-9, "{moment}");
    }
}

/// The rows of the profile: the material coordinate grows from zero to the unstretched length,
/// friction integrates to the pulleys' torques, positions to the path. Trapezoid rule with 4000
/// rows on zones of some 100 rows: 1e-5.
#[test]
fn profile_rows_integrate_to_the_torques() {
    for drive in [
        model_2(),
        serpentine(),
        backwards(&serpentine()),
        backwards(&model_2()),
    ] {
        let prepared = full(&drive);
        let running = runs(&prepared);
        let rows = prepared.profile(&running, 4000);
        assert!(rows[0].material_coordinate.abs() < ROUND_OFF);
        let last = rows[rows.len() - 1].material_coordinate;
        assert!((last - running.unstretched_length).abs() < ROUND_OFF);
        let mut torques = vec![0.0; drive.pulley.len()];
        for pair in rows.windows(2) {
            let step = pair[1].material_coordinate - pair[0].material_coordinate;
            assert!(step >= -1.0e-15);
            let moved = (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y);
            let stretch = 0.5 * (pair[0].jacobian + pair[1].jacobian);
            assert!((moved - step * stretch).abs() < 1.0e-7);
            let on = drive.pulley.iter().position(|p| p.name == pair[0].pulley);
            if let (Some(i), true) = (on, pair[0].pulley == pair[1].pulley) {
                let friction = 0.5 * (pair[0].friction_force + pair[1].friction_force);
                torques[i] -= drive.pulley[i].radius * friction * step;
                assert!(pair[0].normal_force > 0.0);
            }
            assert!(pair[0].speed * prepared.direction > 0.0);
            // Friction opposes slip.
            assert!(pair[0].friction_force * pair[0].slip_speed <= 1.0e-9);
        }
        for (torque, p) in torques.iter().zip(prepared.pulleys(&running)) {
            assert!(
                (torque - p.torque).abs() < 1.0e-5,
                "{} {torque} {}",
                p.name,
                p.torque
            );
        }
    }
}

#[test]
fn tightness_by_length_tension_or_strain() {
    let by_tension = full(&model_2());
    let mut drive = model_2();
    drive.belt.tension = None;
    drive.belt.strain = Some(50.0 / by_tension.string.axial_stiffness);
    let by_strain = full(&drive);
    drive.belt.strain = None;
    drive.belt.length = Some(runs(&by_tension).unstretched_length);
    let by_length = full(&drive);
    for other in [by_strain, by_length] {
        let (a, b) = (runs(&by_tension), runs(&other));
        assert!((a.spans[0].tension - b.spans[0].tension).abs() < 1.0e-8);
    }
}

#[test]
fn bad_drives_are_named() {
    let refuse = |change: fn(&mut Drive)| {
        let mut drive = model_2();
        change(&mut drive);
        let prepared = DriveString::new(&drive, Model::Full, Closure::UnstretchedLength);
        prepared
            .and_then(|prepared| prepared.solve())
            .unwrap_err()
            .to_string()
    };
    assert!(refuse(|d| d.pulley[0].speed = None).contains("no pulley has a `speed`"));
    let both = refuse(|d| d.pulley[1].speed = Some(Profile::Constant(1.0)));
    assert!(both.contains("\"driver\" and \"driven\""), "{both}");
    assert!(refuse(|d| d.pulley[0].torque = Profile::Constant(1.0)).contains("1 N m"));
    assert!(refuse(|d| d.pulley[0].speed = Some(Profile::Constant(0.0))).contains("\"driver\""));
    assert!(refuse(|d| d.pulley[0].angle = Some(Profile::Constant(0.0))).contains("`angle`"));
    assert!(refuse(|d| d.belt.tension = None).contains("`tension`"));
    assert!(refuse(|d| d.pulley[1].center[0] = 0.0).contains("overlap"));
    let torque = refuse(|d| d.pulley[1].torque = Profile::Constant(f64::NAN));
    assert!(
        torque.contains("torque [N m] of pulley \"driven\""),
        "{torque}"
    );
}

#[test]
fn gross_slip_and_slack_are_explained() {
    let mut drive = model_2();
    drive.pulley[1].torque = Profile::Constant(-8.0);
    let prepared = full(&drive);
    let Answer::GrossSlip(slip) = prepared.solve().unwrap() else {
        panic!("runs")
    };
    let text = prepared.explain_gross_slip(&slip);
    assert!(
        text.contains("wrapped by 180.0") && text.contains("of the given torques"),
        "{text}"
    );
    let prepared = DriveString::new(&drive, Model::Full, Closure::TensionSum).unwrap();
    let Answer::GrossSlip(slip) = prepared.solve().unwrap() else {
        panic!("runs")
    };
    let text = prepared.explain_gross_slip(&slip);
    assert!(text.contains("\"driver-driven\" would go slack"), "{text}");
    drive.belt.tension = Some(5.0);
    let prepared = full(&drive);
    let Answer::Slack(slack) = prepared.solve().unwrap() else {
        panic!("runs")
    };
    assert!(prepared.explain_slack(&slack).contains("5.000000 N"));
}
