//! Devices, buffers, textures, bindings, programs and pipelines, for all other modules. Nothing here knows of
//! faces.

pub(crate) mod attachment;
pub(crate) mod bindings;
pub(crate) mod buffers;
pub(crate) mod color;
pub(crate) mod device;
pub(crate) mod identity;
pub(crate) mod image;
pub(crate) mod mips;
pub(crate) mod pipeline;
pub(crate) mod program;
pub(crate) mod readback;
pub(crate) mod ring;
pub(crate) mod texture;
pub(crate) mod vec4_texture;
