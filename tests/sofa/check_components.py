#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks scenes of `lumen export sofa` against a list of SOFA's components and their data, and the syntax of scene.py.

check_components.py LUMEN [COMPONENTS.json]

In the current dialect every component must be in the list (v26.06) with all data that the scene states, under the
plugin that the scene requires. The dialect v23.06 has the old names and the material at WireRestShape.
Exit status: 0 all held, 1 something did not, 77 the list is not there."""
import ast, itertools, json, pathlib, subprocess, sys, tempfile, xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
ELSEWHERE = {"LightManager", "DirectionalLight", "BlobField", "BlobMotion", "BlobPose", "BeamBlobContact"}  # not in the list
OLD = {"DefaultPipeline": "CollisionPipeline", "DefaultContactManager": "CollisionResponse", "FixedConstraint": "FixedProjectiveConstraint"}
# data of WireRestShape before v23.12
OLD_SHAPE = {"length", "straightLength", "spireDiameter", "spireHeight", "youngModulus", "youngModulusExtremity", "poissonRatio",
             "radius", "radiusExtremity", "massDensity", "massDensityExtremity", "keyPoints", "densityOfBeams", "numEdgesCollis", "numEdges"}
failures = []


def complain(what):
    failures.append(what)
    print(what)


def check(scene, known, dialect, what):
    everywhere = set(known["_about"]["every_component_also_accepts"])
    plugins = {e.get("pluginName") for e in scene.iter("RequiredPlugin")}
    used = set()
    for item in scene.iter():
        if item.tag in ("Node", "RequiredPlugin") or item.tag in ELSEWHERE: continue
        name = OLD.get(item.tag, item.tag) if dialect == "v23.06" else item.tag
        if dialect == "v23.06" and item.tag in OLD.values(): complain(f"{what}: {item.tag} has another name in v23.06")
        entry = known["components"].get(name)
        if entry is None:
            complain(f"{what}: there is no component {item.tag}")
            continue
        accepts = everywhere | {d for key in ("data", "inherited", "links", "aliases", "parse_attributes") for d in entry.get(key, [])}
        if dialect == "v23.06" and name == "WireRestShape": accepts = everywhere | OLD_SHAPE
        for datum in item.attrib:
            if datum not in accepts: complain(f"{what}: {item.tag} has no datum {datum}")
        if dialect == "v23.06" and "nbBeams" in item.attrib: complain(f"{what}: {item.tag}: nbBeams came with v25.06")
        if not entry["plugin"].startswith("("): used.add(entry["plugin"])
    if used - plugins: complain(f"{what}: RequiredPlugin lacks {sorted(used - plugins)}")


def main():
    lumen = str(pathlib.Path(sys.argv[1]).resolve())
    listed = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT.parent / "shared/sofa/components.json"
    if not listed.exists():
        print(f"skipped: {listed} is not there")
        return 77
    known = json.loads(listed.read_text())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run = lambda *a: subprocess.run([lumen, *a, "--quiet"], cwd=folder, check=True)
        run("phantom", "bifurcation", "v.nrrd", "--size", "64", "--seeds", "s.json")
        run("convert", "v.nrrd", "c.lumen", "--seeds", "s.json", "--seeds-only")
        for dialect, wall, tool in itertools.product(("current", "v23.06"), ("mesh", "implicit", "grid", "soft"), ("guidewire", "coil")):
            what = f"{dialect}-{wall}-{tool}"
            run("export", "sofa", "c.lumen", what, "--dialect", dialect, "--wall", wall, "--instrument", tool)
            check(xml.etree.ElementTree.parse(folder / what / "scene.scn").getroot(), known, dialect, what)
            ast.parse((folder / what / "scene.py").read_text())
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
