#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs what `lumen export openfoam` writes in OpenFOAM (Debian: openfoam).

check_openfoam.py LUMEN [--keep FOLDER]

The surface is checked, meshed, the mesh checked, and 50 steps of simpleFoam run on a bifurcation and on two vessels that
touch; what flows in flows out to 1 %, the mesh holds what the surface encloses, its patches lie where the ends are. Exit
status: 0 all held, 1 something did not, 77 OpenFOAM is not installed."""
import argparse, json, math, os, pathlib, re, shutil, subprocess, sys, tempfile
from flow_cases import *

PROGRAMS = ["surfaceCheck", "surfaceFeatureExtract", "blockMesh", "snappyHexMesh", "checkMesh", "simpleFoam"]


def last_flow(file):
    """The last number of a surfaceFieldValue's table."""
    return float([row for row in file.read_text().splitlines() if row and not row.startswith("#")][-1].split()[-1])


def stl(file):
    """Corners of the triangles of each solid."""
    solids, name = {}, None
    for row in file.read_text().splitlines():
        words = row.split()
        if words[:1] == ["solid"]: solids[(name := words[1])] = []
        if words[:1] == ["vertex"]: solids[name].append([float(w) for w in words[1:4]])
    return {k: [v[i:i + 3] for i in range(0, len(v), 3)] for k, v in solids.items()}


def volume(triangles):
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in triangles) / 6


def run(case, steps):
    """Allrun with fewer steps; the logs."""
    control = case / "system" / "controlDict"
    text = control.read_text()
    expect("endTime 500;" in text and "writeInterval 500;" in text, "the case runs 500 steps")
    control.write_text(text.replace("endTime 500;", f"endTime {steps};").replace("writeInterval 500;", f"writeInterval {steps};"))
    done = subprocess.run(["nice", "sh", "Allrun"], cwd=case, capture_output=True, text=True)
    expect(done.returncode == 0, f"Allrun: {done.stdout} {done.stderr}")
    return {p: (case / f"log.{p}").read_text() if (case / f"log.{p}").is_file() else "" for p in PROGRAMS}


def check_case(name, program, folder, parts):
    lumen(program, folder, "export", "openfoam", f"{name}.lumen", name, "--edge", "0.25r", "--quiet")
    case = folder / name
    manifest = json.loads((case / "lumen-export.json").read_text())
    logs = run(case, 50)
    expect("Surface is closed" in logs["surfaceCheck"], f"{name}: the surface is closed")
    expect(f"Number of unconnected parts : {parts}" in logs["surfaceCheck"], f"{name}: {parts} parts")
    expect("no illegal triangles" in logs["surfaceCheck"], f"{name}: no illegal triangles")
    expect("Finished meshing without any errors" in logs["snappyHexMesh"], f"{name}: meshed without errors")
    expect("Mesh OK." in logs["checkMesh"] and "Failed" not in logs["checkMesh"], f"{name}: the mesh is OK")
    solids = stl(case / "constant" / "triSurface" / "vessel.stl")
    meshed = float(re.search(r"Total volume = ([0-9]+\.[0-9]+(?:e[+-][0-9]+)?)", logs["checkMesh"]).group(1))
    near(meshed, volume([t for s in solids.values() for t in s]), 0.02, f"{name}: the mesh holds what the surface encloses, m^3")
    flows = {p.name[5:]: last_flow(p / "0" / "surfaceFieldValue.dat") for p in (case / "postProcessing").iterdir()}
    into = -sum(v for k, v in flows.items() if k.startswith("inlet"))
    out = sum(v for k, v in flows.items() if k.startswith("outlet"))
    near(out, into, 0.01, f"{name}: what flows out, m^3/s")
    stated = sum(0.2 * math.pi * e["radius"] ** 2 for e in manifest["ends"] if e["kind"] == "inlet")
    near(into, stated, 0.001, f"{name}: 0.2 m/s at the inlets, m^3/s")
    expect(all(v > 0 for k, v in flows.items() if k.startswith("outlet")), f"{name}: something flows out of each outlet: {flows}")
    for end in manifest["ends"]:
        points = [p for t in solids[end["name"]] for p in t]
        middle = [sum(p[a] for p in points) / len(points) for a in range(3)]
        expect(math.dist(middle, end["position"]) < 0.3 * end["radius"], f"{name}: {end['name']} lies where it is said to")
    print(name, flows, re.search(r"cells: +(\d+)", logs["checkMesh"]).group(0))
    return flows


def check_split(name, program, folder, flows):
    """Checks that the flow of a fork splits by the resistances of `lumen export svzerod` for the same outlets."""
    lumen(program, folder, "export", "svzerod", f"{name}.lumen", f"{name}0", "--quiet")
    vessels = json.loads((folder / f"{name}0" / "model.json").read_text())["vessels"]
    resistance = {v["boundary_conditions"]["outlet"]: v["zero_d_element_values"]["R_poiseuille"] for v in vessels if "outlet" in v.get("boundary_conditions", {})}
    near(flows["outlet-root"] / flows["outlet-b01"], resistance["outlet-b01"] / resistance["outlet-root"], 0.05, f"{name}: the flow splits by resistances")


def make(program, folder, design):
    lumen(program, folder, "phantom", design, f"{design}.nrrd", "--size", "64", "--seeds", f"{design}.json", "--quiet")
    lumen(program, folder, "convert", f"{design}.nrrd", f"{design}.lumen", "--seeds", f"{design}.json", "--seeds-only", "--quiet")


def check(program, folder):
    make(program, folder, "bifurcation")
    check_split("bifurcation", program, folder, check_case("bifurcation", program, folder, 1))
    make(program, folder, "kissing")
    check_case("kissing", program, folder, 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen")
    parser.add_argument("--keep", help="an empty folder in which the cases stay")
    options = parser.parse_args()
    missing = [p for p in PROGRAMS if not shutil.which(p)]
    if missing: skip(f"OpenFOAM is not installed: there is no {missing[0]} (Debian: openfoam)")
    program = str(pathlib.Path(options.lumen).resolve())
    if options.keep: check(program, pathlib.Path(options.keep).resolve())
    else:
        with tempfile.TemporaryDirectory() as folder: check(program, pathlib.Path(folder))
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
