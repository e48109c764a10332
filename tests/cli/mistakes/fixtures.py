# SPDX-License-Identifier: Apache-2.0
"""The files that the pages of docs/mistakes use, each made when a command mentions its name.

FILES has a recipe for each: a function that is handed the Store and returns the bytes of the file, or None if it made it
there itself. A folder's name ends with a slash."""
import gzip, json, math, re, shutil, struct

FILES = {}


def fixture(*names):
    """The function as the recipe of these files."""
    def add(recipe):
        FILES.update(dict.fromkeys(names, recipe))
        return recipe
    return add


class Store:
    """The files made so far, in a folder; `run` is called with a command line and that folder."""
    def __init__(self, folder, run):
        self.folder, self.run = folder, run
        self.folder.mkdir()

    def path(self, name):
        """The file or folder of that name, made if it is not there yet."""
        target = self.folder / name.rstrip("/")
        if not target.exists():
            made = FILES[name](self)
            if made is not None: target.write_bytes(made)
        return target

    def bytes(self, name): return self.path(name).read_bytes()

    def text(self, name): return self.bytes(name).decode()

    def lumen(self, line, *needed):
        """Runs lumen on files that are there, or made before."""
        for name in needed: self.path(name)
        done = self.run(line.split() + ["--quiet"], self.folder)
        assert done.returncode == 0, f"{line}: {done.stdout}"

    def copy(self, commands, folder):
        """Puts the files that the commands mention into a folder."""
        words = set(re.findall(r"[\w.-]+/?", commands))
        for name in sorted(words | {word + "/" for word in words}):
            target = folder / name.rstrip("/")
            if name not in FILES or target.exists(): continue
            source = self.path(name)
            shutil.copytree(source, target) if source.is_dir() else shutil.copy(source, target)


# ---- a tube of 40^3 voxels of 0.2 mm, 8 mm long, of 0.45 mm radius, its seeds, its truth and its case

@fixture("tube.nrrd", "seeds.json", "truth.lumen")
def tube(store): store.lumen("phantom tube tube.nrrd --size 40 --truth truth.lumen --seeds seeds.json")

@fixture("case.lumen")
def case(store): store.lumen("convert tube.nrrd case.lumen --seeds seeds.json", "tube.nrrd")

@fixture("plain.lumen.json")
def plain(store): store.lumen("convert truth.lumen plain.lumen.json", "truth.lumen")

@fixture("tube.nii")
def nifti(store): store.lumen("phantom tube tube.nii --size 40")

@fixture("other.nrrd")
def other(store): store.lumen("phantom tube other.nrrd --size 40 --seed 2")

@fixture("labels.nrrd")
def labels(store): store.lumen("check tube.nrrd case.lumen --mask labels.nrrd", "tube.nrrd", "case.lumen")

@fixture("line.lumen")
def line(store):
    (store.folder / "line.swc").write_text("".join(f"{i + 1} 3 {i} 0 0 1 {i or -1}\n" for i in range(10)))
    store.lumen("convert line.swc line.lumen")

@fixture("results/")
def results(store): (store.folder / "results").mkdir()


# ---- cases that were changed

SMALL = """{
  "format": "lumen", "version": "1.1", "minimumReader": "1.0",
  "metadata": {"coordinateSystem": "LPS", "units": "mm", "steps": []},
  "tree": {
    "branches": [
      {"label": "a", "kind": "vessel", "parentNode": -1, "firstNode": 0, "nodeCount": 2, "stopReason": "unknown"}
    ],
    "centre": [[1,2,3], [1,2,4]], "direction": [[0,0,1], [0,0,1]],
    "radius": [1, 1], "height": [0.5, 0.5], "parent": [-1, 0], "branch": [0, 0]
  }
}
"""


