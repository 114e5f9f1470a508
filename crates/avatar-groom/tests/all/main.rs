//! Tests of avatar-groom as its users see it, in one binary.

mod field;
mod hair_toml;
mod roots;
mod swing;
