# SPDX-License-Identifier: Apache-2.0
"""Run by Blender: blender -b -P blender_read.py -- FILE.glb OUT.json. World positions of its mesh and its empties."""
import json, sys
import bpy, numpy

numpy.bool = bool  # Debian 12: the importer of Blender 3.4 is older than its NumPy
source, out = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source)
said = {"vertices": [], "empties": {}, "scales": set()}
for thing in bpy.data.objects:
    said["scales"].update(round(s, 6) for s in thing.matrix_world.to_scale())
    if thing.type == "MESH": said["vertices"] += [list(thing.matrix_world @ v.co) for v in thing.data.vertices]
    if thing.type == "EMPTY": said["empties"][thing.name] = list(thing.matrix_world.translation)
said["scales"] = sorted(said["scales"])
with open(out, "w") as file: json.dump(said, file)
