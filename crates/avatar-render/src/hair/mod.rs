//! Hair: strands grow on the deformed skin in every frame, swing, and are drawn.

pub(crate) mod detail;
pub(crate) mod error;
pub(crate) mod grower;
pub(crate) mod layouts;
pub(crate) mod model;
pub(crate) mod pipelines;
pub(crate) mod programs;
pub(crate) mod state;
pub(crate) mod swing;
pub(crate) mod targets;
pub(crate) mod uniforms;
