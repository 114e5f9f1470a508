//! glTF and GLB: values computed by hand and by other programs, damaged files, writing.

mod damaged;
mod expected;
mod geometry;
mod motion;
mod speed;
mod write;
