#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes words into every place that a person can name, runs every command, and searches all that it leaves.

    private_words.py BATCH_LUMEN

Words are in the names of folders, of the home folder and of the user, and in fields of inputs that name a patient, a place or a
file: headers of volumes and meshes, tags of DICOM, comments. Outputs are searched within archives, packed parts and base64, too.
Answers as JSON, and messages, are searched where the paths that a person gives have no such word."""
import base64, gzip, io, json, os, pathlib, re, struct, sys, tempfile, zipfile, zlib

from batch import Batch

FOLDER, HOME, INSIDE = "Wolkenstein^Hildegund", "Rutherford", "Katharina"
WORDS = [w.encode() for w in (*FOLDER.split("^"), HOME, INSIDE)]
RUNS = """
convert IN/tube.nrrd OUT/a.lumen --label-map IN/labels.nrrd --label-table IN/names.json
convert IN/tube.nrrd OUT/a.lumen.json --seeds IN/seeds.json --corrections IN/tube.lumen
convert IN/tube.nii OUT/nii.lumen.json --seeds IN/seeds.json
convert IN/tube.mha OUT/mha.lumen.json --seeds IN/seeds.mrk.json
convert IN/series OUT/dicom.lumen.json --seeds IN/seeds.json
convert IN/tube.lumen OUT/a.gltf
convert IN/tube.lumen OUT/a.glb
convert IN/tube.lumen OUT/a.stl
convert IN/tube.lumen OUT/a.obj
convert IN/tube.lumen OUT/a.ply
convert IN/tube.lumen OUT/a.vtp
convert IN/tube.lumen OUT/a.swc
convert IN/tube.lumen OUT/a.tre
convert IN/tube.lumen OUT/a.centerline.vtp
convert IN/tube.lumen OUT/a.mrk.json
convert OUT/a.stl OUT/b.lumen.json --centerline OUT/a.swc
convert OUT/a.swc OUT/c.lumen.json
convert IN/m.stl OUT/m-stl.lumen.json
convert IN/m.obj OUT/m-obj.lumen.json
convert IN/m.ply OUT/m-ply.lumen.json
convert IN/m.vtk OUT/m-vtk.lumen.json
convert IN/m.vtp OUT/m-vtp.lumen.json
convert IN/m.gltf OUT/m-gltf.lumen.json
convert IN/c.swc OUT/c-swc.lumen.json
convert IN/c.tre OUT/c-tre.lumen.json
track IN/tube.nrrd OUT/t.lumen.json --seeds IN/seeds.json
seeds IN/tube.nrrd OUT/s.json
seeds IN/tube.nrrd OUT/s.mrk.json
fit IN/tube.lumen OUT/f.lumen.json --image IN/tube.nrrd
ends IN/tube.lumen --root 2 --out OUT/ends.lumen.json
names IN/tube.lumen --table OUT/names.csv
batch IN/series OUT/batch
trim IN/tube.lumen OUT/trimmed.lumen.json --min-length 1
check IN/tube.nrrd IN/tube.lumen --mask OUT/m.nrrd --overlay OUT/o.png
check IN/tube.nii IN/tube.lumen --mask OUT/m.nii
check IN/tube.mha IN/tube.lumen --mask OUT/m.mha
measure IN/tube.lumen IN/truth.lumen --out OUT/m.csv
measure IN/tube.lumen --out OUT/m.json
measure IN/tube.lumen --against IN/truth.lumen --out OUT/tables
motion IN/tube.lumen IN/tube.nrrd --out OUT/mo.lumen.json --reach 1
phantom --tree OUT/a.swc OUT/p.nrrd --truth OUT/pt.lumen.json --seeds OUT/ps.json
phantom tube OUT/p.mha --size 32
picture IN/tube.lumen OUT/p.png
picture IN/tube.lumen OUT/pv.png --volume IN/tube.nii
xray IN/tube.lumen OUT/x.png --size 64x48
xray IN/tube.lumen OUT/x.nrrd --size 64x48
report IN/tube.lumen OUT/r.html --volume IN/tube.nrrd
report OUT/dicom.lumen.json OUT/rd.html
"""
PAGES = """
view IN/tube.lumen IN/tube.nii --html OUT/v.html --html-volume
view IN/tube.mha IN/m.ply IN/c.swc --html OUT/vm.html
view IN/series OUT/dicom.lumen.json --html OUT/vd.html
"""
ANSWERS = """
info IN/tube.nrrd --voxels
info IN/tube.nii
info IN/tube.mha
info IN/series
info IN/tube.lumen
info IN/tube.lumen --chunks
info IN/m.stl
info IN/m.vtk
info IN/m.gltf
info IN/c.swc
info IN/c.tre
validate IN/tube.lumen
compare IN/tube.lumen IN/truth.lumen
export --list
"""
LIBRARY = """
library init OUT/lib --title T --publisher P --licence CC-BY-4.0
library add OUT/lib IN/tube.lumen --title One --synthetic --attribution A --id one
library index OUT/lib
library extract OUT/lib OUT/own --case one
"""
LIBRARY_ANSWERS = """
library list OUT/lib
library check OUT/lib
"""


def packed_parts(data, depth=3):
    """The bytes, and those that are packed or coded in them."""
    yield data
    if depth == 0: return
    parts = []
    if data[:2] == b"\x1f\x8b": parts.append(gzip.decompress(data))
    if data[:4] == b"PK\3\4":
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts += [name.encode() for name in archive.namelist()] + [archive.read(name) for name in archive.namelist()]
    for coded in re.findall(rb"[A-Za-z0-9+/]{24,}={0,2}", data)[:2000]:
        try: parts.append(base64.b64decode(coded + b"=" * (-len(coded) % 4)))
        except ValueError: pass
    for start in list(re.finditer(rb"\x78[\x01\x5e\x9c\xda]", data))[:200]:
        try: parts.append(zlib.decompressobj().decompress(data[start.start():], 1 << 20))
        except zlib.error: pass
    for part in parts: yield from packed_parts(part, depth - 1)


def words_in(data, words=WORDS):
    """The words that the bytes hold, as text of 8 or 16 bits."""
    wanted = {w: re.compile(re.escape(w) + b"|" + re.escape(w.decode().encode("utf-16-le")), re.I) for w in words}
    return sorted({w.decode() for part in packed_parts(data) for w, look in wanted.items() if look.search(part)})


def check_search():
    """The search finds a word wherever it can be."""
    word, made = WORDS[0], io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive: archive.writestr("x/y.txt", b"a " + word)
    long = b"one two three four " + word
    for data in (word, b"/home/" + word.lower(), gzip.compress(long), made.getvalue(), base64.b64encode(long), b"_" + base64.b64encode(zlib.compress(long)),
                 b"PNG" + zlib.compress(long), word.decode().encode("utf-16-le")):
        if words_in(data) != [word.decode()]: sys.exit(f"private_words.py: the search does not find {word} in {data}")
    if words_in(b"nothing"): sys.exit("private_words.py: the search finds what is not there")


def nrrd_parts(data):
    """Fields and voxels of an NRRD file that lumen wrote; shorts."""
    head, _, body = data.partition(b"\n\n")
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    return fields, gzip.decompress(body) if fields["encoding"] == "gzip" else body


def dicom(k, sizes, spacing, place, voxels):
    """A slice whose tags of people and places hold words."""
    def element(group, number, vr, value):
        raw = value if isinstance(value, bytes) else str(value).encode()
        raw += (b"\0" if vr in ("UI", "OB", "OW") else b" ") * (len(raw) % 2)
        head = struct.pack("<HH2s", group, number, vr.encode())
        return head + (struct.pack("<HI", 0, len(raw)) if vr in ("OB", "OW") else struct.pack("<H", len(raw))) + raw
    short = lambda n: struct.pack("<H", n)
    root = "1.2.826.0.1.3680043.2.1125.7"
    meta = b"".join(element(2, *e) for e in ((1, "OB", b"\0\1"), (2, "UI", "1.2.840.10008.5.1.4.1.1.2"), (3, "UI", f"{root}.{k + 1}"), (16, "UI", "1.2.840.10008.1.2.1")))
    body = b"".join(element(*e) for e in (
        (8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2"), (8, 0x18, "UI", f"{root}.{k + 1}"), (8, 0x60, "CS", "CT"), (8, 0x80, "LO", INSIDE), (8, 0x90, "PN", INSIDE),
        (8, 0x1010, "SH", INSIDE), (8, 0x1030, "LO", INSIDE), (8, 0x103E, "LO", INSIDE), (16, 0x10, "PN", f"{INSIDE}^X"), (16, 0x20, "LO", INSIDE), (16, 0x4000, "LT", INSIDE),
        (24, 0x1030, "LO", INSIDE), (32, 0xD, "UI", root), (32, 0xE, "UI", root + ".0"), (32, 0x10, "SH", INSIDE), (32, 0x13, "IS", k + 1),
        (32, 0x32, "DS", "\\".join(f"{v:g}" for v in place)), (32, 0x37, "DS", "1\\0\\0\\0\\1\\0"), (32, 0x52, "UI", root + ".9"), (32, 0x4000, "LT", INSIDE),
        (40, 2, "US", short(1)), (40, 4, "CS", "MONOCHROME2"), (40, 0x10, "US", short(sizes[1])), (40, 0x11, "US", short(sizes[0])), (40, 0x30, "DS", f"{spacing:g}\\{spacing:g}"),
        (40, 0x100, "US", short(16)), (40, 0x101, "US", short(16)), (40, 0x102, "US", short(15)), (40, 0x103, "US", short(1)), (0x7FE0, 0x10, "OW", voxels)))
    return b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + body


def make_inputs(lumen, folder):
    """Inputs whose fields hold the word INSIDE, from files of lumen."""
    for words in (("phantom", "tube", "tube.nrrd", "--size", "64", "--truth", "truth.lumen", "--seeds", "seeds.json"), ("convert", "tube.nrrd", "tube.lumen", "--seeds", "seeds.json"),
                  ("check", "tube.nrrd", "tube.lumen", "--mask", "labels.nrrd"), ("check", "tube.nrrd", "tube.lumen", "--mask", "labels.nii"), ("phantom", "tube", "tube.mha", "--size", "64"), ("phantom", "tube", "tube.nii", "--size", "64"),
                  *(("convert", "tube.lumen", f"m.{e}") for e in ("stl", "obj", "ply", "vtp", "gltf")), ("convert", "tube.lumen", "c.tre")):
        done = lumen.run(words, folder)
        if done.returncode: sys.exit(f"private_words.py: {words}: {done.stderr}")
    at = lambda name: folder / name
    fields, voxels = nrrd_parts(at("tube.nrrd").read_bytes())
    sizes, spacing = [int(n) for n in fields["sizes"].split()], float(re.search(r"\(([-\d.e]+)", fields["space directions"])[1])
    origin = [float(v) for v in fields["space origin"].strip("()").split(",")]
    if fields["type"] not in ("short", "int16"): voxels = struct.pack(f"<{len(voxels) // 4}h", *(int(v) for v in struct.unpack(f"<{len(voxels) // 4}f", voxels)))
    at("series").mkdir()
    n = 2 * sizes[0] * sizes[1]
    for k in range(sizes[2]): at(f"series/{k:03d}").write_bytes(dicom(k, sizes, spacing, (*origin[:2], origin[2] + k * spacing), voxels[k * n:(k + 1) * n]))
    nii = bytearray(at("tube.nii").read_bytes())
    for place, size in ((14, 18), (148, 80), (228, 24), (328, 16)): nii[place:place + len(INSIDE)] = INSIDE.encode()  # db_name, descrip, aux_file, intent_name
    at("tube.nii").write_bytes(nii)
    mha = at("tube.mha").read_bytes()
    at("tube.mha").write_bytes(f"Comment = {INSIDE}\nPatientName = {INSIDE}\n".encode() + mha)
    nrrd = at("tube.nrrd").read_bytes()
    at("tube.nrrd").write_bytes(nrrd.replace(b"\n", f"\n# {INSIDE}\ncontent: {INSIDE}\nPatient:={INSIDE}\n".encode(), 1))
    stl = at("m.stl").read_bytes()
    at("m.stl").write_bytes(f"mm, LPS {INSIDE}".encode().ljust(80) + stl[80:])
    at("m.obj").write_bytes(f"# /home/{INSIDE}/x\nmtllib {INSIDE}.mtl\n".encode() + at("m.obj").read_bytes() + f"usemtl {INSIDE}\n".encode())
    at("m.ply").write_bytes(at("m.ply").read_bytes().replace(b"comment", f"comment {INSIDE}\ncomment".encode(), 1))
    points, faces = [], []
    for line in at("m.obj").read_text().splitlines():
        if line.startswith("v "): points.append(line[2:])
        if line.startswith("f "): faces.append("3 " + " ".join(str(int(w.split("/")[0]) - 1) for w in line[2:].split()))
    field = f"FIELD FieldData 1\nSource 1 1 string\n/home/{INSIDE}/x.vtk\n"
    at("m.vtk").write_text(f"# vtk DataFile Version 3.0\n{INSIDE} mm, LPS\nASCII\nDATASET POLYDATA\n{field}POINTS {len(points)} float\n" + "\n".join(points) +
                           f"\nPOLYGONS {len(faces)} {4 * len(faces)}\n" + "\n".join(faces) + "\n")
    at("m.vtp").write_bytes(re.sub(rb"<PolyData>", f'<PolyData><FieldData><Array type="String" Name="{INSIDE}" NumberOfTuples="1" format="ascii">65 0</Array></FieldData>'.encode(), at("m.vtp").read_bytes(), count=1))
    scene = json.loads(at("m.gltf").read_text())
    scene["asset"].update(copyright=INSIDE, generator=INSIDE, extras={"path": f"/home/{INSIDE}"})
    at("m.gltf").write_text(json.dumps(scene))
    wide = "".join(f"{i + 1} 2 0 0 {i} 2 {i or -1}\n" for i in range(40))  # for an instrument
    at("c.swc").write_text(f"# ORIGINAL_SOURCE /home/{INSIDE}/x\n# CREATURE {INSIDE}\n{wide}")
    at("c.tre").write_bytes(f"Comment = {INSIDE}\n".encode() + at("c.tre").read_bytes())
    at("names.json").write_text('{"1": "BA"}')
    done = lumen.run(("seeds", "tube.nrrd", "seeds.mrk.json"), folder)
    if done.returncode: sys.exit(f"private_words.py: {done.stderr}")


def main():
    check_search()
    with tempfile.TemporaryDirectory() as root:
        place, home = pathlib.Path(root, FOLDER), pathlib.Path(root, HOME)
        for folder in (place / "in", place / "out", home): folder.mkdir(parents=True)
        lumen = Batch(sys.argv[1], env={**os.environ, "HOME": str(home), "USER": HOME, "LOGNAME": HOME, "XDG_STATE_HOME": str(home / "state"), "XDG_CONFIG_HOME": str(home / "config")})
        make_inputs(lumen, place / "in")
        refusal = lumen.run(["export", "none", str(place / "in/tube.lumen"), "x"], root).stderr
        targets = re.findall(r"[a-z]+", refusal.partition("exports to ")[2].replace(" or ", " "))
        runs = RUNS + "".join(f"export {t} {'OUT/c-swc.lumen.json' if t == 'sofa' else 'IN/tube.lumen'} OUT/x-{t}\n" for t in targets)
        answers = ANSWERS
        if "library" in lumen.run(["--help"], root).stdout: runs, answers = runs + LIBRARY, answers + LIBRARY_ANSWERS
        if (pathlib.Path(sys.argv[1]).resolve().parents[2] / "viewer/page/page.js").exists(): runs += PAGES
        else: print("the page was not built: the pages of lumen view are not searched")
        runs, answers = ([line for line in lines.splitlines() if line] for lines in (runs, answers))
        faults = []
        for line in runs:
            words = [str(place / w.split("/")[0].lower() / w.split("/", 1)[1]) if w.startswith(("IN/", "OUT/")) else w for w in line.split()]
            done = lumen.run(words, root)
            if done.returncode: faults.append(f"{line}: {done.stderr.strip()[-300:]}")
        (place / "again").mkdir()
        for line in runs + answers:
            words = [re.sub("^OUT/", "again/", re.sub("^IN/", "in/", w)) for w in line.split()]
            done = lumen.run([*words, "--json"], place)
            if done.returncode: faults.append(f"{line} --json: {done.stderr.strip()[-300:]}")
            if found := words_in((done.stdout + done.stderr).encode()): faults.append(f"the answer to {line} holds {', '.join(found)}")
        lumen.end()
        files = [p for p in (place / "out").rglob("*") if p.is_file()]
        for file in files:
            if found := words_in(file.read_bytes()): faults.append(f"{file.relative_to(place / 'out')} holds {', '.join(found)}")
    print(f"{len(runs)} commands with {len(targets)} targets wrote {len(files)} files, and {len(runs) + len(answers)} answered")
    for fault in faults: print("FAULT", fault)
    sys.exit(bool(faults) or len(files) < 100 or len(targets) < 16)


if __name__ == "__main__": main()