def half(data): return data[:len(data) // 2]


def with_bit(data):
    """One bit changed in the middle."""
    return data[:len(data) // 2] + bytes([data[len(data) // 2] ^ 1]) + data[len(data) // 2 + 1:]


def negative(text):
    """A first radius that was made negative by hand."""
    at = text.index("[", text.index('"radius"')) + 1
    return (text[:at] + "-" + text[at:].lstrip()).encode()


def future(text):
    """A part of a later version of the format."""
    return re.sub(r'"(version|minimumReader)": "[^"]*"', r'"\1": "2.0"', text, count=2).encode()


def case_with(old, new): return lambda store: SMALL.replace(old, new).encode()


FILES.update({
    "half.lumen": lambda store: half(store.bytes("truth.lumen")),
    "damaged.lumen": lambda store: with_bit(store.bytes("truth.lumen")),
    "comma.lumen.json": lambda store: store.bytes("plain.lumen.json").replace(b"]\n", b"],\n", 1),
    "negative.lumen.json": lambda store: negative(store.text("plain.lumen.json")),
    "future.lumen.json": lambda store: future(store.text("plain.lumen.json")),
    "metres.lumen.json": case_with('"mm"', '"m"'),
    "forged.lumen.json": case_with('"mm"', '"m\\nforged.lumen.json: valid\\u001b[2K"'),
    "misspelt.lumen.json": case_with('"units"', '"unit"'),
    "faults.lumen.json": case_with('"radius": [1, 1], "height": [0.5, 0.5]', '"radius": [-1, 0], "height": [-0.0, 0.5]'),
    "warning.lumen.json": case_with('"height": [0.5, 0.5]', '"height": [-0.0, 0.5]'),
    "head.img": lambda store: store.bytes("tube.nrrd"),
    "download.nrrd": lambda store: b"<!DOCTYPE html>\n<title>Please log in</title>\n",
    "picture.png": lambda store: b"\x89PNG\r\n\x1a\n",
    "options.toml": lambda store: b"threads = 1\n[convert]\ncel = 0.5\n",
    "value.toml": lambda store: b"[convert]\ndraco = true  # smaller\ncell = -1\n",
})


# ---- volumes

def nrrd(*lines, type="uint8", sizes="2 2 2", voxels=bytes(range(8))):
    header = ["NRRD0004", f"type: {type}", f"dimension: {len(sizes.split())}", f"sizes: {sizes}", *lines, "encoding: raw", ""]
    return "\n".join(header).encode() + b"\n" + voxels


def meta(*lines, data="LOCAL", voxels=bytes(range(8))):
    """A MetaImage file of 2 x 2 x 2 bytes."""
    header = ["NDims = 3", *lines, "DimSize = 2 2 2", "ElementType = MET_UCHAR", f"ElementDataFile = {data}"]
    return "\n".join(header).encode() + b"\n" + voxels


def cube(values):
    """The volume of these 40^3 bytes, in the place of the tube."""
    return nrrd("space: left-posterior-superior", "space directions: (0.2,0,0) (0,0.2,0) (0,0,0.2)", "space origin: (0,0,0)",
                sizes="40 40 40", voxels=bytes(values))


def in_tube():
    """For every voxel of a cube, whether it lies within 1 mm of the middle axis."""
    return [((i - 19.5) ** 2 + (j - 19.5) ** 2) * 0.04 < 1 for k in range(40) for j in range(40) for i in range(40)]


def moved(data, old, new):
    assert data.count(old) == 1, data[:400]
    return data.replace(old, new)


def negated(data):
    """A volume with x and y negated, as if RAS were LPS."""
    directions = re.search(rb"space directions: \(([^,]*),0,0\) \(0,([^,]*),0\)", data)
    return data.replace(directions[0], b"space directions: (-%s,0,0) (0,-%s,0)" % directions.groups())


def packed(data, layout, at, *values):
    """The bytes with these numbers at a place."""
    data = bytearray(data)
    struct.pack_into(layout, data, at, *values)
    return bytes(data)


def copied(store):
    """A compressed volume of which a part is missing in the middle."""
    whole = gzip.compress(store.bytes("tube.nii"), mtime=0)
    return whole[:len(whole) // 3] + whole[len(whole) // 3 + 100:]


def times(data):
    """Two volumes in one file."""
    return packed(data[:352], "<5h", 40, 4, *struct.unpack_from("<3h", data, 42), 2) + 2 * data[352:]


FILES.update({
    "half.nrrd": lambda store: half(store.bytes("tube.nrrd")),
    "moved.nrrd": lambda store: moved(store.bytes("tube.nrrd"), b"space origin: (0,0,0)", b"space origin: (1000,0,0)"),
    "negated.nrrd": lambda store: negated(store.bytes("tube.nrrd")),
    "far-labels.nrrd": lambda store: re.sub(rb"origin: \([^,]*,", b"origin: (900,", store.bytes("labels.nrrd"), count=1),
    "metres.nrrd": lambda store: nrrd("spacings: 0.0005 0.0005 0.0005"),
    "colour.nrrd": lambda store: nrrd("kinds: RGB-color domain domain domain", sizes="3 2 2 2", voxels=bytes(24)),
    "flat.nrrd": lambda store: nrrd(sizes="4 2"),
    "blank.nrrd": lambda store: cube([7] * 40 ** 3),
    "dark.nrrd": lambda store: cube(20 if v else 200 - n % 3 for n, v in enumerate(in_tube())),
    "cut-off.nrrd": lambda store: cube(200 - n % 3 if v else 0 for n, v in enumerate(in_tube())),
    "sheared.mha": lambda store: meta("ElementSpacing = 1 1 1", "TransformMatrix = 1 0 0 0.8 0.6 0 0 0 1"),
    "moved.mhd": lambda store: meta("ElementSpacing = 1 1 1", data="moved.raw", voxels=b""),
    "outside.mhd": lambda store: meta("ElementSpacing = 1 1 1", data="/etc/passwd", voxels=b""),
    "copied.nii.gz": copied,
    "no-unit.nii": lambda store: packed(store.bytes("tube.nii"), "<b", 123, 0),
    "no-spacing.nii": lambda store: packed(store.bytes("tube.nii"), "<3f", 80, 0, 0, 0),
    "moved.nii": lambda store: packed(store.bytes("tube.nii"), "<f", 268, 5),
    "times.nii": lambda store: times(store.bytes("tube.nii")),
})


def element(group, number, kind, value):
    value = value.encode() if isinstance(value, str) else value
    value += b"\0" * (len(value) % 2) if kind == "UI" else b" " * (len(value) % 2)
    head = struct.pack("<HH2s", group, number, kind.encode())
    return head + (struct.pack("<HI" if kind == "OW" else "<H", *([0] if kind == "OW" else []), len(value))) + value


def dicom(number, series="1.2.3.1", spacing="0.5\\0.5"):
    """A slice of 8 x 8 pixels, 1 mm from the next."""
    short = lambda group, element_, value: element(group, element_, "US", struct.pack("<H", value))
    storage = "1.2.840.10008.5.1.4.1.1.2"
    meta_ = element(2, 2, "UI", storage) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1")
    data = element(8, 0x16, "UI", storage) + element(8, 0x103e, "LO", "Angio " + series[-1]) + element(0x20, 0xe, "UI", series)
    data += element(0x20, 0x32, "DS", f"0\\0\\{number}") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
    data += short(0x28, 2, 1) + element(0x28, 4, "CS", "MONOCHROME2") + short(0x28, 0x10, 8) + short(0x28, 0x11, 8)
    data += element(0x28, 0x30, "DS", spacing) if spacing else b""
    data += short(0x28, 0x100, 16) + short(0x28, 0x101, 16) + short(0x28, 0x102, 15) + short(0x28, 0x103, 0)
    data += element(0x7fe0, 0x10, "OW", struct.pack("<64H", *range(number, number + 64)))
    return bytes(128) + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta_))) + meta_ + data


