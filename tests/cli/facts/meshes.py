# SPDX-License-Identifier: Apache-2.0
"""The wall of the vessels as STL, OBJ, PLY, VTK's surfaces and glTF, each stated fact turned one at a time."""
import base64, json, math, struct

from lines import legacy, vtp
from turned import VESSELS, Turned

IDENTITY = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def tube():
    """A closed, bent tube of 24 corners around the trunk and its first branch, which narrows: points, and triangles that face outward."""
    (a, b, r0), (_, c, r1) = VESSELS[:2]
    n, rings, points, faces = 24, 24, [], []
    for k in range(rings + 1):
        t = k / rings
        at = [(1 - t) ** 2 * x + 2 * t * (1 - t) * y + t * t * z for x, y, z in zip(a, b, c)]
        along = [2 * (1 - t) * (y - x) + 2 * t * (z - y) for x, y, z in zip(a, b, c)]
        along = [x / math.hypot(*along) for x in along]
        u = [-along[1], along[0], 0.0]
        u = [x / math.hypot(*u) for x in u]
        v = [along[1] * u[2] - along[2] * u[1], along[2] * u[0] - along[0] * u[2], along[0] * u[1] - along[1] * u[0]]
        r = r0 + (r1 - r0) * t
        for i in range(n):
            w = 2 * math.pi * i / n
            points.append(tuple(p + r * (math.cos(w) * x + math.sin(w) * y) for p, x, y in zip(at, u, v)))
    for k in range(rings):
        for i in range(n):
            j = (i + 1) % n
            p, q, s, o = k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i
            faces += [(p, q, s), (p, s, o)]
    points += [a, c]
    for i in range(n):
        j = (i + 1) % n
        faces += [(len(points) - 2, j, i), (len(points) - 1, rings * n + i, rings * n + j)]
    return points, faces


POINTS, FACES = tube()
QUADS = [(*f, g[2]) for f, g in zip(FACES[:-48:2], FACES[1:-48:2])] + FACES[-48:]
RAS = ((-1, 0, 0), (0, -1, 0), (0, 0, 1))


def placed(rows=IDENTITY, k=1.0, shift=(0, 0, 0)):
    return [tuple(k * sum(m * x for m, x in zip(row, p)) + s for row, s in zip(rows, shift)) for p in POINTS]


def stl(points=None, faces=FACES, text=None, head=b"", normals=(0, 0, 0)):
    points = points or POINTS
    if text is not None:
        body = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.15g %.15g %.15g\n" % points[i] for i in f) + "endloop\nendfacet\n" for f in faces)
        return f"solid {text}\n{body}endsolid {text}\n".encode()
    return head.ljust(80, b"\0")[:80] + struct.pack("<I", len(faces)) + b"".join(
        struct.pack("<12fH", *normals, *(x for i in f for x in points[i]), 0) for f in faces)


def obj(points=None, faces=FACES, head="", corner=lambda i: str(i + 1), weight="", faces_first=False, eol="\n"):
    points = [f"v {x:.15g} {y:.15g} {z:.15g}{weight}\n" for x, y, z in points or POINTS]
    rows = ["f " + " ".join(corner(i) for i in f) + "\n" for f in faces]
    return (head + "".join(rows + points if faces_first else points + rows)).replace("\n", eol).encode()


def ply(points=None, faces=FACES, form="ascii", kind="float", order="xyz", comment="", extra=False, name="vertex_indices", index="int",
        count="uchar", faces_first=False):
    points = points or POINTS
    codes = {"float": "f", "double": "d", "float32": "f", "float64": "d", "int": "i", "uint": "I", "int32": "i", "ushort": "H", "uchar": "B", "uint8": "B"}
    endian = ">" if form == "binary_big_endian" else "<"
    vertex = f"element vertex {len(points)}\n" + ("property uchar red\n" if extra else "") + "".join(f"property {kind} {c}\n" for c in order)
    face = f"element face {len(faces)}\nproperty list {count} {index} {name}\n"
    head = f"ply\nformat {form} 1.0\n" + (f"comment {comment}\n" if comment else "") + (face + vertex if faces_first else vertex + face) + "end_header\n"
    rows = [([7] if extra else []) + [dict(zip("xyz", p))[c] for c in order] for p in points]
    if form == "ascii":
        parts = ["".join(" ".join(repr(v) for v in r) + "\n" for r in rows).encode(), "".join(f"{len(f)} " + " ".join(map(str, f)) + "\n" for f in faces).encode()]
    else:
        of = endian + ("B" if extra else "") + 3 * codes[kind]
        parts = [b"".join(struct.pack(of, *r) for r in rows), b"".join(struct.pack(f"{endian}{codes[count]}{len(f)}{codes[index]}", len(f), *f) for f in faces)]
    return head.encode() + b"".join(parts[::-1] if faces_first else parts)


