//! Meshes of rigged faces: raw buffers, blend shapes, skinning on the CPU, OBJ.