def folder(name, files):
    """A recipe for a folder of these files."""
    def make(store):
        (store.folder / name).mkdir()
        for file, data in files().items(): (store.folder / name / file).write_bytes(data)
    FILES[name + "/"] = make


FILES["slice.dcm"] = lambda store: dicom(0)
folder("papers", lambda: {"notes.txt": b"No image here.\n"})
folder("two-series", lambda: {f"{s}{n}.dcm": dicom(n, f"1.2.3.{s}") for s in (1, 2) for n in range(4)})
folder("gap", lambda: {f"{n}.dcm": dicom(n) for n in range(8) if n != 3})
folder("unscaled", lambda: {f"{n}.dcm": dicom(n, spacing=None) for n in range(4)})


# ---- seeds

def seeds_with(change):
    """A recipe for the seeds after `change(document)`."""
    def make(store):
        seeds = json.loads(store.bytes("seeds.json"))
        change(seeds)
        return json.dumps(seeds).encode()
    return make


def with_branch(**branch): return seeds_with(lambda seeds: seeds["branches"].append(branch))


def placed(place):
    """A recipe for the seeds with every position p at `place(p)`."""
    def change(seeds):
        for branch in seeds["branches"]:
            for point in branch["points"]: point["position"] = place(point["position"])
    return seeds_with(change)


def seed(*position, radius):
    return json.dumps({"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
                       "branches": [{"label": "vessel", "points": [list(position)], "radius": radius}]}).encode()


FILES.update({
    "unknown-key.json": seeds_with(lambda seeds: seeds["branches"][0].update(lable=seeds["branches"][0].pop("label"))),
    "ras.json": placed(lambda p: [-p[0], -p[1], p[2]]),
    "voxels.json": placed(lambda p: [x / 0.2 for x in p]),
    "astray.json": with_branch(label="astray", points=[[50, 1, 1]]),
    "dark.json": with_branch(label="dark", parent="root", points=[[6.5, 6.5, 5]]),
    "twin.json": seeds_with(lambda seeds: seeds["branches"].append(dict(seeds["branches"][0], label="twin"))),
    "halved.json": with_branch(label="tip", points=[[4.3, 4.1, 7]]),
    "wide.json": seeds_with(lambda seeds: seeds["branches"][0]["points"][0].update(radius=1300)),
    "inches.json": seeds_with(lambda seeds: seeds.update(units="in")),
    "twice.json": seeds_with(lambda seeds: seeds["branches"].append(seeds["branches"][0])),
    "orphan.json": with_branch(label="child", parent="trunk", points=[[4, 4, 4]]),
    "no-radius.json": with_branch(label="sac", kind="aneurysm", points=[[4, 4, 4]]),
    "cut.json": lambda store: store.bytes("seeds.json")[:-20],
    "points.csv": lambda store: b"x,y,z\n4.1,3.9,4.0\n",
    "no-frame.fcsv": lambda store: b"# Markups fiducial file version = 4.11\n"
                                   b"# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"
                                   b"1,4.1,3.9,4,0,0,0,1,1,1,0,F-1,,\n",
    "plane.mrk.json": lambda store: b'{"markups": [{"type": "Plane", "coordinateSystem": "LPS", "controlPoints": []}]}',
    "background.json": lambda store: seed(1, 7, 4, radius=0.5),
})