def plains(original):
    def turned(format, file, write, fact, answer="same", words="", options=(), **how):
        return Turned(format, fact, {file: write(**how)}, answer, words, options, original)
    inward = [f[::-1] for f in FACES]
    said = (("SPACE=RAS", placed(RAS)), ("SPACE=LPS", None), ("mm, LPS", None))
    units = (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3))
    for format, file, write in (("STL", "m.stl", stl), ("OBJ", "m.obj", obj), ("PLY", "m.ply", ply)):
        comment = {"STL": lambda s: {"head": b"x " + s.encode()}, "OBJ": lambda s: {"head": f"# x {s}\n"}, "PLY": lambda s: {"comment": f"x {s}"}}[format]
        yield turned(format, file, write, "plain")
        yield turned(format, file, write, "facing inward", faces=inward)
        yield turned(format, file, write, "triangles in another order", faces=FACES[::-1])
        yield turned(format, file, write, "corners that begin elsewhere", faces=[f[1:] + f[:1] for f in FACES])
        yield turned(format, file, write, "half of the triangles turned", faces=[f[::-1] if n % 2 else f for n, f in enumerate(FACES)])
        for words, points in said: yield turned(format, file, write, words, points=points, **comment(words))
        yield turned(format, file, write, "--frame ras", points=placed(RAS), options=("--frame", "ras"))
        yield turned(format, file, write, "SPACE=RAS and --frame ras", points=placed(RAS), options=("--frame", "ras"), **comment("SPACE=RAS"))
        yield turned(format, file, write, "SPACE=RAS, but --frame lps", options=("--frame", "lps"), **comment("SPACE=RAS"))
        for unit, k in units:
            yield turned(format, file, write, f"--unit {unit}", points=placed(k=k), options=("--unit", unit))
            for words in (f"units: {unit}", f"unit = {unit}", f"coordinates in {unit}"):
                yield turned(format, file, write, words, points=placed(k=k), **comment(words))
        yield turned(format, file, write, "metres, by size", points=placed(k=1e-3))
        yield turned(format, file, write, "comment on another unit", **comment("exported with normals, 5 m ago"))
    yield turned("STL", "m.stl", stl, "text", text="vessel")
    yield turned("STL", "m.stl", stl, "text, SPACE=RAS", points=placed(RAS), text="3D Slicer. SPACE=RAS")
    yield turned("STL", "m.stl", stl, "text of cm", points=placed(k=0.1), text="vessel units: cm")
    yield turned("STL", "m.stl", stl, "binary that begins with solid", head=b"solid by somebody")
    yield turned("STL", "m.stl", stl, "normals that point inward", normals=(0, 0, -1))
    yield turned("OBJ", "m.obj", obj, "quads", faces=QUADS)
    yield turned("OBJ", "m.obj", obj, "negative indices", corner=lambda i: str(i - len(POINTS)))
    yield turned("OBJ", "m.obj", obj, "normals and texture", corner=lambda i: f"{i + 1}/1/1")
    yield turned("OBJ", "m.obj", obj, "normals", corner=lambda i: f"{i + 1}//1")
    yield turned("OBJ", "m.obj", obj, "weights", weight=" 1.0")
    yield turned("OBJ", "m.obj", obj, "colours", weight=" 0.5 0.5 0.5")
    yield turned("OBJ", "m.obj", obj, "faces first", faces_first=True)
    yield turned("OBJ", "m.obj", obj, "CR LF", eol="\r\n")
    yield turned("OBJ", "m.obj", obj, "material and groups", head="mtllib x.mtl\no vessel\ng wall\nusemtl red\ns 1\n")
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        for kind in ("float", "double", "float32", "float64"): yield turned("PLY", "m.ply", ply, f"{form} {kind}", form=form, kind=kind)
        for order in ("zyx", "yzx"): yield turned("PLY", "m.ply", ply, f"{form} {order}", form=form, order=order)
        for index in ("uint", "ushort", "int32"): yield turned("PLY", "m.ply", ply, f"{form} {index}", form=form, index=index)
        yield turned("PLY", "m.ply", ply, f"{form} vertex_index", form=form, name="vertex_index")
        yield turned("PLY", "m.ply", ply, f"{form} quads", form=form, faces=QUADS)
        yield turned("PLY", "m.ply", ply, f"{form} a property before", form=form, extra=True)
        yield turned("PLY", "m.ply", ply, f"{form} faces first", form=form, faces_first=True)


