#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs the add-on's archive in Blender, imports a case, changes it and exports it.

check_blender.py LUMEN [PICTURE.png]. Ends with 77 where there is no Blender. Blender runs this file again, inside of itself."""
import json, math, os, pathlib, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCALE = 0.001


def outside(lumen, picture):
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: blender is missing (apt install blender)")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run = lambda *words: subprocess.run([str(w) for w in words], cwd=folder, check=True, capture_output=True, text=True, timeout=300)
        run(lumen, "phantom", "bifurcation", "fork.nrrd", "--size", "48", "--seeds", "seeds.json")
        run(lumen, "convert", "fork.nrrd", "fork.lumen", "--seeds", "seeds.json")
        run(lumen, "convert", "fork.lumen", "fork.lumen.json")
        run("bash", ROOT / "packages/blender/build.sh", folder)
        archive = next(folder.glob("lumen-blender-*.zip"))
        version = tuple(map(int, archive.stem.split("-")[-1].split(".")))
        environment = {**os.environ, "LUMEN": lumen, "BLENDER_USER_SCRIPTS": str(folder / "scripts"), "BLENDER_USER_CONFIG": str(folder / "config"),
                       "HOME": name}
        inner = subprocess.run([blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", __file__, "--",
                                "inside", str(archive), json.dumps(version), str(picture or "")],
                               cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
        if inner.returncode != 0 or "all held" not in inner.stdout:
            print(inner.stdout[-3000:], inner.stderr[-3000:])
            return 1
        for exported in ("curves.lumen", "surface.lumen"):
            answer = json.loads(run(lumen, "info", exported, "--json", "--quiet").stdout)
            check(len(answer["branches"]) == 2 and answer["blobs"] > 0, f"{exported}: {answer}")
        check_exported(run, lumen, folder)
    print("Blender: all held")
    return 0


def check(holds, what):
    if not holds: raise AssertionError(what)


def tree_of(run, lumen, folder, name):
    run(lumen, "convert", name, "read.lumen.json")
    return json.loads((folder / "read.lumen.json").read_text())["tree"]


def check_exported(run, lumen, folder):
    """Nodes lie on the course of the imported case, but for the radius and the vessel that were changed in Blender."""
    before, after = (tree_of(run, lumen, folder, name) for name in ("fork.lumen", "curves.lumen"))
    check({b["label"] for b in before["branches"]} == {b["label"] for b in after["branches"]}, "labels went")
    near = lambda at: min(math.dist(at, other) for other in before["centre"])
    check(max(map(near, after["centre"])) < 0.3, f"a node lies {max(map(near, after['centre']))} mm from the course")
    check(max(after["radius"]) > 1.8 * max(before["radius"]), "the radius that was doubled in Blender is not")
    surface = tree_of(run, lumen, folder, "surface.lumen")
    off = sorted(map(near, surface["centre"]))
    check(off[len(off) // 2] < 0.1, f"half of the nodes of the surface's case lie {off[len(off) // 2]} mm from the course")


def inside(archive, version, picture):
    import bpy
    from mathutils import Vector
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_install(filepath=archive)
    bpy.ops.preferences.addon_enable(module="lumen_blender")
    import lumen_blender
    check(lumen_blender.bl_info["version"] == tuple(json.loads(version)), f"the add-on's version is {lumen_blender.bl_info['version']}")
    check(bpy.ops.import_scene.lumen(filepath="fork.lumen", scale=SCALE) == {"FINISHED"}, "the import was cancelled")
    case = json.loads(pathlib.Path("fork.lumen.json").read_text())
    objects = list(bpy.data.collections["fork"].all_objects)
    curves = {each.name: each for each in objects if each.type == "CURVE"}
    check(sorted(curves) == sorted(b["label"] for b in case["tree"]["branches"]), f"curves are {sorted(curves)}")
    root = case["tree"]["branches"][0]
    points = curves[root["label"]].data.splines[0].points
    check(len(points) == root["nodeCount"], f"{len(points)} points of {root['nodeCount']} nodes")
    check(math.dist(points[3].co.xyz, [SCALE * x for x in case["tree"]["centre"][3]]) < 1e-7, "a point lies elsewhere")
    check(abs(points[3].radius - case["tree"]["radius"][3]) < 1e-6, "a radius is another")
    ends = {each.name: each for each in objects if each.type == "EMPTY" and each.get("lumen_part") == "end"}
    check("inlet" in ends and any(name.startswith("outlet") for name in ends), f"ends are {sorted(ends)}")
    apart = math.dist(ends["inlet"].matrix_world.translation, points[0].co.xyz) / SCALE
    check(apart < 1, f"the inlet lies {apart} mm from the root's first node")
    mesh = next(each for each in objects if each.type == "MESH")
    out = ends["inlet"].matrix_world.to_quaternion() @ Vector((0, 0, 1))
    along = case["tree"]["direction"][0]
    check(sum(a * b for a, b in zip(out, along)) < -0.9, f"the inlet points to {out}, the vessel to {along}")
    nearest = [min(math.dist(mesh.matrix_world @ v.co, [SCALE * x for x in c]) for c in case["tree"]["centre"]) / SCALE for v in list(mesh.data.vertices)[::29]]
    check(0.2 < min(nearest) and max(nearest) < 2, f"the surface lies {min(nearest)} to {max(nearest)} mm from the nodes")
    if picture: draw(picture, mesh, curves)
    for words in ({"filepath": "surface.lumen", "source": "SURFACE"}, {"filepath": "curves.lumen", "source": "CURVES"}):
        if words["source"] == "CURVES": points[10].radius *= 2
        check(bpy.ops.export_scene.lumen(scale=SCALE, **words) == {"FINISHED"}, f"{words} was cancelled")
    try:
        bpy.ops.import_scene.lumen(filepath="none.lumen")
        check(False, "a missing file is taken")
    except RuntimeError as error:
        check("none.lumen" in str(error), f"the message for a missing file is {error}")
    bpy.ops.preferences.addon_disable(module="lumen_blender")
    print("all held")


def draw(picture, mesh, curves):
    """The surface, seen through, with the curves within and the camera in front of the patient."""
    import bpy
    from mathutils import Vector
    glass = bpy.data.materials.new("glass")
    glass.use_nodes = True
    shader = glass.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value, shader.inputs["Alpha"].default_value = (0.9, 0.5, 0.45, 1), 0.35
    mesh.data.materials.clear()
    mesh.data.materials.append(glass)
    for curve in curves.values(): curve.data.bevel_depth *= 0.3
    corners = [mesh.matrix_world @ Vector(corner) for corner in mesh.bound_box]
    middle = sum(corners, Vector()) / 8
    scene, size = bpy.context.scene, max((corner - middle).length for corner in corners)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.clip_start = size / 100
    camera.location = middle + Vector((0.6, -0.4, 2.6)) * size
    camera.rotation_euler = (middle - camera.location).to_track_quat("-Z", "Y").to_euler()
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "SUN"))
    lamp.data.energy, lamp.rotation_euler = 4, camera.rotation_euler
    for each in (camera, lamp): scene.collection.objects.link(each)
    scene.camera, scene.render.engine, scene.cycles.samples, scene.cycles.device = camera, "CYCLES", 24, "CPU"
    scene.cycles.use_denoising = False
    world = bpy.data.worlds.new("world")
    world.color = (0.5, 0.5, 0.55)
    scene.world = world
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 640, 480, picture
    bpy.ops.render.render(write_still=True)
    for curve in curves.values(): curve.data.bevel_depth /= 0.3


if "--" in sys.argv and "inside" in sys.argv:
    inside(*sys.argv[sys.argv.index("inside") + 1:])
elif __name__ == "__main__":
    if len(sys.argv) not in (2, 3): sys.exit(__doc__)
    sys.exit(outside(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) == 3 else None))
