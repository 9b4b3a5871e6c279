//! Belt drives: what the user states, made into a mechanical system, and what the user wants to know.

pub mod drive;
pub mod layout;
pub mod profile;
pub mod steady;
