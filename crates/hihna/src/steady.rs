//! Steady running: what a belt drive settles to, found without stepping through time.

pub mod drive_string;
pub mod profile;
pub mod running;
pub mod string;