def vtks(original):
    strips = [[k * 24 + i % 24 + (24 if b else 0) for i in range(25) for b in (1, 0)] for k in range(24)]
    for format, file, write in (("VTP", "m.vtp", vtp), ("VTK", "m.vtk", legacy)):
        polys, strip = ("Polys", "Strips") if write is vtp else ("POLYGONS", "TRIANGLE_STRIPS")

        def turned(fact, answer="same", words="", options=(), points=None, faces=FACES, kind=polys, **how):
            return Turned(format, fact, {file: write(points or POINTS, faces, kind=kind, **how)}, answer, words, options, original)
        yield turned("plain")
        yield turned("facing inward", faces=[f[::-1] for f in FACES])
        yield turned("quads", faces=QUADS)
        yield turned("strips, open ends", "warned", "", kind=strip, faces=strips)
        for unit, k in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3)):
            yield turned(f"Unit {unit}", points=placed(k=k), texts={"Unit": unit})
            yield turned(f"--unit {unit}", points=placed(k=k), options=("--unit", unit))
        for space, rows in (("RAS", RAS), ("LPS", IDENTITY), ("right-anterior-superior", RAS), ("ras", RAS)):
            yield turned(f"SPACE {space}", points=placed(rows), texts={"SPACE": space})
        yield turned("SPACE RAS and --frame ras", points=placed(RAS), texts={"SPACE": "RAS"}, options=("--frame", "ras"))
        yield turned("SPACE RAS, but --frame lps", texts={"SPACE": "RAS"}, options=("--frame", "lps"))
        if write is vtp:
            for form in ("ascii", "binary", "appended"):
                for floats in ("Float32", "Float64"):
                    for endian in "<>":
                        for pack in (False, True): yield turned(f"{form} {floats} {endian} {pack}", form=form, floats=floats, endian=endian, pack=pack, header="Q")
            continue
        yield turned("title SPACE=RAS", points=placed(RAS), title="SPACE=RAS")
        yield turned("title of cm", points=placed(k=0.1), title="vessel, units: cm")
        for version in ("2.0", "3.0", "4.2", "5.1"):
            for binary in (False, True):
                for code in ("float", "double"): yield turned(f"version {version} {binary} {code}", version=version, binary=binary, code=code)


# glTF ------------------------------------------------------------------------------------------

