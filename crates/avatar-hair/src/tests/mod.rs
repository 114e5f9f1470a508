//! Tests of several modules together; those of one module stand in it.

#![allow(clippy::disallowed_methods, reason = "tests read files and measure")]

mod marsienne;
mod roots;
