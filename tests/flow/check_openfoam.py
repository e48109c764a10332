#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs what `lumen export openfoam` writes in OpenFOAM (Debian: openfoam).

check_openfoam.py LUMEN [--keep FOLDER]

Allrun meshes a bifurcation and two vessels that touch, with layers at the wall and no failed check, and runs a steady flow until it
has converged. Balance, split, pressures beside Poiseuille's, and the stress in the table on the surface are checked. Exit
status: 0 all held, 1 something did not, 77 OpenFOAM is not installed."""
import argparse, csv, json, math, os, pathlib, re, shutil, subprocess, sys, tempfile
from flow_cases import *

DENSITY = 1060  # kg/m^3
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


def run(case):
    """The output of Allrun, and the logs."""
    expect(os.access(case / "Allrun", os.X_OK), "Allrun is a program")
    done = subprocess.run(["nice", "./Allrun"], cwd=case, capture_output=True, text=True)
    expect(done.returncode == 0, f"Allrun: {done.stdout} {done.stderr}")
    return done.stdout, {p: (case / f"log.{p}").read_text() if (case / f"log.{p}").is_file() else "" for p in PROGRAMS}


def table(file):
    """Points, triangles, and the arrays of each triangle of a VTP in ASCII."""
    arrays = {}
    for name, body in re.findall(r"<DataArray[^>]*Name=['\"](\w+)['\"][^>]*>(.*?)</DataArray>", file.read_text(), re.S):
        arrays[name] = [float(w) for w in body.split()]
    by3 = lambda v: [v[i:i + 3] for i in range(0, len(v), 3)]
    return by3(arrays["Points"]), by3([int(i) for i in arrays["connectivity"]]), arrays["pressure_Pa"], by3(arrays["wall_shear_stress_Pa"])


def check_wall(name, case, expected, ends):
    """The stress on the surface points downstream, and near the inlet it is somewhat less than Poiseuille's."""
    points, triangles, pressures, stresses = table(next(case.glob("wall-*.vtp")))
    expect(len(triangles) == len(pressures) == len(stresses), f"{name}: a value for each triangle")
    expect(all(map(math.isfinite, pressures)), f"{name}: pressures are numbers")
    for end in ends:
        if end["kind"] != "inlet": continue
        r, along, ahead = 1e3 * end["radius"], [-w for w in end["direction"]], []
        for t, stress in zip(triangles, stresses):
            middle = [sum(points[v][a] for v in t) / 3 - 1e3 * end["position"][a] for a in range(3)]
            if 2 < sum(m * w for m, w in zip(middle, along)) / r < 4 and math.hypot(*middle) < 5 * r:
                ahead.append(sum(s * w for s, w in zip(stress, along)))
        mean = sum(ahead) / max(1, len(ahead))
        poiseuille = 4 * 4e-3 * expected[end["name"]]["flow"] / (math.pi * end["radius"] ** 3)
        print(f"{name}: stress behind {end['name']} {mean / poiseuille:.3f} times Poiseuille's")
        # a chord across the first cell is flatter than the profile at the wall, and vessels bend away from the axis of their inlet
        expect(0.68 * poiseuille < mean < poiseuille, f"{name}: a stress of {mean} Pa behind {end['name']}, Poiseuille's is {poiseuille}")


