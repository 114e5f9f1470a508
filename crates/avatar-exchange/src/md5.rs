//! Meshes and animations of id Tech 4.
