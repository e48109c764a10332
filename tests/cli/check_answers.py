#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds every JSON answer of lumen to its schema in spec/answers.

check_answers.py BATCH_LUMEN BUILD

BUILD is the build folder, which has the schemas and the conformance set.
Runs each command with --json on good and bad input, and validates what it prints. Then it breaks each answer in
every place (a key more, a key less, a value of another type), which the schema must refuse, and tells which key of
a schema no answer had. Exit status: 0 all held, 1 something did not."""
import functools, json, math, pathlib, random, shutil, struct, sys, tempfile, warnings

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests/cli"), str(ROOT / "tests/library")]
from batch import Batch
from made import Maker, ssh_key
if len(sys.argv) != 3: sys.exit(__doc__)
BUILD = pathlib.Path(sys.argv[2]).resolve()
ANSWERS = BUILD / "spec/answers"
CONFORMANCE = BUILD / "spec/conformance"
HOSTILE = ROOT.parent / "shared/hostile"  # not in the repository
SCHEMAS = {p.name: json.loads(p.read_text()) for p in sorted(ANSWERS.glob("*.schema.json"))}
BAD = {"no-such-file.lumen": None, "empty.lumen": b"", "text.lumen": b"not a case", "seeds.json": b'{"format": "lumen-seeds"}',
       "cut.nrrd": b"NRRD0004\ntype: short\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n"}

failures, seen, kept = [], {}, {}


def complain(what):
    failures.append(what)
    print(what)


@functools.cache
def validator(name):
    with warnings.catch_warnings():  # newer versions have a registry besides, the oldest that we support does not
        warnings.simplefilter("ignore", DeprecationWarning)
        resolver = jsonschema.RefResolver("", SCHEMAS[name], store=SCHEMAS)
        return jsonschema.Draft202012Validator(SCHEMAS[name], resolver=resolver)


def keys_of(value):
    """Every key of every object in an answer or a schema."""
    if isinstance(value, dict):
        for key, below in value.items():
            yield key
            yield from keys_of(below)
    elif isinstance(value, list):
        for below in value: yield from keys_of(below)


def stated(schema):
    """The keys that the objects of a schema have."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for below in schema.values(): yield from stated(below)
    elif isinstance(schema, list):
        for below in schema: yield from stated(below)


def loose(schema, place):
    """Objects of a schema that take any key, or do without one that they have, unless it comes with others."""
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            if "properties" in schema and (schema.get("additionalProperties") is not False
                                           or set(schema.get("required", [])) | set(schema.get("dependentRequired", {}))
                                           != set(schema["properties"])): yield place
            if "properties" not in schema and not isinstance(schema.get("additionalProperties"), dict): yield place
        for key, below in schema.items(): yield from loose(below, f"{place}/{key}")
    elif isinstance(schema, list):
        for i, below in enumerate(schema): yield from loose(below, f"{place}/{i}")


def check_schemas():
    readme = (ROOT / "spec/answers/README.md").read_text()
    for name, schema in SCHEMAS.items():
        jsonschema.Draft202012Validator.check_schema(schema)
        if schema["$id"] != name: complain(f"{name}: its $id is {schema['$id']}")
        for place in loose(schema, "#"): complain(f"{name}: {place} must list all its keys, require them and have no other")
        if name not in readme: complain(f"{name}: spec/answers/README.md does not name it")


def run(lumen, folder, *arguments):
    return lumen.run([*arguments, "--json", "--quiet"], folder)


def hold(name, result, what, codes=(0,)):
    """One JSON object that the schema takes, and an exit code of those expected."""
    if result.returncode not in codes:
        return complain(f"{what}: exit code {result.returncode}, expected one of {codes}: {result.stderr}")
    try:
        answer = json.loads(result.stdout)
    except ValueError as error:
        return complain(f"{what}: no JSON: {error}: {result.stdout[:200]!r}")
    for error in validator(name).iter_errors(answer): complain(f"{what}: {name}: {error.json_path}: {error.message[:300]}")
    seen.setdefault(name, set()).update(keys_of(answer))
    if len(result.stdout) < 20000: kept.setdefault(name, []).append(answer)
    return answer


def hold_or_silent(name, result, what):
    """Checks that a failed command prints nothing on standard output, or an answer in the form of the schema."""
    if result.returncode == 0 or result.stdout: return hold(name, result, what, (0, 1, 3))
    if result.returncode < 0 or not result.stderr: complain(f"{what}: {result.returncode}, {result.stderr!r}")


