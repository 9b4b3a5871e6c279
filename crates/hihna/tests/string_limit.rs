//! The belt of finite elements tends to the extensible string (`docs/src/studies/string_limit.md`).
//!
//! `examples/towards_the_string.toml` has little bending, stiff pulleys and a steep creep slope. By the
//! study's table 120 elements leave less than half a percent in the tensions, and the creep slope a quarter
//! of a thousandth in the speed. The bounds are 1 % and 0.5 thousandths: a belt without stretch would
//! miss the speed by 0.6 thousandths.

use hihna::simulate::{Flow, simulate};
use hihna::steady::drive_string::DriveString;
use hihna::steady::string::{Answer, Closure, Model};
use hihna::summary::Summary;

#[test]
fn the_belt_beam_tends_to_the_string() {
    let text = include_str!("../../../examples/towards_the_string.toml");
    let drive = hihna::input::parse("towards_the_string.toml", text, &[]).expect("a valid drive");
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    assert!(outcome.audit.passed(), "{:?}", outcome.audit);
    let means = Summary::new(&drive, &outcome).steady;

    let string = DriveString::new(&drive, Model::Full, Closure::UnstretchedLength)
        .expect("a drive that the theory takes");
    let Ok(Answer::Running(running)) = string.solve() else {
        panic!("the string does not run");
    };
    for (pulley, (name, found)) in string.pulleys(&running).iter().zip(&means.pulley.0) {
        assert_eq!(&pulley.name, name);
        let off = found.speed / pulley.speed - 1.0;
        assert!(off.abs() < 5.0e-4, "{name}: speed off by {off:.1e}");
    }
    for (span, (name, found)) in string.spans(&running).iter().zip(&means.span.0) {
        assert_eq!(&span.name, name);
        let off = found.tension / span.tension - 1.0;
        assert!(off.abs() < 0.01, "{name}: tension off by {off:.1e}");
    }
}
