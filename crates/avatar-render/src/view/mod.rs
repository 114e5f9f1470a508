//! What all passes that draw share: camera, light, shading, shadow maps, tables, and their bindings.

pub(crate) mod camera;
pub(crate) mod config;
pub(crate) mod environment;
pub(crate) mod inputs;
pub(crate) mod lamps;
pub(crate) mod pores;
pub(crate) mod resources;
pub(crate) mod scene;
pub(crate) mod seen;
pub(crate) mod shaders;
pub(crate) mod shading;
pub(crate) mod shadows;
pub(crate) mod uniforms;