def edited(lumen, folder, case):
    """The case with three records of corrections: of a request that fits, of one that does not, and of none."""
    run(lumen, folder, "convert", case, "plain.lumen.json")
    value = json.loads((folder / "plain.lumen.json").read_text())
    label = value["tree"]["branches"][0]["label"]
    near, far = ({"label": label, "at": at, "radius": 1} for at in (value["tree"]["centre"][0], [900, 0, 0]))
    request = lambda place: json.dumps(dict(op="rename", branch=place, word="renamed"))
    value["metadata"]["steps"].append(dict(name="edit", tool="test", parameters={
        "0001": "renamed it", "0001-request": request(near), "0002": "renamed another", "0002-request": request(far), "0003": "anything"}))
    return value


def moving(lumen, folder, case):
    """The case with a periodic motion of its first node."""
    run(lumen, folder, "convert", case, "plain.lumen.json")
    value = json.loads((folder / "plain.lumen.json").read_text())
    first = value["tree"]["centre"][0]
    value.update(version="1.2", motion=dict(period=1.5, time=[0, 1], node=[0], centre=[[first], [[first[0] + 0.1, *first[1:]]]],
                                            rotation=[[[0, 0, 0, 1]]] * 2, factor=[[1], [1]]))
    return value


def write_scan(path):
    """A ball of soft tissue in air, as CT has them."""
    noise = random.Random(1)
    inside = lambda x, y, z: min(1, max(0, 13.5 - math.dist((x, y, z), (20, 20, 20))))
    voxels = [round(-1000 + 1040 * inside(x, y, z) + noise.gauss(0, 4)) for z in range(40) for y in range(40) for x in range(40)]
    path.write_bytes(b"NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 40 40 40\nencoding: raw\nendian: little\n"
                     b"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n" + struct.pack(f"<{len(voxels)}h", *voxels))


def write_two_scans(folder):
    """Bone in soft tissue in air, with a vessel through it and, elsewhere, without, as CT has them."""
    noise = random.Random(2)
    for name, shift, blood in ("cta.nrrd", 0, 350), ("plain.nrrd", 2, 40):
        def level(x, y, z):
            if max(abs(x - 20), abs(y - 20)) > 17: return -1000
            x, y, z = x - shift, y + shift / 2, z - shift / 2
            if math.hypot(x - 19, y - 20) < 4: return blood
            if max(abs(x - 20) - 10, abs(y - 20) - 9, abs(z - 18) - 13) < 0: return 500 + 300 * math.sin(x) * math.sin(.8 * y) * math.sin(.9 * z)
            return 40
        voxels = [round(level(x, y, z) + noise.gauss(0, 8)) for z in range(40) for y in range(40) for x in range(40)]
        (folder / name).write_bytes(b"NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 40 40 40\nencoding: raw\nendian: little\n"
                                    b"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n" + struct.pack(f"<{len(voxels)}h", *voxels))


