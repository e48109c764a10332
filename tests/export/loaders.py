# SPDX-License-Identifier: Apache-2.0
"""How each target of lumen export reads its folder, brought back to mm, LPS by the unit and frame that the target is
known to have, whatever lumen-export.json says."""
import ctypes, ctypes.util, dataclasses, json, os, pathlib, re, shutil, subprocess, sys, tempfile, time, xml.etree.ElementTree as ET, zipfile
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass
class Found:
    """Positions in mm, LPS."""
    vertices: np.ndarray = None    # of the surface
    centerline: np.ndarray = None  # the tree's nodes, in any order, repeated or not
    ends: dict = dataclasses.field(default_factory=dict)
    faults: list = dataclasses.field(default_factory=list)
    samples: int = 0               # of a grid, which were compared by the loader itself


@dataclasses.dataclass
class Loader:
    """`read(folder)` gives (Found, "") or (None, why it cannot be read here)."""
    read: object
    options: list = dataclasses.field(default_factory=list)  # of lumen export
    surface: list = dataclasses.field(default_factory=list)  # of lumen convert, for the same surface
    ends: list = None  # of lumen convert, for the surface whose ends are named; as `surface`
    has_surface: bool = True


def schema_faults(value, schema):
    try:
        import jsonschema
    except ImportError:
        return []
    errors = jsonschema.Draft202012Validator(json.loads(schema.read_text())).iter_errors(value)
    return [f"lumen-export.json: {error.json_path}: {error.message}" for error in errors]


def ends_of_tree(tree):
    """Ends of landmark.swc: its first point, and the last ones of its two branches."""
    return {"inlet": tree[0], "outlet-b000": tree[48], "outlet-b001": tree[63]}


def farthest(found, expected):
    """The greatest distance of one of `found` from the nearest of `expected`."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticPointLocator
    points, data, locator = vtkPoints(), vtkPolyData(), vtkStaticPointLocator()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(expected, dtype=float)))
    data.SetPoints(points)
    locator.SetDataSet(data)
    nearest = expected[[locator.FindClosestPoint(p) for p in found]]
    return float(np.linalg.norm(found - nearest, axis=1).max(initial=0.0))


def vtk_points(reader, file):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(file))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).astype(float)


def read_vtp(file):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    reader = vtkXMLPolyDataReader()
    points = vtk_points(reader, file)
    data = reader.GetOutput()
    triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    group = vtk_to_numpy(data.GetCellData().GetArray("ModelFaceID")) - 1
    names = data.GetFieldData().GetAbstractArray("GroupNames")
    return points, triangles, group, [names.GetValue(i) for i in range(names.GetNumberOfValues())]


def read_obj(file):
    from vtkmodules.vtkIOGeometry import vtkOBJReader
    return vtk_points(vtkOBJReader(), file)


def read_stl(file):
    from vtkmodules.vtkIOGeometry import vtkSTLReader
    return vtk_points(vtkSTLReader(), file)


def read_pth(folder):
    """As stEVE's VMR: without the first two lines, every <pos>, times ten."""
    points = []
    for file in sorted(folder.glob("*.pth")):
        root = ET.fromstring("\n".join(file.read_text().splitlines()[2:]))
        points += [[10 * float(pos.get(a)) for a in "xyz"] for pos in root.iter("pos")]
    return np.array(points)


def read_markups(file):
    points = {}
    for markup in json.loads(file.read_text())["markups"]:
        flip = {"LPS": [1, 1, 1], "RAS": [-1, -1, 1]}[markup["coordinateSystem"]]
        for point in markup["controlPoints"]:
            points[point.get("label") or str(len(points))] = np.array(point["position"]) * flip
    return points


def read_sofa(folder):
    return Found(vertices=read_obj(folder / "vessel.obj")), ""


def read_steve(folder):
    found = Found(vertices=read_obj(folder / "vessel.obj"), centerline=read_pth(folder / "Paths"))
    scaled = 10 * read_vtp(folder / "Meshes/vessel.vtp")[0]
    if farthest(scaled, found.vertices) > 1e-4: found.faults.append("Meshes/vessel.vtp in cm is not vessel.obj in mm")
    return found, ""


# glTF: metres, y up; z is the front
GLTF_TO_LPS = 1000 * np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)


