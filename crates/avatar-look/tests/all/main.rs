//! Tests of avatar-look as its users see it, in one binary.

mod colors;
mod energy;
mod environment;
mod materials;
mod tone;
mod wrinkles;
