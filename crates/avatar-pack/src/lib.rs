//! Avatar packs: rig, meshes, textures, controls and poses from a set of named byte strings.
