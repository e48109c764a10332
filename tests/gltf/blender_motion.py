# SPDX-License-Identifier: Apache-2.0
"""Run by Blender: blender -b -P blender_motion.py -- FILE.glb OUT.json TIME. Numbers of armatures and actions, and world
positions of the skinned vertices at a time in s."""
import json, sys
import bpy, numpy

numpy.bool = bool  # Debian 12: the importer of Blender 3.4 is older than its NumPy
source, out, time = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source)
scene = bpy.context.scene
frame = float(time) * scene.render.fps / scene.render.fps_base
scene.frame_set(int(frame), subframe=frame - int(frame))
said = {"armatures": len(bpy.data.armatures), "actions": len(bpy.data.actions), "vertices": []}
graph = bpy.context.evaluated_depsgraph_get()
for thing in bpy.data.objects:
    if thing.type != "MESH" or not any(m.type == "ARMATURE" for m in thing.modifiers): continue  # others draw bones
    moved = thing.evaluated_get(graph)
    said["vertices"] += [list(moved.matrix_world @ v.co) for v in moved.to_mesh().vertices]
with open(out, "w") as file: json.dump(said, file)