def read_blender(folder):
    """By Blender's own importer, which turns to z up: then x, y, z are L, P, S."""
    if not shutil.which("blender"): return None, "Blender is not here"
    with tempfile.TemporaryDirectory() as name:
        out = pathlib.Path(name) / "out.json"
        done = subprocess.run(["blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "3", "-P",
                               str(HERE / "blender_read.py"), "--", str(folder / "vessels.glb"), str(out)],
                              capture_output=True, text=True)
        if not out.exists(): return Found(faults=["Blender: " + (done.stdout + done.stderr)[-500:]]), ""
        said = json.loads(out.read_text())
    found = Found(vertices=1000 * np.array(said["vertices"]))
    found.ends = {name: 1000 * np.array(place) for name, place in said["empties"].items() if name != "vessels"}
    if said["scales"] != [1.0]: found.faults.append(f"Blender has scales {said['scales']}, expected 1")
    return found, ""


def read_godot(folder):
    """By the importer of Godot 3's editor, then as the engine has the scene."""
    if not shutil.which("godot3-server"): return None, "godot3-server is not here"
    with tempfile.TemporaryDirectory() as name:
        project = pathlib.Path(name)
        shutil.copy(folder / "vessels.glb", project)
        shutil.copy(HERE / "godot_read.gd", project / "read.gd")
        (project / "project.godot").write_text('config_version=4\n[application]\nconfig/name="landmark"\n')
        environment = {"HOME": name, "PATH": "/usr/bin:/bin", "LANG": "en_US.UTF-8"}
        # the editor of 3.2 imports, but does not end by itself without a display
        editor = subprocess.Popen(["godot3-server", "--path", name, "--editor"], env=environment,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.time() + 300
        while not list((project / ".import").glob("vessels.glb-*.md5")) and time.time() < end and editor.poll() is None:
            time.sleep(0.2)
        editor.kill()
        editor.wait()
        done = subprocess.run(["godot3-server", "--path", name, "-s", "read.gd"], env=environment, capture_output=True,
                              text=True, timeout=300)
    line = next((l for l in done.stdout.splitlines() if l.startswith("{")), None)
    if line is None: return Found(faults=["Godot: " + (done.stdout + done.stderr)[-500:]]), ""
    said = json.loads(line)
    found = Found(vertices=np.array(said["vertices"], float) @ GLTF_TO_LPS.T)
    found.ends = {name: GLTF_TO_LPS @ np.array(place, float) for name, place in said["places"].items()}
    if said["collider_triangles"] != said["triangles"]:
        found.faults.append(f"a collider of {said['collider_triangles']} triangles, expected {said['triangles']}")
    return found, ""


def read_slicer(folder):
    found = Found(vertices=read_vtp(folder / "vessels.vtp")[0])
    scene = ET.parse(folder / "scene.mrml").getroot()
    stored = {node.get("id"): node for node in scene}
    curves = []
    for node in scene:
        if node.get("storageNodeRef") is None: continue
        storage = stored[node.get("storageNodeRef")]
        if storage.get("coordinateSystem") != "LPS": found.faults.append(f"{storage.get('id')} is not LPS")
        if node.get("displayNodeRef") not in stored: found.faults.append(f"{node.get('id')} has no display")
        if not (folder / storage.get("fileName")).exists(): found.faults.append(f"{storage.get('fileName')} is missing")
        elif node.tag == "MarkupsCurve": curves += read_markups(folder / storage.get("fileName")).values()
    found.centerline = np.array(curves)
    found.ends = read_markups(folder / "ends.mrk.json")
    for file in ("vessels.vtp", "ends.mrk.json", "seeds.mrk.json"):
        if not any(node.get("fileName") == file for node in scene): found.faults.append(f"scene.mrml lacks {file}")
    return found, ""


def lib3mf_faults(file):
    """Faults that lib3mf, the reference reader of the 3MF Consortium, reports of a file; none where it is not here."""
    name = ctypes.util.find_library("3MF")
    if name is None: return []
    library, model, reader, found, mesh = ctypes.CDLL(name), *(ctypes.c_void_p() for _ in range(4))
    warnings, count, flag = ctypes.c_uint32(), ctypes.c_uint32(), ctypes.c_int()
    read = (library.lib3mf_createmodel(ctypes.byref(model)) or
            library.lib3mf_model_queryreader(model, b"3mf", ctypes.byref(reader)) or
            library.lib3mf_reader_readfromfileutf8(reader, str(file).encode()) or
            library.lib3mf_reader_getwarningcount(reader, ctypes.byref(warnings)) or
            library.lib3mf_model_getmeshobjects(model, ctypes.byref(found)) or
            library.lib3mf_resourceiterator_movenext(found, ctypes.byref(flag)) or
            library.lib3mf_resourceiterator_getcurrent(found, ctypes.byref(mesh)) or
            library.lib3mf_meshobject_gettrianglecount(mesh, ctypes.byref(count)) or
            library.lib3mf_meshobject_ismanifoldandoriented(mesh, ctypes.byref(flag)))
    if read != 0: return [f"lib3mf refuses {file.name}: {read:#x}"]
    faults = [] if flag.value else [f"lib3mf: {file.name} is not manifold and oriented"]
    if warnings.value: faults.append(f"lib3mf has {warnings.value} warnings about {file.name}")
    return faults + ([] if count.value else [f"lib3mf finds no triangle in {file.name}"])


def read_print(folder):
    """admesh's verdict on the STL; the 3MF by lib3mf, and by its XML, which says its unit."""
    with zipfile.ZipFile(folder / "wall.3mf") as package:
        model = ET.fromstring(package.read("3D/3dmodel.model"))
    space = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    found = Found(vertices=np.array([[float(v.get(a)) for a in "xyz"] for v in model.iterfind(".//m:vertex", space)]))
    if model.get("unit") != "millimeter": found.faults.append("3MF is not in millimetres")
    if len(model.findall(".//m:item", space)) != 1: found.faults.append("3MF builds nothing")
    found.faults += lib3mf_faults(folder / "wall.3mf") + lib3mf_faults(folder / "core.3mf")
    for name in ("wall.stl", "core.stl"):
        if not shutil.which("admesh"): return None, "admesh is not here"
        # admesh prints the header of a binary STL with bytes that follow it
        said = subprocess.run(["admesh", str(folder / name)], capture_output=True, text=True, errors="replace").stdout
        for words in ("Total disconnected facets", "Degenerate facets", "Backwards edges", "Facets reversed"):
            count = re.search(words + r"\s*:\s*(\d+)", said)
            if count is None or int(count[1]) != 0: found.faults.append(f"admesh of {name}: {words} {count and count[1]}")
    return found, ""


def read_engine(scene):
    """Vertices of each mesh geom, and sites, of a scene in MuJoCo, in the world; m, turned to mm."""
    engine = HERE.parent / "mujoco"
    if not shutil.which("node") or not (engine / "node_modules/@mujoco/mujoco").exists():
        return None, "MuJoCo is not here (npm ci in tests/mujoco)"
    done = subprocess.run(["node", str(engine / "read_scene.mjs"), str(scene)], capture_output=True, text=True)
    if done.returncode != 0: return None, "MuJoCo refuses it: " + done.stderr[-500:]
    said = json.loads(done.stdout)
    return {part: {name: 1000 * np.array(place) for name, place in said[part].items()} for part in said}, ""


def read_mujoco(folder):
    """The sites; planes cut the wall into pieces, whose vertices are others than the surface's, so of those it asks that
    they reach as far as the ends do."""
    said, why = read_engine(folder / "scene-joints.xml")
    if said is None: return None, why
    found = Found(ends={name: place for name, place in said["sites"].items() if not name.startswith("wire_")})
    wall = np.concatenate([v for name, v in said["meshes"].items() if name.startswith("wall_")])
    for name, place in found.ends.items():
        if np.linalg.norm(wall - place, axis=1).min() > 5: found.faults.append(f"no wall is near {name}")
    return found, ""


def read_cathsim(folder):
    said, why = read_engine(folder / "phantom_assets/vessel.xml")
    if said is None: return None, why
    return Found(vertices=said["meshes"]["visual"], ends=said["sites"]), ""


def read_svzerod(folder):
    """A model without a dimension has no places but those that it notes of its ends, in cm."""
    ends = json.loads((folder / "model.json").read_text())["boundary_conditions"]
    return Found(ends={end["bc_name"]: 10 * np.array(end["_place"]) for end in ends}), ""


def read_oned(folder):
    """svOneDSolver's nodes, in cm; the first one is the inlet, others without a joint are the ends of their segments."""
    cards = [line.split() for line in (folder / "vessels.in").read_text().splitlines()]
    place = {card[1]: 10 * np.array([float(x) for x in card[2:5]]) for card in cards if card[:1] == ["NODE"]}
    found = Found(ends={"inlet": place["0"]})
    for card in cards:
        if card[:1] == ["SEGMENT"] and "RESISTANCE" in card:
            found.ends["outlet-" + re.sub(r"_\d+$", "", card[1])] = place[card[6]]
    return found, ""


def read_openfoam(folder):
    """The text STL, in metres; the block around it, and a place within it, from the dictionaries."""
    text = (folder / "constant/triSurface/vessel.stl").read_text()
    found = Found(vertices=1000 * np.array([[float(x) for x in line.split()[1:]] for line in text.splitlines() if "vertex" in line]))
    vectors = lambda file, key: [[1000 * float(x) for x in m.split()] for m in
                                 re.findall(r"\(([-0-9.e+ ]+)\)", re.search(key + r"[^;]*;", (folder / file).read_text(), re.S)[0])]
    corners = np.array([v for v in vectors("system/blockMeshDict", "vertices") if len(v) == 3])
    inside = np.array(vectors("system/snappyHexMeshDict", "locationInMesh")[0])
    low, high = found.vertices.min(axis=0), found.vertices.max(axis=0)
    if not ((corners.min(axis=0) < low) & (corners.max(axis=0) > high)).all(): found.faults.append("the block does not hold the vessels")
    if not ((inside > low) & (inside < high)).all(): found.faults.append("locationInMesh is not in the vessels")
    return found, ""


def read_simvascular(folder):
    return Found(vertices=10 * read_vtp(folder / "Models/vessel.vtp")[0], centerline=read_pth(folder / "Paths")), ""
def read_isaac(folder):
    """The arrays by NumPy, which are mm, LPS; the stage by three's USD loader, whose world is metres, y up."""
    found = Found(centerline=np.load(folder / "centerline_points_mm.npy").astype(float))
    modules = HERE.parent.parent / "viewer/page/node_modules"
    if not shutil.which("node") or not (modules / "three").is_dir(): return None, "node or three.js is not here"
    done = subprocess.run(["node", str(HERE / "load_usda.mjs"), str(folder / "vessel.usda"), str(modules)],
                          capture_output=True, text=True)
    if done.returncode != 0: return Found(faults=["three.js: " + done.stderr[-500:]]), ""
    stage = json.loads(done.stdout)
    found.vertices = np.array(stage["wall"], float).reshape(-1, 3) @ GLTF_TO_LPS.T
    found.ends = {name.replace("_", "-"): GLTF_TO_LPS @ np.array(place) for name, place in stage["ends"].items()}
    return found, ""


def read_grid(folder):
    """By VTK's reader of MetaImage: in the lumen its samples are libblob's distances at the places that it gives."""
    try:
        from lumen import blob
    except ImportError:
        return None, "the Python package lumen is missing; PYTHONPATH has its folder, BUILD/packages/python"
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkMetaImageReader
    reader = vtkMetaImageReader()
    reader.SetFileName(str(folder / "distance.mhd"))
    reader.Update()
    image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    inside = np.flatnonzero(values < 0)
    places = np.array([image.GetPoint(int(i)) for i in inside])
    model = blob.Model(str(folder.parent / "landmark.lumen"))
    distances = model.query(places).distance if len(places) else np.zeros(0)
    off = float(np.abs(distances - values[inside]).max(initial=0))
    faults = [] if len(places) > 1000 and off <= 1e-4 else [f"{len(places)} samples in the lumen, {off:.3g} mm off"]
    return Found(faults=faults, samples=len(places)), ""


WALL = ["--thickness", "0.4r"]
LOADERS = {
    "sofa": Loader(read_sofa),
    "svzerod": Loader(read_svzerod, has_surface=False),
    "oned": Loader(read_oned, has_surface=False),
    "openfoam": Loader(read_openfoam),
    "simvascular": Loader(read_simvascular),
    "steve": Loader(read_steve),
    "godot": Loader(read_godot, surface=WALL),
    # no engine of theirs is to be had here: Blender's importer of glTF stands in
    "unity": Loader(read_blender, surface=WALL),
    "unreal": Loader(read_blender, surface=WALL),
    "blender": Loader(read_blender, surface=WALL),
    "slicer": Loader(read_slicer),
    "mujoco": Loader(read_mujoco),
    "cathsim": Loader(read_cathsim),
    "grid": Loader(read_grid, options=["--format", "mhd"], has_surface=False),
    "isaac": Loader(read_isaac, surface=["--thickness", "0.2r"]),
    "print": Loader(read_print, surface=["--thickness", "1"], ends=[]),
}
