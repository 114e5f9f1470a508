//! What tests share.
#![allow(dead_code, unreachable_pub, reason = "which readers are built in decides what of it is used")]

pub mod damage;
pub mod data;
#[cfg(feature = "gltf")]
pub mod gltf;
pub mod random;
pub mod texts;