def check_case(name, program, folder, parts):
    lumen(program, folder, "export", "openfoam", f"{name}.lumen", name, "--edge", "0.25r", "--cells", "coarse", "--quiet")
    case = folder / name
    manifest = json.loads((case / "lumen-export.json").read_text())
    printed, logs = run(case)
    expect("Surface is closed" in logs["surfaceCheck"], f"{name}: the surface is closed")
    expect(f"Number of unconnected parts : {parts}" in logs["surfaceCheck"], f"{name}: {parts} parts")
    expect("no illegal triangles" in logs["surfaceCheck"], f"{name}: no illegal triangles")
    expect("Finished meshing without any errors" in logs["snappyHexMesh"], f"{name}: meshed without errors")
    layered = re.findall(r"Extruding \d+ out of \d+ faces \(([0-9.]+)%\)", logs["snappyHexMesh"])
    expect(layered and float(layered[-1]) > 98, f"{name}: layers at the wall: {layered}")
    expect("Mesh OK." in logs["checkMesh"] and "Failed" not in logs["checkMesh"], f"{name}: the mesh is OK")
    expect("converged in" in printed, f"{name}: converged: {printed}")
    expect(abs(float(re.search(r"balance (\S+) %", printed).group(1))) < 0.01, f"{name}: the balance of flows: {printed}")
    solids = stl(case / "constant" / "triSurface" / "vessel.stl")
    meshed = float(re.search(r"Total volume = ([0-9]+\.[0-9]+(?:e[+-][0-9]+)?)", logs["checkMesh"]).group(1))
    enclosed = volume([t for s in solids.values() for t in s])
    print(f"{name}: layers on {layered[-1]} % of the wall, {meshed / enclosed:.4f} of the volume")
    # six cells across a vessel cut the corners of its section
    expect(0.975 < meshed / enclosed < 1, f"{name}: the mesh holds {meshed / enclosed} of what the surface encloses")
    post = lambda kind, end: last_flow(next((case / "postProcessing" / f"{kind}_{end}").rglob("surfaceFieldValue.dat")))
    expected = {row["end"]: {"flow": float(row["flow_m3_s"]), "drop": float(row["pressure_Pa"])} for row in csv.DictReader((case / "expected.csv").open())}
    speed = 0.2
    for end in manifest["ends"]:
        sign = -1 if end["kind"] == "inlet" else 1
        near(sign * post("flow", end["name"]), expected[end["name"]]["flow"], 0.001, f"{name}: the flow through {end['name']}, m^3/s")
        points = [p for t in solids[end["name"]] for p in t]
        middle = [sum(p[a] for p in points) / len(points) for a in range(3)]
        expect(math.dist(middle, end["position"]) < 0.3 * end["radius"], f"{name}: {end['name']} lies where it is said to")
        # the resistance goes with the fourth power of the radius, and the volume with its square; an even flow becomes a parabola at the
        # entrance, which takes 1.33 times the pressure of its speed, and behind a fork once more; bends add up to a seventh at their Dean
        # numbers of 20 to 35 (White, Proc R Soc A 123, 1929)
        drop, law, dynamic = DENSITY * post("pressure", end["name"]), expected[end["name"]]["drop"] * (enclosed / meshed) ** 2, DENSITY * speed ** 2 / 2
        if end["kind"] == "inlet":
            expect(law + dynamic < drop < 1.15 * law + 2.33 * dynamic, f"{name}: {drop} Pa at {end['name']}, by Poiseuille in the mesh {law}")
            print(f"{name}: {drop:.1f} Pa at {end['name']}, by Poiseuille in the mesh {law:.1f}, pressure of the speed {dynamic:.1f}")
    check_wall(name, case, expected, manifest["ends"])
    print(name, printed.splitlines()[-2:], re.search(r"cells: +(\d+)", logs["checkMesh"]).group(0))


def check_cycle(program, folder):
    """The verdict on two cycles of the heart, on series of its own: a periodic one, and one that grows by 0.2 a cycle."""
    lumen(program, folder, "export", "openfoam", "bifurcation.lumen", "beat", "--cells", "coarse", "--flow", "pulsatile", "--quiet")
    times = [2.2 * k / 777 for k in range(1, 778)]
    for growth, expected in ((0, 0), (0.2, 10.5)):  # its range over the cycle is 2 - 0.1
        rows = "".join(f"{t:.6g} {3 + math.sin(2 * math.pi * t / 1.1) + growth * t / 1.1:.8g}\n" for t in times)
        (folder / "series.dat").write_text("# Time value\n" + rows)
        said = subprocess.run(["awk", "-f", folder / "beat/constant/cycle.awk", folder / "series.dat"], capture_output=True, text=True).stdout
        mean, difference = map(float, said.split())
        near(mean, 3 + 1.5 * growth, 1e-3, f"the mean over the second cycle, growth {growth}")
        expect(abs(difference - expected) < 0.4, f"halves of cycles differ by {difference} % of the range, expected {expected}")


def make(program, folder, design):
    lumen(program, folder, "phantom", design, f"{design}.nrrd", "--size", "64", "--seeds", f"{design}.json", "--quiet")
    lumen(program, folder, "convert", f"{design}.nrrd", f"{design}.lumen", "--seeds", f"{design}.json", "--seeds-only", "--quiet")


def check(program, folder):
    make(program, folder, "bifurcation")
    check_cycle(program, folder)
    check_case("bifurcation", program, folder, 1)
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
