//! All tests of this crate in one program. Tests of a reader are compiled where its feature is on, so that
//! `cargo test -p avatar-exchange --no-default-features --features obj` runs those of that reader alone;
//! `cargo test -p avatar-exchange obj::` runs them with all readers built in.
#![allow(
    clippy::disallowed_methods,
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "tests may panic, and use files, the clock and the environment"
)]

mod scene;
mod support;

#[cfg(feature = "bvh")]
mod bvh;
#[cfg(feature = "collada")]
mod collada;
#[cfg(all(
    feature = "gltf",
    feature = "obj",
    feature = "fbx",
    feature = "collada",
    feature = "md5",
    feature = "bvh"
))]
mod documented;
#[cfg(feature = "fbx")]
mod fbx;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(feature = "md5")]
mod md5;
#[cfg(feature = "obj")]
mod obj;
#[cfg(feature = "target")]
mod target;
#[cfg(all(feature = "obj", feature = "fbx", feature = "collada", feature = "md5", feature = "bvh"))]
mod text_end;
#[cfg(feature = "vrm")]
mod vrm;
