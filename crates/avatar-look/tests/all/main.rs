//! Tests of avatar-look as its users see it, in one binary.

mod energy;
mod environment;
mod materials;
mod tone;
