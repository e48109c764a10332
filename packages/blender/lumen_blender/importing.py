# SPDX-License-Identifier: Apache-2.0
"""A case as a collection: curves with radii, the surface, the ends as empties. Blender's x, y, z are the patient's left, back and
head (LPS)."""
import json, math, pathlib, tempfile

import bpy
from mathutils import Vector

from . import program

# A colour for each vessel, from light to dark red and orange; linear.
COLOURS = [(0.60, 0.05, 0.04, 1), (0.70, 0.20, 0.05, 1), (0.45, 0.03, 0.10, 1), (0.75, 0.35, 0.15, 1), (0.35, 0.06, 0.05, 1)]
WALL, END = (0.55, 0.08, 0.07, 1), (0.20, 0.01, 0.02, 1)


def import_case(context, path, stated, scale, with_curves, with_surface, edge):
    """The new collection. Raises Failure."""
    path = pathlib.Path(path)
    with tempfile.TemporaryDirectory(prefix="lumen-") as folder:
        text = pathlib.Path(folder) / "case.lumen.json"
        program.run(stated, "convert", path, text)
        case = json.loads(text.read_text())
        name = path.name.removesuffix(".json").removesuffix(".lumen")
        collection = bpy.data.collections.new(name)
        context.scene.collection.children.link(collection)
        if with_curves: add_curves(case["tree"], collection, scale)
        if with_surface and "models" in case: add_surface(path, stated, pathlib.Path(folder), collection, scale, edge)
    return collection


def add_curves(tree, collection, scale):
    """A curve for each branch, from the node that it leaves its parent at. Radii of points are mm."""
    for index, branch in enumerate(tree["branches"]):
        nodes = list(range(branch["firstNode"], branch["firstNode"] + branch["nodeCount"]))
        parent = branch["parentNode"]
        label = tree["branches"][tree["branch"][parent]]["label"] if parent >= 0 else ""
        points = [(tree["centre"][node], tree["radius"][node]) for node in nodes]
        if parent >= 0: points.insert(0, (tree["centre"][parent], tree["radius"][nodes[0]]))
        curve = bpy.data.curves.new(branch["label"], "CURVE")
        curve.dimensions = "3D"
        curve.bevel_depth = scale  # drawn at a radius of 1, so points show their radii in mm
        curve.use_fill_caps = True
        curve.materials.append(material(f"lumen vessel {index % len(COLOURS) + 1}", COLOURS[index % len(COLOURS)]))
        spline = curve.splines.new("POLY")
        spline.points.add(len(points) - 1)
        for point, (centre, radius) in zip(spline.points, points):
            point.co = (*(scale * x for x in centre), 1)
            point.radius = radius
        made = bpy.data.objects.new(branch["label"], curve)
        made["lumen_label"], made["lumen_kind"], made["lumen_parent"] = branch["label"], branch["kind"], label
        collection.objects.link(made)


def read_obj(path):
    """Vertices (mm), triangles, the group of each triangle, and the names of groups, of lumen's OBJ."""
    vertices, triangles, groups, names = [], [], [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if not words: continue
        if words[0] == "v": vertices.append(tuple(map(float, words[1:4])))
        elif words[0] == "g": names.append(" ".join(words[1:]))
        elif words[0] == "f":
            triangles.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
            groups.append(len(names) - 1)
    return vertices, triangles, groups, names


def end_of(vertices, triangles):
    """Centre, direction out of the vessel and radius of a flat face: a disc of its area."""
    area, centre = Vector(), Vector()
    for triangle in triangles:
        a, b, c = (Vector(vertices[i]) for i in triangle)
        normal = (b - a).cross(c - a) / 2
        area += normal
        centre += (a + b + c) / 3 * normal.length
    whole = sum((Vector(vertices[t[1]]) - Vector(vertices[t[0]])).cross(Vector(vertices[t[2]]) - Vector(vertices[t[0]])).length / 2
                for t in triangles)
    return centre / whole, area.normalized(), math.sqrt(whole / math.pi)


def add_surface(path, stated, folder, collection, scale, edge):
    """The closed surface, with a material for its wall and one for its ends, and an empty at each end."""
    wall = folder / "wall.obj"
    program.run(stated, "convert", path, wall, "--edge", edge)
    vertices, triangles, groups, names = read_obj(wall)
    mesh = bpy.data.meshes.new(f"{collection.name} surface")
    mesh.from_pydata([[scale * x for x in vertex] for vertex in vertices], [], triangles)
    mesh.materials.append(material("lumen wall", WALL))
    mesh.materials.append(material("lumen end", END))
    is_wall = [name.split("-")[0] not in ("inlet", "outlet") for name in names]
    mesh.polygons.foreach_set("material_index", [0 if is_wall[group] else 1 for group in groups])
    mesh.polygons.foreach_set("use_smooth", [is_wall[group] for group in groups])
    mesh.update()
    made = bpy.data.objects.new(mesh.name, mesh)
    made["lumen_part"] = "surface"
    collection.objects.link(made)
    for group, name in enumerate(names):
        own = [triangle for triangle, of in zip(triangles, groups) if of == group]
        if not is_wall[group] and own: add_end(name, *end_of(vertices, own), collection, scale)


def add_end(name, centre, direction, radius, collection, scale):
    """An empty whose z axis points out of the vessel."""
    made = bpy.data.objects.new(name, None)
    made.empty_display_type, made.empty_display_size = "SINGLE_ARROW", 4 * radius * scale
    made.location, made.rotation_mode = centre * scale, "QUATERNION"
    made.rotation_quaternion = direction.to_track_quat("Z", "Y")
    made["lumen_part"], made["lumen_radius_mm"] = "end", radius
    collection.objects.link(made)


def material(name, colour):
    found = bpy.data.materials.get(name)
    if found is None:
        found = bpy.data.materials.new(name)
        found.diffuse_color = colour
        found.use_nodes = True
        found.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    return found