# ---- meshes, scenes and tables of labels

def stl(radius, length, around=12, rings=6):
    """A tube that is open at both ends."""
    turn = [(radius * math.cos(2 * math.pi * a / around), radius * math.sin(2 * math.pi * a / around)) for a in range(around)]
    ring = lambda r: [(x, y, length * r / rings) for x, y in turn]
    triangles = []
    for r in range(rings):
        low, high = ring(r), ring(r + 1)
        for a in range(around):
            b = (a + 1) % around
            triangles += [(low[a], low[b], high[a]), (low[b], high[b], high[a])]
    return (b"tube".ljust(80) + struct.pack("<I", len(triangles))
            + b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles))


def open_tube(store):
    """A tube, 40 mm long, of 2 mm radius, open at both ends."""
    turn = [(2 * math.cos(2 * math.pi * k / 24), 2 * math.sin(2 * math.pi * k / 24)) for k in range(24)]
    lines = [f"v {i} {y:.6f} {z:.6f}" for i in range(41) for y, z in turn]
    for i in range(40):
        for k in range(24):
            a, b = 24 * i + k + 1, 24 * i + (k + 1) % 24 + 1
            lines += [f"f {a} {b + 24} {b}", f"f {a} {a + 24} {b + 24}"]
    return ("\n".join(lines) + "\n").encode()


def scene(*nodes): return lambda store: ('<Node name="root">\n' + "\n".join(nodes) + "\n</Node>\n").encode()


FILES.update({
    "half.stl": lambda store: half(stl(2, 40)),
    "metres.stl": lambda store: stl(0.008, 0.2),
    "nan.obj": lambda store: b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n",
    "outside.gltf": lambda store: b'{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 72, "uri": "../../../../etc/passwd"}]}',
    "grid.vtk": lambda store: b"# vtk DataFile Version 3.0\nvolume mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n",
    "open.obj": open_tube,
    "negated.swc": lambda store: "".join(f"{i} 0 {-i} 0 0 2 {i - 1 if i > 1 else -1}\n" for i in range(1, 40)).encode(),
    "twice.csv": lambda store: b"value,name\n1,ica\n1,mca\n",
    "two.scn": scene('<Node name="Arteries"><MeshOBJLoader name="loader" filename="open.obj"/></Node>',
                     '<Node name="Tip"><MeshSTLLoader name="tip" filename="tip.stl"/></Node>'),
    "volumetric.scn": scene('<Node name="Vessels"><MeshGmshLoader filename="vessels.msh"/></Node>'),
})


# ---- libraries

def library(store, name, case_id, *files):
    (store.folder / "licence.txt").write_text("Do what you like.\n")
    store.lumen(f"library init {name} --title Tubes --licence CC0-1.0 --date 2026-11-22 "
                "--id 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
    store.lumen(f"library add {name} case.lumen --id {case_id} --synthetic --no-surface --picture none --date 2026-11-22 "
                + " ".join(files), "case.lumen")

@fixture("tubes/")
def tubes(store): library(store, "tubes", "tube-1")

@fixture("published/")
def published(store):
    shutil.copytree(store.path("tubes/"), store.folder / "published")
    store.lumen("library index published")
    (store.folder / "published/library.json.minisig").write_text("untrusted comment: any\n")

@fixture("shared/")
def shared(store): library(store, "shared", "tube", "--file", "licence.txt")

@fixture("edited/")
def edited(store):
    """A library in which somebody changed a file, removed another and left a note."""
    shutil.copytree(store.path("shared/"), store.folder / "edited")
    place = store.folder / "edited/data/tube"
    next(place.rglob("licence.txt")).write_text("Ask first.\n")
    (place / "case.lumen").unlink()
    (place / "to do.txt").write_text("ask for consent\n")


FILES.update({
    "about.json": lambda store: json.dumps({"title": "A tube", "laterality": "links"}).encode(),
    # of a key that was made for this page, signs nothing, and is thrown away
    "publisher.pub": lambda store: b"untrusted comment: minisign public key 4399E96D31EC718D\n"
                                   b"RWSNcewxbemZQ25UeTL5oHtBrhmRV2EuLdlY1eRmmzTCIaWAcV1UKXaI\n",
})
