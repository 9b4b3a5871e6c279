//! Belt drives: what the user states, made into a mechanical system, and what the user wants to know.

pub mod assemble;
pub mod contact;
pub mod drive;
pub mod frames;
pub mod free_belt;
pub mod friction;
pub mod history;
pub mod input;
pub mod layout;
pub mod load;
pub mod number;
pub mod observe;
pub mod profile;
pub mod quantities;
pub mod record;
pub mod simulate;
pub mod steady;
pub mod summary;
pub mod units;
pub mod user_laws;
pub mod validate;

/// The Rust code of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
