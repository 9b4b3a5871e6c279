//! Frames: the moving belt at equal intervals of time, for eyes.

use crate::drive::Drive;
use crate::simulate::nominal_speed;

/// Frames that are chosen where the user names no interval.
const COUNT: f64 = 240.0;

/// Turn of the smallest pulley between frames [rad]: the eye follows a mark that moves by less than
/// half a radian, whereas one that jumps by half a turn seems to go both ways.
const TURN: f64 = 0.25;

/// Gives a drive without frames 240 of them: over the whole run if the eye can follow the pulleys then,
/// else over as much of its end as it can. An interval of the user's stays.
pub fn choose(drive: &mut Drive) {
    if drive.run.frame_interval.is_some() {
        return;
    }
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    let end = drive.run.end_time;
    let duration = end - drive.run.frame_start;
    let interval = (duration / COUNT).min(2.0 * TURN * smallest / nominal_speed(drive));
    if interval * COUNT < duration {
        // Too fast for the whole run: its end, at a turn that is easy to follow.
        let interval = 0.5 * interval;
        drive.run.frame_interval = Some(interval);
        drive.run.frame_start = end - COUNT * interval;
    } else {
        drive.run.frame_interval = Some(interval);
    }
}
