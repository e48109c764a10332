# SPDX-License-Identifier: Apache-2.0
"""Curves with radii, or a surface, as a case. Curves go to lumen as those of 3D Slicer, a surface as OBJ, in mm and LPS."""
import json, pathlib, tempfile

from . import program
from .program import Failure


def export_case(context, path, stated, scale, source, selected):
    """Writes the case; a sentence on it. Raises Failure."""
    objects = [each for each in (context.selected_objects if selected else context.scene.objects) if each.visible_get()]
    curves = [each for each in objects if each.type == "CURVE"]
    meshes = [each for each in objects if each.type == "MESH" and (selected or each.get("lumen_part") == "surface")]
    with tempfile.TemporaryDirectory(prefix="lumen-") as name:
        folder = pathlib.Path(name)
        lines = folder / "curves.mrk.json"
        if curves: lines.write_text(json.dumps({"markups": markups_of(curves, scale)}))
        if source == "CURVES":
            if not curves: raise Failure("There is no curve to export")
            program.run(stated, "convert", lines, path, "--unit", "mm", "--frame", "lps")
            return f"{pathlib.Path(path).name}: {len(curves)} curves"
        if not meshes: raise Failure("There is no surface to export: select a mesh, or import one with a case")
        wall = folder / "wall.obj"
        wall.write_text(obj_of(context, meshes, scale))
        known = ["--centerline", lines, "--centerline-unit", "mm", "--centerline-frame", "lps"] if curves else []
        program.run(stated, "convert", wall, path, "--unit", "mm", *known)
        return f"{pathlib.Path(path).name}: {len(meshes)} surfaces"


def points_of(spline):
    """Points of a spline: local positions and radii. Bezier curves give their knots."""
    if spline.type == "BEZIER": return [(point.co, point.radius) for point in spline.bezier_points]
    return [(point.co.xyz, point.radius) for point in spline.points]


def markups_of(curves, scale):
    """A markup of 3D Slicer's for each spline of two points or more."""
    out = []
    for each in curves:
        # a point's radius counts in units of the curve's bevel, which is a millimetre where this add-on has made it
        bevel = (each.data.bevel_depth or scale) / scale * each.matrix_world.median_scale
        for k, spline in enumerate(each.data.splines):
            points = points_of(spline)
            if len(points) < 2: continue
            label = each.get("lumen_label", each.name) + (f"-{k + 1}" if len(each.data.splines) > 1 else "")
            out.append({"type": "Curve", "name": label, "coordinateSystem": "LPS", "coordinateUnits": "mm",
                        "measurements": [{"name": "Radius", "enabled": True, "units": "mm",
                                          "controlPointValues": [radius * bevel for _, radius in points]}],
                        "controlPoints": [{"id": str(i + 1), "position": [x / scale for x in each.matrix_world @ at], "positionStatus": "defined"}
                                          for i, (at, _) in enumerate(points)]})
    if not out: raise Failure("No curve has two points")
    return out


def obj_of(context, meshes, scale):
    """The triangles of all meshes, with their modifiers, in mm."""
    lines, first, graph = [], 1, context.evaluated_depsgraph_get()
    for each in meshes:
        evaluated = each.evaluated_get(graph)
        mesh = evaluated.to_mesh()
        mesh.calc_loop_triangles()
        for vertex in mesh.vertices: lines.append("v " + " ".join(repr(x / scale) for x in each.matrix_world @ vertex.co))
        for triangle in mesh.loop_triangles: lines.append("f " + " ".join(str(first + i) for i in triangle.vertices))
        first += len(mesh.vertices)
        evaluated.to_mesh_clear()
    return "\n".join(lines) + "\n"