def gltf(points, faces=FACES, node=None, above=None, index="I", floats="f", binary=False, uri=True, indexed=True, mode=None, stride=0,
         extra_scene=False, skin=None, sparse=False, normalized=None):
    """`points` as they are stored. `node`: the mesh's node; `above`: its parent's fields. `normalized`: (scale, shift) of 16 bits."""
    if not indexed: points, faces = [points[i] for f in faces for i in f], None
    if normalized:
        k, shift = normalized
        stored = b"".join(struct.pack("<3hxx", *(max(-32767, min(32767, round((x - s) / k * 32767))) for x, s in zip(p, shift))) for p in points)
        stride = 8
    else: stored = b"".join(struct.pack("<3f", *p) + bytes(max(0, stride - 12)) for p in points)
    indices = struct.pack(f"<{3 * len(faces)}{index}", *(i for f in faces for i in f)) if faces else b""
    code = {"B": 5121, "H": 5123, "I": 5125}[index]
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": len(stored), **({"byteStride": stride} if stride else {})}]
    accessors = [{"bufferView": 0, "componentType": 5122 if normalized else 5126, "count": len(points), "type": "VEC3", **({"normalized": True} if normalized else {})}]
    data = stored
    primitive = {"attributes": {"POSITION": 0}, **({"mode": mode} if mode is not None else {})}
    if faces:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(indices)})
        accessors.append({"bufferView": 1, "componentType": code, "count": 3 * len(faces), "type": "SCALAR"})
        primitive["indices"] = 1
        data += indices + bytes(-len(indices) % 4)
    if sparse:  # the first point is stored apart
        views += [{"buffer": 0, "byteOffset": len(data), "byteLength": 4}, {"buffer": 0, "byteOffset": len(data) + 4, "byteLength": 12}]
        accessors[0]["sparse"] = {"count": 1, "indices": {"bufferView": len(views) - 2, "componentType": 5125}, "values": {"bufferView": len(views) - 1}}
        data += struct.pack("<I3f", 0, *points[0])
        data = struct.pack("<3f", 90, 90, 90) + data[12:]
    nodes = [{"mesh": 0, **(node or {})}]
    if above: nodes.append({**above, "children": [0]})
    root = len(nodes) - 1
    file = {"asset": {"version": "2.0"}, "scene": 1 if extra_scene else 0, "scenes": ([{"nodes": []}] if extra_scene else []) + [{"nodes": [root]}],
            "nodes": nodes, "meshes": [{"primitives": [primitive]}], "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
    if normalized: file["extensionsRequired"] = file["extensionsUsed"] = ["KHR_mesh_quantization"]
    if skin:
        nodes[0]["skin"] = 0
        nodes.append(skin)
        file["scenes"][-1]["nodes"].append(len(nodes) - 1)
        file["skins"] = [{"joints": [len(nodes) - 1]}]
    if binary:
        text = json.dumps(file).encode()
        text += b" " * (-len(text) % 4)
        data += bytes(-len(data) % 4)
        return {"m.glb": struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data}
    file["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode() if uri else "m.bin"
    return {"m.gltf": json.dumps(file).encode(), **({} if uri else {"m.bin": data})}


def up(points, k=1e-3):
    """LPS mm as glTF's metres with +Y up and +Z to the front."""
    return [(k * x, k * z, -k * y) for x, y, z in points]


def gltfs(original):
    def turned(fact, answer="same", words="", options=(), points=None, k=1e-3, **how):
        return Turned("glTF", fact, gltf(points or up(POINTS, k), **how), answer, words, options, original)
    yield turned("metres, +Y up")
    yield turned("binary", binary=True)
    yield turned("data in a file", uri=False)
    yield turned("mm by --unit", k=1, options=("--unit", "mm"))
    yield turned("mm", "warned", "implausible", k=1)
    yield turned("cm by --unit", k=0.1, options=("--unit", "cm"))
    yield turned("a scale of the node", k=1, node={"scale": [1e-3] * 3})
    yield turned("a scale of the node above", k=1, above={"scale": [1e-3] * 3})
    yield turned("a translation", points=[(x - 1, y - 2, z - 3) for x, y, z in up(POINTS)], node={"translation": [1, 2, 3]})
    half = math.sqrt(0.5)
    yield turned("a rotation: Z up", points=[(1e-3 * x, 1e-3 * y, 1e-3 * z) for x, y, z in POINTS], node={"rotation": [-half, 0, 0, half]})
    yield turned("a matrix: Z up", points=[(1e-3 * x, 1e-3 * y, 1e-3 * z) for x, y, z in POINTS], node={"matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]})
    yield turned("a matrix above a scale", points=POINTS, node={"scale": [1e-3] * 3}, above={"matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]})
    yield turned("a mirror", points=[(-x, y, z) for x, y, z in up(POINTS)], node={"scale": [-1, 1, 1]})
    yield turned("indices of 16 bits", index="H")
    yield turned("no indices", indexed=False)
    yield turned("stride", stride=24)
    yield turned("mode 4", mode=4)
    yield turned("the second scene", extra_scene=True)
    yield turned("quantized", points=up(POINTS), normalized=(0.05, (-0.02, 0.05, -0.014)), node={"scale": [0.05] * 3, "translation": [-0.02, 0.05, -0.014]})
    yield turned("sparse positions", "refused", "sparse.*export", sparse=True)
    yield turned("a skin of a joint that moves", "same", "skin", skin={"translation": [0.1, 0, 0]})
    yield turned("a skin under a node that scales", "warned", "skin", k=1e-3, node={"scale": [2, 2, 2]}, skin={"name": "joint"})


def others(_):
    """Places 10 km away, and a wide vessel in cm, which has the size of a vessel in mm, too."""
    away = [(x + 1e7 + 30, y - 2e7 - 30, z) for x, y, z in POINTS]
    original = Turned("STL", "moved by 30 mm", {"m.stl": stl([(x + 30, y - 30, z) for x, y, z in POINTS])})
    for format, files in (("OBJ", {"m.obj": obj(away)}), ("PLY", {"m.ply": ply(away, kind="double")}), ("STL", {"m.stl": stl(away, text="x")}),
                          ("VTP", {"m.vtp": vtp(away, FACES, kind="Polys", floats="Float64")}),
                          ("VTK", {"m.vtk": legacy(away, FACES, kind="POLYGONS", code="double")})):
        yield Turned(format, "10 km away", files, "same", "far from 0", (), original)
    wide = placed(k=8)
    in_cm = placed(k=0.8)
    original = Turned("STL", "a wide vessel, --unit mm", {"m.stl": stl(wide)}, options=("--unit", "mm"))
    for format, files in (("STL", {"m.stl": stl(in_cm, head=b"units: cm")}), ("OBJ", {"m.obj": obj(in_cm, head="# units: cm\n")}),
                          ("PLY", {"m.ply": ply(in_cm, comment="units: cm")}), ("VTK", {"m.vtk": legacy(in_cm, FACES, kind="POLYGONS", title="x, units: cm")}),
                          ("VTP", {"m.vtp": vtp(in_cm, FACES, kind="Polys", texts={"Units": "cm"})})):
        yield Turned(format, "a wide vessel of cm", files, "same", "", (), original)
        yield Turned(format, "a wide vessel of cm, no unit", {n: f.replace(b"units: cm", b"units: ??").replace(b"Units", b"Xnits") for n, f in files.items()}, "warned", "cm", (), original)


def all_meshes():
    original = Turned("STL", "mm, LPS", {"m.stl": stl()})
    for made in (plains, vtks, gltfs, others): yield from made(original)
