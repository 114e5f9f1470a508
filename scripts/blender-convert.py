"""Run by Blender: reads a GLB and writes it as FBX and COLLADA."""

import sys

import bpy
import numpy

# Debian's numpy is newer than its Blender, whose reader of glTF still uses the old names.
for old in (bool, int, float, object):
    if old.__name__ not in numpy.__dict__:
        setattr(numpy, old.__name__, old)

glb, fbx, dae = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=glb)
bpy.ops.export_scene.fbx(
    filepath=fbx, add_leaf_bones=False, bake_anim=False, apply_scale_options="FBX_SCALE_UNITS"
)
bpy.ops.wm.collada_export(filepath=dae, include_animations=False)