def make_cases(lumen, folder):
    go = lambda name, *arguments, **more: hold(name, run(lumen, folder, *arguments), " ".join(arguments), **more)
    go("phantom.schema.json", "phantom", "aneurysm", "a.nrrd", "--size", "64", "--truth", "truth.lumen", "--seeds", "seeds.json")
    go("phantom.schema.json", "phantom", "tube", "a.nii.gz", "--size", "32")
    write_scan(folder / "scan.nrrd")
    (folder / "vessel.swc").write_text("1 0 12 20 20 2 -1\n2 0 28 20 20 2 1\n")
    go("phantom.schema.json", "phantom", "--tree", "vessel.swc", "--into", "scan.nrrd", "drawn.nrrd")
    write_two_scans(folder)
    for command in ("convert", "track"):
        result = run(lumen, folder, command, "cta.nrrd", "native.lumen", "--native", "plain.nrrd")
        if "without ITK" not in result.stderr: hold(f"{command}.schema.json", result, f"{command} --native")
    go("seeds.schema.json", "seeds", "a.nrrd", "proposals.mrk.json")
    go("convert.schema.json", "convert", "a.nrrd", "proposed.lumen", "--seeds", "proposals.mrk.json")
    go("convert.schema.json", "convert", "a.nrrd", "found.lumen", "--repeat", "2")
    seeds = json.loads((folder / "seeds.json").read_text())
    vessel = seeds["branches"][0]
    air = dict(vessel, label="air", points=[[1.0, 1.0, 1.0]], radius=0.3)
    air.pop("direction", None)
    vessel["points"] = vessel["points"][:1] + [[2.0, 2.0, 2.0]]
    (folder / "astray.json").write_text(json.dumps(dict(seeds, branches=seeds["branches"] + [air])))
    go("track.schema.json", "track", "a.nrrd", "tracked.lumen", "--seeds", "astray.json")
    go("fit.schema.json", "fit", "tracked.lumen", "image.lumen", "--image", "a.nrrd")
    go("fit.schema.json", "fit", "tracked.lumen", "fitted.lumen")
    run(lumen, folder, "check", "a.nrrd", "fitted.lumen", "--mask", "labels.nrrd")
    go("track.schema.json", "track", "a.nrrd", "mapped.lumen", "--label-map", "labels.nrrd", "--label-table", "topcow")
    run(lumen, folder, "check", "a.nrrd", "fitted.lumen", "--mask", "half.nii")
    labels = bytearray((folder / "half.nii").read_bytes())
    labels[-64 ** 3 // 2:] = bytes(64 ** 3 // 2)  # a map that the vessels go on beyond
    (folder / "half.nii").write_bytes(labels)
    go("convert.schema.json", "convert", "a.nrrd", "beyond.lumen", "--label-map", "half.nii", "--role", "1=artery")
    go("measure.schema.json", "measure", "beyond.lumen")
    go("info-volume.schema.json", "info", "labels.nrrd", "--voxels", "--role", "1=artery")
    go("motion.schema.json", "motion", "tracked.lumen", "a.nrrd", "--out", "moving.lumen", "--reach", "2")
    go("phantom.schema.json", "phantom", "coronary", "beat.nrrd", "--size", "64", "--motion", "heart", "--phases", "2")
    go("trim.schema.json", "trim", "fitted.lumen", "trimmed.lumen", "--min-length", "1")
    go("convert.schema.json", "convert", "a.nrrd", "made.lumen.json", "--seeds", "astray.json")
    hold_or_silent("convert.schema.json", run(lumen, folder, "convert", "a.nrrd", "strict.lumen", "--seeds", "astray.json", "--strict"),
                   "convert --strict")
    go("convert.schema.json", "convert", "fitted.lumen", "mesh.ply")
    (folder / "moving.lumen.json").write_text(json.dumps(moving(lumen, folder, "fitted.lumen")))
    go("info-case.schema.json", "info", "moving.lumen.json")
    go("convert.schema.json", "convert", "moving.lumen.json", "posed.lumen", "--time", "0.5")
    go("convert.schema.json", "convert", "fitted.lumen", "wall.ply", "--thickness", "0.2r")
    if shutil.which("lumen-netgen"): go("convert.schema.json", "convert", "fitted.lumen", "cells.vtu", "--layers", "2")
    go("convert.schema.json", "convert", "fitted.lumen", "rounded.lumen", "--point-bits", "12", "--compress")
    go("compare.schema.json", "compare", "fitted.lumen", "truth.lumen")
    go("compare.schema.json", "compare", "truth.lumen", "tracked.lumen")
    (folder / "vessel.json").write_text(json.dumps(dict(seeds, branches=[vessel])))
    go("convert.schema.json", "convert", "a.nrrd", "vessel.lumen", "--seeds", "vessel.json", "--seeds-only")
    go("phantom.schema.json", "phantom", "bifurcation", "fork.nrrd", "--size", "64", "--seeds", "fork.json")
    fork = json.loads((folder / "fork.json").read_text())
    shutil.copy(folder / "fork.json", folder / "both.json")
    (folder / "fork.json").write_text(json.dumps(dict(fork, branches=fork["branches"][:1])))
    go("convert.schema.json", "convert", "fork.nrrd", "trunk.lumen", "--seeds", "fork.json", "--seeds-only")
    go("check.schema.json", "check", "fork.nrrd", "trunk.lumen")
    go("check.schema.json", "check", "fork.nrrd", "trunk.lumen", "--profile", "simulator", codes=(3,))
    (folder / "edited.lumen.json").write_text(json.dumps(edited(lumen, folder, "trunk.lumen")))
    go("convert.schema.json", "convert", "fork.nrrd", "again.lumen", "--seeds", "fork.json", "--seeds-only", "--corrections", "edited.lumen.json")
    go("trim.schema.json", "trim", "proposed.lumen", "trimmed.lumen", "--min-radius", "0.1")
    for case in ("fitted.lumen", "vessel.lumen"): go("check.schema.json", "check", "a.nrrd", case)
    (folder / "cross.swc").write_text("1 0 2 5 5 1 -1\n2 0 10 5 5 1 1\n3 0 5 2 5 1 -1\n4 0 5 10 5 1 3\n")
    run(lumen, folder, "convert", "cross.swc", "cross.lumen", "--unit", "mm")
    go("check.schema.json", "check", "a.nrrd", "cross.lumen")
    go("convert.schema.json", "convert", "fork.nrrd", "both.lumen", "--seeds", "both.json")
    go("trim.schema.json", "trim", "both.lumen", "trunk-alone.lumen", "--min-length", "10")
    go("ends.schema.json", "ends", "both.lumen")
    go("ends.schema.json", "ends", "both.lumen", "--root", "2", "--out", "rooted.lumen")
    go("names.schema.json", "names", "both.lumen")
    run(lumen, folder, "phantom", "willis", "circle.nrrd")
    run(lumen, folder, "convert", "circle.nrrd", "circle.lumen")
    go("names.schema.json", "names", "circle.lumen", "--anatomy")
    (folder / "scans").mkdir()
    shutil.copy(folder / "a.nrrd", folder / "scans")
    (folder / "scans" / "broken.nrrd").write_text("NRRD0004\n")
    go("batch.schema.json", "batch", "scans", "cases", codes=(3,))
    go("measure.schema.json", "measure", "both.lumen", "--against", "both.lumen", "--out", "both-measures")
    go("phantom.schema.json", "phantom", "stenosis", "s.nrrd", "--size", "128", "--seeds", "s.json")
    go("convert.schema.json", "convert", "s.nrrd", "s.lumen", "--seeds", "s.json")
    go("measure.schema.json", "measure", "s.lumen", "--against", "s.lumen")
    go("measure.schema.json", "measure", "fitted.lumen", "truth.lumen")
    go("picture.schema.json", "picture", "fitted.lumen", "fitted.png", "--size", "200x160")
    go("xray.schema.json", "xray", "fitted.lumen", "xray.png", "--size", "64x48")
    go("picture.schema.json", "picture", "fitted.lumen", "turn.png", "--size", "64x64", "--turntable", "3")
    go("report.schema.json", "report", "fitted.lumen", "page.html", "--volume", "a.nrrd")
    go("report.schema.json", "report", "truth.lumen", "bare.html")
    go("library.schema.json", "library", "init", "lib", "--title", "A library", "--licence", "MIT")
    go("library-add.schema.json", "library", "add", "lib", "fitted.lumen", "--synthetic", "--export", "svzerod", "--id", "one")
    go("library-add.schema.json", "library", "add", "lib", "truth.lumen", "--synthetic", "--id", "two")
    go("library-list.schema.json", "library", "list", "lib")
    go("library.schema.json", "library", "extract", "lib", "extract", "--case", "two")
    go("library.schema.json", "library", "update", "lib", "two", "--title", "Another title")
    go("library.schema.json", "library", "remove", "lib", "two")
    for shell in ("bash", "fish", "zsh"): go("completion.schema.json", "completion", shell)
    hold("version.schema.json", lumen.run(["--version", "--json"], folder), "--version")
    (folder / "library").mkdir()
    (folder / "library/library.json").write_text(json.dumps(dict(
        format="lumen-library", formatVersion=1, id="0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4", revision=1, previous=None, title="Cases", description="",
        publisher="", licence="CC0-1.0", date="2026-11-22", generator="lumen 0.1.0", cases=[])))
    go("library-index.schema.json", "library", "index", "library")
    for volume in ("a.nrrd", "a.nii.gz"):
        for voxels in ((), ("--voxels",)): go("info-volume.schema.json", "info", volume, *voxels)
    for mesh in ("mesh.ply", *sorted(map(str, (ROOT / "tests/data/mesh").glob("*")))): go("info-mesh.schema.json", "info", mesh)
    go("info-seeds.schema.json", "info", "astray.json")
    for tree in ("a.swc", "a.tre", "a.centerline.vtp", "a.mrk.json"):
        go("convert.schema.json", "convert", "truth.lumen", tree)
        go("info-centerline.schema.json", "info", tree)
    go("convert.schema.json", "convert", "a.swc", "given.lumen")
    # two vessels whose lumens overlap
    lines = [f"{10 * y + x + 1} 3 {x} {1.2 * y} 0 1 {10 * y + x if x else -1}" for y in (0, 1) for x in range(10)]
    (folder / "two.swc").write_text("\n".join(lines) + "\n")
    go("convert.schema.json", "convert", "two.swc", "two.glb")
    go("convert.schema.json", "convert", "mesh.ply", "of-mesh.lumen")
    go("export-list.schema.json", "export", "--list")
    go("convert.schema.json", "convert", "two.swc", "two.lumen")
    go("export.schema.json", "export", "sofa", "two.lumen", "two-sofa")
    go("export.schema.json", "export", "svzerod", "two.lumen", "two-0d")
    go("seeds.schema.json", "seeds", "tracked.lumen", "kept.json")
    for case in ("tracked.lumen", "fitted.lumen", "rounded.lumen", "truth.lumen", "made.lumen.json"):
        go("info-case.schema.json", "info", case)
        if not case.endswith(".json"): go("info-chunks.schema.json", "info", case, "--chunks")
    round_end = str(CONFORMANCE / "valid/bend-tighter-than-wide.lumen.json")  # a warning of its surface
    for case in ("fitted.lumen", "two.lumen", round_end): go("info-case.schema.json", "info", case, "--surface")
    go("info-case.schema.json", "info", "two.lumen", "--accept", "two vessels touch", "--out", "accepted.lumen")
    secret = json.loads((folder / "made.lumen.json").read_text())
    secret["tree"]["branches"][0]["label"] = "Doe^Jane 1999-12-31"
    (folder / "secret.lumen.json").write_text(json.dumps(secret))
    go("validate.schema.json", "validate", "fitted.lumen", "secret.lumen.json", "--privacy", codes=(3,))
    go("validate.schema.json", "validate", "fitted.lumen", "truth.lumen", "--surface")


def builds(folder, go):
    """A list of which one row is made, and one fails."""
    go_init = lambda name: go("init", name, "--title", "Rows", "--licence", "CC0-1.0", schema="library.schema.json")
    (folder / "rows.csv").write_text("input,id,title,synthetic\na.lumen,one,One,yes\nempty.swc,two,Two,yes\n")
    (folder / "empty.swc").write_text("no numbers\n")
    go_init("rows")
    go("build", "rows.csv", "rows", codes=(3,))
    go("build", "rows.csv", "rows", "--status", schema="library-build-status.schema.json")


def libraries(lumen, folder):
    go = lambda name, *arguments, schema=None, **more: hold(schema or f"library-{name}.schema.json", run(lumen, folder, "library", name, *arguments),
                                                            " ".join(("library", name, *arguments)), **more)
    maker = Maker(lumen, folder)
    maker.init(folder / "tubes", "Tubes")
    maker.add(folder / "tubes", "a", maker.case("a"))
    builds(folder, go)
    go("check", "tubes", "--resume", "checked")
    if shutil.which("ssh-keygen"):
        key = ssh_key(folder, "publisher")
        go("sign", "tubes", "--key", key.name)
        for _ in range(2): go("verify", "tubes", "--key", f"{key.name}.pub", "--state", "state")
        (folder / "tubes/data/a/surface.glb").write_bytes(b"")
        for _ in range(2): go("sign", "tubes", "--key", key.name, codes=(3,))
    go("check", "tubes", "--max-faults", "0", codes=(3,) if shutil.which("ssh-keygen") else (0,))
    (folder / "tubes/library.json").write_text("{}")
    go("check", "tubes", codes=(3,))


def bad_input(lumen, folder):
    for name, content in BAD.items():
        if content is not None: (folder / name).write_bytes(content)
        say = lambda schema, *arguments: hold_or_silent(schema, run(lumen, folder, *arguments), " ".join(arguments))
        say("info-volume.schema.json" if name.endswith("nrrd") else "info-case.schema.json", "info", name)
        say("info-chunks.schema.json", "info", name, "--chunks")
        say("fit.schema.json", "fit", name, "out.lumen")
        say("trim.schema.json", "trim", name, "out.lumen", "--min-length", "1")
        say("compare.schema.json", "compare", name, name)
        say("check.schema.json", "check", "a.nrrd", name)
        say("picture.schema.json", "picture", name, "out.png")
        say("measure.schema.json", "measure", name)
        say("measure.schema.json", "measure", "fitted.lumen", "--against", name)
        say("export.schema.json", "export", "sofa", name, "out-sofa")
        say("check.schema.json", "check", name, "fitted.lumen")
        say("library-add.schema.json", "library", "add", "lib", name, "--synthetic", "--id", "bad")
        say("library-list.schema.json", "library", "list", name)
        say("report.schema.json", "report", name, "out.html")
        say("report.schema.json", "report", "fitted.lumen", "out.html", "--volume", name)
        say("convert.schema.json", "convert", name, "out.glb", "--seeds", "astray.json")
        say("track.schema.json", "track", name, "out.lumen", "--seeds", "astray.json")
    hold("validate.schema.json", run(lumen, folder, "validate", *BAD), "validate of what is no case", (3,))


def conformance_set(lumen, folder):
    for case in sorted((CONFORMANCE / "valid").glob("*.lumen*")):
        if case.name.endswith(".queries.json"): continue
        hold("info-case.schema.json", run(lumen, folder, "info", str(case)), case.name)
        if case.suffix == ".lumen": hold("info-chunks.schema.json", run(lumen, folder, "info", str(case), "--chunks"), case.name)
    for few in ((), ("--max-issues", "0"), ("--max-issues", "1"), ("--privacy",)):
        files = [str(p) for kind in ("valid", "hostile") for p in sorted((CONFORMANCE / kind).iterdir())]
        hold("validate.schema.json", run(lumen, folder, "validate", *files, *few), f"validate {' '.join(few)} of the conformance set", (3,))
    for case in sorted((CONFORMANCE / "hostile").iterdir())[::20]:
        hold_or_silent("info-case.schema.json", run(lumen, folder, "info", str(case)), case.name)


def hostile_files(lumen, folder):
    files = [f for f in sorted(HOSTILE.glob("*")) if not f.name.endswith("seeds.json")]
    if not files: return print("skipped: the hostile files, which are not in ../shared/hostile")
    for file in files:
        kind = "case" if file.suffix in (".lumen", ".json") else "volume"
        hold_or_silent(f"info-{kind}.schema.json", run(lumen, folder, "info", str(file)), file.name)
        hold_or_silent("validate.schema.json", run(lumen, folder, "validate", str(file)), f"validate {file.name}")


def broken(value):
    """Copies of an answer with one fault each: the first element of an array stands for all."""
    if isinstance(value, dict):
        if value: yield dict(value, **{"no such key": 1})
        for key, below in value.items():
            yield {k: v for k, v in value.items() if k != key}
            if key in ("parameters", "arguments"): continue  # of any name
            for other in broken(below): yield dict(value, **{key: other})
    elif isinstance(value, list):
        yield {"an": "object"}
        if value and isinstance(value[0], (dict, list)):
            for other in broken(value[0]): yield [other] + value[1:]
        elif value: yield [{}] + value[1:]
    else:
        yield ["another type"]


def check_that_faults_are_noticed():
    for name, answers in kept.items():
        check = validator(name)
        for fault in broken(max(answers, key=lambda a: len(set(keys_of(a))))):
            if check.is_valid(fault): complain(f"{name} takes a broken answer: {json.dumps(fault)[:400]}")


def check_that_all_is_used():
    for name, schema in SCHEMAS.items():
        if name == "parts.schema.json": continue
        for key in set(stated(schema)) - seen.get(name, set()): complain(f"{name}: no answer had the key {key}")


def main():
    lumen = Batch(pathlib.Path(sys.argv[1]).resolve())
    check_schemas()
    with tempfile.TemporaryDirectory(prefix="lumen-answers-") as name:
        folder = pathlib.Path(name)
        make_cases(lumen, folder)
        libraries(lumen, folder)
        bad_input(lumen, folder)
        conformance_set(lumen, folder)
        hostile_files(lumen, folder)
        lumen.end()
    check_that_faults_are_noticed()
    check_that_all_is_used()
    print(f"{len(SCHEMAS)} schemas, {sum(map(len, kept.values()))} answers, {len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
