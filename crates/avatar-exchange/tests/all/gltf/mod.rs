//! glTF and GLB: values computed by hand and by other programs, damaged files, writing.

mod compressed;
mod damaged;
mod expected;
mod extensions;
mod geometry;
mod looks;
mod motion;
mod nodes;
mod speed;
mod write;
